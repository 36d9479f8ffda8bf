#include "arenas/include.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <list>
#include <set>

#include "arenas/piece.h"
#include "arenas/raf.h"
#include "base/text_file.h"
#include "base/words.h"

namespace rubble::arenas {
namespace {

namespace fs = std::filesystem;
using NodePtr = std::shared_ptr<YamlNode>;
using Kind = YamlNode::Kind;

constexpr int kMostPieces = 1000;  ///< files that include each other twice would grow without bound
constexpr int kMostCells = 400;    ///< a side of the arena
constexpr const char* kSettings[] = {"cell_m", "ramp_deg", "floor_friction", "wall_height_m", "wall_thickness_m"};

std::string short_name(const std::string& path) { return path.substr(path.find_last_of('/') + 1); }

std::string canonical(const std::string& path) {
  std::error_code error;
  const fs::path found = fs::weakly_canonical(path, error);
  return error ? path : found.string();
}

/// The files being composed, outermost first, and how many there were so far.
struct Chain {
  std::vector<std::string> names;      ///< as written in messages
  std::vector<std::string> canonical;  ///< the same file has one name here
  int pieces = 0;
};

YamlMap composed(const YamlMap& root, const std::string& path, Chain& chain);

/// An entry of `include` with its file read.
struct Included {
  YamlMap entry;
  std::string file;
  YamlMap root;  ///< of the file, composed
  PiecePlace place;
};

/// The ground, walls and parts of a league's file; where the robot starts is up to who includes it.
YamlMap raf_document(const YamlMap& entry, const std::string& path) {
  const RafImport import = import_raf(path);
  if (!import.unknown.empty())
    entry.fail("file", path + ": " + import.summary() + ": remove these parts from the file");
  const YamlMap root = YamlMap::parse(to_yaml(import), path);
  std::vector<YamlNode::Entry>& entries = root.tree()->entries;
  entries.erase(
      std::remove_if(entries.begin(), entries.end(), [](const YamlNode::Entry& e) { return e.key == "start"; }),
      entries.end());
  return root;
}

YamlMap read_file(const YamlMap& entry, const std::string& path, Chain& chain) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) {
    entry.fail("file", "there is no arena file '" + path + "'; the path is relative to the file that includes it");
  }
  const std::string known = canonical(path);
  const auto same = std::find(chain.canonical.begin(), chain.canonical.end(), known);
  if (same != chain.canonical.end()) {
    std::string way;
    for (auto i = same - chain.canonical.begin(); i < static_cast<std::ptrdiff_t>(chain.names.size()); ++i)
      way += short_name(chain.names[static_cast<std::size_t>(i)]) + " -> ";
    entry.fail("file", "the file includes itself: " + way + short_name(path) + "; take one of these includes out");
  }
  if (++chain.pieces > kMostPieces)
    entry.fail("file", "more than " + std::to_string(kMostPieces) + " pieces are included; include fewer");
  if (fs::path(path).extension() == ".raf") return raf_document(entry, path);
  chain.names.push_back(path);
  chain.canonical.push_back(known);
  const YamlMap root = composed(YamlMap::load(path), path, chain);
  chain.names.pop_back();
  chain.canonical.pop_back();
  return root;
}

PiecePlace read_place(const YamlMap& entry) {
  PiecePlace place;
  if (entry.has("at")) {
    const std::vector<double> at = entry.numbers("at", 2);
    for (const double number : at) {
      if (!(number >= 0 && number < kMostCells) || number != std::floor(number))
        entry.fail("at", "give 'at: [columns, rows]' in whole pallets from the south-western one, 0 to " +
                             std::to_string(kMostCells - 1));
    }
    place.column = static_cast<int>(at[0]);
    place.row = static_cast<int>(at[1]);
  }
  const std::string turn = entry.choice("turn", "0", {"0", "90", "180", "270"});
  place.quarters = static_cast<int>(turn.size() == 1 ? 0 : turn == "90" ? 1 : turn == "180" ? 2 : 3);
  place.name = entry.text("name", std::string());
  return place;
}

