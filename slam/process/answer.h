#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "base/grid.h"
#include "base/trajectory.h"
#include "slam/mapper.h"
#include "slam/process/message.h"

namespace rubble::slam {

/// A whole map, as an answer carries it.
struct AnsweredMap {
  GridFrame frame;
  std::vector<std::uint16_t> seen;
  std::vector<std::uint16_t> occupied;
};

/// What a mapper process says about one tick: only what is new.
struct MapperAnswer {
  std::optional<mrpt::math::TPose2D> pose;  ///< T_map_base at the newest odometry (or scan)
  std::optional<PoseCovariance> covariance;
  std::vector<StampedPose> at;          ///< T_map_base at scans digested now
  std::optional<Trajectory> corrected;  ///< the whole trajectory: poses of the past have moved
  std::optional<std::uint64_t> mapped;  ///< scans in the map
  std::optional<bool> settled;          ///< the map shows each scan where the trajectory has it
  std::optional<double> blind_way;      ///< by odometry alone, since scans last told how far [m]
  std::vector<MapperFigure> figures;
  std::optional<AnsweredMap> map;
};

/// Texts of the protocol that docs/mapper_protocol.md describes, in both directions: what a mapper says.
void append_ready(std::string& text);
/// The map in its counts.
void append_answer(std::string& text, const MapperAnswer& answer);

/// Throws BadMessage.
void read_ready(MessageReader& in);
MapperAnswer read_answer(MessageReader& in);

}  // namespace rubble::slam
