#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "arenas/model/arena.h"

namespace rubble::arenas {

/// One of the league's building blocks on its pallet.
struct Element {
  std::string type;                ///< name in the arena designer of Team Hector, e.g. "half_ramp"
  mrpt::math::TPoint2D position;   ///< middle of the pallet [m]
  double rotation = 0.0;           ///< clockwise seen from above, as in arena files [rad]
  std::optional<int> mount_point;  ///< which hole of the wall behind it a victim's box hangs at
  mrpt::math::TPoint2D offset;     ///< shift of a free item on its pallet [m]
  std::optional<double> slope;     ///< of ramps: their angle instead of the model's own [rad]
  std::optional<double> friction;  ///< of its floors instead of the type's
  std::uint64_t thrown = 1;        ///< of step fields: which throw of the columns, as a seed
};

/// What is known about a type of element.
enum class ElementKind {
  Floor,     ///< lies on the pallet
  Wall,      ///< stands on the pallet's edge at the element's own +y
  Diagonal,  ///< a wall across the pallet
  Item,      ///< stands or hangs on the pallet, or on either side of a wall
  Label,     ///< known, but without a shape a robot or a laser could meet: signs, eye charts, floor colour
  Unknown,   ///< never heard of
};

ElementKind kind_of(const std::string& type);

/// All types that have a shape, in alphabetical order.
std::vector<std::string> element_types();

/// Whether the type is a ramp whose angle may be given.
bool has_slope(const std::string& type);

/// Whether the type is a step field, whose columns are thrown.
bool is_thrown(const std::string& type);

/// Whether wheels can stand on the type, so that its friction may be given.
bool has_floor(const std::string& type);

/// What the type is and does, one line; empty for labels and unknown types.
std::string description_of(const std::string& type);

/// "floor", "wall", ...
std::string name_of(ElementKind kind);

/// The wall on the same edge of the same pallet as an item, or null: victims hang at its holes.
const Element* wall_behind(const Element& item, const std::vector<Element>& elements);

/// Whether the element is a floor that hides the ground of its whole pallet.
bool covers_pallet(const std::string& type);

/// Adds the shape of an element to the arena; labels and unknown types add nothing. `wall` is the wall on the same edge
/// of the same pallet, if there is one: victims hang at its holes. Dimensions: Team Hector's models of the NIST arena
/// elements (hector_nist_arenas_gazebo, BSD), measured.
void place(const Element& element, const Element* wall, Arena& arena);

}  // namespace rubble::arenas
