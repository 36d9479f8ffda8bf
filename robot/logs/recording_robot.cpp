#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "base/error.h"
#include "robot/logs/log.h"
#include "robot/logs/own/log_codec.h"
#include "robot/logs/own/log_frames.h"

namespace rubble::robot {
namespace {

constexpr double kFlushPeriod = 1.0;                       // of log time: what a kill can cost [s]
constexpr std::size_t kFlushBytes = std::size_t{1} << 20;  // or this much at once

bool same_bits(const Commands& a, const Commands& b) {
  return std::memcmp(&a.drive, &b.drive, sizeof a.drive) == 0 && std::memcmp(&a.aim, &b.aim, sizeof a.aim) == 0 &&
         a.brake == b.brake;
}

}  // namespace

struct RecordingRobot::Impl {
  Robot& inner;
  std::string path;
  int file = -1;
  std::string buffer;
  TickContext context;
  Stamp flushed = Stamp::never();
  std::optional<Commands> in_force;

  Impl(Robot& robot, std::string log_path) : inner(robot), path(std::move(log_path)) {
    file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (file < 0)
      throw RunError(path + ": cannot be created (" + std::strerror(errno) +
                     "); give a log path in a folder that exists and may be written");
  }
  ~Impl() {
    if (file >= 0) ::close(file);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void write_out() {
    std::size_t written = 0;
    while (written < buffer.size()) {
      const ssize_t step = ::write(file, buffer.data() + written, buffer.size() - written);
      if (step < 0 && errno == EINTR) continue;
      if (step <= 0) {
        const std::string reason = step < 0 ? std::strerror(errno) : "nothing more is accepted";
        buffer.erase(0, written);
        throw RunError(path + ": the log cannot be written on (" + reason + "); free some space and run again, " +
                       "what was written before can be replayed");
      }
      written += static_cast<std::size_t>(step);
    }
    buffer.clear();
  }
};

RecordingRobot::RecordingRobot(Robot& inner, const std::string& path, const std::string& note)
    : impl_(std::make_unique<Impl>(inner, path)) {
  impl_->buffer = kLogMagic;
  append_header_frame(impl_->buffer, {inner.model(), note});
  impl_->write_out();
}

RecordingRobot::~RecordingRobot() {
  try {
    flush();
  } catch (const RunError&) {
    // Whoever needs to know calls flush() before; a destructor has nobody to tell.
  }
}

const RobotModel& RecordingRobot::model() const { return impl_->inner.model(); }

std::optional<Inputs> RecordingRobot::read() {
  std::optional<Inputs> inputs = impl_->inner.read();
  if (!inputs) {
    flush();
    return inputs;
  }
  append_codes_frame(impl_->buffer, *inputs);
  append_battery_frame(impl_->buffer, *inputs);
  append_tick_frame(impl_->buffer, *inputs, impl_->context);
  const bool due = impl_->flushed == Stamp::never() || inputs->now - impl_->flushed >= kFlushPeriod ||
                   impl_->buffer.size() >= kFlushBytes;
  if (due) {
    impl_->write_out();
    impl_->flushed = inputs->now;
  }
  return inputs;
}

void RecordingRobot::command(const Commands& commands) {
  if (!impl_->in_force || !same_bits(*impl_->in_force, commands)) {
    append_commands_frame(impl_->buffer, commands);
    impl_->in_force = commands;
  }
  impl_->inner.command(commands);
}

void RecordingRobot::flush() { impl_->write_out(); }

}  // namespace rubble::robot
