#include "base/text/formula.h"

#include <string_view>

namespace rubble {
namespace {

bool is_one_of(char c, std::string_view letters) { return letters.find(c) != std::string_view::npos; }

bool is_formula(std::string_view text) {
  if (text.empty()) return false;
  if (is_one_of(text.front(), "=@\t\r")) return true;
  return is_one_of(text.front(), "+-") && (text.size() < 2 || !is_one_of(text[1], "0123456789."));
}

}  // namespace

std::string not_a_formula(const std::string& text) { return is_formula(text) ? "'" + text : text; }

}  // namespace rubble
