#include "slam/paper/particle_filter.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "base/planar.h"

namespace rubble::slam {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

namespace {

/// A particle's place in the order by weight: heaviest first, equal weights by their index.
struct Rank {
  double weight;
  std::size_t index;
  bool operator<(const Rank& other) const {
    return weight != other.weight ? weight > other.weight : index < other.index;
  }
};

/// The `count` heaviest in order, the others behind them in any.
std::vector<Rank> heaviest_first(const Particles& particles, std::size_t count) {
  std::vector<Rank> ranks(particles.size());
  for (std::size_t i = 0; i < ranks.size(); ++i) ranks[i] = {particles[i].weight, i};
  const auto end = ranks.begin() + static_cast<std::ptrdiff_t>(count);
  if (count < ranks.size()) std::nth_element(ranks.begin(), end, ranks.end());
  std::sort(ranks.begin(), end);
  return ranks;
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
    beams.reach = std::max(beams.reach, length(p) / resolution);
  }
  return beams;
}

/// Where a particle's beams end on the grid: rotation and position in cells.
struct BeamTransform {
  float c, s, x, y;
};

/// Where a cell's p_occ lies: the number of its tile, and its place in it in the low bits.
constexpr int kTileBits = 6;
constexpr int kPlaceBits = 2 * kTileBits;
static_assert(CountTiles::kSide == 1 << kTileBits);

/// Of the beam ends of a particle all of whose beams end inside the map. Coordinates are positive, so truncation is
/// floor. Built twice from the same source: all operations are exact or rounded alike, so both give the same bits.
__attribute__((always_inline)) inline void index_cells(const BeamTransform& T, const Beams& beams, int across,
                                                       std::int32_t* __restrict cell) {
  constexpr std::int32_t kInTile = CountTiles::kSide - 1;
  const std::size_t n = beams.x.size();
  const float* __restrict x = beams.x.data();
  const float* __restrict y = beams.y.data();
  for (std::size_t k = 0; k < n; ++k) {
    const std::int32_t column = static_cast<std::int32_t>(T.c * x[k] - T.s * y[k] + T.x);
    const std::int32_t row = static_cast<std::int32_t>(T.s * x[k] + T.c * y[k] + T.y);
    const std::int32_t tile = (row >> kTileBits) * across + (column >> kTileBits);
    cell[k] = (tile << kPlaceBits) | ((row & kInTile) << kTileBits) | (column & kInTile);
  }
}

void index_cells_anywhere(const BeamTransform& T, const Beams& beams, int across, std::int32_t* cell) {
  index_cells(T, beams, across, cell);
}

#if defined(__x86_64__)
__attribute__((target("avx2"))) void index_cells_avx2(const BeamTransform& T, const Beams& beams, int across,
                                                      std::int32_t* cell) {
  index_cells(T, beams, across, cell);
}
const bool kHasAvx2 = __builtin_cpu_supports("avx2");
const auto index_cells_here = kHasAvx2 ? index_cells_avx2 : index_cells_anywhere;
#else
const auto index_cells_here = index_cells_anywhere;
#endif

/// Eq. (2) for a particle all of whose beams end inside the map.
std::uint32_t sum_inside(const BeamTransform& T, const Beams& beams, const CountTiles& tiles,
                         std::vector<std::int32_t>& cells) {
  index_cells_here(T, beams, tiles.across(), cells.data());
  const CountTiles::Tile* const* const all = tiles.all();
  const auto p_occ = [&](std::int32_t cell) {
    return all[cell >> kPlaceBits]->p_occ[static_cast<std::size_t>(cell) % CountTiles::kCells];
  };
  const std::int32_t* cell = cells.data();
  std::array<std::uint32_t, 4> sums{};  // four chains: the loads need not wait for each other's additions
  const std::size_t n = cells.size();
  std::size_t k = 0;
  for (; k + 4 <= n; k += 4) {
    for (std::size_t i = 0; i < 4; ++i) sums[i] += p_occ(cell[k + i]);
  }
  for (; k < n; ++k) sums[0] += p_occ(cell[k]);
  return sums[0] + sums[1] + sums[2] + sums[3];
}

/// The same where beams may end outside.
std::uint32_t sum_checked(const BeamTransform& T, const Beams& beams, const CountMap& map) {
  const GridFrame& frame = map.frame();
  std::uint32_t sum = 0;
  for (std::size_t k = 0; k < beams.x.size(); ++k) {
    const float column = std::floor(T.c * beams.x[k] - T.s * beams.y[k] + T.x);
    const float row = std::floor(T.s * beams.x[k] + T.c * beams.y[k] + T.y);
    if (!(column >= 0.0f && row >= 0.0f && column < static_cast<float>(frame.width) &&
          row < static_cast<float>(frame.height))) {
      continue;
    }
    sum += map.p_occ_255({static_cast<int>(column), static_cast<int>(row)});  // eq. (2)
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
  for (const Rank& parent : heaviest_first(particles, n)) {
    const double share = static_cast<double>(n) * parent.weight;
    const double wanted = std::floor(share + 0.5 + 0.5);  // round(N w + 0.5): at least one, so N are always filled
    for (double child = 0.0; child < wanted && children.size() < n; child += 1.0) {
      children.push_back({particles[parent.index].T_map_base, 1.0 / static_cast<double>(n)});
    }
  }
  return children;
}

Particles drift(Particles particles, const TPose2D& T_last_now, const MotionError& error, Rng& rng) {
  const double path = length(T_last_now.x, T_last_now.y);
  const double turn = wrap_angle(T_last_now.phi);
  const double sigma_start = error.rotation * std::abs(turn);
  const double sigma_scale = path > 0.0 ? error.distance : 0.0;
  const double sigma_end = error.heading_per_m * path;
  const double sigma_slide = error.distance_per_rad * std::abs(turn);
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
    if (sigma_slide > 0.0) {  // else not a draw: the paper's bits
      particle.T_map_base.x += rng.gaussian(sigma_slide);
      particle.T_map_base.y += rng.gaussian(sigma_slide);
    }
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
    const std::uint32_t sum =
        inside ? sum_inside(beam_transform, beams, map.tiles(), cells) : sum_checked(beam_transform, beams, map);
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
  const double wanted = std::round(share * static_cast<double>(particles.size()));
  const std::size_t best =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::max(0.0, wanted)), 1, particles.size());
  const std::vector<Rank> order = heaviest_first(particles, best);
  double x = 0.0, y = 0.0, c = 0.0, s = 0.0;
  for (std::size_t i = 0; i < best; ++i) {
    const TPose2D& T = particles[order[i].index].T_map_base;
    x += T.x;
    y += T.y;
    c += std::cos(T.phi);
    s += std::sin(T.phi);
  }
  const double n = static_cast<double>(best);
  return {x / n, y / n, std::atan2(s, c)};
}

PoseCovariance spread(const Particles& particles) {
  if (particles.empty()) return {};
  double c = 0.0, s = 0.0, x = 0.0, y = 0.0;
  for (const Particle& particle : particles) {
    x += particle.weight * particle.T_map_base.x;
    y += particle.weight * particle.T_map_base.y;
    c += particle.weight * std::cos(particle.T_map_base.phi);
    s += particle.weight * std::sin(particle.T_map_base.phi);
  }
  const double heading = std::atan2(s, c);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (const Particle& particle : particles) {
    const Eigen::Vector3d off(particle.T_map_base.x - x, particle.T_map_base.y - y,
                              wrap_angle(particle.T_map_base.phi - heading));
    covariance += particle.weight * off * off.transpose();
  }
  return PoseCovariance(covariance);
}

}  // namespace rubble::slam
