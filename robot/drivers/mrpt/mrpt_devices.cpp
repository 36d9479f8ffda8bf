// The module with MRPT's drivers: the only place that knows mrpt-hwdrivers.
#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/hwdrivers/C2DRangeFinderAbstract.h>
#include <mrpt/hwdrivers/CHokuyoURG.h>
#include <mrpt/hwdrivers/registerAllClasses.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/system/datetime.h>

#include <chrono>
#include <cmath>
#include <condition_variable>
#include <mutex>
#include <optional>
#include <thread>

#include "base/angle.h"
#include "base/error.h"
#include "robot/drivers/clock_map.h"
#include "robot/drivers/mrpt_module.h"
#include "robot/drivers/scan_queue.h"

namespace rubble::robot {
namespace {

using mrpt::hwdrivers::C2DRangeFinderAbstract;
using mrpt::hwdrivers::CGenericSensor;
using mrpt::hwdrivers::CHokuyoURG;
using mrpt::obs::CObservation2DRangeScan;

constexpr const char* kSection = "SCANNER";
constexpr double kOverdue = 0.25;  // without a scan for so long a device may be gone [s]
constexpr double kJump = 1.0;      // MRPT's stamps leap so far when the device's clock wraps or restarts [s]

/// MRPT keeps what the device said of its geometry to itself.
class Hokuyo : public CHokuyoURG {
 public:
  const TSensorInfo& told() const { return m_sensor_info; }
  /// Its destructor says goodbye to the device, which over a TCP connection that the other side closed never returns.
  void forget_line() { m_stream.reset(); }
};

std::unique_ptr<C2DRangeFinderAbstract> make_sensor(const std::string& type) {
  if (type == "CHokuyoURG") return std::make_unique<Hokuyo>();
  std::unique_ptr<CGenericSensor> sensor(CGenericSensor::createSensor(type));
  auto* scanner = dynamic_cast<C2DRangeFinderAbstract*>(sensor.get());
  if (scanner == nullptr) return nullptr;
  sensor.release();
  return std::unique_ptr<C2DRangeFinderAbstract>(scanner);
}

Stamp stamp_of(const mrpt::system::TTimeStamp& time) { return Stamp::from_seconds(mrpt::Clock::toDouble(time)); }

class MrptScanner : public Scanner {
 public:
  MrptScanner(const MrptScannerConfig& config, Stamp (*now)()) : config_(config), now_(now) {
    thread_ = std::thread([this] { run(); });
  }
  ~MrptScanner() override {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ending_ = true;
    }
    ended_.notify_all();
    thread_.join();
  }

  std::vector<LaserScan> take() override { return queue_.take(); }
  ScannerStatus status() const override { return queue_.status(); }
  ScannerInfo info() const override { return queue_.info(); }
  int descriptor() const override { return queue_.descriptor(); }

 private:
  std::string name() const { return config_.port.empty() ? config_.type : config_.port; }

  /// MRPT's messages run over many lines, the one that counts starts with `Message:`, below lies a stack.
  std::string one_line(std::string text) const {
    static const std::string mark = "Message:";
    const std::size_t found = text.find(mark);
    if (found != std::string::npos) text = text.substr(text.find_first_not_of(' ', found + mark.size()));
    text = text.substr(0, text.find('\n'));
    return text.rfind(name() + ":", 0) == 0 ? text : name() + ": " + text;
  }

  bool pause(double seconds) {
    std::unique_lock<std::mutex> lock(mutex_);
    return !ended_.wait_for(lock, std::chrono::duration<double>(seconds), [this] { return ending_; });
  }

  void run() {
    while (pause(0.0)) {
      try {
        converse();
      } catch (const std::exception& error) {
        const std::string what = one_line(error.what());
        queue_.update([&](ScannerStatus& status) {
          status.connected = false;
          status.error = what;
        });
        pause(config_.retry);
      }
    }
  }

