#include "scenarios/run/loop.h"

#include <sys/resource.h>

#include <algorithm>
#include <utility>

namespace rubble::scenarios {
namespace {

constexpr double kFirstSavePeriod = 0.4;    // [s]
constexpr double kLongestSavePeriod = 3.0;  // [s]
constexpr double kReportPeriod = 0.2;       // [s]

}  // namespace

Loop::Loop(const Scenario& scenario, RunFolder& folder, Core& core, LoopHooks hooks)
    : scenario_(scenario), folder_(folder), core_(core), hooks_(std::move(hooks)) {}

LoopEnd Loop::run(robot::Robot& robot) {
  LoopEnd end;
  bool has_mapper = true;
  try {
    drive(robot, end);
  } catch (const robot::DeviceLost& lost) {
    end.failure = end.reason = lost.what();
  } catch (const slam::MapperLost& lost) {
    end.failure = end.reason = lost.what();
    has_mapper = false;
  }
  if (hooks_.stop) hooks_.stop();
  try {
    if (has_mapper) core_.finish();
  } catch (const slam::MapperLost& lost) {
    end.failure = end.reason = lost.what();
  }
  if (hooks_.each_second) hooks_.each_second(end.sim_s);
  save_now();
  return end;
}

void Loop::drive(robot::Robot& robot, LoopEnd& end) {
  Stamp first = Stamp::never(), saved = Stamp::never();
  while (auto inputs = robot.read()) {
    const robot::Commands wanted = core_.step(*inputs);
    tell_decisions();
    robot.command(hooks_.steer ? hooks_.steer(*inputs, wanted) : wanted);
    if (first == Stamp::never()) first = saved = inputs->now;
    end.sim_s = inputs->now - first + robot.model().tick;
    if (inputs->now - saved >= 1.0) {
      saved = inputs->now;
      save(end.sim_s);
    }
    if (const std::string why = hooks_.over ? hooks_.over() : std::string(); !why.empty()) {
      end.reason = why;
      return;
    }
    if (core_.finished()) {
      end.reason = core_.reason();
      return;
    }
    if (hooks_.interrupted && hooks_.interrupted()) {
      end.interrupted = true;
      end.reason = "interrupted";
      return;
    }
  }
  end.robot_ended = true;
  end.reason = "the robot's time is over";
}

void Loop::tell_decisions() {
  if (hooks_.waits && !told_waits_ && core_.waits()) {
    told_waits_ = true;
    hooks_.waits(*core_.waits());
  }
  if (!hooks_.decided || core_.explorer() == nullptr) return;
  const std::vector<explore::Decision>& all = core_.explorer()->decisions();
  for (; told_ < all.size(); ++told_) hooks_.decided(all[told_]);
}

void Loop::save(double sim_s) {
  folder_.append_estimate(core_.mapper());
  if (hooks_.each_second) hooks_.each_second(sim_s);
  if (seconds_since(last_save_) >= save_period_) {
    save_now();
    last_save_ = Clock::now();
    save_period_ = std::min(kLongestSavePeriod, 2.0 * save_period_ + kFirstSavePeriod);
  }
  if (hooks_.progress && seconds_since(last_report_) > kReportPeriod) {
    last_report_ = Clock::now();
    hooks_.progress(
        {sim_s, hooks_.share ? hooks_.share() : 0.0, known_area(core_.mapper().map()), sim_s / seconds_since(start_)});
  }
}

void Loop::save_now() {
  folder_.save_estimate(core_.mapper());
  folder_.save_map(scenario_, core_.mapper(), core_.victims(), [this](const mrpt::math::TPoint2D& place) {
    return core_.explorer() != nullptr && core_.explorer()->searched(place);
  });
}

double Loop::seconds_since(Clock::time_point then) const {
  return std::chrono::duration<double>(Clock::now() - then).count();
}

scoring::RunFigures run_figures(const Core& core, double sim_s, const std::string& reason) {
  const slam::Mapper& mapper = core.mapper();
  scoring::RunFigures out;
  out.end = reason;
  out.sim_s = sim_s;
  out.area_known_m2 = known_area(mapper.map());
  out.scans = mapper.counts().scans;
  out.scans_mapped = mapper.counts().mapped;
  out.scans_out_of_order = mapper.counts().out_of_order;
  out.hits_outside = mapper.map().dropped_hits();
  for (const slam::MapperFigure& figure : mapper.figures()) out.own.emplace_back(figure.key, figure.value);
  return out;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double peak_megabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace rubble::scenarios
