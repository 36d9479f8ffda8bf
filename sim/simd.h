#pragma once

#include <cmath>
#include <cstring>

namespace rubble::sim {

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
inline Float4 min4(const Float4& a, const Float4& b) { return a < b ? a : b; }
inline Float4 max4(const Float4& a, const Float4& b) { return a > b ? a : b; }
inline Float4 sqrt4(const Float4& v) {
  return Float4{std::sqrt(v[0]), std::sqrt(v[1]), std::sqrt(v[2]), std::sqrt(v[3])};
}
inline bool any4(const Int4& mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) != 0; }

}  // namespace rubble::sim
