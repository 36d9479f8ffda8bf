#include "scenarios/run/map_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/image/legend.h"
#include "base/image/png.h"
#include "base/round_step.h"
#include "base/text/text_file.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "slam/map_exports.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMapFile = "map.rmap";
constexpr int kWidth = 1000;  ///< of the picture's curves [pixels]
constexpr int kLeft = 230;    ///< for their names and values
constexpr int kTop = 10;
constexpr int kPanel = 60;  ///< height of one
constexpr int kGap = 12;    ///< between two
constexpr int kFoot = 50;   ///< for the times and a line of words

std::string csv_of(const slam::ScanRecords& records) {
  std::string text = "stamp_s";
  for (const std::string& column : records.columns) text += "," + column;
  text += '\n';
  char number[40];
  for (std::size_t i = 0; i < records.stamps.size(); ++i) {
    std::snprintf(number, sizeof number, "%lld.%09lld", static_cast<long long>(records.stamps[i].ns / 1000000000),
                  static_cast<long long>(records.stamps[i].ns % 1000000000));
    text += number;
    for (std::size_t k = 0; k < records.columns.size(); ++k) {
      std::snprintf(number, sizeof number, ",%.6g",
                    static_cast<double>(records.values[i * records.columns.size() + k]));
      text += number;
    }
    text += '\n';
  }
  return text;
}

/// Least and greatest value of each column of pixels, or nothing where no scan fell.
struct Curve {
  std::vector<std::pair<float, float>> spans;
  float low = 0.0F;
  float high = 0.0F;
};

Curve curve_of(const slam::ScanRecords& records, std::size_t column) {
  Curve curve;
  curve.spans.assign(kWidth, {1.0F, 0.0F});
  const Stamp first = records.stamps.front();
  const double time = std::max(1e-9, records.stamps.back() - first);
  for (std::size_t i = 0; i < records.stamps.size(); ++i) {
    const float value = records.values[i * records.columns.size() + column];
    if (!std::isfinite(value)) continue;
    const auto at = static_cast<std::size_t>((records.stamps[i] - first) / time * (kWidth - 1));
    auto& [least, most] = curve.spans[std::min<std::size_t>(at, kWidth - 1)];
    const bool fresh = least > most;
    least = fresh ? value : std::min(least, value);
    most = fresh ? value : std::max(most, value);
    curve.low = std::min(curve.low, value);
    curve.high = std::max(curve.high, value);
  }
  if (curve.high <= curve.low) curve.high = curve.low + 1.0F;
  return curve;
}

/// A scale of seconds below the panels, with a faint line up through them at each number.
void draw_times(cv::Mat& picture, double seconds, int bottom) {
  constexpr int kApart = 80, kTick = 5;  // [pixels]
  const double pixels = (kWidth - 1) / seconds;
  const double step = round_step(kApart / pixels);
  for (int k = 0; k * step <= seconds; ++k) {
    const int x = kLeft + static_cast<int>(std::lround(k * step * pixels));
    cv::line(picture, {x, kTop}, {x, bottom}, cv::Scalar(235, 235, 235));
    cv::line(picture, {x, bottom}, {x, bottom + kTick}, cv::Scalar(kInkBgr[0], kInkBgr[1], kInkBgr[2]));
    const std::string words = cv::format("%.6g", k * step);
    draw_text(picture, words, x - text_width(words) / 2, bottom + kTick + 13);
  }
  draw_text(picture, "time [s]", kLeft - 16 - text_width("time [s]"), bottom + kTick + 13);
}

/// One panel a column, time to the right, from the least to the greatest value (zero always in sight).
cv::Mat picture_of(const slam::ScanRecords& records) {
  const auto panels = static_cast<int>(records.columns.size());
  const int bottom = kTop + panels * (kPanel + kGap);
  cv::Mat picture(bottom + kFoot, kLeft + kWidth + 20, CV_8UC3, cv::Scalar(255, 255, 255));
  draw_times(picture, std::max(1e-9, records.stamps.back() - records.stamps.front()), bottom);
  for (int p = 0; p < panels; ++p) {
    const Curve curve = curve_of(records, static_cast<std::size_t>(p));
    const int top = kTop + p * (kPanel + kGap);
    const auto row = [&](float value) {
      return top + kPanel - 1 - static_cast<int>((value - curve.low) / (curve.high - curve.low) * (kPanel - 1));
    };
    cv::rectangle(picture, {kLeft, top}, {kLeft + kWidth, top + kPanel}, cv::Scalar(225, 225, 225));
    draw_text(picture, records.columns[static_cast<std::size_t>(p)], 8, top + kPanel / 2 + 4);
    const auto write_value = [&](float value, int y) {
      const std::string words = cv::format("%.4g", static_cast<double>(value));
      draw_text(picture, words, kLeft - 5 - text_width(words), y);
    };
    write_value(curve.high, top + 9);
    write_value(curve.low, top + kPanel);
    int last = -1;
    for (int x = 0; x < kWidth; ++x) {
      const auto& [least, most] = curve.spans[static_cast<std::size_t>(x)];
      if (least > most) continue;
      const int above = row(most);
      const int below = row(least);
      cv::line(picture, {kLeft + x, last < 0 ? below : std::max(last, below)}, {kLeft + x, above},
               cv::Scalar(178, 114, 0));
      last = above;
    }
  }
  draw_text(picture,
            cv::format("%zu scans; each panel from the least to the greatest value of scans.csv, zero always in sight; "
                       "key_frames, loops_*, near_edges: counts so far",
                       records.stamps.size()),
            8, picture.rows - 10);
  return picture;
}

