#include "robot/protocols/levelling_line.h"

#include <charconv>
#include <cstdio>

namespace rubble::robot {
namespace {

constexpr std::size_t kLongestLine = 200;  // the protocol's own limit is 80

unsigned sum_of(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<unsigned char>(c);
  return sum;
}

std::string hexadecimal(unsigned sum) {
  char text[4];
  std::snprintf(text, sizeof text, "%02X", sum & 0xFFu);
  return text;
}

std::vector<std::string> split(std::string_view body) {
  std::vector<std::string> fields(1);
  for (const char c : body) {
    if (c == ',') {
      fields.emplace_back();
    } else {
      fields.back() += c;
    }
  }
  return fields;
}

bool is_sum(std::string_view text, unsigned sum) {
  unsigned value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return text.size() == 2 && end.ec == std::errc() && end.ptr == text.data() + 2 && value == sum;
}

/// Takes numbers out of fields; one that is not whole or out of bounds makes all of it bad.
class Numbers {
 public:
  Numbers(const std::vector<std::string>& fields, std::size_t from) : fields_(fields), at_(from) {}
  long next(long low, long high) {
    const auto value = at_ < fields_.size() ? whole_number(fields_[at_], low, high) : std::nullopt;
    ++at_;
    good_ = good_ && value;
    return value.value_or(low);
  }
  int next_int(int low, int high) { return static_cast<int>(next(low, high)); }
  bool good() const { return good_; }

 private:
  const std::vector<std::string>& fields_;
  std::size_t at_;
  bool good_ = true;
};

}  // namespace

std::string levelling_line(std::string_view body) {
  return "$" + std::string(body) + "*" + hexadecimal(sum_of(body)) + "\r\n";
}

void LevellingLines::feed(std::string_view bytes) {
  waiting_.append(bytes);
  if (waiting_.size() > 64 * kLongestLine && waiting_.find('\n') == std::string::npos)
    waiting_.clear();  // not our device
}

std::optional<std::vector<std::string>> LevellingLines::next() {
  for (;;) {
    const auto end = waiting_.find('\n');
    if (end == std::string::npos) return std::nullopt;
    std::string line = waiting_.substr(0, end);
    waiting_.erase(0, end + 1);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (line.empty()) continue;
    // Half a line may stand before the dollar when a connection begins within one.
    const auto dollar = line.rfind('$');
    const auto star = line.rfind('*');
    if (dollar != std::string::npos && star != std::string::npos && star > dollar && line.size() <= kLongestLine) {
      const std::string_view body = std::string_view(line).substr(dollar + 1, star - dollar - 1);
      if (is_sum(std::string_view(line).substr(star + 1), sum_of(body))) return split(body);
    }
    ++bad_lines_;
  }
}

std::optional<long> whole_number(const std::string& text, long low, long high) {
  long value = 0;
  const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool good = end.ec == std::errc() && end.ptr == text.data() + text.size() && value >= low && value <= high;
  return good ? std::optional<long>(value) : std::nullopt;
}

std::string body(const LevellingIdentity& v) {
  char text[160];
  std::snprintf(text, sizeof text, "V,%.20s,%.20s,%d,%d,%d,%d,%d,%d", v.model.c_str(), v.sensor.c_str(), v.tick_hz,
                v.period_ticks, v.rate, v.us_min, v.us_max, v.watchdog_ms);
  return text;
}

std::optional<LevellingIdentity> parse_identity(const std::vector<std::string>& fields) {
  if (fields.size() < 9 || fields[0] != "V") return std::nullopt;
  LevellingIdentity v;
  v.model = fields[1];
  v.sensor = fields[2];
  Numbers numbers(fields, 3);
  v.tick_hz = numbers.next_int(1, 1000000000);
  v.period_ticks = numbers.next_int(1, 1000000000);
  v.rate = numbers.next_int(1, 10000);
  v.us_min = numbers.next_int(100, 10000);
  v.us_max = numbers.next_int(100, 10000);
  v.watchdog_ms = numbers.next_int(0, 1000000);
  if (!numbers.good() || v.us_min > v.us_max) return std::nullopt;
  return v;
}

std::string body(const LevellingReport& r) {
  char text[160];
  std::snprintf(text, sizeof text, "L,1,%d,%lu,%ld,%ld,%ld,%d,%d,%d", r.sequence, static_cast<unsigned long>(r.time_us),
                r.t1x, r.t1y, r.t2, r.pitch_us, r.roll_us, r.flags);
  return text;
}

std::optional<LevellingReport> parse_report(const std::vector<std::string>& fields) {
  if (fields.size() < 10 || fields[0] != "L" || fields[1] != "1") return std::nullopt;
  constexpr long kMost = 2000000000;
  LevellingReport r;
  Numbers numbers(fields, 2);
  r.sequence = numbers.next_int(0, 65535);
  r.time_us = static_cast<std::uint32_t>(numbers.next(0, 4294967295L));
  r.t1x = numbers.next(0, kMost);
  r.t1y = numbers.next(0, kMost);
  r.t2 = numbers.next(1, kMost);
  r.pitch_us = numbers.next_int(0, 10000);
  r.roll_us = numbers.next_int(0, 10000);
  r.flags = numbers.next_int(0, 65535);
  if (!numbers.good()) return std::nullopt;
  return r;
}

}  // namespace rubble::robot
