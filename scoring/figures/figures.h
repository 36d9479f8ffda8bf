// The one table of figures: everything that is said about a run or a map in numbers. score.json, `expect`, the tables
// on the terminal, reports, comparisons, regression checks and leagues read it; docs/extending.md tells how to add a
// row.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "scoring/figures/evidence.h"

namespace rubble::scoring {

/// A figure in one case; monostate: not known.
using Value = std::variant<std::monostate, bool, std::uint64_t, double, std::string>;

enum class Better { Higher, Lower, Neither };

/// Where a figure goes beside score.json, and what it is like.
enum Traits : unsigned {
  kPlain = 0,
  kShown = 1u << 0,    ///< a row of the table that ends a run or a scoring
  kReport = 1u << 1,   ///< a column of a sweep's report
  kRanking = 1u << 2,  ///< a column of a league's ranking
  kLeague = 1u << 3,   ///< a column of league.csv
  kMachine = 1u << 4,  ///< depends on the machine, not on the seed: kept out of hashes and comparisons
  kText = 1u << 5,     ///< words; cannot be bounded by `expect`
  kSpecial = 1u << 6,  ///< only of a real drive, or where trajectories alone are compared: else left out of score.json
  kPlaced = 1u << 7,   ///< measured where the map lies; of a refused map the worst there is, which no table shows
};

/// A row of the table.
struct Figure {
  std::string key;    ///< in score.json, `expect`, league.csv
  std::string label;  ///< for people
  std::string unit;   ///< "m", "s"; "%": a share from 0 to 1, shown to people in percent; empty: none
  int decimals = 3;   ///< as people read it
  Better better = Better::Neither;
  double floor = 0.0;  ///< a change of the median smaller than this is of no interest to anybody
  unsigned traits = kPlain;
  std::function<Value(const Evidence&)> get;
  /// For who reads it for the first time, on a line behind the value; whatever people are shown in a table has one.
  std::string meaning{};

  bool is(Traits trait) const { return (traits & trait) != 0; }
  /// It can get worse: comparisons and checks judge it.
  bool judged() const { return better != Better::Neither && !is(kMachine); }
};

/// All rows, in the order of score.json; those that are judged with the most important first.
const std::vector<Figure>& figures();

/// Null: there is no such row.
const Figure* find_figure(const std::string& key);

/// Rows with a trait, in order.
std::vector<const Figure*> figures_with(Traits trait);

/// "psi [m]": what a column of plain numbers is headed with.
std::string heading(const Figure& figure);

/// "0.980", "100.0 %", "636.5 s", "yes": for people; empty where the value is not known.
std::string text_of(const Figure& figure, const Value& value);

/// "0.980", "1.000", "yes": without the unit, as league.csv has it.
std::string plain_text_of(const Figure& figure, const Value& value);

}  // namespace rubble::scoring
