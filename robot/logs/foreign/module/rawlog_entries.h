#pragma once

#include <mrpt/serialization/CSerializable.h>

#include <functional>
#include <string>
#include <string_view>

namespace rubble::robot {

/// Hands out the objects of a rawlog in order, with their number from 0. Throws InputError that says where the file
/// ends in the middle of an object or cannot be understood.
void each_rawlog_entry(std::string_view bytes, const std::string& path,
                       const std::function<void(std::size_t, const mrpt::serialization::CSerializable::Ptr&)>& visit);

}  // namespace rubble::robot
