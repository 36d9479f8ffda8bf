#include "app/robots/keyboard.h"

#include <unistd.h>

#include <cctype>
#include <chrono>
#include <utility>

namespace rubble::app {
namespace {

constexpr double kFirstHold = 0.6;  ///< a terminal repeats a held key after so long at the latest [s]
constexpr double kHold = 0.2;       ///< and then more often than this [s]
constexpr double kRearm = 0.5;      ///< R means something else for so long after it was last waited for [s]
constexpr double kAlone = 0.1;      ///< the bytes of one key come closer together [s]
constexpr int kEscape = 27;

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// W, A, S, D for the last letter of an arrow key's sequence.
int letter_of_arrow(int last) {
  switch (last) {
    case 'A':
      return 'w';
    case 'B':
      return 's';
    case 'C':
      return 'd';
    case 'D':
      return 'a';
    default:
      return last;
  }
}

}  // namespace

Keyboard::Keyboard() {
  if (!isatty(STDIN_FILENO) || tcgetpgrp(STDIN_FILENO) != getpgrp() || tcgetattr(STDIN_FILENO, &before_) != 0) return;
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_iflag &= ~static_cast<tcflag_t>(IXON | IXOFF);  // Ctrl-S would hold up what we print, and us with it
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  // A program that is ended or suspended on the spot leaves the robot to its watchdog: these become keys like others.
  raw.c_cc[VQUIT] = raw.c_cc[VSUSP] = _POSIX_VDISABLE;
  active_ = tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

Keyboard::~Keyboard() { restore(); }

void Keyboard::restore() {
  if (active_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

/// The next byte waiting, if there is one. Ctrl-Space is a 0.
std::optional<int> Keyboard::next() {
  unsigned char byte = 0;
  return active_ && ::read(STDIN_FILENO, &byte, 1) == 1 ? std::optional<int>(byte) : std::nullopt;
}

void Keyboard::take(int key) {
  if (key == 'r' && now() < rearm_until_) {
    rearmed_ = true;
    return;
  }
  any_ = true;
  quit_ = quit_ || key == 'q';
  const double v = key == 'w' ? 1.0 : key == 's' ? -1.0 : 0.0;
  const double w = key == 'a' ? 1.0 : key == 'd' ? -1.0 : 0.0;
  const bool repeated = v == v_ && w == w_ && now() < until_;
  v_ = v;
  w_ = w;
  until_ = now() + (repeated ? kHold : kFirstHold);
}

/// The key that ends with this byte: ESC [ A and ESC O A are arrows, with parameters (a shifted one) too; other
/// sequences are a key like any other. Nothing: more is to come, perhaps in a later look. What follows an ESC and is
/// none of it is a key of its own: nobody who pressed ESC may find the next key dead.
std::optional<int> Keyboard::decoded(int byte) {
  const bool late = now() - byte_at_ > kAlone;
  byte_at_ = now();
  const bool arrow = byte >= 'A' && byte <= 'D';  // it may have been cut apart on its way
  if (sequence_ == Sequence::Inside && late && !arrow) sequence_ = Sequence::None;
  switch (sequence_) {
    case Sequence::None:
      if (byte != kEscape) return byte;
      any_ = true;  // whatever comes of it, a key was pressed
      alone_ = false;
      sequence_ = Sequence::Escape;
      return std::nullopt;
    case Sequence::Escape:
      if (byte == '[' || byte == 'O') {
        sequence_ = Sequence::Inside;
        return std::nullopt;
      }
      if (byte != kEscape) sequence_ = Sequence::None;
      alone_ = false;
      return byte;
    case Sequence::Inside:
      if (byte < '@') return std::nullopt;  // a parameter
      sequence_ = Sequence::None;
      return byte <= 'D' ? letter_of_arrow(byte) : kEscape;
  }
  return byte;
}

void Keyboard::look() {
  const std::lock_guard<std::mutex> lock(mutex_);
  while (const auto byte = next())
    if (const auto key = decoded(*byte)) take(std::tolower(*key));
  if (sequence_ != Sequence::Escape || alone_ || now() - byte_at_ <= kAlone) return;
  alone_ = true;
  take(kEscape);
}

bool Keyboard::pressed() {
  look();
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(any_, false);
}

bool Keyboard::rearmed() {
  const std::lock_guard<std::mutex> lock(mutex_);
  rearm_until_ = now() + kRearm;
  return std::exchange(rearmed_, false);
}

void Keyboard::forget() {
  const std::lock_guard<std::mutex> lock(mutex_);
  until_ = 0.0;
}

bool Keyboard::quit() {
  look();
  const std::lock_guard<std::mutex> lock(mutex_);
  return quit_;
}

robot::Drive Keyboard::drive(double v, double w) {
  look();
  const std::lock_guard<std::mutex> lock(mutex_);
  return now() < until_ ? robot::Drive{v_ * v, w_ * w} : robot::Drive{};
}

}  // namespace rubble::app
