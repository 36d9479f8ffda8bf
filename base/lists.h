#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

namespace rubble {

/// Puts `more` behind what is there.
template <class T>
void append(std::vector<T>& list, std::vector<T>&& more) {
  list.insert(list.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

/// Those of equal stamps stay in their order.
template <class T>
void sort_by_stamp(std::vector<T>& list) {
  std::stable_sort(list.begin(), list.end(), [](const T& a, const T& b) { return a.stamp < b.stamp; });
}

}  // namespace rubble
