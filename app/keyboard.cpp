#include "app/keyboard.h"

#include <unistd.h>

#include <chrono>

namespace rubble::app {
namespace {

constexpr double kFirstHold = 0.6;  ///< a terminal repeats a held key after so long at the latest [s]
constexpr double kHold = 0.2;       ///< and then more often than this [s]
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
  if (!isatty(STDIN_FILENO) || tcgetattr(STDIN_FILENO, &before_) != 0) return;
  termios raw = before_;
  raw.c_lflag &= ~static_cast<tcflag_t>(ICANON | ECHO);
  raw.c_cc[VMIN] = 0;
  raw.c_cc[VTIME] = 0;
  active_ = tcsetattr(STDIN_FILENO, TCSANOW, &raw) == 0;
}

Keyboard::~Keyboard() {
  if (active_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
}

/// The next key waiting; 0: none.
int Keyboard::next() {
  unsigned char key = 0;
  return active_ && ::read(STDIN_FILENO, &key, 1) == 1 ? key : 0;
}

bool Keyboard::pressed() {
  bool any = false;
  while (next() != 0) any = true;
  return any;
}

robot::Drive Keyboard::drive(double v, double w) {
  for (int key = next(); key != 0; key = next()) {
    if (key == kEscape && next() == '[') key = letter_of_arrow(next());
    robot::Drive wanted;
    if (key == 'w') wanted.v = v;
    if (key == 's') wanted.v = -v;
    if (key == 'a') wanted.w = w;
    if (key == 'd') wanted.w = -w;
    quit_ = quit_ || key == 'q';
    const bool repeated = wanted.v == drive_.v && wanted.w == drive_.w && now() < until_;
    drive_ = wanted;
    until_ = now() + (repeated ? kHold : kFirstHold);
  }
  return now() < until_ ? drive_ : robot::Drive{};
}

}  // namespace rubble::app
