#pragma once

#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "base/error.h"
#include "scoring/maps/normalise.h"
#include "scoring/walls/resample.h"

/// The labelled sensor-map pairs of two Halmstad buildings and the rule by which an alignment of them succeeds.
namespace rubble::scoring::testing {

constexpr double kPairResolution = 0.05;  ///< [m] a pixel
constexpr int kPairSide = 1585;           ///< [pixels]

struct LabelledPair {
  std::string map_a;
  std::string map_b;
  std::vector<mrpt::math::TPoint2D> a;  ///< [m]
  std::vector<mrpt::math::TPoint2D> b;
};

/// The pairs of sensor maps in `points.csv`; layouts, which have another scale, are left out.
inline std::vector<LabelledPair> load_pairs(const std::string& folder) {
  std::ifstream file(folder + "/points.csv");
  if (!file) throw InputError(folder + "/points.csv: cannot be opened");
  std::vector<LabelledPair> pairs;
  std::string line;
  std::getline(file, line);
  while (std::getline(file, line)) {
    std::stringstream fields(line);
    std::string map_a;
    std::string map_b;
    std::string field;
    std::getline(fields, map_a, ',');
    std::getline(fields, map_b, ',');
    double px[4] = {};
    for (double& value : px) {
      std::getline(fields, field, ',');
      value = std::stod(field);
    }
    if (map_b.find("layout") != std::string::npos) continue;
    if (pairs.empty() || pairs.back().map_a != map_a || pairs.back().map_b != map_b)
      pairs.push_back({map_a, map_b, {}, {}});
    const auto metres = [](double x, double y) {
      return mrpt::math::TPoint2D((x + 0.5) * kPairResolution, (kPairSide - y - 0.5) * kPairResolution);
    };
    pairs.back().a.push_back(metres(px[0], px[1]));
    pairs.back().b.push_back(metres(px[2], px[3]));
  }
  return pairs;
}

inline std::map<std::string, OccupancyGrid> load_maps(const std::string& folder,
                                                      const std::vector<LabelledPair>& pairs) {
  std::map<std::string, OccupancyGrid> maps;
  for (const LabelledPair& pair : pairs)
    for (const std::string& name : {pair.map_a, pair.map_b})
      if (maps.count(name) == 0)
        maps[name] = crop_to_known(load_map(folder + "/" + name + ".png", {kPairResolution}).grid, 0.0);
  return maps;
}

inline double mean_error(const LabelledPair& pair, const mrpt::math::TPose2D& T_b_a) {
  double sum = 0.0;
  for (std::size_t i = 0; i < pair.a.size(); ++i) sum += (T_b_a.composePoint(pair.a[i]) - pair.b[i]).norm();
  return sum / static_cast<double>(pair.a.size());
}

/// Least-squares rigid fit of the labels.
inline mrpt::math::TPose2D best_fit(const LabelledPair& pair) {
  mrpt::math::TPoint2D mean_a(0.0, 0.0);
  mrpt::math::TPoint2D mean_b(0.0, 0.0);
  const double n = static_cast<double>(pair.a.size());
  for (std::size_t i = 0; i < pair.a.size(); ++i) {
    mean_a += pair.a[i];
    mean_b += pair.b[i];
  }
  mean_a *= 1.0 / n;
  mean_b *= 1.0 / n;
  double dot = 0.0;
  double cross = 0.0;
  for (std::size_t i = 0; i < pair.a.size(); ++i) {
    const mrpt::math::TPoint2D a = pair.a[i] - mean_a;
    const mrpt::math::TPoint2D b = pair.b[i] - mean_b;
    dot += a.x * b.x + a.y * b.y;
    cross += a.x * b.y - a.y * b.x;
  }
  const double phi = std::atan2(cross, dot);
  const mrpt::math::TPoint2D turned = mrpt::math::TPose2D(0.0, 0.0, phi).composePoint(mean_a);
  return {mean_b.x - turned.x, mean_b.y - turned.y, phi};
}

/// Mean error an alignment may have: 1 m, or half as much again as the best rigid fit.
inline double allowed_error(const LabelledPair& pair) { return std::max(1.0, 1.5 * mean_error(pair, best_fit(pair))); }

}  // namespace rubble::scoring::testing