  void converse() {
    const auto sensor = make_sensor(config_.type);
    sensor->logging_enable_console_output = false;
    sensor->setMinLoggingLevel(mrpt::system::LVL_ERROR);
    mrpt::config::CConfigFileMemory settings;
    settings.write(kSection, "process_rate", 200);
    settings.write(kSection, "sensorLabel", "LASER");
    for (const auto& [key, value] : config_.parameters) settings.write(kSection, key, value);
    sensor->loadConfig(settings, kSection);
    last_arrival_ = now_();
    try {
      sensor->initialize();
      listen(*sensor);
    } catch (...) {
      forget_line(*sensor);
      throw;
    }
    if (now_() - last_arrival_ > kOverdue) forget_line(*sensor);
  }

  static void forget_line(C2DRangeFinderAbstract& sensor) {
    if (auto* hokuyo = dynamic_cast<Hokuyo*>(&sensor)) hokuyo->forget_line();
  }

  /// Until the driver ends; throws when the device is gone.
  void listen(C2DRangeFinderAbstract& sensor) {
    bool first = true;
    last_arrival_ = now_();
    while (pause(0.001)) {
      sensor.doProcess();
      for (const auto& [time, object] : sensor.getObservations()) {
        const auto scan = std::dynamic_pointer_cast<CObservation2DRangeScan>(object);
        if (!scan) continue;
        if (std::exchange(first, false)) greet(sensor, *scan);
        deliver(sensor, *scan);
      }
      if (sensor.getState() == CGenericSensor::ssError || now_() - last_arrival_ > config_.silence)
        throw RunError(name() + ": the scanner is silent; it is started anew, check its cable and power");
    }
  }

  void greet(const C2DRangeFinderAbstract& sensor, const CObservation2DRangeScan& scan) {
    map_.reset();
    ScannerInfo info;
    info.protocol = "MRPT " + config_.type;
    info.model = config_.type;
    if (const auto* hokuyo = dynamic_cast<const Hokuyo*>(&sensor)) {
      info.model = hokuyo->told().model;
      info.laser.scan_period = 60.0 / hokuyo->told().motor_speed_rpm;
    } else {
      info.laser.scan_period = config_.scan_period;
    }
    LaserScan frame;
    set_bearings(sensor, scan, frame);
    info.laser.name = info.model;
    info.laser.beams = static_cast<int>(scan.getScanSize());
    info.laser.angle_min = frame.angle_min;
    info.laser.angle_step = frame.angle_step;
    info.laser.range_max = static_cast<double>(scan.maxRange);
    info.laser.beam_period = info.laser.scan_period * frame.angle_step / (2.0 * kPi);
    period_ = info.laser.scan_period;
    queue_.set_info(info);
    queue_.update([](ScannerStatus& status) {
      status.connected = true;
      status.error.clear();
      status.worst_latency = 0.0;
      ++status.connects;
    });
  }

  /// MRPT gives the aperture as N steps where N beams span N - 1, and puts its middle in front where step AFRT is.
  static void set_bearings(const C2DRangeFinderAbstract& sensor, const CObservation2DRangeScan& scan, LaserScan& to) {
    const auto beams = static_cast<double>(scan.getScanSize());
    if (const auto* hokuyo = dynamic_cast<const Hokuyo*>(&sensor)) {
      const auto& told = hokuyo->told();
      to.angle_step = 2.0 * kPi / told.scans_per_360deg;
      to.angle_min = (told.scan_first - told.scan_front) * to.angle_step;
      return;
    }
    to.angle_step = static_cast<double>(scan.aperture) / (beams - 1.0);
    to.angle_min = -0.5 * static_cast<double>(scan.aperture) + scan.sensorPose.yaw();
  }

  /// Time from the stamped moment, step 0 of the turn, to the last beam.
  double until_last_beam(const C2DRangeFinderAbstract& sensor, std::size_t beams) const {
    const auto* hokuyo = dynamic_cast<const Hokuyo*>(&sensor);
    // The device sends when step 768 of 1024 is passed, a while after the last one that measures.
    return hokuyo != nullptr ? 0.75 * period_ : static_cast<double>(beams) * queue_.info().laser.beam_period;
  }

