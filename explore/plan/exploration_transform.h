#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/grid.h"
#include "explore/plan/traversable.h"

namespace rubble::explore {

/// How the discomfort of eq. (3) is summed along a way.
enum class Discomfort {
  PerMetre,  ///< times the length of each step: the same way costs the same at any resolution, and no metre more than
             ///< 60
  PerCell    ///< as printed: of every cell of the way, first and last included
};

/// Distances are compared with this slack [m]: 7 cells of 0.05 m are 0.35 m, also in float.
inline constexpr double kClearanceRounding = 1e-4;

struct TransformConfig {
  double alpha = 20.0;  ///< weight of the discomfort against length, per metre travelled
  double d_min = 0.40;  ///< never closer to an obstacle [m]
  double d_opt = 0.60;  ///< distance to obstacles the robot likes best [m]
  Discomfort discomfort = Discomfort::PerMetre;
};

/// Discomfort of a place at distance d from the nearest obstacle, eq. (4): infinite below d_min, else (d_opt - d)^2.
/// Two-sided: near walls are dangerous, and a short-range scanner far from all walls loses its landmarks.
double danger(double d, const TransformConfig& config);

/// A cell a way may end in; `head_start` makes ways to it look longer [m].
struct Source {
  Cell cell;
  double head_start = 0.0;
};

/// The Exploration Transform, eq. (3): for every free cell the cost of the cheapest way to any of the sources, where a
/// metre costs 1 + alpha * danger metres. With all frontier cells as sources it is Wirth and Pellenz's transform
/// (2007), with one source Zelinsky's path transform (1991). It has no local minima: every reached cell that is no
/// source has a lower neighbour. Multi-source Dijkstra on steps of 12 : 17 with a bucket queue (Dial 1969), the buckets
/// as wide as the cheapest step allows (Dinitz 1978). Keeps its memory between runs.
class ExplorationTransform {
 public:
  /// Runs over the free cells of `floor` (its clearance measured). With `until`, stops once the cost of that cell is
  /// final: costs not below it are then not final.
  void run(const Traversable& floor, const std::vector<Source>& sources, const TransformConfig& config,
           std::optional<Cell> until = std::nullopt);

  /// Whether the robot's centre may be in this cell.
  bool passable(Cell c) const;
  bool reached(Cell c) const;
  /// Cost to the nearest source [m of undisturbed way]; inf where none can be reached.
  double cost(Cell c) const;
  /// The cells of the cheapest way from `from` to its source, both included; empty when there is none.
  std::vector<Cell> descend(Cell from) const;

 private:
  /// A cell's cost so far and the cost of a step out of it, straight and diagonal; steps of 0: impassable.
  struct Node {
    std::uint32_t cost;
    std::uint16_t straight;
    std::uint16_t diagonal;
  };
  struct Start {
    std::uint32_t cost;
    std::uint32_t cell;
  };

  static constexpr std::uint32_t kBuckets = 128;

  void run_per_cell(const Traversable& floor, const std::vector<Source>& sources, const TransformConfig& config);
  void prepare(const Traversable& floor, const TransformConfig& config);
  void expand(const std::vector<Start>& starts, std::uint32_t until);
  void push(std::uint32_t cell, std::uint32_t cost);
  /// The first bucket >= `from` that is not empty; all of them lie in [from, from + kBuckets).
  std::uint32_t next_bucket(std::uint32_t from) const;
  std::size_t index(Cell c) const { return frame_.index(c); }

  GridFrame frame_;
  std::vector<Node> nodes_;
  std::array<std::vector<std::uint32_t>, kBuckets> buckets_;  ///< of cells, by cost, in a ring
  std::vector<double> per_cell_;                              ///< costs as printed [m]; empty: those of the nodes hold
  std::vector<std::uint32_t> towards_;                        ///< then the next cell of each one's way
};

}  // namespace rubble::explore
