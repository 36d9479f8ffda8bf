#include "robot/drivers/scip/scip_reply.h"

#include <algorithm>
#include <cstdio>

#include "base/angle.h"
#include "base/text/words.h"
#include "robot/drivers/scip/scip_text.h"

namespace rubble::robot::scip {
namespace {

constexpr int kUrgStepsPerTurn = 1024, kUrgFrontStep = 384;

std::optional<std::pair<std::string, std::string>> entry(std::string_view text) {
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return std::nullopt;
  return std::make_pair(std::string(text.substr(0, colon)), std::string(text.substr(colon + 1)));
}

bool makes_sense(const Geometry& g) {
  return g.steps_per_turn >= 8 && g.steps_per_turn <= 100000 && g.first_step >= 0 && g.last_step > g.first_step &&
         g.last_step < 4 * g.steps_per_turn && g.front_step >= 0 && g.front_step <= g.last_step &&
         g.last_step <= 9999 && g.least_mm >= 0 && g.most_mm > g.least_mm && g.turns_per_minute > 0;
}

/// The lines from the third on, put together and, if `sums`, each checked.
std::optional<std::string> data_of(const Reply& reply, std::size_t first_line, bool sums) {
  std::string data;
  for (std::size_t i = first_line; i < reply.lines.size(); ++i) {
    const std::string& line = reply.lines[i];
    const auto text = sums ? checked(line) : std::optional<std::string_view>(line);
    const bool is_last = i + 1 == reply.lines.size();
    if (!text || text->size() > kDataLine || (text->size() < kDataLine && !is_last)) return std::nullopt;
    data += *text;
  }
  return data;
}

std::optional<std::vector<std::uint32_t>> values_of(const std::string& data, std::size_t count,
                                                    std::size_t characters) {
  if (data.size() != count * characters) return std::nullopt;
  std::vector<std::uint32_t> values(count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto value = decode(std::string_view(data).substr(i * characters, characters));
    if (!value) return std::nullopt;
    values[i] = *value;
  }
  return values;
}

}  // namespace

double Geometry::step_angle() const { return 2.0 * kPi / steps_per_turn; }
double Geometry::period() const { return 60.0 / turns_per_minute; }
double Geometry::step_time() const { return period() / steps_per_turn; }
double Geometry::after_sweep() const { return last_step * step_time(); }

std::optional<std::string> status_of(const Reply& reply) {
  if (reply.lines.size() < 2) return std::nullopt;
  const std::string& line = reply.lines[1];
  if (line.size() == 1) return line;
  if (line.size() != 3) return std::nullopt;
  const auto text = checked(line);
  return text ? std::optional<std::string>(std::string(*text)) : std::nullopt;
}

std::optional<Entries> entries_of(const Reply& reply, bool sums) {
  Entries entries;
  for (std::size_t i = 2; i < reply.lines.size(); ++i) {
    const auto text = sums ? checked_entry(reply.lines[i]) : std::optional<std::string_view>(reply.lines[i]);
    const auto parts = text ? entry(*text) : std::nullopt;
    if (!parts) return std::nullopt;
    entries.emplace_back(one_line(parts->first), one_line(parts->second));  // they come onto the terminal
  }
  return entries;
}

std::optional<Geometry> geometry_of(const Entries& entries) {
  Geometry g;
  const std::vector<std::pair<const char*, int*>> wanted = {
      {"ARES", &g.steps_per_turn}, {"AMIN", &g.first_step}, {"AMAX", &g.last_step},       {"AFRT", &g.front_step},
      {"DMIN", &g.least_mm},       {"DMAX", &g.most_mm},    {"SCAN", &g.turns_per_minute}};
  for (const auto& [key, value] : wanted) {
    const std::string name = key;
    const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto& e) { return e.first == name; });
    const auto read = found == entries.end() ? std::nullopt : number(found->second);
    if (!read) return std::nullopt;
    *value = *read;
  }
  return makes_sense(g) ? std::optional<Geometry>(g) : std::nullopt;
}

std::optional<Geometry> geometry_of_firmware(const std::string& firmware) {
  const std::size_t bracket = firmware.find('(');
  if (bracket == std::string::npos) return std::nullopt;
  Geometry g;
  g.steps_per_turn = kUrgStepsPerTurn;
  g.front_step = kUrgFrontStep;
  int degrees = 0;
  const int fields = std::sscanf(firmware.c_str() + bracket, "(%6d-%6d[mm],%6d[deg],%6d-%6d[step],%6d[rpm])",
                                 &g.least_mm, &g.most_mm, &degrees, &g.first_step, &g.last_step, &g.turns_per_minute);
  return fields == 6 && makes_sense(g) && g.last_step <= 999 ? std::optional<Geometry>(g) : std::nullopt;
}

LaserModel laser_of(const Geometry& geometry, const std::string& name) {
  LaserModel laser;
  laser.name = name;
  laser.beams = static_cast<int>(geometry.steps());
  laser.angle_step = geometry.step_angle();
  laser.angle_min = (geometry.first_step - geometry.front_step) * geometry.step_angle();
  laser.range_min = 0.001 * geometry.least_mm;
  laser.range_max = 0.001 * geometry.most_mm;
  laser.scan_period = geometry.period();
  laser.beam_period = geometry.step_time();
  return laser;
}

std::optional<Sweep> sweep_of(const Reply& reply, std::size_t count) {
  if (reply.lines.size() < 3) return std::nullopt;
  const auto time = checked(reply.lines[2]);
  const auto clock = time && time->size() == 4 ? decode(*time) : std::nullopt;
  const auto data = data_of(reply, 3, true);
  if (!clock || !data) return std::nullopt;
  auto values = values_of(*data, count, 3);
  if (!values) return std::nullopt;
  return Sweep{*clock, std::move(*values)};
}

std::optional<Sweep> old_sweep_of(const Reply& reply, std::size_t count) {
  const auto data = data_of(reply, 2, false);
  if (!data) return std::nullopt;
  auto values = values_of(*data, count, 2);
  if (!values) return std::nullopt;
  return Sweep{0, std::move(*values)};
}

}  // namespace rubble::robot::scip
