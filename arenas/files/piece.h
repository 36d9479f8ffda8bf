#pragma once

#include <mrpt/math/TPoint2D.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arenas/model/drawing.h"
#include "base/yaml/strict_yaml.h"
#include "base/yaml/yaml_node.h"

namespace rubble::arenas {

inline constexpr double kFar = 500.0;  ///< no place or length in an arena file is more [m]

/// The lists of an arena file: what stands or lies somewhere.
const std::vector<std::string>& list_keys();

/// Where a piece is put: turned by quarters counter-clockwise, then with the south-western corner of its drawing on a
/// pallet.
struct PiecePlace {
  int column = 0, row = 0;  ///< from the south-western pallet of the arena
  int quarters = 0;         ///< 0 to 3
  std::string name;         ///< put before the names of its victims
};

/// The drawing after `quarters` quarter turns counter-clockwise: walls, ramps and marks turn with it.
Drawing turned(const Drawing& drawing, int quarters);

/// One arena file that another one includes, itself without `include` any more: reads its entries where the including
/// arena has them. Letters of its own drawing become places in metres; without a drawing it takes the includer's.
class Piece {
 public:
  /// `root` must stay; `cell_size` in metres. Throws InputError in the drawing.
  Piece(const YamlMap& root, const PiecePlace& place, double cell_size);

  /// Its drawing as the arena has it, or nothing.
  const std::optional<Drawing>& drawing() const { return drawing_; }
  const PiecePlace& place() const { return place_; }

  /// The entries of one of list_keys(), each a map of its own. Throws InputError at the place in the piece.
  std::vector<std::shared_ptr<YamlNode>> entries(const std::string& key);

  /// `start` as a map of x_m, y_m and heading_deg, or null when the file says nothing about it.
  std::shared_ptr<YamlNode> start() const;

  /// Throws InputError at a letter of its drawing that none of its entries asked for.
  void finish() const;

 private:
  struct Mark {
    std::vector<mrpt::math::TPoint2D> centres;  ///< [m], in the piece's own frame
    int row = 0, column = 0;                    ///< in the text of the drawing
    bool used = false;
  };

  mrpt::math::TPoint2D in_arena(mrpt::math::TPoint2D p) const;
  mrpt::math::TPoint2D turned_vector(mrpt::math::TPoint2D v) const;
  void add_turn(const YamlMap& entry, const std::string& key, int quarters) const;
  void move_points(const YamlMap& entry, const std::string& key) const;
  std::vector<std::shared_ptr<YamlNode>> moved_to_cells(const YamlMap& entry, const std::string& key);
  void turn_bearings(const YamlMap& entry, const std::string& key) const;

  const YamlMap& root_;
  PiecePlace place_;
  double cell_size_;
  double width_ = 0.0, height_ = 0.0;  ///< of its own drawing before the turn [m]
  std::optional<Drawing> drawing_;
  std::map<char, Mark> marks_;
};

/// A plain number as a YAML value that stands at `place`.
std::shared_ptr<YamlNode> number_node(double value, const YamlPlace& place);

}  // namespace rubble::arenas
