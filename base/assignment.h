#pragma once

#include <cstddef>
#include <vector>

namespace rubble {

/// Minimum-cost assignment of every row to a column of its own; rows <= columns. Returns the column of each row.
/// Kuhn 1955 with potentials, O(rows^2 columns).
std::vector<std::size_t> assign(const std::vector<std::vector<double>>& cost);

}  // namespace rubble
