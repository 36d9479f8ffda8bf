#include "arenas/raf/raf.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "arenas/elements/elements.h"
#include "arenas/model/geometry.h"
#include "arenas/raf/raf_layout.h"
#include "arenas/raf/raf_reader.h"
#include "arenas/raf/raf_start.h"
#include "base/error.h"
#include "base/planar.h"
#include "base/text/text_file.h"
#include "base/text/words.h"

namespace rubble::arenas {
namespace {

constexpr int kMostPallets = 6000;  ///< from the first element to the last; rc_2015_arena_big has 544

std::string list(const std::map<std::string, int>& counts) {
  std::string text;
  for (const auto& [type, count] : counts) text += (text.empty() ? "" : ", ") + type + " " + std::to_string(count);
  return text;
}

/// The element that lies farthest from the middle one, as the file has it.
std::string farthest(const std::vector<Element>& elements) {
  const auto middle = [&](double mrpt::math::TPoint2D::*axis) {
    std::vector<double> values;
    for (const Element& e : elements) values.push_back(e.position.*axis);
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values[values.size() / 2];
  };
  const mrpt::math::TPoint2D at{middle(&mrpt::math::TPoint2D::x), middle(&mrpt::math::TPoint2D::y)};
  const auto off = [&](const Element& e) { return rubble::distance(e.position, at); };
  const Element& e = *std::max_element(elements.begin(), elements.end(),
                                       [&](const Element& a, const Element& b) { return off(a) < off(b); });
  const auto pallet = [](double v) { return std::to_string(std::lround(v / kPallet)); };
  return "'" + e.type + "' at x=\"" + pallet(e.position.x) + "\" y=\"" + pallet(e.position.y) + "\"";
}

}  // namespace

std::string RafImport::summary() const {
  int parts = 0;
  for (const auto& [type, count] : built) parts += count;
  std::string text = std::to_string(parts) + " parts built";
  if (!labels.empty()) text += "; without a shape: " + list(labels);
  if (!unknown.empty()) text += "; UNKNOWN, left out: " + list(unknown);
  return text;
}

std::vector<std::string> RafImport::notes() const {
  std::vector<std::string> lines;
  if (!labels.empty() || !unknown.empty()) lines.push_back(summary());
  if (!askew.empty()) lines.push_back("at other than quarter turns: " + list(askew) + "; their walls close no room");
  if (!start_note.empty()) lines.push_back(start_note);
  return lines;
}

bool is_raf(const std::string& path) { return ends_with(path, ".raf"); }

RafImport parse_raf(const std::string& text, const std::string& name) {
  const std::vector<Element> elements = read_raf_elements(text, name);
  RafImport import;
  const std::string file = name.substr(name.find_last_of('/') + 1);
  import.arena.name = file.substr(0, file.find_last_of('.'));
  const Layout layout = layout_of(elements);
  const int wide = layout.occupied.width() - 2, high = layout.occupied.height() - 2;  // without the rim
  if (wide * high > kMostPallets)
    throw InputError(name + ": its elements lie " + std::to_string(wide) + " by " + std::to_string(high) +
                     " pallets apart, and a .raf may cover " + std::to_string(kMostPallets) + ": take out what lies " +
                     "far off, as " + farthest(elements) + " does");
  lay_ground(layout, import.arena);
  for (const Element& element : elements) {
    const ElementKind kind = kind_of(element.type);
    if (!is_quarter_turn(element)) ++import.askew[element.type];
    if (kind == ElementKind::Unknown) {
      ++import.unknown[element.type];
    } else if (kind == ElementKind::Label) {
      ++import.labels[element.type];
    } else {
      ++import.built[element.type];
      import.elements.push_back(element);
      place(element, wall_behind(element, elements), import.arena);
    }
  }
  set_bounds(import.arena);
  find_start(layout, elements, name, import);
  check(import.arena, name);
  return import;
}

RafImport import_raf(const std::string& path) { return parse_raf(read_text_file(path), path); }

}  // namespace rubble::arenas