  void deliver(const C2DRangeFinderAbstract& sensor, const CObservation2DRangeScan& from) {
    const Stamp arrived = now_(), told = stamp_of(from.timestamp);
    LaserScan scan;
    set_bearings(sensor, from, scan);
    const std::size_t beams = from.getScanSize();
    // MRPT stamps a turn with the device's time plus a constant, which is the arrival of an early one.
    const bool leapt = map_ && std::abs((told - last_told_) - (arrived - last_arrival_)) > kJump;
    if (!map_ || leapt) {
      ClockMapConfig clock;
      clock.usual_delay = until_last_beam(sensor, beams) + config_.delivery;
      map_.emplace(clock);
      first_told_ = told;
    }
    const double device = told - first_told_;
    map_->add(device, arrived);
    scan.beam_period = queue_.info().laser.beam_period;
    scan.stamp = map_->host(device);
    if (const auto* hokuyo = dynamic_cast<const Hokuyo*>(&sensor))
      scan.stamp = scan.stamp + hokuyo->told().scan_first * scan.beam_period;
    scan.range_max = std::min(config_.range_max, static_cast<double>(from.maxRange));
    if (const auto* hokuyo = dynamic_cast<const Hokuyo*>(&sensor)) scan.range_min = hokuyo->told().d_min;
    set_ranges(from, scan);
    const double latency = arrived - scan.beam_stamp(beams);
    last_told_ = told;
    last_arrival_ = arrived;
    queue_.update([&](ScannerStatus& status) {
      ++status.scans;
      status.latency = latency;
      status.worst_latency = std::max(status.worst_latency, latency);
      status.clock_drift = map_->drift();
    });
    queue_.put(std::move(scan), now_());
  }

  void set_ranges(const CObservation2DRangeScan& from, LaserScan& to) const {
    const std::size_t beams = from.getScanSize();
    to.ranges.resize(beams);
    for (std::size_t i = 0; i < beams; ++i) {
      const std::size_t source = from.rightToLeft ? i : beams - 1 - i;
      const float range = from.getScanRange(source);
      float& out = to.ranges[i];
      if (!from.getScanRangeValidity(source)) {
        out = config_.no_echo_is_miss ? LaserScan::kMiss : LaserScan::kUnknown;
      } else {
        out = static_cast<double>(range) > to.range_max ? LaserScan::kMiss : range;
      }
    }
  }

  MrptScannerConfig config_;
  Stamp (*now_)();
  ScanQueue queue_;
  std::optional<ClockMap> map_;
  Stamp first_told_, last_told_, last_arrival_;
  double period_ = 0.1;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool ending_ = false;
  std::thread thread_;
};

Scanner* make(const MrptScannerConfig& config, Stamp (*now)(), std::string& trouble) {
  mrpt::hwdrivers::registerAllClasses_mrpt_hwdrivers();
  if (!make_sensor(config.type)) {
    trouble = "scanner type '" + config.type +
              "': MRPT has no such scanner; give CHokuyoURG, CSickLaserSerial, CSickLaserUSB, CLMS100Eth, "
              "CSICKTim561Eth or CRoboPeakLidar";
    return nullptr;
  }
  for (const auto& [key, value] : config.parameters)
    if (config.type == "CHokuyoURG" && key == "reduced_fov") {
      trouble = "scanner type 'CHokuyoURG': 'reduced_fov' would leave the bearings unknown; take it out";
      return nullptr;
    }
  return new MrptScanner(config, now);
}

}  // namespace
}  // namespace rubble::robot

extern "C" __attribute__((visibility("default"))) rubble::robot::Scanner* rubble_make_mrpt_scanner(
    const rubble::robot::MrptScannerConfig& config, rubble::Stamp (*now)(), std::string& trouble) {
  return rubble::robot::make(config, now, trouble);
}
