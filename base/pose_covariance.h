#pragma once

#include <array>
#include <cstddef>

namespace rubble {

/// Covariance of a planar pose: x, y [m^2], heading [rad^2].
class PoseCovariance {
 public:
  /// Zero.
  PoseCovariance() = default;
  /// From a 3 x 3 matrix of any library.
  template <class Matrix>
  explicit PoseCovariance(const Matrix& m) {
    for (int row = 0; row < 3; ++row)
      for (int column = 0; column < 3; ++column) (*this)(row, column) = m(row, column);
  }

  double operator()(int row, int column) const { return v_[index(row, column)]; }
  double& operator()(int row, int column) { return v_[index(row, column)]; }
  bool operator==(const PoseCovariance& other) const { return v_ == other.v_; }

 private:
  static std::size_t index(int row, int column) { return static_cast<std::size_t>(3 * row + column); }

  std::array<double, 9> v_{};
};

}  // namespace rubble
