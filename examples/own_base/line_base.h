// A base of one's own: a microcontroller that drives two motors and speaks lines of text. docs/extending.md tells where
// it goes.
//   it reports twenty times a second   O <x m> <y m> <heading rad> <v m/s> <w rad/s> <motors 0|1> <battery V>
//   it is told                         V <v m/s> <w rad/s>   and   M <0|1>: motors off, on
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "robot/drivers/base_driver.h"

namespace rubble::robot {

class LineBase : public BaseDriver {
 public:
  explicit LineBase(const BaseSettings& settings) : settings_(settings) {}

  // The conversation.
  void opened(Stamp now, LineKind line) override {
    line_ = line;
    waiting_.clear();
    last_report_ = Stamp::never();
    obeyed_ = false;  // who was switched off and on has its motors off
    said_ = now;
  }
  void receive(std::string_view bytes, Stamp now) override {
    waiting_.append(bytes);
    for (std::size_t end; (end = waiting_.find('\n')) != std::string::npos; waiting_.erase(0, end + 1))
      digest(waiting_.substr(0, end), now);
    if (waiting_.size() > 200) waiting_.clear();  // no line of its is so long
  }
  void advance(Stamp now) override {
    if (now - said_ >= kRefresh) due_ = true;
  }
  std::string take_output(Stamp now) override {
    if (!due_ || settings_.passive) return "";
    due_ = false;
    said_ = now;
    char text[64];
    std::snprintf(text, sizeof text, "M %d\nV %.3f %.3f\n", motors_ ? 1 : 0, target_.v, target_.w);
    return text;
  }
  std::vector<std::string> farewell() override { return {"V 0 0\n", "M 0\n"}; }
  Stamp deadline() const override { return said_ + kRefresh; }
  int baud() const override { return 115200; }

  // How it is.
  bool ready() const override { return last_report_ != Stamp::never(); }
  Stamp last_report() const override { return last_report_; }
  std::string state() const override { return ready() ? "reports" : "waits for its first report"; }
  bool motors_on() const override { return motors_on_; }
  double battery() const override { return battery_; }
  std::size_t bad_sums() const override { return bad_lines_; }
  std::vector<Odometry> take_odometry() override { return std::exchange(odometry_, {}); }

  // What it shall do.
  void drive(const Drive& drive) override {
    const Drive old = target_;
    target_.v = motors_ ? std::clamp(drive.v, -settings_.max_v, settings_.max_v) : 0.0;
    target_.w = motors_ ? std::clamp(drive.w, -settings_.max_w, settings_.max_w) : 0.0;
    if (target_.v != old.v || target_.w != old.w) due_ = true;  // an answer to what was just seen leaves at once
  }
  void enable(bool on) override {
    on = on && !settings_.passive && hold_ == Hold::None;
    if (on != motors_) due_ = true;
    motors_ = on;
    if (on) return;
    obeyed_ = false;
    drive({});
  }
  void stop() override {
    enable(false);
    due_ = true;
  }
  // Somebody at the robot switched its motors off: they stay off until the operator lets it go.
  Hold hold() const override { return hold_; }
  void rearm() override { hold_ = Hold::None; }

 private:
  static constexpr double kRefresh = 0.1;  ///< its own watchdog stops it after half a second of silence [s]

  void digest(const std::string& line, Stamp now) {
    Odometry o;
    int motors = 0;
    double battery = 0.0;
    const int read = std::sscanf(line.c_str(), "O %lf %lf %lf %lf %lf %d %lf", &o.pose.x, &o.pose.y, &o.pose.phi, &o.v,
                                 &o.w, &motors, &battery);
    const double all = std::abs(o.pose.x) + std::abs(o.pose.y) + std::abs(o.pose.phi) + std::abs(o.v) + std::abs(o.w);
    if (read != 7 || !(all + std::abs(battery) < 1e6)) {  // nor is a line with "nan" in it a report
      ++bad_lines_;
      return;
    }
    battery_ = battery;
    go_on(o);
    const auto bytes = static_cast<double>(line.size());
    o.stamp = now - (settings_.delay + time_on_line(line_, bytes, baud()));
    if (last_stamp_ != Stamp::never() && o.stamp <= last_stamp_) o.stamp = {last_stamp_.ns + 1};
    last_stamp_ = o.stamp;
    last_report_ = now;
    motors_on_ = motors != 0;
    if (motors_ && obeyed_ && !motors_on_) {
      hold_ = Hold::MotorsOff;
      enable(false);
    }
    obeyed_ = motors_ && motors_on_;
    odometry_.push_back(o);
  }

  /// Poses go on by scaled steps, and where they were when the microcontroller starts anew at zero.
  void go_on(Odometry& o) {
    const auto reported = o.pose;
    auto step = reported - reported_;
    if (std::hypot(step.x, step.y) > 0.5 || std::abs(step.phi) > 0.5) step = {};  // in a twentieth of a second
    step.x *= settings_.distance_scale;
    step.y *= settings_.distance_scale;
    step.phi *= settings_.turn_scale;
    pose_ = pose_ + step;
    reported_ = reported;
    o.pose = pose_;
    o.v *= settings_.distance_scale;
    o.w *= settings_.turn_scale;
  }

  BaseSettings settings_;
  mrpt::math::TPose2D pose_, reported_;
  LineKind line_ = LineKind::Tcp;
  std::string waiting_;
  Drive target_;
  bool motors_ = false, motors_on_ = false, due_ = false;
  bool obeyed_ = false;  ///< its motors were on as they were asked for
  Hold hold_ = Hold::None;
  double battery_ = 0.0;
  std::size_t bad_lines_ = 0;
  Stamp said_ = Stamp::never(), last_report_ = Stamp::never(), last_stamp_ = Stamp::never();
  std::vector<Odometry> odometry_;
};

}  // namespace rubble::robot
