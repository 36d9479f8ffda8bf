#include "robot/logs/own/range_codec.h"

#include <cmath>
#include <cstring>
#include <limits>

namespace rubble::robot {
namespace {

// First byte of a code; docs/robot.md explains the split. Two-byte differences reach 12479 / 2 = 6.2 m.
constexpr std::uint32_t kTwoBytes = 0xC0;   // below: a zigzag difference in this one byte
constexpr std::uint32_t kVarint = 0xF0;     // a zigzag difference follows as varint
constexpr std::uint32_t kMisses = 0xF1;     // a run of +inf; its length - 1 follows in one byte
constexpr std::uint32_t kNoMeasure = 0xF2;  // a run of NaN, likewise
constexpr std::uint32_t kRaw = 0xF3;        // the float's four bytes follow
constexpr std::uint32_t kTwoByteEnd = kTwoBytes + (kVarint - kTwoBytes) * 256;

constexpr std::uint32_t kInfinityBits = 0x7f800000u;
constexpr std::uint32_t kQuietNanBits = 0x7fc00000u;
constexpr float kMaxCodedRange = 8000.0f;  // beyond, float32 no longer resolves a millimetre
constexpr std::size_t kLongestCode = 5;    // kRaw; a varint of a coded difference (< 2^25) takes no more

std::uint32_t bits_of(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

float from_bits(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

float metres(std::int32_t mm) { return static_cast<float>(static_cast<double>(mm) * 0.001); }

std::size_t run_length(const std::vector<float>& ranges, std::size_t first, std::uint32_t bits) {
  std::size_t end = first + 1;
  while (end < ranges.size() && end - first < 256 && bits_of(ranges[end]) == bits) ++end;
  return end - first;
}

}  // namespace

void encode_ranges(const std::vector<float>& ranges, std::string& out) {
  const std::size_t start = out.size();
  out.resize(start + ranges.size() * kLongestCode);
  auto* to = reinterpret_cast<unsigned char*>(&out[0]) + start;
  const auto put = [&to](std::uint32_t byte) { *to++ = static_cast<unsigned char>(byte); };

  std::int32_t last_mm = 0;
  for (std::size_t i = 0; i < ranges.size();) {
    const std::uint32_t bits = bits_of(ranges[i]);
    if (bits == kInfinityBits || bits == kQuietNanBits) {
      const std::size_t run = run_length(ranges, i, bits);
      put(bits == kInfinityBits ? kMisses : kNoMeasure);
      put(static_cast<std::uint32_t>(run - 1));
      i += run;
      continue;
    }
    ++i;
    const float range = from_bits(bits);
    const bool in_reach = range >= 0.0f && range <= kMaxCodedRange;
    const auto mm = static_cast<std::int32_t>(in_reach ? static_cast<double>(range) * 1000.0 + 0.5 : 0.0);
    if (!in_reach || bits_of(metres(mm)) != bits) {
      put(kRaw);
      for (unsigned shift = 0; shift < 32; shift += 8) put(bits >> shift);
      continue;
    }
    const auto difference = static_cast<std::uint32_t>(zigzag(mm - last_mm));
    last_mm = mm;
    if (difference < kTwoBytes) {
      put(difference);
    } else if (difference < kTwoByteEnd) {
      put(kTwoBytes + ((difference - kTwoBytes) >> 8));
      put(difference - kTwoBytes);
    } else {
      put(kVarint);
      std::uint32_t rest = difference;
      for (; rest >= 0x80; rest >>= 7) put(rest | 0x80);
      put(rest);
    }
  }
  out.resize(static_cast<std::size_t>(reinterpret_cast<char*>(to) - &out[0]));
}

std::vector<float> decode_ranges(ByteReader& bytes, std::size_t beams) {
  if (beams / 128 > bytes.left()) throw BadPayload("more beams than bytes");  // the densest code: 256 beams in 2 bytes
  std::vector<float> ranges;
  ranges.reserve(beams);
  std::int64_t mm = 0;
  const auto step = [&](std::uint64_t difference) {
    mm = wrapped_sum(mm, unzigzag(difference));
    if (mm < 0 || mm > std::numeric_limits<std::int32_t>::max()) throw BadPayload("a range out of reach");
    ranges.push_back(metres(static_cast<std::int32_t>(mm)));
  };
  while (ranges.size() < beams) {
    const std::uint32_t code = bytes.u8();
    if (code < kTwoBytes) {
      step(code);
    } else if (code < kVarint) {
      step(kTwoBytes + ((code - kTwoBytes) << 8) + bytes.u8());
    } else if (code == kVarint) {
      step(bytes.varint());
    } else if (code == kRaw) {
      ranges.push_back(bytes.f32());
    } else if (code == kMisses || code == kNoMeasure) {
      const std::size_t run = std::size_t{bytes.u8()} + 1;
      if (run > beams - ranges.size()) throw BadPayload("more beams than announced");
      ranges.insert(ranges.end(), run, from_bits(code == kMisses ? kInfinityBits : kQuietNanBits));
    } else {
      throw BadPayload("an unknown range code");
    }
  }
  return ranges;
}

}  // namespace rubble::robot