std::list<Included> read_includes(const YamlMap& root, const std::string& path, Chain& chain) {
  std::list<Included> pieces;
  for (const YamlMap& entry : root.maps("include")) {
    const fs::path file = entry.text("file", std::nullopt);
    const PiecePlace place = read_place(entry);
    entry.finish();
    const std::string full =
        (file.is_absolute() ? file : fs::path(path).parent_path() / file).lexically_normal().string();
    pieces.push_back({entry, full, read_file(entry, full, chain), place});
  }
  return pieces;
}

/// A setting that one of the files gives holds for all; where two give it, they must agree.
void share_settings(const YamlMap& out, const YamlMap& piece) {
  for (const char* key : kSettings) {
    if (!piece.has(key)) continue;
    const double value = piece.number(key, std::nullopt, -1e9, 1e9);
    if (!out.has(key)) {
      out.tree()->entries.push_back(*piece.tree()->find(key));
    } else if (out.number(key, std::nullopt, -1e9, 1e9) != value) {
      piece.fail(key, rubble::quoted(key) + " is " + piece.text(key, std::nullopt) + " here but " +
                          out.text(key, std::nullopt) + " at " + out.place(key) +
                          "; an arena has one: give it in one file, or the same in both");
    }
  }
}

/// Adds walls and pallets of a piece to the arena's drawing; letters stay behind.
void merge_drawing(const Included& from, const Drawing& piece, const std::string& path, Drawing& arena) {
  const int x0 = from.place.column;
  const int y0 = from.place.row;
  const int columns = arena.cells.width();
  for (int y = 0; y < piece.cells.height(); ++y) {
    for (int x = 0; x < piece.cells.width(); ++x) {
      if (piece.cells[{x, y}].shape == ' ') continue;
      DrawnCell& cell = arena.cells[{x0 + x, y0 + y}];
      if (cell.shape != ' ') {
        from.entry.fail("file", short_name(from.file) + " draws pallet [" + std::to_string(x0 + x) + ", " +
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

/// Puts arena files together.
class Composition {
 public:
  Composition(const YamlMap& root, const std::string& path, Chain& chain)
      : root_(root),
        path_(path),
        out_(YamlMap::of(std::make_shared<YamlNode>())),
        files_(read_includes(root, path, chain)) {
    YamlNode& tree = *out_.tree();
    tree.kind = Kind::Map;
    tree.place = root.tree()->place;
    for (const YamlNode::Entry& entry : root.tree()->entries) {
      if (entry.key == "include") continue;
      tree.entries.push_back(entry);
      tree.entries.back().asked = false;
    }
  }

  YamlMap result() {
    for (const Included& file : files_) share_settings(out_, file.root);
    const double cell_size = out_.number("cell_m", 1.2, 0.5, 5.0);
    for (const Included& file : files_) pieces_.emplace_back(file.root, file.place, cell_size);
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

  void check_inside(const Included& file, const Drawing& piece, const Drawing& arena) const {
    const int columns = file.place.column + piece.cells.width();
    const int rows = file.place.row + piece.cells.height();
    if (columns <= arena.cells.width() && rows <= arena.cells.height()) return;
    file.entry.fail("file", short_name(file.file) + " reaches column " + std::to_string(columns) + " and row " +
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
        file->entry.fail("file", "two victims are named " + rubble::quoted(name) +
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
    const Included* last = nullptr;
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
    for (const Included& file : files_) {
      for (const YamlNode::Entry& entry : file.root.tree()->entries) {
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
  std::list<Included> files_;
  std::list<Piece> pieces_;  ///< refer to files_, one each
};

YamlMap composed(const YamlMap& root, const std::string& path, Chain& chain) {
  if (!root.has("include")) return root;
  return Composition(root, path, chain).result();
}

}  // namespace

YamlMap compose(const YamlMap& root, const std::string& path) {
  Chain chain{{path}, {canonical(path)}, 0};
  return composed(root, path, chain);
}

std::string self_contained_arena(const std::string& path) {
  const std::string text = read_text_file(path);
  const YamlMap root = YamlMap::parse(text, path);
  if (!root.has("include")) return text;
  return "# Composed of " + short_name(path) + " and the files it includes.\n" + compose(root, path).dump();
}

}  // namespace rubble::arenas
