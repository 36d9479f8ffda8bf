#pragma once

#include <mrpt/math/TPoint2D.h>

#include <map>
#include <optional>
#include <vector>

#include "arenas/model/arena.h"
#include "arenas/model/drawing.h"
#include "base/yaml/strict_yaml.h"

namespace rubble::arenas {

/// The pallets and walls of an arena file in metres, and the letters that name pallets.
class Plan {
 public:
  /// Reads `maze` and the sizes that go with it, and adds floors, walls and blocks to the arena.
  Plan(const YamlMap& root, Arena& arena);

  /// Where an entry of a list lies: `x_m` and `y_m`, or the middle of each pallet marked `cell`, moved by `dx_m`,
  /// `dy_m`.
  std::vector<mrpt::math::TPoint2D> places(const YamlMap& entry);
  /// The same for entries that can lie in one place only.
  mrpt::math::TPoint2D place(const YamlMap& entry);

  double wall_height() const { return wall_height_; }
  double wall_thickness() const { return wall_thickness_; }
  double cell_size() const { return cell_size_; }

  /// The pallet marked S.
  const std::optional<DrawnCell>& start_cell() const { return start_cell_; }
  mrpt::math::TPoint2D start() const { return start_; }

  /// Throws InputError at a letter that no entry asked for.
  void finish(const YamlMap& root) const;

 private:
  struct Mark {
    std::vector<mrpt::math::TPoint2D> centres;
    DrawnCell first;
    bool used = false;
  };

  void add_cells(const YamlMap& root, Arena& arena, const Drawing& drawing, double ramp_slope);
  void add_walls(Arena& arena, const Drawing& drawing) const;

  double cell_size_;
  double wall_height_;
  double wall_thickness_;
  std::map<char, Mark> marks_;
  std::optional<DrawnCell> start_cell_;
  mrpt::math::TPoint2D start_;
};

}  // namespace rubble::arenas
