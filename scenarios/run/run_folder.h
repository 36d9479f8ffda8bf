#pragma once

#include <mrpt/math/TPoint2D.h>

#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/trajectory.h"
#include "explore/victim_report.h"
#include "scenarios/config/scenario.h"
#include "scenarios/run/folder_lock.h"
#include "scoring/maps/league_map.h"
#include "slam/mapper.h"

namespace rubble::scenarios {

/// A mapper's map as the league's drawing asks for it; refers to `map`.
scoring::LeagueCells league_cells(const slam::CountMap& map);

/// One run's folder, written as the run goes: after a kill it holds all but the last second of the trajectories and the
/// last saved map. The trajectories grow line by line; all other files are replaced whole (written beside, then
/// renamed), so none of them is ever half a file. estimate_live.tum only grows; estimate.tum is replaced whole when the
/// mapper has moved poses of the past.
class RunFolder {
 public:
  /// Creates the folder and keeps other commands out of it. An existing one with content is refused unless `replace` is
  /// set and it is a run folder: all of its files have names that rubble gives (run_folder_names()), and none of them
  /// was read by this process. So what is read for a run is read before. Throws InputError (cannot be created, not
  /// empty). What it takes the place of waits in its `.replaced` until close() and is put back when this ends before
  /// that; after a kill it is still there. A new folder in which no scan was mapped before this ends without close()
  /// goes again: the command was refused, and is given once more when it is mended. `remedy`: what the user may do
  /// about a folder that is not empty.
  RunFolder(const std::string& path, bool replace,
            const std::string& remedy = "give another folder with --out, or --force to replace it");

  ~RunFolder();
  RunFolder(const RunFolder&) = delete;
  RunFolder& operator=(const RunFolder&) = delete;

  const std::string& path() const { return path_; }
  std::string file(const std::string& name) const { return path_ + "/" + name; }

  /// Replaces a text file.
  void write(const std::string& name, const std::string& content) const;
  /// Appends poses the files do not hold yet.
  void append_truth(const Trajectory& truth);
  /// Both trajectories of the mapper. Where its revision has changed, estimate.tum waits for save_estimate().
  void append_estimate(const slam::Mapper& mapper);
  /// Lets estimate.tum hold the trajectory as known now.
  void save_estimate(const slam::Mapper& mapper);
  /// Replaces map.tif, map.tfw, map.png, map.pgm, map.yaml, pois.csv and victims.csv. `searched`: what was searched for
  /// victims (LeagueDrawing).
  void save_map(const Scenario& scenario, const slam::Mapper& mapper, const std::vector<explore::VictimReport>& victims,
                const std::function<bool(const mrpt::math::TPoint2D&)>& searched = {}) const;
  /// Lets `write` make files of these names below the folder it is given (which ends in a slash), then puts them all in
  /// their places at once.
  void publish(const std::vector<std::string>& names, const std::function<void(const std::string&)>& write) const;
  /// Writes truth.tif, truth.png and arena.png.
  void save_truth(const arenas::Arena& arena, const OccupancyGrid& truth) const;
  /// hashes.json: SHA-256 of each deterministic artefact that exists, plus `score` over the given text.
  void save_hashes(const std::string& score_text) const;
  /// Nothing is written any more. What this took the place of goes, but for `whole` false: the run ended early.
  void close(bool whole = true);
  /// What is written cannot be made again: it stays too when this ends before close().
  void keep_unfinished() { keeps_unfinished_ = true; }
  /// Lets `latest` in `runs` point to this folder of it, where links can be made: whoever reads it meanwhile finds the
  /// run before or this one. A run whose mapper placed no scan is nothing to go on with and leaves the link as it is.
  void link_latest(const slam::Mapper& mapper) const;

 private:
  /// A trajectory that grows on disk.
  struct Growing {
    std::ofstream file;
    std::size_t written = 0;  ///< poses
  };
  void append(Growing& growing, const Trajectory& trajectory);
  void set_aside(const std::vector<std::string>& old) const;
  void put_back() noexcept;
  void clear_away() noexcept;

  std::string path_;
  std::optional<FolderLock> lock_;  ///< two that replace one run would take away each other's files
  Growing truth_;
  Growing estimate_;
  Growing live_;
  std::uint64_t revision_ = 0;  ///< of the mapper, that estimate.tum shows
  bool replaces_ = false;       ///< and did not end yet
  bool keeps_unfinished_ = false;
  bool made_ = false;   ///< the folder was not there before
  bool begun_ = false;  ///< there are poses
  bool closed_ = false;
};

/// `parent/name-seedN-001` with the first free number.
std::string next_run_folder(const std::string& parent, const std::string& name, std::uint64_t seed);

/// The names of all files that rubble writes into run folders, and nobody else's: these are what --force removes.
const std::vector<std::string>& run_folder_names();

/// What a run left in `path`, in an order in which it can be removed. Throws InputError where the folder holds anything
/// else, or what this process has read: then nothing may be removed.
std::vector<std::string> files_of_run(const std::string& path);

/// The artefacts that must be the same on every run of one seed.
const std::vector<std::string>& deterministic_artefacts();

}  // namespace rubble::scenarios
