#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace rubble::robot::arcos {

/// The sum at the end of a packet: pairs of bytes added as big-endian words, a last odd byte joined by exclusive or
/// (Pioneer 3 operations manual, appendix "packet checksum").
std::uint16_t checksum(std::string_view payload);

/// FA FB, length, payload, sum. The payload's first byte is the command's number or the packet's type.
/// `payload` has 1 to 253 bytes.
std::string packet(std::string_view payload);

/// Finds packets in a stream of bytes that may hold junk, be cut anywhere and be damaged.
class PacketParser {
 public:
  void feed(std::string_view bytes) { waiting_.append(bytes); }
  /// The payload of the next whole packet with a good sum; nothing while more bytes are needed.
  std::optional<std::string> next();
  /// A new stream begins.
  void reset() { waiting_.clear(); }

  /// Packets dropped for their sum, and bytes that belonged to no packet, since the start.
  std::size_t bad_sums() const { return bad_sums_; }
  std::size_t junk() const { return junk_; }

 private:
  void drop(std::size_t bytes);

  std::string waiting_;
  std::size_t bad_sums_ = 0;
  std::size_t junk_ = 0;
};

/// Little-endian two's complement fields of a payload, read one after the other; all zero behind the end.
class Fields {
 public:
  explicit Fields(std::string_view payload, std::size_t from = 0) : payload_(payload), at_(from) {}
  std::uint8_t u8();
  std::uint16_t u16();
  std::int16_t i16() { return static_cast<std::int16_t>(u16()); }
  std::int32_t i32();
  /// Up to the next NUL, which is passed over.
  std::string text();
  void skip(std::size_t bytes) { at_ += bytes; }
  std::size_t left() const { return at_ < payload_.size() ? payload_.size() - at_ : 0; }

 private:
  std::string_view payload_;
  std::size_t at_;
};

/// The inverse of Fields; values keep their low bits.
void put_u8(std::string& out, int value);
void put_u16(std::string& out, int value);
void put_i32(std::string& out, std::int32_t value);
void put_text(std::string& out, std::string_view text);

}  // namespace rubble::robot::arcos
