#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "base/stamp.h"

namespace rubble::robot::scip {

/// What a device sends between two empty lines: echo, status, data. Nothing in it is checked yet.
struct Reply {
  std::vector<std::string> lines;
  Stamp begun;  ///< arrival of the bytes that held the first one of the reply
  Stamp ended;  ///< arrival of the bytes that held the last one
};

/// Cuts a stream of bytes into replies, and finds the next one after whatever junk. Keeps at most a few kilobytes.
class Receiver {
 public:
  /// A line that starts with `start` and has the length `length` begins a reply, wherever it stands: so a reply whose
  /// end was lost does not swallow the next one.
  void expect_echo(const std::string& start, std::size_t length);

  void push(const std::uint8_t* bytes, std::size_t size, Stamp arrived);
  /// The next whole reply, if there is one.
  std::optional<Reply> next();
  /// Throws away what waits.
  void clear();
  /// Times that bytes were thrown away: too long a line or reply, or a reply that another one's echo broke off.
  std::uint64_t broken() const { return broken_; }

 private:
  void end_line(Stamp arrived);
  void drop();

  std::string echo_;
  std::size_t echo_length_ = 0;
  std::string line_;
  Stamp line_begun_;
  Reply reply_;
  std::size_t reply_size_ = 0;
  std::deque<Reply> done_;
  std::uint64_t broken_ = 0;
};

}  // namespace rubble::robot::scip
