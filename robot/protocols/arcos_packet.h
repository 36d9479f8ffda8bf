#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/stamp.h"

namespace rubble::robot::arcos {

/// The sum at the end of a packet: pairs of bytes added as big-endian words, a last odd byte joined by exclusive or
/// (Pioneer 3 operations manual, appendix "packet checksum").
std::uint16_t checksum(std::string_view payload);

/// The length byte's most, which counts payload and sum: the manual allows packets of 200 bytes.
constexpr std::size_t kLongest = 200;

/// FA FB, length, payload, sum. The payload's first byte is the command's number or the packet's type.
/// `payload` has 1 to kLongest - 2 bytes.
std::string packet(std::string_view payload);

/// Finds packets in a stream of bytes that may hold junk, be cut anywhere and be damaged.
class PacketParser {
 public:
  /// Bytes that arrived at `now`. Without times nothing is ever given up, see next().
  void feed(std::string_view bytes, Stamp now = {});
  /// The payload of the next whole packet with a good sum; nothing while more bytes are needed. A head is given up when
  /// the packet it promises has not come at `now` though it had kPatience and the time that it takes at 9600 baud: junk
  /// that looks like a head must not swallow what follows it.
  std::optional<std::string> next(Stamp now = {});
  static constexpr double kPatience = 0.1;  ///< [s]
  /// A new stream begins.
  void reset() { waiting_.clear(); }

  /// Packets dropped for their sum, and bytes that belonged to no packet, since the start.
  std::size_t bad_sums() const { return bad_sums_; }
  std::size_t junk() const { return junk_; }

 private:
  void drop(std::size_t bytes);
  bool is_overdue(std::size_t bytes, Stamp now) const;

  std::string waiting_;
  Stamp fed_;    ///< when bytes came last
  Stamp since_;  ///< when the first of those that wait came, at the latest
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
