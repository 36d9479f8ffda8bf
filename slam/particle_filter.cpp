#include "slam/particle_filter.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

/// Indices of the particles, heaviest first; equal weights keep their order.
std::vector<std::size_t> by_weight(const Particles& particles) {
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return particles[a].weight > particles[b].weight; });
  return order;
}

/// Beam ends in the base frame in cells, x and y apart so that the compiler can take four at a time.
struct Beams {
  std::vector<float> x;
  std::vector<float> y;
  double reach = 0.0;  ///< of the farthest [cells]
};

Beams beams_in_cells(const std::vector<TPoint2D>& hits, double resolution) {
  Beams beams;
  beams.x.reserve(hits.size());
  beams.y.reserve(hits.size());
  for (const TPoint2D& p : hits) {
    beams.x.push_back(static_cast<float>(p.x / resolution));
    beams.y.push_back(static_cast<float>(p.y / resolution));
    beams.reach = std::max(beams.reach, std::hypot(p.x, p.y) / resolution);
  }
  return beams;
}

/// Where a particle's beams end on the grid: rotation and position in cells.
struct BeamTransform {
  float c, s, x, y;
};

/// Eq. (2) for a particle all of whose beams end inside the map.
std::uint32_t sum_inside(const BeamTransform& T, const Beams& beams, const std::uint8_t* plane, int width,
                         std::vector<std::int32_t>& cells) {
  const std::size_t n = beams.x.size();
  const float* x = beams.x.data();
  const float* y = beams.y.data();
  std::int32_t* cell = cells.data();
  for (std::size_t k = 0; k < n; ++k) {  // vectorised; coordinates are positive, so truncation is floor
    const std::int32_t column = static_cast<std::int32_t>(T.c * x[k] - T.s * y[k] + T.x);
    const std::int32_t row = static_cast<std::int32_t>(T.s * x[k] + T.c * y[k] + T.y);
    cell[k] = row * width + column;
  }
  std::uint32_t sum = 0;
  for (std::size_t k = 0; k < n; ++k) sum += plane[cell[k]];  // eq. (2)
  return sum;
}

/// The same where beams may end outside.
std::uint32_t sum_checked(const BeamTransform& T, const Beams& beams, const std::uint8_t* plane,
                          const GridFrame& frame) {
  std::uint32_t sum = 0;
  for (std::size_t k = 0; k < beams.x.size(); ++k) {
    const float column = std::floor(T.c * beams.x[k] - T.s * beams.y[k] + T.x);
    const float row = std::floor(T.s * beams.x[k] + T.c * beams.y[k] + T.y);
    if (!(column >= 0.0f && row >= 0.0f && column < static_cast<float>(frame.width) &&
          row < static_cast<float>(frame.height))) {
      continue;
    }
    sum += plane[frame.index({static_cast<int>(column), static_cast<int>(row)})];  // eq. (2)
  }
  return sum;
}

}  // namespace

Particles particles_at(const TPose2D& T_map_base, int count) {
  return Particles(static_cast<std::size_t>(count), Particle{T_map_base, 1.0 / count});
}

Particles resample(Particles particles) {
  const std::size_t n = particles.size();
  Particles children;
  children.reserve(n);
  for (const std::size_t parent : by_weight(particles)) {
    const double share = static_cast<double>(n) * particles[parent].weight;
    const double wanted = std::floor(share + 0.5 + 0.5);  // round(N w + 0.5): at least one, so N are always filled
    for (double child = 0.0; child < wanted && children.size() < n; child += 1.0) {
      children.push_back({particles[parent].T_map_base, 1.0 / static_cast<double>(n)});
    }
  }
  return children;
}

Particles drift(Particles particles, const TPose2D& T_last_now, const MotionError& error, Rng& rng) {
  const double distance = std::hypot(T_last_now.x, T_last_now.y);
  const double turn = wrap_angle(T_last_now.phi);
  const double sigma_start = error.rotation * std::abs(turn);
  const double sigma_scale = distance > 0.0 ? error.distance : 0.0;
  const double sigma_end = error.heading_per_m * distance;
  for (Particle& particle : particles) {
    const double start = rng.gaussian(sigma_start);        // initial orientation
    const double scale = 1.0 + rng.gaussian(sigma_scale);  // distance
    const double end = rng.gaussian(sigma_end);            // orientation when the motion is finished
    const double heading = particle.T_map_base.phi + start;
    const double c = std::cos(heading);
    const double s = std::sin(heading);
    particle.T_map_base.x += scale * (c * T_last_now.x - s * T_last_now.y);
    particle.T_map_base.y += scale * (s * T_last_now.x + c * T_last_now.y);
    particle.T_map_base.phi = wrap_angle(heading + turn + end);
  }
  return particles;
}

Particles measure(Particles particles, const std::vector<TPoint2D>& hits, const CountMap& map) {
  const GridFrame& frame = map.frame();
  const Beams beams = beams_in_cells(hits, frame.resolution);
  std::vector<std::int32_t> cells(hits.size());
  for (Particle& particle : particles) {
    const TPose2D& T = particle.T_map_base;
    const double x = (T.x - frame.x0) / frame.resolution;
    const double y = (T.y - frame.y0) / frame.resolution;
    const double margin = beams.reach + 1.0;
    const BeamTransform beam_transform{static_cast<float>(std::cos(T.phi)), static_cast<float>(std::sin(T.phi)),
                                       static_cast<float>(x), static_cast<float>(y)};
    const bool inside = x > margin && y > margin && x + margin < frame.width && y + margin < frame.height;
    const std::uint32_t sum = inside ? sum_inside(beam_transform, beams, map.p_occ_plane(), frame.width, cells)
                                     : sum_checked(beam_transform, beams, map.p_occ_plane(), frame);
    particle.weight = static_cast<double>(sum);
  }
  return particles;
}

Particles normalise(Particles particles) {
  double sum = 0.0;
  for (const Particle& particle : particles) sum += particle.weight;
  const double uniform = 1.0 / static_cast<double>(particles.size());
  for (Particle& particle : particles) particle.weight = sum > 0.0 ? particle.weight / sum : uniform;
  return particles;
}

TPose2D mean_of_best(const Particles& particles, double share) {
  const std::vector<std::size_t> order = by_weight(particles);
  const double wanted = std::round(share * static_cast<double>(particles.size()));
  const std::size_t best = std::clamp<std::size_t>(static_cast<std::size_t>(std::max(0.0, wanted)), 1, order.size());
  double x = 0.0, y = 0.0, c = 0.0, s = 0.0;
  for (std::size_t i = 0; i < best; ++i) {
    const TPose2D& T = particles[order[i]].T_map_base;
    x += T.x;
    y += T.y;
    c += std::cos(T.phi);
    s += std::sin(T.phi);
  }
  const double n = static_cast<double>(best);
  return {x / n, y / n, std::atan2(s, c)};
}

}  // namespace rubble::slam
