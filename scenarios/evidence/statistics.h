#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rubble::scenarios {

double mean(const std::vector<double>& values);
/// Of a sample, n - 1 in the denominator; 0 for fewer than two values.
double standard_deviation(const std::vector<double>& values);
/// Linear between order statistics (type 7 of Hyndman and Fan 1996). `share` 0..1, values not empty, in any order.
double quantile(std::vector<double> values, double share);
double median(const std::vector<double>& values);
/// 1.4826 x median absolute deviation: the standard deviation of a normal sample, deaf to a few outliers.
double robust_deviation(const std::vector<double>& values);

struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// 95 % confidence interval of the mean by bootstrap, 10,000 resamples drawn from the stream (seed, "bootstrap"):
/// percentiles, expanded for small samples (Hesterberg 2015, "What teachers should know about the bootstrap",
/// sec. 5.2). One value, or none: infinite.
Interval bootstrap_mean(const std::vector<double>& values, std::uint64_t seed);

/// Exact two-sided probability of a split at least as uneven as this, were both signs equally likely. Ties are left
/// out.
double sign_test(std::size_t positive, std::size_t negative);

/// P(T <= t) of Student's distribution (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4).
double student_cdf(double t, int degrees);
double student_quantile(double p, int degrees);
double normal_cdf(double z);

}  // namespace rubble::scenarios
