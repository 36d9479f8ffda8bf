#include "arenas/files/include.h"

#include <algorithm>
#include <list>
#include <set>
#include <utility>

#include "arenas/files/include_tree.h"
#include "arenas/files/piece.h"
#include "arenas/model/arena.h"
#include "base/text/text_file.h"
#include "base/text/words.h"

namespace rubble::arenas {
namespace {

using NodePtr = std::shared_ptr<YamlNode>;
using Kind = YamlNode::Kind;

constexpr int kMostCells = 400;  ///< a side of the arena

/// Adds walls and pallets of a piece to the arena's drawing; letters stay behind.
void merge_drawing(const Inclusion& from, const Drawing& piece, const std::string& path, Drawing& arena) {
  const int x0 = from.place.column;
  const int y0 = from.place.row;
  const int columns = arena.cells.width();
  for (int y = 0; y < piece.cells.height(); ++y) {
    for (int x = 0; x < piece.cells.width(); ++x) {
      if (piece.cells[{x, y}].shape == ' ') continue;
      DrawnCell& cell = arena.cells[{x0 + x, y0 + y}];
      if (cell.shape != ' ') {
        from.entry.fail("file", short_name(from.file.path) + " draws pallet [" + std::to_string(x0 + x) + ", " +
                                    std::to_string(y0 + y) + "], which " + short_name(path) +
                                    " has already; move the piece with 'at', or leave that pallet blank");
      }
      cell.shape = piece.cells[{x, y}].shape;
      cell.level = piece.cells[{x, y}].level;
    }
  }
  for (int y = 0; y <= piece.cells.height(); ++y)
    for (int x = 0; x < piece.cells.width(); ++x)
      if (piece.wall_south(x, y)) arena.lying[static_cast<std::size_t>((y0 + y) * columns + x0 + x)] = '-';
  for (int y = 0; y < piece.cells.height(); ++y)
    for (int x = 0; x <= piece.cells.width(); ++x)
      if (piece.wall_west(x, y)) arena.upright[static_cast<std::size_t>((y0 + y) * (columns + 1) + x0 + x)] = '|';
}

Drawing blank_drawing(int columns, int rows) {
  Drawing drawing{Grid<DrawnCell>({columns, rows, 1.0, 0.0, 0.0}), {}, {}};
  drawing.lying.assign(static_cast<std::size_t>(columns * (rows + 1)), ' ');
  drawing.upright.assign(static_cast<std::size_t>((columns + 1) * rows), ' ');
  return drawing;
}

YamlMap composed(const ArenaFile& file, double cell_size);

/// Puts an arena file and the files it includes together.
class Composition {
 public:
  Composition(const ArenaFile& file, double cell_size)
      : root_(file.root), path_(file.path), out_(YamlMap::of(std::make_shared<YamlNode>())), files_(file.includes) {
    YamlNode& tree = *out_.tree();
    tree.kind = Kind::Map;
    tree.place = root_.tree()->place;
    for (const YamlNode::Entry& entry : root_.tree()->entries) {
      if (entry.key == "include") continue;
      tree.entries.push_back(entry);
      tree.entries.back().asked = false;
    }
    for (const Inclusion& inclusion : files_) {
      roots_.push_back(composed(inclusion.file, cell_size));
      pieces_.emplace_back(roots_.back(), inclusion.place, cell_size);
    }
  }

  YamlMap result() {
    draw_maze();
    for (const std::string& key : list_keys()) join_lists(key);
    check_names();
    find_start();
    for (const Piece& piece : pieces_) piece.finish();
    keep_strangers();
    return out_;
  }

 private:
  void put(const std::string& key, const YamlPlace& place, NodePtr value) {
    if (YamlNode::Entry* const entry = out_.tree()->find(key)) {
      entry->value = std::move(value);
    } else {
      out_.tree()->entries.push_back({key, place, std::move(value)});
    }
  }

  void draw_maze() {
    const bool has_own = root_.has("maze");
    int columns = 0, rows = 0;
    auto file = files_.begin();
    for (const Piece& piece : pieces_) {
      if (piece.drawing()) {
        columns = std::max(columns, piece.place().column + piece.drawing()->cells.width());
        rows = std::max(rows, piece.place().row + piece.drawing()->cells.height());
        if (!has_own && std::max(columns, rows) > kMostCells)
          file->entry.fail("file", "the arena would have more than " + std::to_string(kMostCells) + " pallets a side");
      }
      ++file;
    }
    if (columns == 0) return;
    Drawing drawing = has_own ? read_drawing(root_, "maze") : blank_drawing(columns, rows);
    file = files_.begin();
    for (const Piece& piece : pieces_) {
      if (piece.drawing()) {
        if (has_own) check_inside(*file, *piece.drawing(), drawing);
        merge_drawing(*file, *piece.drawing(), path_, drawing);
      }
      ++file;
    }
    auto maze = std::make_shared<YamlNode>();
    maze->kind = Kind::Scalar;
    maze->style = YamlNode::Style::Block;
    for (const std::string& line : draw(drawing)) maze->text += line + "\n";
    const YamlNode::Entry* const own = has_own ? root_.tree()->find("maze") : root_.tree()->find("include");
    maze->place = own->value->place;
    put("maze", own->place, maze);
  }