void write_simplemap(const slam::MapContent& map, const std::string& out) {
  std::vector<robot::PosedScan> scans;
  for (const slam::MapScan& kept : map.scans) scans.push_back({kept.scan, kept.T_map_base});
  robot::write_simplemap(out, scans, map.T_base_laser);
}

/// Each cause has its own remedy.
void require_whole(slam::MergeEnd end, const std::string& first, const std::string& second) {
  switch (end) {
    case slam::MergeEnd::Whole:
      return;
    case slam::MergeEnd::OtherMount:
      throw InputError(second + ": was made with the laser mounted otherwise than for " + first +
                       "; merge maps of robots whose lasers are mounted alike");
    case slam::MergeEnd::NoPlace:
      throw InputError(second + ": shows no place of " + first +
                       " for sure: they have too little in common; map on until both saw the same few metres of way");
    case slam::MergeEnd::SeenThrough:
      throw InputError(second + ": is of another arena than " + first +
                       ": places look alike, but walls of one stand where the other looked through; merge maps of one "
                       "arena");
  }
}

/// `both`: one map of two, with the first one's `of_first` scans before those of the second.
MergeReport report_of(const std::vector<slam::MapScan>& both, std::size_t of_first) {
  constexpr double kTogether = 1.0;  // [m]
  constexpr double kOneDrive = 2.0;  // scans farther from each other are of two drives [m]
  MergeReport report;
  if (both.size() <= of_first) return report;
  report.T_first_start = both[of_first].T_map_base;
  const auto apart = [&](std::size_t a, std::size_t b) {
    return std::hypot(both[a].T_map_base.x - both[b].T_map_base.x, both[a].T_map_base.y - both[b].T_map_base.y);
  };
  bool was_near = false;
  for (std::size_t i = of_first; i < both.size(); ++i) {
    bool near = false;
    for (std::size_t k = 0; k < of_first && !near; ++k) near = apart(i, k) <= kTogether;
    if (const double step = i > of_first ? apart(i - 1, i) : 0.0; step <= kOneDrive) {
      report.second_m += step;
      if (near && was_near) report.common_m += step;
    }
    was_near = near;
  }
  return report;
}

}  // namespace

void save_map_files(const RunFolder& folder, const slam::Mapper& mapper) {
  if (const std::string bytes = mapper.saved_map(); !bytes.empty()) folder.write(kMapFile, bytes);
  const slam::ScanRecords* records = mapper.scan_records();
  if (records == nullptr || records->stamps.empty()) return;
  folder.write("scans.csv", csv_of(*records));
  folder.write("scans.png", png_bytes(picture_of(*records)));
}

std::shared_ptr<const slam::MapBase> load_map_base(const std::string& path, bool grows,
                                                   const std::optional<mrpt::math::TPose2D>& start) {
  std::string file = path;
  if (fs::is_directory(path)) {
    file = path + "/" + kMapFile;
    if (!fs::exists(file))
      throw InputError(path + ": holds no " + kMapFile +
                       "; give the folder of a run of the robust mapper that has ended, or a map file");
  }
  auto base = std::make_shared<slam::MapBase>();
  base->bytes = read_text_file(file);
  base->name = file;
  base->grows = grows;
  base->start = start;
  return base;
}

MergeReport merge_maps(const std::string& first, const std::string& second, const Scenario& scenario,
                       const std::string& out, bool replace, const slam::MergeProgress& progress) {
  if (scenario.mapper.kind() != "robust")
    throw InputError("mapper.kind '" + scenario.mapper.kind() + "': only maps of the robust mapper are merged");
  const auto a = load_map_base(first, true, std::nullopt);
  const auto b = load_map_base(second, true, std::nullopt);
  if (replace && fs::is_directory(out) && !fs::is_empty(out)) files_of_run(out);  // told before the work
  const slam::MapContent content = slam::content_of(*a);
  robot::RobotModel model = scenario.robot;
  model.T_base_laser = content.T_base_laser;
  if (!content.scans.empty()) model.laser.range_max = content.scans.front().scan.range_max;
  const slam::MergedBytes merged = slam::merged_maps(*a, *b, model, scenario.mapper, progress);
  require_whole(merged.end, first, second);
  if (progress) progress("draws the map", 0.0);
  const auto both = std::make_shared<slam::MapBase>(slam::MapBase{merged.bytes, first, true, std::nullopt});
  const auto mapper = scenario.mapper.make(model, {scenario.seed, "", both});
  mapper->finish();
  RunFolder folder(out, replace);  // not before the work is done: it may take the place of an older one
  folder.write("scenario.yaml", resolved_yaml(scenario));
  folder.write(kMapFile, merged.bytes);
  folder.save_map(scenario, *mapper, {});
  folder.close();
  MergeReport report = report_of(slam::content_of(*both).scans, content.scans.size());
  report.same = a->bytes == b->bytes;
  return report;
}

bool is_map_export(const std::string& out) {
  const std::string ending = fs::path(out).extension().string();
  return ending == ".g2o" || ending == ".simplemap";
}

void export_map(const std::string& path, const std::string& out) {
  const auto map = load_map_base(path, true, std::nullopt);
  const std::string ending = fs::path(out).extension().string();
  if (ending == ".g2o")
    write_text_file(out, slam::graph_as_g2o(*map));
  else if (ending == ".simplemap")
    write_simplemap(slam::content_of(*map), out);
  else
    throw InputError(out + ": maps are exported as .g2o or .simplemap");
}

}  // namespace rubble::scenarios
