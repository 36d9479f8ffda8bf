#include "robot/drivers/scip/scip_receiver.h"

#include <utility>

namespace rubble::robot::scip {
namespace {

constexpr std::size_t kLongestLine = 256;     // the longest true one is a FIRM line of SCIP 1.1, below 100
constexpr std::size_t kLongestReply = 16384;  // 1440 steps of a UTM-30LX with two values a step fit
constexpr std::size_t kMostReplies = 64;      // that nobody fetched

}  // namespace

void Receiver::expect_echo(const std::string& start, std::size_t length) {
  echo_ = start;
  echo_length_ = length;
}

void Receiver::push(const std::uint8_t* bytes, std::size_t size, Stamp arrived) {
  for (std::size_t i = 0; i < size; ++i) {
    const char c = static_cast<char>(bytes[i]);
    if (line_.empty()) line_begun_ = arrived;
    if (c == '\n') {
      end_line(arrived);
    } else {
      line_ += c;
      if (line_.size() > kLongestLine) drop();
    }
  }
}

void Receiver::end_line(Stamp arrived) {
  const bool is_echo = !echo_.empty() && line_.size() == echo_length_ && line_.compare(0, echo_.size(), echo_) == 0;
  if (line_.empty()) {
    if (!reply_.lines.empty()) {
      reply_.ended = arrived;
      if (done_.size() == kMostReplies) {
        done_.pop_front();
        ++broken_;
      }
      done_.push_back(std::exchange(reply_, {}));
      reply_size_ = 0;
    }
    return;
  }
  if (is_echo && !reply_.lines.empty()) {
    ++broken_;
    reply_ = {};
    reply_size_ = 0;
  }
  if (reply_.lines.empty()) reply_.begun = line_begun_;
  reply_size_ += line_.size();
  reply_.lines.push_back(std::exchange(line_, {}));
  if (reply_size_ > kLongestReply || reply_.lines.size() > kLongestReply / 8) drop();
}

void Receiver::drop() {
  ++broken_;
  line_.clear();
  reply_ = {};
  reply_size_ = 0;
}

std::optional<Reply> Receiver::next() {
  if (done_.empty()) return std::nullopt;
  Reply first = std::move(done_.front());
  done_.pop_front();
  return first;
}

void Receiver::clear() {
  line_.clear();
  reply_ = {};
  reply_size_ = 0;
  done_.clear();
}

}  // namespace rubble::robot::scip
