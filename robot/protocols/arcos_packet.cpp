#include "robot/protocols/arcos_packet.h"

#include <algorithm>

namespace rubble::robot::arcos {
namespace {

constexpr char kFirst = static_cast<char>(0xFA);
constexpr char kSecond = static_cast<char>(0xFB);
constexpr std::size_t kPacketHead = 3;  // FA FB length
constexpr std::size_t kSum = 2;
constexpr double kSlowestByte = 10.0 / 9600.0;  ///< [s]

std::uint8_t byte(std::string_view text, std::size_t i) { return static_cast<std::uint8_t>(text[i]); }

}  // namespace

std::uint16_t checksum(std::string_view payload) {
  unsigned sum = 0;
  std::size_t i = 0;
  for (; i + 1 < payload.size(); i += 2)
    sum = (sum + ((static_cast<unsigned>(byte(payload, i)) << 8) | byte(payload, i + 1))) & 0xFFFFu;
  if (i < payload.size()) sum ^= byte(payload, i);
  return static_cast<std::uint16_t>(sum);
}

std::string packet(std::string_view payload) {
  std::string out{kFirst, kSecond};
  put_u8(out, static_cast<int>(payload.size() + kSum));
  out.append(payload);
  const std::uint16_t sum = checksum(payload);
  put_u8(out, sum >> 8);
  put_u8(out, sum & 0xFF);
  return out;
}

void PacketParser::drop(std::size_t bytes) {
  waiting_.erase(0, bytes);
  junk_ += bytes;
  if (bytes > 0) since_ = fed_;
}

void PacketParser::feed(std::string_view bytes, Stamp now) {
  if (waiting_.empty()) since_ = now;
  fed_ = now;
  waiting_.append(bytes);
}

bool PacketParser::is_overdue(std::size_t bytes, Stamp now) const {
  return now - since_ > kPatience + kSlowestByte * static_cast<double>(bytes);
}

std::optional<std::string> PacketParser::next(Stamp now) {
  for (;;) {
    // A lone FA at the end may be the first half of a head.
    std::size_t head = 0;
    while (head < waiting_.size() &&
           !(waiting_[head] == kFirst && (head + 1 == waiting_.size() || waiting_[head + 1] == kSecond)))
      ++head;
    drop(head);
    const bool has_head = waiting_.size() >= kPacketHead;
    const std::size_t length = has_head ? byte(waiting_, 2) : 0;
    if (has_head && (length <= kSum || length > kLongest)) {
      drop(2);
      continue;
    }
    if (!has_head || waiting_.size() < kPacketHead + length) {
      if (waiting_.empty() || !is_overdue(kPacketHead + length, now)) return std::nullopt;
      drop(std::min<std::size_t>(2, waiting_.size()));
      continue;
    }
    const std::string payload = waiting_.substr(kPacketHead, length - kSum);
    const unsigned sum = (static_cast<unsigned>(byte(waiting_, kPacketHead + payload.size())) << 8) |
                         byte(waiting_, kPacketHead + payload.size() + 1);
    if (sum == checksum(payload)) {
      waiting_.erase(0, kPacketHead + length);
      since_ = fed_;
      return payload;
    }
    // The length itself may be what was damaged, so the next packet is looked for right behind this head.
    ++bad_sums_;
    drop(2);
  }
}

std::uint8_t Fields::u8() {
  const std::uint8_t value = at_ < payload_.size() ? byte(payload_, at_) : std::uint8_t{0};
  ++at_;
  return value;
}

std::uint16_t Fields::u16() {
  const unsigned low = u8();
  const unsigned high = u8();
  return static_cast<std::uint16_t>(low | (high << 8));
}

std::int32_t Fields::i32() {
  const std::uint32_t low = u16();
  const std::uint32_t high = u16();
  return static_cast<std::int32_t>(low | (high << 16));
}

std::string Fields::text() {
  if (at_ >= payload_.size()) return "";
  const std::string_view rest = payload_.substr(at_);
  const std::size_t length = std::min(rest.find('\0'), rest.size());
  at_ += length + 1;
  return std::string(rest.substr(0, length));
}

void put_u8(std::string& out, int value) { out.push_back(static_cast<char>(value & 0xFF)); }

void put_u16(std::string& out, int value) {
  put_u8(out, value);
  put_u8(out, value >> 8);
}

void put_i32(std::string& out, std::int32_t value) {
  const auto bits = static_cast<std::uint32_t>(value);
  put_u16(out, static_cast<int>(bits & 0xFFFFu));
  put_u16(out, static_cast<int>(bits >> 16));
}

void put_text(std::string& out, std::string_view text) {
  out.append(text);
  out.push_back('\0');
}

}  // namespace rubble::robot::arcos
