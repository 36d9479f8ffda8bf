#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "robot/measurements.h"
#include "robot/model.h"
#include "slam/process/message.h"

namespace rubble::slam {

/// What a mapper process is told before the first tick.
struct MapperHeader {
  robot::RobotModel model;
  std::uint64_t seed = 0;
  std::string parameters;  ///< lines of text for the mapper, YAML where it is one of ours
};

/// Texts of the protocol that docs/mapper_protocol.md describes, in both directions: what rubble says.
void append_header(std::string& text, const MapperHeader& header);
/// Victim cues are left out: they are no matter of mapping.
void append_tick(std::string& text, const robot::Inputs& inputs);
void append_finish(std::string& text);

/// Throws BadMessage.
MapperHeader read_header(MessageReader& in);

/// A tick, or the end of the measurements.
struct MapperRequest {
  bool finish = false;
  robot::Inputs inputs;
};

/// The next one; nothing when the other side has closed. Lines of kinds that are not known are skipped, as a mapper
/// shall do, so that later versions can add some. Throws BadMessage.
std::optional<MapperRequest> read_request(MessageReader& in);

}  // namespace rubble::slam
