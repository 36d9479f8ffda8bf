#include "arenas/files/piece.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "base/text/number_text.h"

namespace rubble::arenas {
namespace {

using mrpt::math::TPoint2D;
using NodePtr = std::shared_ptr<YamlNode>;
using Kind = YamlNode::Kind;

char turned_shape(char shape, int quarters) {
  static const std::string kRound = ">^<v";
  const std::size_t at = kRound.find(shape);
  return at == std::string::npos ? shape : kRound[(at + static_cast<std::size_t>(quarters)) % 4];
}

Drawing quarter_turned(const Drawing& from) {
  const int columns = from.cells.height();
  const int rows = from.cells.width();
  Drawing to{Grid<DrawnCell>({columns, rows, 1.0, 0.0, 0.0}), {}, {}};
  to.lying.assign(static_cast<std::size_t>(columns * (rows + 1)), ' ');
  to.upright.assign(static_cast<std::size_t>((columns + 1) * rows), ' ');
  for (int y = 0; y < from.cells.height(); ++y) {
    for (int x = 0; x < from.cells.width(); ++x) {
      DrawnCell cell = from.cells[{x, y}];
      cell.shape = turned_shape(cell.shape, 1);
      to.cells[{columns - 1 - y, x}] = cell;
    }
  }
  for (int y = 0; y <= from.cells.height(); ++y) {
    for (int x = 0; x < from.cells.width(); ++x) {
      if (from.wall_south(x, y)) to.upright[static_cast<std::size_t>(x * (columns + 1) + columns - y)] = '|';
    }
  }
  for (int y = 0; y < from.cells.height(); ++y) {
    for (int x = 0; x <= from.cells.width(); ++x) {
      if (from.wall_west(x, y)) to.lying[static_cast<std::size_t>(x * columns + columns - 1 - y)] = '-';
    }
  }
  return to;
}

NodePtr copied(const YamlNode& node) {
  const NodePtr copy = std::make_shared<YamlNode>(node);
  for (NodePtr& item : copy->items) item = copied(*item);
  for (YamlNode::Entry& entry : copy->entries) entry.value = copied(*entry.value);
  return copy;
}

void erase(YamlNode& map, const std::string& key) {
  map.entries.erase(std::remove_if(map.entries.begin(), map.entries.end(),
                                   [&](const YamlNode::Entry& entry) { return entry.key == key; }),
                    map.entries.end());
}

void set_number(YamlNode& map, const std::string& key, double value) {
  if (YamlNode::Entry* const entry = map.find(key)) {
    entry->value = number_node(value, entry->value->place);
  } else {
    map.entries.push_back({key, map.place, number_node(value, map.place)});
  }
}

void set_numbers(YamlNode& map, const std::string& key, const std::vector<double>& values) {
  YamlNode& list = *map.find(key)->value;
  for (std::size_t i = 0; i < values.size(); ++i) list.items[i] = number_node(values[i], list.items[i]->place);
}

}  // namespace

NodePtr number_node(double value, const YamlPlace& place) {
  auto node = std::make_shared<YamlNode>();
  node->kind = Kind::Scalar;
  node->text = number_text(value);
  node->place = place;
  return node;
}

const std::vector<std::string>& list_keys() {
  static const std::vector<std::string> keys{"floors", "walls", "boxes",   "elements",
                                             "paper",  "balls", "objects", "victims"};
  return keys;
}

Drawing turned(const Drawing& drawing, int quarters) {
  Drawing result = drawing;
  for (int i = 0; i < quarters; ++i) result = quarter_turned(result);
  return result;
}

Piece::Piece(const YamlMap& root, const PiecePlace& place, double cell_size)
    : root_(root), place_(place), cell_size_(cell_size) {
  if (!root.has("maze")) return;
  const Drawing own = read_drawing(root, "maze");
  width_ = own.cells.width() * cell_size;
  height_ = own.cells.height() * cell_size;
  drawing_ = turned(own, place.quarters);
  for (int y = 0; y < own.cells.height(); ++y) {
    for (int x = 0; x < own.cells.width(); ++x) {
      const DrawnCell& cell = own.cells[{x, y}];
      if (cell.mark == 0) continue;
      if (cell.mark == 'S' && marks_.count('S') > 0)
        root.fail_at("maze", cell.row, cell.column, "a second S: the robot starts in one pallet");
      Mark& mark = marks_[cell.mark];
      if (mark.centres.empty()) std::tie(mark.row, mark.column) = std::pair(cell.row, cell.column);
      mark.centres.push_back({(x + 0.5) * cell_size, (y + 0.5) * cell_size});
    }
  }
}

TPoint2D Piece::turned_vector(TPoint2D v) const {
  for (int i = 0; i < place_.quarters; ++i) v = {0.0 - v.y, v.x};
  return v;
}

TPoint2D Piece::in_arena(TPoint2D p) const {
  double width = width_;
  double height = height_;
  for (int i = 0; i < place_.quarters; ++i) {
    p = {height - p.y, p.x};
    std::swap(width, height);
  }
  return {place_.column * cell_size_ + p.x, place_.row * cell_size_ + p.y};
}

/// A bearing in degrees, where it is given or has the default 0.
void Piece::add_turn(const YamlMap& entry, const std::string& key, int quarters) const {
  if (quarters == 0) return;
  double angle = entry.number(key, 0.0, -360.0, 360.0) + 90.0 * quarters;
  if (angle > 360.0) angle -= 360.0;
  if (angle < -360.0) angle += 360.0;
  set_number(*entry.tree(), key, angle);
}

/// A list of x, y, x, y, ...; one of odd length stays as it is and is complained about when it is read.
void Piece::move_points(const YamlMap& entry, const std::string& key) const {
  std::vector<double> numbers = entry.numbers(key);
  for (std::size_t i = 0; i + 1 < numbers.size(); i += 2) {
    const TPoint2D p = in_arena({numbers[i], numbers[i + 1]});
    numbers[i] = p.x;
    numbers[i + 1] = p.y;
  }
  if (numbers.size() % 2 == 0 && !numbers.empty()) set_numbers(*entry.tree(), key, numbers);
}

void Piece::turn_bearings(const YamlMap& entry, const std::string& key) const {
  if (key == "floors" || key == "boxes" || (key == "paper" && !entry.has("outline_m"))) {
    add_turn(entry, "angle_deg", place_.quarters);
  } else if (key == "elements") {
    add_turn(entry, "rotation_deg", -place_.quarters);  // clockwise
  } else if (key == "victims" && entry.has("wall")) {
    static const std::vector<std::string> kRound{"east", "north", "west", "south"};
    const std::string side = entry.choice("wall", std::nullopt, kRound);
    const auto at = static_cast<std::size_t>(std::find(kRound.begin(), kRound.end(), side) - kRound.begin());
    entry.tree()->find("wall")->value->text = kRound[(at + static_cast<std::size_t>(place_.quarters)) % 4];
  } else if (key == "victims" && entry.has("facing_deg")) {
    add_turn(entry, "facing_deg", place_.quarters);
  }
}

/// `cell: A` of the piece's own drawing: one entry for each pallet with that letter.
std::vector<NodePtr> Piece::moved_to_cells(const YamlMap& entry, const std::string& key) {
  const std::string letter = entry.text("cell", std::nullopt);
  const auto found = letter.size() == 1 ? marks_.find(letter[0]) : marks_.end();
  if (found == marks_.end()) {
    entry.fail("cell", "no pallet of the drawing is marked '" + letter + "': write that letter into one");
  }
  Mark& mark = found->second;
  mark.used = true;
  if (key == "victims" && mark.centres.size() > 1) {
    entry.fail("cell",
               "several pallets are marked '" + letter + "', but this can lie in one only: use a letter of its own");
  }
  for (const char* other : {"x_m", "y_m"}) {
    if (entry.has(other)) entry.fail(other, std::string("'") + other + "' beside 'cell': give one of them");
  }
  const TPoint2D shift{entry.number("dx_m", 0.0, -kFar, kFar), entry.number("dy_m", 0.0, -kFar, kFar)};
  std::vector<NodePtr> moved;
  for (const TPoint2D& centre : mark.centres) {
    const NodePtr copy = copied(*entry.tree());
    for (const char* gone : {"cell", "dx_m", "dy_m"}) erase(*copy, gone);
    const TPoint2D p = in_arena(centre + shift);
    set_number(*copy, "x_m", p.x);
    set_number(*copy, "y_m", p.y);
    moved.push_back(copy);
  }
  return moved;
}

std::vector<NodePtr> Piece::entries(const std::string& key) {
  std::vector<NodePtr> result;
  for (const YamlMap& own : root_.maps(key)) {
    const YamlMap entry = YamlMap::of(copied(*own.tree()));
    turn_bearings(entry, key);
    if (key == "victims" && !place_.name.empty() && entry.has("name")) {
      YamlNode& name = *entry.tree()->find("name")->value;
      name.text = place_.name + "_" + entry.text("name", std::nullopt);
    }
    if (key == "walls") {
      for (const char* end : {"from_m", "to_m"}) move_points(entry, end);
    } else if (key == "paper" && entry.has("outline_m")) {
      move_points(entry, "outline_m");
    } else if (entry.has("cell") && drawing_) {
      for (const NodePtr& moved : moved_to_cells(entry, key)) result.push_back(moved);
      continue;
    } else if (entry.has("cell")) {  // a letter of the includer's drawing
      const TPoint2D shift =
          turned_vector({entry.number("dx_m", 0.0, -kFar, kFar), entry.number("dy_m", 0.0, -kFar, kFar)});
      set_number(*entry.tree(), "dx_m", shift.x);
      set_number(*entry.tree(), "dy_m", shift.y);
    } else if (entry.has("x_m")) {
      const TPoint2D p =
          in_arena({entry.number("x_m", std::nullopt, -kFar, kFar), entry.number("y_m", std::nullopt, -kFar, kFar)});
      set_number(*entry.tree(), "x_m", p.x);
      set_number(*entry.tree(), "y_m", p.y);
    }
    result.push_back(entry.tree());
  }
  return result;
}

NodePtr Piece::start() const {
  const YamlMap given = root_.map("start");
  const auto mark = marks_.find('S');
  TPoint2D p;
  given.number("heading_deg", 0.0, -360.0, 360.0);
  if (given.has("x_m") || given.has("y_m")) {
    if (mark != marks_.end())
      given.fail("x_m", "the drawing marks the start with S already: remove x_m and y_m, or the S");
    p = {given.number("x_m", std::nullopt, -kFar, kFar), given.number("y_m", std::nullopt, -kFar, kFar)};
  } else if (mark != marks_.end()) {
    p = mark->second.centres.front();
  } else {
    given.finish();
    return nullptr;
  }
  given.finish();
  p = in_arena(p);
  const NodePtr start = copied(*given.tree());
  start->kind = Kind::Map;
  const YamlMap heading = YamlMap::of(start);
  add_turn(heading, "heading_deg", place_.quarters);
  set_number(*start, "x_m", p.x);
  set_number(*start, "y_m", p.y);
  return start;
}

void Piece::finish() const {
  for (const auto& [letter, mark] : marks_) {
    if (mark.used || letter == 'S') continue;
    root_.fail_at("maze", mark.row, mark.column,
                  std::string("nothing below refers to the letter '") + letter + "': use it as 'cell: " + letter +
                      "' or take it out");
  }
}

}  // namespace rubble::arenas
