#include "arenas/model/drawing.h"

#include <algorithm>

namespace rubble::arenas {
namespace {

constexpr int kPitch = 4;  ///< characters from post to post

/// The drawing as a rectangle of characters, with a place for errors.
struct Sheet {
  const YamlMap& map;
  const std::string& key;
  std::vector<std::string> lines;
  char at(int row, int column) const { return lines[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]; }
  [[noreturn]] void fail(int row, int column, const std::string& message) const {
    map.fail_at(key, row, column, message);
  }
};

std::string quoted(char c) { return std::string("'") + c + "'"; }

std::vector<std::string> split_lines(const std::string& text) {
  std::vector<std::string> lines;
  std::string line;
  for (const char c : text) {
    if (c == '\n') {
      lines.push_back(line);
      line.clear();
    } else if (c != '\r') {
      line += c;
    }
  }
  if (!line.empty()) lines.push_back(line);
  for (std::string& l : lines) l.erase(l.find_last_not_of(' ') + 1);
  while (!lines.empty() && lines.back().empty()) lines.pop_back();
  return lines;
}

Sheet read_sheet(const YamlMap& map, const std::string& key) {
  Sheet sheet{map, key, split_lines(map.text(key, std::nullopt))};
  if (sheet.lines.size() < 3) {
    map.fail(key, "the drawing needs at least three lines: posts and walls, pallets, posts and walls");
  }
  if (sheet.lines.size() % 2 == 0) {
    sheet.fail(static_cast<int>(sheet.lines.size()) - 1, 0,
               "the drawing ends after a row of pallets: add the row of posts and walls below it");
  }
  std::size_t width = 0;
  for (const std::string& line : sheet.lines) width = std::max(width, line.size());
  const std::size_t columns = std::max<std::size_t>(1, (width + kPitch - 2) / kPitch);
  for (std::string& line : sheet.lines) line.resize(columns * kPitch + 1, ' ');
  return sheet;
}

/// A wall of three characters between two posts: all '-' or all blank.
char read_lying_wall(const Sheet& sheet, int row, int column) {
  const char first = sheet.at(row, column);
  for (int i = 0; i < kPitch - 1; ++i) {
    const char c = sheet.at(row, column + i);
    if (c != '-' && c != ' ') sheet.fail(row, column + i, quoted(c) + " in a row of walls: draw '---' or three blanks");
    if (c != first) sheet.fail(row, column + i, "half a wall: draw '---' or three blanks between two posts");
  }
  return first;
}

char read_upright_wall(const Sheet& sheet, int row, int column) {
  const char c = sheet.at(row, column);
  if (c != '|' && c != ' ') sheet.fail(row, column, quoted(c) + " between two pallets: draw '|' or a blank");
  return c;
}

void read_post(const Sheet& sheet, int row, int column) {
  const char c = sheet.at(row, column);
  if (c != '+' && c != ' ') {
    sheet.fail(row, column, quoted(c) + " where a post belongs: draw '+' or a blank (pallets are 3 characters wide)");
  }
}

DrawnCell read_cell(const Sheet& sheet, int row, int column) {
  DrawnCell cell;
  cell.row = row;
  cell.column = column + 1;
  bool has_level = false;
  for (int i = 0; i < kPitch - 1; ++i) {
    const char c = sheet.at(row, column + i);
    if (c == ' ') continue;
    if (std::string(".^v<>#").find(c) != std::string::npos) {
      if (cell.shape != ' ') sheet.fail(row, column + i, "a second floor glyph in one pallet: keep one of . ^ v < > #");
      cell.shape = c;
    } else if (c >= '0' && c <= '9') {
      if (has_level) sheet.fail(row, column + i, "a second digit in one pallet: its level is one digit, 0 to 9");
      cell.level = c - '0';
      has_level = true;
    } else if (c >= 'A' && c <= 'Z') {
      if (cell.mark != 0) sheet.fail(row, column + i, "a second letter in one pallet: keep one");
      cell.mark = c;
    } else {
      sheet.fail(row, column + i,
                 quoted(c) + " is no glyph of a pallet: use . ^ v < > # with a letter A-Z and a digit");
    }
  }
  if (cell.shape == ' ' && (cell.mark != 0 || has_level)) cell.shape = '.';
  return cell;
}

}  // namespace

Drawing read_drawing(const YamlMap& map, const std::string& key) {
  const Sheet sheet = read_sheet(map, key);
  const int columns = static_cast<int>(sheet.lines[0].size()) / kPitch;
  const int rows = static_cast<int>(sheet.lines.size()) / 2;
  Drawing drawing{Grid<DrawnCell>({columns, rows, 1.0, 0.0, 0.0}), {}, {}};
  for (int y = 0; y <= rows; ++y) {
    const int row = 2 * (rows - y);  // north is up: the last line is the southern edge
    for (int x = 0; x <= columns; ++x) read_post(sheet, row, kPitch * x);
    for (int x = 0; x < columns; ++x) drawing.lying.push_back(read_lying_wall(sheet, row, kPitch * x + 1));
    if (y == rows) break;
    for (int x = 0; x <= columns; ++x) drawing.upright.push_back(read_upright_wall(sheet, row - 1, kPitch * x));
    for (int x = 0; x < columns; ++x) drawing.cells[{x, y}] = read_cell(sheet, row - 1, kPitch * x + 1);
  }
  return drawing;
}

std::vector<std::string> draw(const Drawing& drawing) {
  const int columns = drawing.cells.width();
  const int rows = drawing.cells.height();
  std::vector<std::string> lines;
  for (int y = rows; y >= 0; --y) {
    std::string edge = "+";
    for (int x = 0; x < columns; ++x) edge += drawing.wall_south(x, y) ? "---+" : "   +";
    lines.push_back(edge);
    if (y == 0) break;
    std::string pallets = drawing.wall_west(0, y - 1) ? "|" : " ";
    for (int x = 0; x < columns; ++x) {
      const DrawnCell& cell = drawing.cells[{x, y - 1}];
      pallets += cell.mark != 0 ? cell.mark : ' ';
      pallets += cell.shape;
      pallets += cell.level > 0 ? static_cast<char>('0' + cell.level) : ' ';
      pallets += drawing.wall_west(x + 1, y - 1) ? '|' : ' ';
    }
    pallets.erase(pallets.find_last_not_of(' ') + 1);
    lines.push_back(pallets);
  }
  return lines;
}

}  // namespace rubble::arenas
