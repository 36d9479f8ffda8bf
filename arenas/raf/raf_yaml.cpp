#include <algorithm>
#include <cmath>

#include "arenas/model/drawing.h"
#include "arenas/raf/raf.h"
#include "arenas/raf/raf_layout.h"
#include "base/angle.h"
#include "base/text/number_text.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;

/// A name without what would end a quoted text.
std::string plain(std::string name) {
  for (char& c : name) {
    if (c == '"' || c == '\\' || static_cast<unsigned char>(c) < 0x20) c = '_';
  }
  return name;
}

bool is_ground(const FloorPatch& patch) { return patch.element == kFlatElement; }

/// The pallets from the first to the last that carries ground or a part.
GridFrame frame_of(const RafImport& import) {
  TPoint2D low{1e9, 1e9};
  TPoint2D high{-1e9, -1e9};
  const auto include = [&](const TPoint2D& corner) {
    low = {std::min(low.x, corner.x), std::min(low.y, corner.y)};
    high = {std::max(high.x, corner.x + kPallet), std::max(high.y, corner.y + kPallet)};
  };
  for (const FloorPatch& patch : import.arena.floor) {
    if (is_ground(patch)) include(patch.outline[0]);
  }
  for (const Element& e : import.elements) include(e.position - TPoint2D{0.5 * kPallet, 0.5 * kPallet});
  return {static_cast<int>(std::lround((high.x - low.x) / kPallet)),
          static_cast<int>(std::lround((high.y - low.y) / kPallet)), kPallet, low.x, low.y};
}

Drawing drawing_of(const RafImport& import, const GridFrame& frame) {
  Drawing drawing{Grid<DrawnCell>(frame), {}, {}};
  const std::size_t columns = static_cast<std::size_t>(frame.width);
  const std::size_t rows = static_cast<std::size_t>(frame.height);
  drawing.lying.assign(columns * (rows + 1), ' ');
  drawing.upright.assign((columns + 1) * rows, ' ');
  for (const FloorPatch& patch : import.arena.floor) {
    if (is_ground(patch)) drawing.cells[frame.cell(patch.outline[0] + TPoint2D{0.1, 0.1})].shape = '.';
  }
  return drawing;
}

std::string element_line(const Element& e, const TPoint2D& origin) {
  const TPoint2D p = e.position + e.offset - origin;
  std::string line = "  - {type: " + e.type + ", x_m: " + metres_text(p.x) + ", y_m: " + metres_text(p.y);
  const double turn = rad_to_deg(e.rotation);
  if (turn != 0.0) line += ", rotation_deg: " + metres_text(turn);
  if (e.mount_point) line += ", mount_point: " + std::to_string(*e.mount_point);
  return line + "}\n";
}

}  // namespace

std::string to_yaml(const RafImport& import) {
  const GridFrame frame = frame_of(import);
  const TPoint2D origin{frame.x0, frame.y0};
  std::string text = "# Imported: " + import.summary() + ".\n";
  text += "name: \"" + plain(import.arena.name) + "\"\n\nmaze: |\n";
  for (const std::string& line : draw(drawing_of(import, frame))) text += "  " + line + "\n";
  const mrpt::math::TPose2D& start = import.arena.start;
  text += "\nstart: {x_m: " + metres_text(start.x - origin.x) + ", y_m: " + metres_text(start.y - origin.y) +
          ", heading_deg: " + metres_text(rad_to_deg(start.phi)) + "}\n\nelements:\n";
  for (const Element& e : import.elements) text += element_line(e, origin);
  return text;
}

}  // namespace rubble::arenas
