#include "base/rng.h"

#include <cmath>

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "base/angle.h"

namespace rubble {
namespace {

/// FNV-1a, 64 bit: a stable name -> number map (std::hash may differ between libraries).
std::uint64_t hash_name(std::string_view name) {
  std::uint64_t h = 14695981039346656037ull;
  for (const char c : name) {
    h ^= static_cast<unsigned char>(c);
    h *= 1099511628211ull;
  }
  return h;
}

#if defined(__SSE2__)
/// Two blocks at once: word k of both in the low halves of x[k]'s two lanes; what the high halves hold does not matter.
struct TwoBlocks {
  __m128i x[4];
};

void philox_rounds(TwoBlocks (&b)[2], std::array<std::uint32_t, 2> key) {
  const __m128i m0 = _mm_set1_epi64x(0xD2511F53), m1 = _mm_set1_epi64x(0xCD9E8D57);
  for (int round = 0; round < 10; ++round) {
    const __m128i k0 = _mm_set1_epi64x(key[0]), k1 = _mm_set1_epi64x(key[1]);
    for (TwoBlocks& two : b) {
      const __m128i p0 = _mm_mul_epu32(m0, two.x[0]);
      const __m128i p1 = _mm_mul_epu32(m1, two.x[2]);
      two.x[0] = _mm_xor_si128(_mm_xor_si128(_mm_srli_epi64(p1, 32), two.x[1]), k0);
      two.x[2] = _mm_xor_si128(_mm_xor_si128(_mm_srli_epi64(p0, 32), two.x[3]), k1);
      two.x[1] = p1;
      two.x[3] = p0;
    }
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
}

/// The 16 words of the four blocks from `counter` on; its word 0 must not run over.
void four_blocks(const std::array<std::uint32_t, 4>& counter, const std::array<std::uint32_t, 2>& key,
                 std::uint32_t* words) {
  TwoBlocks b[2];
  for (int i = 0; i < 2; ++i) {
    const std::uint32_t first = counter[0] + 2u * static_cast<std::uint32_t>(i);
    b[i].x[0] = _mm_set_epi64x(first + 1u, first);
    for (std::size_t k = 1; k < 4; ++k) b[i].x[k] = _mm_set1_epi64x(counter[k]);
  }
  philox_rounds(b, key);
  for (int i = 0; i < 2; ++i) {
    const auto joined = [&](int k) {  // words k and k + 1 of either block
      const __m128i low = _mm_shuffle_epi32(b[i].x[k], _MM_SHUFFLE(2, 0, 2, 0));
      const __m128i high = _mm_shuffle_epi32(b[i].x[k + 1], _MM_SHUFFLE(2, 0, 2, 0));
      return _mm_unpacklo_epi32(low, high);
    };
    const __m128i front = joined(0), back = joined(2);
    _mm_storeu_si128(reinterpret_cast<__m128i*>(words + 8 * i), _mm_unpacklo_epi64(front, back));
    _mm_storeu_si128(reinterpret_cast<__m128i*>(words + 8 * i + 4), _mm_unpackhi_epi64(front, back));
  }
}
#endif

}  // namespace

std::array<std::uint32_t, 4> philox4x32_10(std::array<std::uint32_t, 4> x, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = 0xD2511F53ull * x[0];
    const std::uint64_t p1 = 0xCD9E8D57ull * x[2];
    x = {static_cast<std::uint32_t>(p1 >> 32) ^ x[1] ^ key[0], static_cast<std::uint32_t>(p1),
         static_cast<std::uint32_t>(p0 >> 32) ^ x[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key[0] += 0x9E3779B9u;  // Weyl sequence: the golden ratio, and the root of 3 less 1
    key[1] += 0xBB67AE85u;
  }
  return x;
}

Rng::Rng(std::uint64_t seed, std::string_view stream)
    : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)} {
  const std::uint64_t name = hash_name(stream);
  counter_[2] = static_cast<std::uint32_t>(name);
  counter_[3] = static_cast<std::uint32_t>(name >> 32);
}

void Rng::refill() {
  block_ = philox4x32_10(counter_, key_);
  used_ = 0;
  if (++counter_[0] == 0) ++counter_[1];
}

std::uint32_t Rng::next_u32() {
  if (used_ == 4) refill();
  return block_[static_cast<std::size_t>(used_++)];
}

void Rng::fill(std::uint32_t* words, std::size_t n) {
  std::size_t i = 0;
  while (i < n && used_ < 4) words[i++] = next_u32();
#if defined(__SSE2__)
  while (i + 16 <= n && counter_[0] < 0xfffffff0u) {
    four_blocks(counter_, key_, words + i);
    counter_[0] += 4;
    i += 16;
  }
#endif
  while (i < n) words[i++] = next_u32();
}

double Rng::uniform() {
  const std::uint64_t high = next_u32();
  const std::uint64_t low = next_u32();
  return static_cast<double>(((high << 32) | low) >> 11) * 0x1.0p-53;
}

std::uint32_t Rng::below(std::uint32_t n) {
  const std::uint32_t limit =
      static_cast<std::uint32_t>(-n) % n;  // 2^32 mod n: draws under it would be over-represented
  std::uint32_t draw = next_u32();
  while (draw < limit) draw = next_u32();
  return draw % n;
}

double Rng::gaussian() {
  if (has_spare_) {
    has_spare_ = false;
    return spare_;
  }
  const double u = 1.0 - uniform();  // (0, 1]: the logarithm stays finite
  const double v = uniform();
  const double radius = std::sqrt(-2.0 * std::log(u));
  spare_ = radius * std::sin(2.0 * kPi * v);
  has_spare_ = true;
  return radius * std::cos(2.0 * kPi * v);
}

}  // namespace rubble
