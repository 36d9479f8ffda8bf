#pragma once

#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>

namespace rubble {

/// A payload that cannot be what its kind says; the reader of the file adds the place and the remedy.
class BadPayload : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Small magnitudes of either sign become small unsigned numbers: 0, -1, 1, -2 -> 0, 1, 2, 3.
constexpr std::uint64_t zigzag(std::int64_t n) {
  return (static_cast<std::uint64_t>(n) << 1) ^ (n < 0 ? ~std::uint64_t{0} : std::uint64_t{0});
}
constexpr std::int64_t unzigzag(std::uint64_t z) {
  return static_cast<std::int64_t>((z >> 1) ^ ((z & 1u) != 0 ? ~std::uint64_t{0} : std::uint64_t{0}));
}

/// a - b modulo 2^64: defined for every pair, Stamp::never() included; wrapped_sum undoes it.
inline std::int64_t wrapped_difference(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
inline std::int64_t wrapped_sum(std::int64_t a, std::int64_t b) {
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

/// Appends numbers to a byte string, little-endian on every machine.
class ByteWriter {
 public:
  explicit ByteWriter(std::string& out) : out_(out) {}

  void u8(std::uint8_t value) { out_.push_back(static_cast<char>(value)); }
  void u32(std::uint32_t value) { fixed(value); }
  void f32(float value) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    fixed(bits);
  }
  void f64(double value) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    fixed(bits);
  }
  /// Seven bits a byte, lowest first, the top bit says that more follow.
  void varint(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) u8(static_cast<std::uint8_t>(value | 0x80));
    u8(static_cast<std::uint8_t>(value));
  }
  void svarint(std::int64_t value) { varint(zigzag(value)); }
  void bytes(std::string_view value) { out_.append(value); }

 private:
  template <class T>
  void fixed(T value) {
    char raw[sizeof(T)];
    for (std::size_t i = 0; i < sizeof(T); ++i) raw[i] = static_cast<char>(static_cast<std::uint8_t>(value >> (8 * i)));
    out_.append(raw, sizeof(T));
  }
  std::string& out_;
};

/// Takes the numbers of a ByteWriter back. Throws BadPayload when the bytes run out.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : bytes_(bytes) {}

  std::size_t left() const { return bytes_.size(); }
  std::uint8_t u8() { return fixed<std::uint8_t>(); }
  std::uint32_t u32() { return fixed<std::uint32_t>(); }
  float f32() {
    const auto bits = fixed<std::uint32_t>();
    float value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  double f64() {
    const auto bits = fixed<std::uint64_t>();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    return value;
  }
  std::uint64_t varint() {
    std::uint64_t value = 0;
    for (unsigned shift = 0; shift < 64; shift += 7) {
      const std::uint8_t byte = u8();
      value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
      if ((byte & 0x80) == 0) return value;
    }
    throw BadPayload("a number of more than ten bytes");
  }
  std::int64_t svarint() { return unzigzag(varint()); }
  std::string_view bytes(std::uint64_t count) {
    if (count > bytes_.size()) throw BadPayload("fewer bytes than announced");
    const std::string_view head = bytes_.substr(0, static_cast<std::size_t>(count));
    bytes_.remove_prefix(head.size());
    return head;
  }
  /// A count of things that take at least `least` bytes each: bounds what a damaged file can make us allocate.
  std::size_t count(std::size_t least) {
    const std::uint64_t n = varint();
    if (n > bytes_.size() / least) throw BadPayload("more entries than bytes");
    return static_cast<std::size_t>(n);
  }

 private:
  template <class T>
  T fixed() {
    const std::string_view raw = bytes(sizeof(T));
    T value = 0;
    for (std::size_t i = 0; i < sizeof(T); ++i)
      value = static_cast<T>(value | static_cast<T>(static_cast<T>(static_cast<std::uint8_t>(raw[i])) << (8 * i)));
    return value;
  }
  std::string_view bytes_;
};

}  // namespace rubble
