#include "robot/drivers/scip/scip_replay.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "robot/drivers/scip/scan_maker.h"
#include "robot/drivers/scip/scip_link.h"
#include "robot/drivers/scip/scip_receiver.h"
#include "robot/drivers/scip/scip_reply.h"
#include "robot/drivers/scip/scip_text.h"

namespace rubble::robot {
namespace {

using namespace scip;

constexpr std::size_t kStreamPart = 13;  ///< of an MD command: what its scans echo, without their number

/// Follows one conversation after the other as Link and ScipScanner led them.
class Listener {
 public:
  Listener(const RangeRules& rules, ReplayedScans& out) : rules_(rules), out_(out) {}

  void opened(LineKind line) {
    count_broken();
    line_ = line;
    receiver_ = {};
    geometry_.reset();
    maker_.reset();
    stream_.clear();
    scip2_ = asked_ = false;
  }

  void set_baud(const std::string& digits) { baud_ = number(digits).value_or(baud_); }

  void sent(const std::string& bytes, Stamp stamp) {
    const std::string command = bytes.substr(0, bytes.find('\n'));
    if (command.empty()) return;
    // What came before the first question was thrown away.
    if (!asked_) receiver_.clear();
    asked_ = true;
    question_ = stamp;
    const bool streams = command.rfind("MD", 0) == 0 || (command.size() == 9 && command[0] == 'G');
    if (streams) stream_ = command.substr(0, kStreamPart);
    receiver_.expect_echo(streams ? stream_ : command, command.size());
  }

  void received(const std::string& bytes, Stamp stamp) {
    receiver_.push(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), stamp);
    while (const auto reply = receiver_.next()) digest(*reply);
  }

  void count_broken() { out_.damaged += receiver_.broken(); }

 private:
  void digest(const Reply& reply) {
    const std::string& echo = reply.lines[0];
    const auto status = status_of(reply);
    if (!stream_.empty() && echo.rfind(stream_, 0) == 0) return follow(reply, status);
    if (!status) return;
    if (echo == "PP" && *status == "00") {
      if (const auto entries = entries_of(reply, true)) meet(geometry_of(*entries), true);
    } else if (echo == "V" && status->size() == 1) {
      const auto entries = entries_of(reply, false);
      if (!entries) return;
      for (const auto& [key, value] : *entries)
        if (key == "FIRM") meet(geometry_of_firmware(value), false);
    } else if (echo == "TM1" && *status == "00" && reply.lines.size() >= 3 && maker_) {
      const auto text = checked(reply.lines[2]);
      const auto count = text && text->size() == 4 ? decode(*text) : std::nullopt;
      if (!count) return;
      const WrappingClock::Reading reading = maker_->clock().read(*count, reply.ended);
      if (reading.restarted) maker_->map().clear();
      const auto [soonest, latest] = when_read(question_, reply.ended, line_, baud_);
      maker_->map().anchor(reading.time, soonest, latest);
    }
  }

  void meet(const std::optional<Geometry>& geometry, bool scip2) {
    if (!geometry) return;
    geometry_ = geometry;
    scip2_ = scip2;
    maker_.emplace(*geometry, scip2, rules_);
  }

  void follow(const Reply& reply, const std::optional<std::string>& status) {
    if (!maker_) return;
    if (scip2_ && status && *status == "00" && reply.lines.size() == 2) return;  // the command's own answer
    std::optional<Sweep> sweep;
    if (status && *status == (scip2_ ? "99" : "0"))
      sweep = scip2_ ? sweep_of(reply, geometry_->steps()) : old_sweep_of(reply, geometry_->steps());
    if (!sweep) {
      ++out_.damaged;
      return;
    }
    if (auto made = maker_->make(*sweep, reply.begun, reply.ended)) {
      out_.missed += static_cast<std::uint64_t>(made->missed);
      out_.scans.push_back(std::move(made->scan));
    }
  }

  RangeRules rules_;
  ReplayedScans& out_;
  Receiver receiver_;
  std::optional<Geometry> geometry_;
  std::optional<ScanMaker> maker_;
  std::string stream_;
  Stamp question_;
  LineKind line_ = LineKind::Tcp;
  int baud_ = 0;
  bool scip2_ = false;
  bool asked_ = false;
};

}  // namespace

ReplayedScans replay_scanner(const std::vector<BlackBoxEntry>& entries, const RangeRules& rules) {
  ReplayedScans replayed;
  Listener listener(rules, replayed);
  for (const BlackBoxEntry& entry : entries) {
    if (entry.device != "urg") continue;
    if (entry.direction == Direction::Opened) listener.opened(line_kind(entry));
    if (entry.direction == Direction::BitRate) listener.set_baud(entry.bytes);
    if (entry.direction == Direction::ToDevice) listener.sent(entry.bytes, entry.stamp);
    if (entry.direction == Direction::FromDevice) listener.received(entry.bytes, entry.stamp);
  }
  listener.count_broken();
  return replayed;
}

}  // namespace rubble::robot
