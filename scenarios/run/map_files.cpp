#include "scenarios/run/map_files.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/image/png.h"
#include "base/text/text_file.h"
#include "robot/logs/foreign/mrpt_bridge.h"
#include "scenarios/run/loop_picture.h"
#include "scenarios/run/run.h"
#include "scenarios/run/scan_picture.h"
#include "slam/map_exports.h"

namespace rubble::scenarios {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMapFile = "map.rmap";

std::string csv_of(const slam::ScanRecords& records, const slam::StampName& name) {
  std::string text = "stamp_s";
  for (const std::string& column : records.columns) text += "," + column;
  text += '\n';
  char number[40];
  for (std::size_t i = 0; i < records.stamps.size(); ++i) {
    text += stamp_text(name(records.stamps[i]));
    for (std::size_t k = 0; k < records.columns.size(); ++k) {
      std::snprintf(number, sizeof number, ",%.6g",
                    static_cast<double>(records.values[i * records.columns.size() + k]));
      text += number;
    }
    text += '\n';
  }
  return text;
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

/// Of several scans that hang on one key frame the first; nothing where they are not in the order of their time.
std::optional<Trajectory> way_of(std::vector<slam::MapScan>::const_iterator scan,
                                 std::vector<slam::MapScan>::const_iterator end) {
  Trajectory way;
  for (; scan != end; ++scan) {
    if (!way.empty() && scan->scan.stamp == way.back().stamp) continue;
    if (!way.empty() && scan->scan.stamp < way.back().stamp) return std::nullopt;
    way.push_back({scan->scan.stamp, scan->T_map_base});
  }
  return way;
}

/// Text of estimate.tum.
std::string way_text(const std::optional<Trajectory>& way) {
  if (!way) return "# no way: the two drives cover the same time\n";
  std::string text = "# key frames of both drives\n";
  for (const StampedPose& stamped : *way) text += tum_line(stamped) + '\n';
  return text;
}

}  // namespace

std::optional<Trajectory> merged_way(const std::vector<slam::MapScan>& both, std::size_t of_first) {
  const auto cut = both.begin() + static_cast<std::ptrdiff_t>(std::min(of_first, both.size()));
  std::optional<Trajectory> earlier = way_of(both.begin(), cut), later = way_of(cut, both.end());
  if (!earlier || !later) return std::nullopt;
  if (earlier->empty() || later->empty()) return earlier->empty() ? later : earlier;
  if (later->front().stamp < earlier->front().stamp) std::swap(earlier, later);
  if (later->front().stamp <= earlier->back().stamp) return std::nullopt;
  earlier->insert(earlier->end(), later->begin(), later->end());
  return earlier;
}

slam::StampName as_measured() {
  return [](Stamp stamp) { return stamp; };
}

void save_map_files(const RunFolder& folder, const slam::Mapper& mapper, const slam::StampName& name) {
  if (const std::string bytes = mapper.saved_map(); !bytes.empty()) folder.write(kMapFile, bytes);
  const slam::ScanRecords* records = mapper.scan_records();
  if (records == nullptr || records->stamps.empty()) return;
  folder.write("scans.csv", csv_of(*records, name));
  folder.write("scans.png", png_bytes(scan_picture(*records)));
  if (const std::string loops = mapper.loop_table(name); !loops.empty()) folder.write("loops.csv", loops);
  if (const auto loops = mapper.found_loops(); !loops.empty())
    folder.write("loops.png", png_bytes(loop_picture(mapper, loops)));
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
  folder.write("versions.json", versions().json(2) + "\n");
  folder.save_map(scenario, *mapper, {});
  const std::vector<slam::MapScan> scans = slam::content_of(*both).scans;
  const std::optional<Trajectory> way = merged_way(scans, content.scans.size());
  folder.write("estimate.tum", way_text(way));
  // Of a run alone: what would stand in them is nothing.
  for (const char* name : {"estimate_live.tum", "pois.csv", "victims.csv"}) fs::remove(folder.file(name));
  folder.close();
  MergeReport report = report_of(scans, content.scans.size());
  report.has_way = way.has_value();
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
