#include "robot/protocols/arcos_commands.h"

#include <algorithm>
#include <cstdlib>

#include "robot/protocols/arcos_packet.h"

namespace rubble::robot::arcos {
namespace {

constexpr int kPositive = 0x3B;
constexpr int kNegative = 0x1B;
constexpr int kString = 0x2B;

}  // namespace

std::string command(Command number) { return packet(std::string(1, static_cast<char>(number))); }

std::string command(Command number, int value) {
  std::string payload;
  put_u8(payload, number);
  put_u8(payload, value < 0 ? kNegative : kPositive);
  put_u16(payload, std::min(std::abs(value), 0xFFFF));
  return packet(payload);
}

std::string sim_set_pose(int x_mm, int y_mm, int heading_deg) {
  std::string payload;
  put_u8(payload, kSimSetPose);
  put_u8(payload, kPositive);
  put_i32(payload, x_mm);
  put_i32(payload, y_mm);
  put_i32(payload, heading_deg);
  return packet(payload);
}

std::optional<Order> parse_order(std::string_view payload) {
  if (payload.empty()) return std::nullopt;
  Order order;
  order.number = static_cast<std::uint8_t>(payload[0]);
  order.rest = std::string(payload.substr(1));
  Fields fields(payload, 1);
  if (fields.left() == 0) return order;
  const int type = fields.u8();
  if (type == kString) {
    const std::size_t length = fields.u8();
    order.text = std::string(payload.substr(std::min<std::size_t>(3, payload.size())).substr(0, length));
  } else if (fields.left() >= 2 && (type == kPositive || type == kNegative)) {
    const int magnitude = fields.u16();
    order.value = type == kNegative ? -magnitude : magnitude;
  }
  return order;
}

WheelSpeeds wheel_speeds(int value) {
  const auto word = static_cast<unsigned>(value) & 0xFFFFu;
  return {static_cast<std::int8_t>(word >> 8), static_cast<std::int8_t>(word & 0xFF)};
}

}  // namespace rubble::robot::arcos
