#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#if defined(__SSE2__)
#include <emmintrin.h>
#endif

namespace rubble::sim {

inline constexpr float kInf = std::numeric_limits<float>::infinity();  ///< nothing in range

/// Four floats worked on together (compiler vector extension, SSE2 on x86-64). Lane by lane IEEE arithmetic, so the
/// bits are those of scalar code.
using Float4 = float __attribute__((vector_size(16)));
using Int4 = int __attribute__((vector_size(16)));

inline Float4 load4(const float* p) {
  Float4 v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void store4(float* p, const Float4& v) { std::memcpy(p, &v, sizeof v); }
inline Float4 splat(float x) { return Float4{x, x, x, x}; }
inline Float4 splat(double x) { return splat(static_cast<float>(x)); }
inline Float4 abs4(const Float4& v) {
  return reinterpret_cast<Float4>(reinterpret_cast<Int4>(v) & Int4{0x7fffffff, 0x7fffffff, 0x7fffffff, 0x7fffffff});
}
#if defined(__SSE2__)
inline Float4 min4(const Float4& a, const Float4& b) { return _mm_min_ps(a, b); }
inline Float4 max4(const Float4& a, const Float4& b) { return _mm_max_ps(a, b); }
inline Float4 sqrt4(const Float4& v) { return _mm_sqrt_ps(v); }
/// Bit i: whether lane i of the mask is set.
inline int bits4(const Int4& mask) { return _mm_movemask_ps(reinterpret_cast<__m128>(mask)); }
#else
inline Float4 min4(const Float4& a, const Float4& b) { return a < b ? a : b; }
inline Float4 max4(const Float4& a, const Float4& b) { return a > b ? a : b; }
inline Float4 sqrt4(const Float4& v) {
  return Float4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}
inline int bits4(const Int4& mask) { return (mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8); }
#endif
/// Lanes 1, 2, 3, 0.
inline Float4 next4(const Float4& v) { return __builtin_shufflevector(v, v, 1, 2, 3, 0); }
/// Number of the lowest set lane; `lanes` is not 0.
inline std::uint32_t lowest4(int lanes) {
  return static_cast<std::uint32_t>(__builtin_ctz(static_cast<unsigned>(lanes)));
}
inline bool any4(const Int4& mask) { return bits4(mask) != 0; }
/// Towards zero, for |v| < 2^31.
inline Float4 truncate4(const Float4& v) { return __builtin_convertvector(__builtin_convertvector(v, Int4), Float4); }

/// atan2 to 2e-5 rad: enough to tell which beams may meet something. Abramowitz and Stegun, 4.4.49. 0 at the origin.
inline Float4 rough_atan2(const Float4& y, const Float4& x) {
  const Float4 ax = abs4(x), ay = abs4(y);
  const Float4 q = min4(ax, ay) / max4(max4(ax, ay), splat(1e-30f));
  const Float4 s = q * q;
  const Float4 series = splat(0.1801410f) + s * (splat(-0.0851330f) + s * splat(0.0208351f));
  Float4 a = q * (splat(0.9998660f) + s * (splat(-0.3302995f) + s * series));
  a = ay > ax ? splat(1.57079633f) - a : a;
  a = x < splat(0.0f) ? splat(3.14159265f) - a : a;
  return y < splat(0.0f) ? -a : a;
}
constexpr double kRoughAtan2Error = 2e-5;  ///< [rad]

}  // namespace rubble::sim
