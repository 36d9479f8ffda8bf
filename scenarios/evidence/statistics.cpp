#include "scenarios/evidence/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/angle.h"
#include "base/rng.h"

namespace rubble::scenarios {
namespace {

constexpr int kResamples = 10000;
constexpr double kTail = 0.025;

double sorted_quantile(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

}  // namespace

double mean(const std::vector<double>& values) {
  if (values.empty()) return std::nan("");
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double standard_deviation(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double centre = mean(values);
  double squares = 0.0;
  for (const double value : values) squares += (value - centre) * (value - centre);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double quantile(std::vector<double> values, double share) {
  assert(!values.empty());
  std::sort(values.begin(), values.end());
  return sorted_quantile(values, share);
}

double median(const std::vector<double>& values) { return values.empty() ? std::nan("") : quantile(values, 0.5); }

double robust_deviation(const std::vector<double>& values) {
  const double centre = median(values);
  std::vector<double> distances;
  for (const double value : values) distances.push_back(std::abs(value - centre));
  return 1.4826 * median(distances);
}

Interval bootstrap_mean(const std::vector<double>& values, std::uint64_t seed) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (values.size() < 2) return {-kInfinity, kInfinity};
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  if (*least == *most) return {*least, *most};
  const auto n = static_cast<std::uint32_t>(values.size());
  Rng rng(seed, "bootstrap");
  std::vector<double> means;
  for (int i = 0; i < kResamples; ++i) {
    double sum = 0.0;
    for (std::uint32_t k = 0; k < n; ++k) sum += values[rng.below(n)];
    means.push_back(sum / n);
  }
  // A resample varies by (n-1)/n of the sample's variance and has normal tails; Student's are wanted.
  const double z = student_quantile(kTail, static_cast<int>(n) - 1) * std::sqrt(n / (n - 1.0));
  const double tail = normal_cdf(z);
  std::sort(means.begin(), means.end());
  return {sorted_quantile(means, tail), sorted_quantile(means, 1.0 - tail)};
}

double sign_test(std::size_t positive, std::size_t negative) {
  const double n = static_cast<double>(positive + negative);
  const auto fewer = std::min(positive, negative);
  double p = 0.0;
  for (std::size_t k = 0; k <= fewer; ++k) {
    const double kk = static_cast<double>(k);
    p += std::exp(std::lgamma(n + 1) - std::lgamma(kk + 1) - std::lgamma(n - kk + 1) - n * std::log(2.0));
  }
  return std::min(1.0, 2.0 * p);
}

double normal_cdf(double z) { return 0.5 * std::erfc(-z / std::sqrt(2.0)); }

double student_cdf(double t, int degrees) {
  assert(degrees >= 1);
  const double theta = std::atan(t / std::sqrt(degrees));
  const double c = std::cos(theta), s = std::sin(theta);
  double inside = 0.0;  // P(|T| <= |t|), signed
  if (degrees % 2 == 1) {
    double term = c, sum = degrees > 1 ? c : 0.0;
    for (int k = 3; k <= degrees - 2; k += 2) sum += term *= c * c * (k - 1) / k;
    inside = 2.0 / kPi * (theta + s * sum);
  } else {
    double term = 1.0, sum = 1.0;
    for (int k = 2; k <= degrees - 2; k += 2) sum += term *= c * c * (k - 1) / k;
    inside = s * sum;
  }
  return 0.5 + 0.5 * inside;
}

double student_quantile(double p, int degrees) {
  double low = -1e6, high = 1e6;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    (student_cdf(middle, degrees) < p ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace rubble::scenarios
