#pragma once

#include <array>

#include "base/image/geotiff.h"

/// The colours of league maps (RoboCupRescue GeoTIFF map rules, as hector_geotiff and crosbot draw them), for writing
/// and reading alike. docs/map_readers.md has the table.
namespace rubble::scoring::league {

constexpr Rgb kWall{0, 40, 120};
constexpr Rgb kUnexplored{226, 226, 227};  ///< the checkerboard's darker squares
constexpr Rgb kUnexploredLight{237, 237, 238};
constexpr Rgb kFree{255, 255, 255};      ///< surely free; less sure: darker greys
constexpr Rgb kSearched{130, 230, 130};  ///< surely free, and searched for victims; less sure: towards the next
constexpr Rgb kSearchedUnsure{180, 230, 180};
constexpr Rgb kGridLine{190, 190, 191};
constexpr Rgb kPath{120, 0, 140};
constexpr Rgb kStart{255, 200, 0};  ///< arrow at the robot's start
constexpr Rgb kVictim{240, 10, 10};
constexpr Rgb kUnconfirmedVictim{240, 100, 10};
constexpr Rgb kHazard{255, 100, 30};
constexpr Rgb kQrCode{10, 10, 240};
constexpr Rgb kScale{0, 50, 140};  ///< and axes
constexpr Rgb kTitle{0, 44, 207};  ///< file name
constexpr Rgb kLettering{255, 255, 255};

/// Ground first: of two that are alike after a change it is the likelier.
constexpr std::array<Rgb, 15> kAll{
    kUnexplored, kUnexploredLight,   kFree,   kSearched, kSearchedUnsure, kWall, kGridLine, kPath, kStart,
    kVictim,     kUnconfirmedVictim, kHazard, kQrCode,   kScale,          kTitle};

constexpr double kVictimRadius = 0.175;  ///< of a victim's circle [m]

}  // namespace rubble::scoring::league
