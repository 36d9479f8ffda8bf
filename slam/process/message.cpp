#include "slam/process/message.h"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>

#include "base/text/words.h"

namespace rubble::slam {
namespace {

constexpr std::size_t kChunk = 1u << 16;

template <class Number>
void append_shortest(std::string& text, Number value) {
  char digits[64];
  const auto end = std::to_chars(digits, digits + sizeof digits, value);
  text += ' ';
  text.append(digits, end.ptr);
}

template <class Number>
void append_real(std::string& text, Number value) {
  if (std::isfinite(value)) return append_shortest(text, value);
  text += std::isnan(value) ? " nan" : value > 0 ? " inf" : " -inf";
}

bool is_space(char c) { return c == ' ' || c == '\t'; }

}  // namespace

std::size_t DescriptorSource::read(char* to, std::size_t at_most) {
  for (;;) {
    const ssize_t got = ::read(descriptor_, to, at_most);
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR) return 0;
  }
}

/// Moves what is left to the front, where new bytes need the room.
bool MessageReader::fill() {
  if (begin_ > 0) {
    std::memmove(buffer_.data(), buffer_.data() + begin_, end_ - begin_);
    end_ -= begin_;
    begin_ = 0;
  }
  if (buffer_.size() - end_ < kChunk) buffer_.resize(std::max(2 * buffer_.size(), end_ + kChunk));
  const std::size_t got = source_.read(buffer_.data() + end_, buffer_.size() - end_);
  end_ += got;
  return got > 0;
}

bool MessageReader::line(std::string_view& text, std::size_t limit) {
  for (std::size_t searched = 0;;) {
    const char* const start = buffer_.data() + begin_;
    const std::size_t held = end_ - begin_;
    const void* const found = held > searched ? std::memchr(start + searched, '\n', held - searched) : nullptr;
    const std::size_t length = found ? static_cast<std::size_t>(static_cast<const char*>(found) - start) : held;
    if (length > limit)
      throw BadMessage("a line is longer than " + std::to_string(limit) +
                       " bytes: " + in_quotes({start, std::min<std::size_t>(length, 40)}));
    if (found) {
      text = {start, length};
      if (!text.empty() && text.back() == '\r') text.remove_suffix(1);
      begin_ += length + 1;
      return true;
    }
    searched = held;
    if (fill()) continue;
    if (held > 0) throw BadMessage("the last line has no end: " + in_quotes({buffer_.data() + begin_, held}));
    return false;
  }
}

void MessageReader::block(char* to, std::size_t size) {
  while (size > 0) {
    if (begin_ == end_ && !fill()) throw BadMessage(std::to_string(size) + " bytes are missing at the end");
    const std::size_t part = std::min(size, end_ - begin_);
    std::memcpy(to, buffer_.data() + begin_, part);
    begin_ += part;
    to += part;
    size -= part;
  }
}

void Words::fail(const std::string& what) const { throw BadMessage(what + " in the line " + in_quotes(line_, 80)); }

std::string_view Words::word() {
  while (!rest_.empty() && is_space(rest_.front())) rest_.remove_prefix(1);
  std::size_t size = 0;
  while (size < rest_.size() && !is_space(rest_[size])) ++size;
  if (size == 0) fail("a word is missing");
  const std::string_view word = rest_.substr(0, size);
  rest_.remove_prefix(size);
  return word;
}

double Words::real() {
  std::string_view text = word();
  double value = 0.0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size()) fail(in_quotes(text, 30) + " is no number");
  return value;
}

double Words::number(double limit) {
  const double value = real();
  if (!(std::abs(value) <= limit)) fail("a number is not finite or far too large");
  return value;
}

std::int64_t Words::whole(std::int64_t low, std::int64_t high) {
  const std::string_view text = word();
  std::int64_t value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  if (end.ec != std::errc() || end.ptr != text.data() + text.size()) fail(in_quotes(text, 30) + " is no whole number");
  if (value < low || value > high)
    fail(std::to_string(value) + " is not within " + std::to_string(low) + " to " + std::to_string(high));
  return value;
}

std::string_view Words::rest() {
  while (!rest_.empty() && is_space(rest_.front())) rest_.remove_prefix(1);
  const std::string_view all = rest_;
  rest_ = {};
  return all;
}

void Words::finish() {
  const std::string_view spare = rest();
  if (!spare.empty()) fail(in_quotes(spare, 30) + " is too much");
}

void append_number(std::string& text, double value) { append_real(text, value); }
void append_number(std::string& text, float value) { append_real(text, value); }
void append_number(std::string& text, std::int64_t value) { append_shortest(text, value); }

}  // namespace rubble::slam
