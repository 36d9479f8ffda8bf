#include "scoring/maps/colours/lettering.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "base/grid.h"
#include "scoring/maps/colours/cell_lattice.h"

namespace rubble::scoring {
namespace {

constexpr int kMostHeight = 60;        // [pixels]
constexpr double kWidestLetter = 2.1;  // heights
constexpr double kMostFilled = 0.75;   // of its box, but for narrow ones
constexpr double kNarrow = 0.35;       // heights: i, l, 1
constexpr double kThickest = 0.34;     // stroke, heights
constexpr double kOneLine = 0.2;       // heights by which tops or bottoms differ in a word
constexpr double kAlikeHeight = 0.6;   // lower over higher
constexpr double kLettersApart = 0.8;  // heights between two letters of a word
constexpr double kBlank = 1.7;         // heights between two words of a line
constexpr double kMoat = 0.2;          // heights of free ground around a word
constexpr std::size_t kLeastLetters = 3;
constexpr double kLeastComplex = 0.34;  // share of a word's letters with many strokes

/// What passes for a letter.
struct Rules {
  int least_height = 6;       ///< [pixels]: less is no writing that anybody reads
  double thickest_pen = 0.0;  ///< that any letter may have, however low it is [pixels]
  double many_strokes = 2.7;  ///< crossed by a row and a column together, in the mean: one wall 2, corners 2
  bool joined = false;        ///< letters may run into each other
  bool drawn_over = false;    ///< only what no cells of the map make up
};

constexpr Rules kSurely{};
/// Share of its edges that no cell of the map has, to be drawn over a map whose cells are squares of pixels. Pens of a
/// pixel have half of them and more there, walls none; blending and JPEG move some.
constexpr double kDrawnOver = 0.25;
/// Letters: those of eight words in a pen of one pixel, 5 to 15 pixels high, sharp and smooth, as they are and through
/// JPEG of qualities 90 and 70. Their strokes are 1 to 2.5 pixels thick (up to 3.6 where they join), a quarter is
/// crossed less than 2.4 times. Ragged walls fall into pieces like that, half of them crossed 2.7 times and more.
constexpr Rules kPerhaps{5, 3.0, 2.5, true};
/// The same of what is finer than the map's cells: no wall is.
constexpr Rules kDrawnOverCells{5, 3.0, 2.5, true, true};
// Share of what looks like letters, or of edges of no cell, that stands in words: of words alone nearly always 1, of
// ragged walls up to 0.16.
constexpr double kLeastOfPieces = 0.4;
constexpr double kWidestRun = 8.0;     // heights, of letters that run into each other; those of a short word have 3
constexpr double kLetterWidth = 0.75;  // heights, with what is between it and the next: two that are joined have 1.5
// Crossed by a row and a column together, in the mean: joined letters 3.4 and more, half of the ragged walls as long
// up to 3.4, worn walls up to 3 (19 of 20).
constexpr double kStrokesOfRun = 3.2;
// Stroke of joined letters, heights: half of them 0.2 to 0.31, nearly all below 0.41; worn walls as long half below
// 0.19, ragged ones of two pixels half from 0.5 on.
constexpr double kThinnestRun = 0.2, kThickestRun = 0.5;

struct Piece {
  cv::Rect box;
  int label = 0;
  double strokes = 0.0;    ///< crossed by a row and a column, in the mean
  double thickness = 0.0;  ///< of its strokes [pixels]
  std::size_t letters = 1;
};

/// Runs of the piece in a row of its box.
int runs(const int* at, int length, int step, int label) {
  int out = 0;
  for (int i = 0; i < length; ++i) out += at[i * step] == label && (i == 0 || at[(i - 1) * step] != label) ? 1 : 0;
  return out;
}

Piece piece_of(const cv::Mat& labels, const cv::Rect& box, int label, int area, const Rules& rules) {
  Piece out{box, label};
  int rows = 0;
  int columns = 0;
  for (int y = 0; y < box.height; ++y) rows += runs(labels.ptr<int>(box.y + y) + box.x, box.width, 1, label);
  for (int x = 0; x < box.width; ++x)
    columns += runs(labels.ptr<int>(box.y) + box.x + x, box.height, static_cast<int>(labels.step1()), label);
  out.strokes = static_cast<double>(rows) / box.height + static_cast<double>(columns) / box.width;
  out.thickness = static_cast<double>(area) / std::max(rows, columns);
  const double length = static_cast<double>(box.width) / box.height, pen = out.thickness / box.height;
  if (rules.joined && length >= 2.0 * kLetterWidth && out.strokes >= kStrokesOfRun && pen >= kThinnestRun &&
      pen <= kThickestRun)
    out.letters = static_cast<std::size_t>(std::lround(length / kLetterWidth));
  return out;
}

bool may_be_letter(const Piece& piece, int area, const Rules& rules) {
  const double height = piece.box.height;
  if (piece.box.width > (piece.letters > 1 ? kWidestRun : kWidestLetter) * height) return false;
  if (piece.letters == 1 && piece.thickness > std::max(kThickest * height, rules.thickest_pen)) return false;
  return piece.box.width <= kNarrow * height || area <= kMostFilled * piece.box.area();
}

/// `b` goes on where `a` ends, at most `reach` heights further.
bool follows(const Piece& a, const Piece& b, double reach) {
  const double height = std::max(a.box.height, b.box.height);
  if (std::min(a.box.height, b.box.height) < kAlikeHeight * height) return false;
  const int gap = std::max(a.box.x, b.box.x) - std::min(a.box.br().x, b.box.br().x);
  const int tops = std::abs(a.box.y - b.box.y);
  const int bottoms = std::abs(a.box.br().y - b.box.br().y);
  const bool one_pen = std::min(a.thickness, b.thickness) >= 0.5 * std::max(a.thickness, b.thickness);
  return one_pen && gap <= reach * height && gap > -0.5 * height && std::min(tops, bottoms) <= kOneLine * height &&
         std::max(tops, bottoms) <= 2.5 * kOneLine * height;
}

std::vector<std::vector<Piece>> words_of(const std::vector<Piece>& letters) {
  std::vector<std::size_t> word(letters.size());
  std::iota(word.begin(), word.end(), std::size_t{0});
  for (std::size_t i = 0; i < letters.size(); ++i)
    for (std::size_t j = i + 1; j < letters.size(); ++j) {
      if (word[i] == word[j] || !follows(letters[i], letters[j], kLettersApart)) continue;
      const std::size_t from = std::max(word[i], word[j]), to = std::min(word[i], word[j]);
      std::replace(word.begin(), word.end(), from, to);
    }
  std::vector<std::vector<Piece>> out(letters.size());
  for (std::size_t i = 0; i < letters.size(); ++i) out[word[i]].push_back(letters[i]);
  return out;
}

cv::Rect box_of(const cv::Mat& stats, int label) {
  return {stats.at<int>(label, cv::CC_STAT_LEFT), stats.at<int>(label, cv::CC_STAT_TOP),
          stats.at<int>(label, cv::CC_STAT_WIDTH), stats.at<int>(label, cv::CC_STAT_HEIGHT)};
}

cv::Rect widened(const cv::Rect& box, int by) {
  return {box.x - by, box.y - by, box.width + 2 * by, box.height + 2 * by};
}

/// All that belongs to a word.
struct Written {
  cv::Rect box;
  int height = 0;  ///< of its highest letter
  std::vector<int> labels;
  int moat() const { return std::max(2, static_cast<int>(kMoat * height)); }
};

/// A word with its dots and hyphens: what is lower than letters, and beside or among these.
Written whole(const std::vector<Piece>& word, const cv::Mat& stats) {
  constexpr double kDotHeight = 0.3, kDotWidth = 0.6;  // heights
  Written out;
  out.box = word[0].box;
  for (const Piece& piece : word) {
    out.box |= piece.box;
    out.height = std::max(out.height, piece.box.height);
    out.labels.push_back(piece.label);
  }
  const cv::Rect reach = widened(out.box, out.moat());
  for (int i = 1; i < stats.rows; ++i) {
    const cv::Rect dot = box_of(stats, i);
    if (dot.height > kDotHeight * out.height || dot.width > kDotWidth * out.height || (dot & reach) != dot) continue;
    out.box |= dot;
    out.labels.push_back(i);
  }
  return out;
}

/// Free ground around the word, with nothing in it but its own.
bool stands_alone(const cv::Mat& classes, const cv::Mat& labels, const Written& word) {
  const cv::Rect around = widened(word.box, word.moat());
  if ((around & cv::Rect({0, 0}, classes.size())) != around) return false;
  for (int y = around.y; y < around.br().y; ++y)
    for (int x = around.x; x < around.br().x; ++x) {
      if (classes.at<unsigned char>(y, x) == static_cast<unsigned char>(Occupancy::Free)) continue;
      if (std::find(word.labels.begin(), word.labels.end(), labels.at<int>(y, x)) == word.labels.end()) return false;
    }
  return true;
}

bool is_written(const std::vector<Piece>& word, const Rules& rules) {
  std::size_t letters = 0, complex = 0;
  for (const Piece& piece : word) {
    letters += piece.letters;
    if (piece.strokes >= rules.many_strokes) complex += piece.letters;
  }
  return letters >= kLeastLetters && static_cast<double>(complex) >= kLeastComplex * static_cast<double>(letters);
}

/// All that is written. A number, or a short word, behind a blank cannot be told from walls by itself: it goes with the
/// word beside it.
std::vector<std::vector<Piece>> written_in(const std::vector<Piece>& letters, const Rules& rules) {
  std::vector<std::vector<Piece>> out;
  std::vector<std::vector<Piece>> others;
  for (std::vector<Piece>& word : words_of(letters))
    (is_written(word, rules) ? out : others).push_back(std::move(word));
  for (std::vector<Piece>& word : out)
    for (std::vector<Piece>& other : others) {
      const bool goes_on = std::any_of(other.begin(), other.end(), [&](const Piece& b) {
        return std::any_of(word.begin(), word.end(), [&](const Piece& a) { return follows(a, b, kBlank); });
      });
      if (!goes_on) continue;
      word.insert(word.end(), other.begin(), other.end());
      other.clear();
    }
  return out;
}

int letters_in(const std::vector<Piece>& pieces) {
  return std::accumulate(pieces.begin(), pieces.end(), 0,
                         [](int sum, const Piece& p) { return sum + static_cast<int>(p.letters); });
}

/// Share of the piece's edges that no cell has.
double share_off(const CellLattice& lattice, const cv::Mat& labels, const cv::Rect& box, int label) {
  int all = 0, off = 0;
  for (int y = box.y; y <= box.br().y; ++y)
    for (int x = box.x; x <= box.br().x; ++x) {
      const auto is_of_it = [&](int v, int u) {
        return v < labels.rows && u < labels.cols && v >= 0 && u >= 0 && labels.at<int>(v, u) == label;
      };
      const bool here = is_of_it(y, x);
      const bool beside = here != is_of_it(y, x - 1), above = here != is_of_it(y - 1, x);
      all += (beside ? 1 : 0) + (above ? 1 : 0);
      off += (beside && !lattice.has_column(x) ? 1 : 0) + (above && !lattice.has_row(y) ? 1 : 0);
    }
  return all == 0 ? 0.0 : static_cast<double>(off) / all;
}

/// Words along the rows: `found` is told each and how many letters it seems to have. Returns how many letters there
/// seem to be, in words or not.
template <class Found>
int find_in_rows(const cv::Mat& classes, const CellLattice& lattice, const Rules& rules, const Found& found) {
  cv::Mat labels, stats, centres;
  const cv::Mat walls = classes == static_cast<int>(Occupancy::Occupied);
  const int count = cv::connectedComponentsWithStats(walls, labels, stats, centres, 8, CV_32S);
  std::vector<Piece> letters;
  for (int i = 1; i < count; ++i) {
    const cv::Rect box = box_of(stats, i);
    const double widest = rules.joined ? kWidestRun : kWidestLetter;
    if (box.height < rules.least_height || box.height > kMostHeight || box.width > widest * box.height) continue;
    // Ragged walls fall into pieces as low as letters, but of whole cells.
    const bool may_be_cells =
        lattice.pixels > 1 && (rules.drawn_over || box.height < rules.least_height * lattice.pixels);
    if (may_be_cells && share_off(lattice, labels, box, i) < kDrawnOver) continue;
    const int area = stats.at<int>(i, cv::CC_STAT_AREA);
    const Piece piece = piece_of(labels, box, i, area, rules);
    if (may_be_letter(piece, area, rules)) letters.push_back(piece);
  }
  constexpr std::size_t kMost = 2000;  // noise, not writing
  if (letters.size() > kMost) return 0;
  for (const std::vector<Piece>& letters_of_word : written_in(letters, rules)) {
    if (letters_of_word.empty()) continue;
    const Written word = whole(letters_of_word, stats);
    if (stands_alone(classes, labels, word)) found(word, letters_in(letters_of_word));
  }
  return letters_in(letters);
}

/// The same lattice in the picture turned clockwise.
CellLattice turned_right(const CellLattice& lattice, int rows) {
  return {lattice.pixels, (rows - lattice.top) % lattice.pixels, lattice.left};
}

cv::Mat walls_of(const cv::Mat& classes) { return classes == static_cast<int>(Occupancy::Occupied); }

/// Runs of `of` (CV_8U) that a row and a column of it cross, in the mean.
double crossed_by(const cv::Mat& of) {
  const auto runs_a_row = [](const cv::Mat& m) {
    int out = 0;
    for (int y = 0; y < m.rows; ++y) {
      const unsigned char* const row = m.ptr<unsigned char>(y);
      for (int x = 0; x < m.cols; ++x) out += row[x] != 0 && (x == 0 || row[x - 1] == 0) ? 1 : 0;
    }
    return static_cast<double>(out) / std::max(1, m.rows);
  };
  return runs_a_row(of) + runs_a_row(of.t());
}

/// Places on free ground where many edges near each other are of no cell, and cross rows and columns more often than
/// single lines do.
int drawn_over(const cv::Mat& classes, const CellLattice& lattice) {
  const cv::Mat walls = walls_of(classes);
  constexpr int kNear = 7;     // [pixels]
  constexpr int kFewest = 20;  // edges
  // Edges that a row and a column cross, in the mean, the fewer of them and the more: of words mostly 1.35 and 4.2 and
  // more, of lines askew 2 and 2, where JPEG moved the edges of walls the fewer 1.0 at the most.
  constexpr double kFewer = 1.2, kMore = 3.8;
  const cv::Mat off = edges_off(lattice, walls);
  cv::Mat near, labels, stats, centres;
  cv::dilate(off > 0, near, cv::Mat::ones(kNear, kNear, CV_8U));
  const int count = cv::connectedComponentsWithStats(near, labels, stats, centres, 8, CV_32S);
  // Small words run into blots that fewer strokes cross: so many of them, with so much of all such edges, are words.
  constexpr int kBlots = 3;
  constexpr double kFewerOfBlots = 1.1, kMoreOfBlots = 3.2;
  int places = 0, blots = 0;
  double edges_of_places = 0.0, edges_of_blots = 0.0, edges_of_all = 0.0;
  for (int i = 1; i < count; ++i) {
    const cv::Rect box = box_of(stats, i);
    const cv::Mat own = labels(box) == i;
    const auto ground = [&](Occupancy o) { return cv::countNonZero(own & (classes(box) == static_cast<int>(o))); };
    if (ground(Occupancy::Unknown) > ground(Occupancy::Free)) continue;  // costs nothing there
    const auto inner = [](const cv::Mat& m) {
      return m(cv::Rect(kNear / 2, kNear / 2, m.cols - kNear + 1, m.rows - kNear + 1));
    };
    cv::Mat edges;
    off(box).copyTo(edges, own);
    const double all = cv::sum(edges)[0];
    edges_of_all += all;
    const int low = std::min(box.width, box.height);
    if (low <= kNear || low > kMostHeight + kNear) continue;
    const double in_row = all / (box.height - kNear + 1), in_column = all / (box.width - kNear + 1);
    const double fewer = std::min(in_row, in_column), more = std::max(in_row, in_column);
    if (all < kFewest || fewer < kFewerOfBlots || more < kMoreOfBlots) continue;
    ++blots;
    edges_of_blots += all;
    if (fewer < kFewer || more < kMore || crossed_by(inner(walls(box) & own)) < kStrokesOfRun) continue;
    ++places;
    edges_of_places += all;
  }
  if (edges_of_places >= kLeastOfPieces * edges_of_all) return places;
  return blots >= kBlots && edges_of_blots >= kLeastOfPieces * edges_of_all ? blots : 0;
}

int erase_rows(cv::Mat& classes, const CellLattice& lattice) {
  int erased = 0;
  const auto erase = [&](const Written& word, int) {
    classes(word.box).setTo(static_cast<int>(Occupancy::Free));
    erased += static_cast<int>(word.labels.size());
  };
  find_in_rows(classes, lattice, kSurely, erase);
  if (lattice.pixels > 1) find_in_rows(classes, lattice, kDrawnOverCells, erase);
  return erased;
}

}  // namespace

int erase_lettering(cv::Mat& classes) {
  if (classes.empty()) return 0;
  const CellLattice lattice = cell_lattice(walls_of(classes));
  int erased = erase_rows(classes, lattice);
  cv::Mat turned;
  cv::rotate(classes, turned, cv::ROTATE_90_CLOCKWISE);
  const int upright = erase_rows(turned, turned_right(lattice, classes.rows));
  if (upright > 0) cv::rotate(turned, classes, cv::ROTATE_90_COUNTERCLOCKWISE);
  return erased + upright;
}

int perhaps_words(const cv::Mat& classes) {
  if (classes.empty()) return 0;
  const CellLattice lattice = cell_lattice(walls_of(classes));
  int words = 0;
  if (lattice.pixels > 1) {
    // Straight walls two cells wide may lie on a lattice of twice the cells, off which others of them are.
    for (const int pixels : {lattice.pixels, lattice.pixels / 2})
      if (pixels > 1 && lattice.pixels % pixels == 0)
        words = std::max(words, drawn_over(classes, {pixels, lattice.left % pixels, lattice.top % pixels}));
    return words;
  }
  const auto in_rows_of = [&words](const cv::Mat& of) {
    int here = 0, letters = 0;
    const int all = find_in_rows(of, {}, kPerhaps, [&](const Written&, int in_word) {
      ++here;
      letters += in_word;
    });
    if (letters >= kLeastOfPieces * all) words += here;
  };
  cv::Mat turned;
  cv::rotate(classes, turned, cv::ROTATE_90_CLOCKWISE);
  in_rows_of(classes);
  in_rows_of(turned);
  return words;
}

}  // namespace rubble::scoring
