#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

/// Sixteen bytes or eight words worked on together (compiler vector extension, SSE on x86-64). They hold numbers of
/// steps, of which the largest means "too far to say", or classes of cells.
namespace rubble::scoring {

using Bytes = std::uint8_t __attribute__((vector_size(16)));
using Words = std::uint16_t __attribute__((vector_size(16)));

template <class V>
constexpr std::size_t kLanes = sizeof(V) / sizeof(V{}[0]);

template <class V>
constexpr V kNothing = V{};
template <class V>
constexpr V kFar = ~V{};

/// kLanes classes, a byte each.
inline void load(const void* classes, Bytes& out) { std::memcpy(&out, classes, sizeof out); }
inline void load(const void* classes, Words& out) {
  std::uint8_t __attribute__((vector_size(8))) bytes;
  std::memcpy(&bytes, classes, sizeof bytes);
  out = __builtin_convertvector(bytes, Words);
}

/// One step further; what is too far stays so.
#if defined(__SSE2__)
inline Bytes further(Bytes steps) {
  return reinterpret_cast<Bytes>(_mm_adds_epu8(reinterpret_cast<__m128i>(steps), _mm_set1_epi8(1)));
}
inline Words further(Words steps) {
  return reinterpret_cast<Words>(_mm_adds_epu16(reinterpret_cast<__m128i>(steps), _mm_set1_epi16(1)));
}
#else
template <class V>
V further(const V& steps) {
  const V next = steps + 1;
  return next | reinterpret_cast<V>(next == 0);
}
#endif

template <class V>
V nearer(const V& a, const V& b) {
  return a < b ? a : b;
}
template <class V>
V farther(const V& a, const V& b) {
  return a > b ? a : b;
}

/// All bits of the lanes in which both are equal.
template <class V>
V equal(const V& a, const V& b) {
  return reinterpret_cast<V>(a == b);
}

/// The lower (the upper) halves of both, lane by lane in turn.
inline Bytes interleave_low(Bytes a, Bytes b) {
  return __builtin_shufflevector(a, b, 0, 16, 1, 17, 2, 18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23);
}
inline Bytes interleave_high(Bytes a, Bytes b) {
  return __builtin_shufflevector(a, b, 8, 24, 9, 25, 10, 26, 11, 27, 12, 28, 13, 29, 14, 30, 15, 31);
}
inline Words interleave_low(Words a, Words b) { return __builtin_shufflevector(a, b, 0, 8, 1, 9, 2, 10, 3, 11); }
inline Words interleave_high(Words a, Words b) { return __builtin_shufflevector(a, b, 4, 12, 5, 13, 6, 14, 7, 15); }

/// Lane j of vector i becomes lane i of vector j. Each round turns the bits of a lane's number (those of i before those
/// of j) by one.
template <class V>
void transpose(V (&square)[kLanes<V>]) {
  constexpr std::size_t kHalf = kLanes<V> / 2;
  for (std::size_t bits = kLanes<V>; bits > 1; bits /= 2) {
    V out[kLanes<V>];
    for (std::size_t i = 0; i < kHalf; ++i) {
      out[2 * i] = interleave_low(square[i], square[i + kHalf]);
      out[2 * i + 1] = interleave_high(square[i], square[i + kHalf]);
    }
    for (std::size_t i = 0; i < kLanes<V>; ++i) square[i] = out[i];
  }
}

/// Sum of many lanes.
class LaneSum {
 public:
  void add(Bytes v) { wide_ += sum(v); }
  void add(Words v) { wide_ += sum(reinterpret_cast<Bytes>(v & 255)) + (sum(reinterpret_cast<Bytes>(v >> 8)) << 8); }
  std::int64_t value() const { return static_cast<std::int64_t>(wide_[0] + wide_[1]); }

 private:
  using Wide = std::uint64_t __attribute__((vector_size(16)));

  static Wide sum(Bytes v) {
#if defined(__SSE2__)
    return reinterpret_cast<Wide>(_mm_sad_epu8(reinterpret_cast<__m128i>(v), _mm_setzero_si128()));
#else
    Wide out{};
    for (std::size_t i = 0; i < kLanes<Bytes>; ++i) out[i % 2] += v[i];
    return out;
#endif
  }

  Wide wide_{};
};

}  // namespace rubble::scoring
