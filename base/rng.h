#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace rubble {

/// The block of four random words at `counter`: Philox4x32-10, a counter-based generator
/// (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3").
std::array<std::uint32_t, 4> philox4x32_10(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// A stream of random numbers that belongs to one owner: the same seed and name give the same numbers on every machine,
/// and a new stream leaves the draws of all others unchanged.
class Rng {
 public:
  Rng(std::uint64_t seed, std::string_view stream);

  std::uint32_t next_u32();
  /// The next n words at once: the same that n calls of next_u32() give, four times as fast.
  void fill(std::uint32_t* words, std::size_t n);
  /// Uniform in [0, 1), 53 bits.
  double uniform();
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform integer in [0, n), n > 0, without modulo bias.
  std::uint32_t below(std::uint32_t n);
  /// Standard normal (Box-Muller; both values of a pair are used).
  double gaussian();
  double gaussian(double sigma) { return sigma * gaussian(); }

 private:
  void refill();

  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_{};
  std::array<std::uint32_t, 4> block_{};
  int used_ = 4;
  bool has_spare_ = false;
  double spare_ = 0.0;
};

}  // namespace rubble
