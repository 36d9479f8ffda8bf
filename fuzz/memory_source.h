#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>

#include "slam/process/message.h"

namespace rubble::fuzz {

/// The input as bytes that come over a pipe, a few at a time, so that every seam between two reads is met.
class MemorySource : public slam::ByteSource {
 public:
  MemorySource(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}

  std::size_t read(char* to, std::size_t at_most) override {
    const std::size_t part = std::min({at_most, left_, part_});
    part_ = part_ % 97 + 16;
    if (part > 0) std::memcpy(to, data_, part);
    data_ += part;
    left_ -= part;
    return part;
  }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
  std::size_t part_ = 16;
};

}  // namespace rubble::fuzz