  void check_inside(const Inclusion& file, const Drawing& piece, const Drawing& arena) const {
    const int columns = file.place.column + piece.cells.width();
    const int rows = file.place.row + piece.cells.height();
    if (columns <= arena.cells.width() && rows <= arena.cells.height()) return;
    file.entry.fail("file", short_name(file.file.path) + " reaches column " + std::to_string(columns) + " and row " +
                                std::to_string(rows) + " of pallets, but the drawing of " + short_name(path_) +
                                " has " + std::to_string(arena.cells.width()) + " x " +
                                std::to_string(arena.cells.height()) +
                                "; move the piece with 'at', or draw blank pallets there");
  }

  void join_lists(const std::string& key) {
    NodePtr list;
    if (root_.has(key)) {
      root_.maps(key);  // complains when it is none
      list = std::make_shared<YamlNode>(*root_.tree()->find(key)->value);
    }
    for (Piece& piece : pieces_) {
      for (const NodePtr& entry : piece.entries(key)) {
        if (!list) {
          list = std::make_shared<YamlNode>();
          list->kind = Kind::List;
          list->place = entry->place;
        }
        list->items.push_back(entry);
      }
    }
    if (list) put(key, list->place, list);
  }

  /// Only where pieces bring them: the names of one file's own victims are looked at when they are read.
  void check_names() {
    std::set<std::string> names;
    for (const YamlMap& victim : root_.maps("victims")) names.insert(victim.text("name", std::nullopt));
    auto file = files_.begin();
    for (Piece& piece : pieces_) {
      std::set<std::string> own;
      for (const NodePtr& entry : piece.entries("victims")) {
        const std::string name = YamlMap::of(entry).text("name", std::nullopt);
        own.insert(name);
        if (names.count(name) == 0) continue;
        file->entry.fail("file", "two victims are named " + in_quotes(name) +
                                     "; give this piece a name, for example 'name: west', to put before its victims'");
      }
      names.insert(own.begin(), own.end());
      ++file;
    }
  }

  /// The including file's own start counts, else the one piece's that has one.
  void find_start() {
    NodePtr found;
    bool is_one = true;
    const Inclusion* last = nullptr;
    auto file = files_.begin();
    for (const Piece& piece : pieces_) {
      if (const NodePtr start = piece.start()) {
        is_one = found == nullptr;
        found = start;
        last = &*file;
      }
      ++file;
    }
    if (!found || has_own_start()) return;
    if (!is_one) {
      last->entry.fail("file", "two pieces say where the robot starts; write S into a pallet of " + short_name(path_) +
                                   ", or 'start: {x_m: , y_m: }'");
    }
    if (const YamlNode::Entry* const heading = root_.map("start").tree()->find("heading_deg")) {
      if (YamlNode::Entry* const turned = found->find("heading_deg")) {
        turned->value = heading->value;
      } else {
        found->entries.push_back(*heading);
      }
    }
    put("start", found->place, found);
  }

  bool has_own_start() const {
    const YamlMap own = root_.map("start");
    if (own.has("x_m") || own.has("y_m")) return true;
    if (!root_.has("maze")) return false;
    const Drawing drawing = read_drawing(root_, "maze");
    const std::vector<DrawnCell>& cells = drawing.cells.cells();
    return std::any_of(cells.begin(), cells.end(), [](const DrawnCell& cell) { return cell.mark == 'S'; });
  }

  /// Keys nobody knows are complained about where they stand, when the arena is read.
  void keep_strangers() {
    for (const YamlMap& root : roots_) {
      for (const YamlNode::Entry& entry : root.tree()->entries) {
        const bool is_list = std::find(list_keys().begin(), list_keys().end(), entry.key) != list_keys().end();
        if (is_list || entry.key == "name" || entry.key == "maze" || entry.key == "include" || entry.key == "start" ||
            out_.tree()->find(entry.key) != nullptr) {
          continue;
        }
        out_.tree()->entries.push_back(entry);
      }
    }
  }

  const YamlMap& root_;
  const std::string& path_;
  YamlMap out_;
  const std::vector<Inclusion>& files_;
  std::list<YamlMap> roots_;  ///< of the included files, put together: one each
  std::list<Piece> pieces_;   ///< refer to roots_, one each
};

YamlMap composed(const ArenaFile& file, double cell_size) {
  return file.root.has("include") ? Composition(file, cell_size).result() : file.root;
}

/// The same with the settings of all files, which the outermost file's `root` gets.
YamlMap composed_arena(const YamlMap& root, const std::string& path) {
  if (!root.has("include")) return root;
  const ArenaFile file = read_arena_tree(root, path);
  const YamlMap settings = shared_settings(file);
  const YamlMap whole = composed(file, settings.number("cell_m", kPallet, 0.5, 5.0));
  for (const YamlNode::Entry& setting : settings.tree()->entries) {
    if (whole.tree()->find(setting.key) == nullptr) whole.tree()->entries.push_back(setting);
  }
  return whole;
}

}  // namespace

YamlMap compose(const YamlMap& root, const std::string& path) { return composed_arena(root, path); }

std::string self_contained_arena(const std::string& path) {
  const std::string text = read_text_file(path);
  const YamlMap root = YamlMap::parse(text, path);
  if (!root.has("include")) return text;
  return "# Composed of " + short_name(path) + " and the files it includes.\n" + compose(root, path).dump();
}

}  // namespace rubble::arenas
