#pragma once

#include <string>
#include <vector>

namespace rubble::robot {

/// What keeps a robot from being driven, or what of it does not work: one line for people, and what kind it is for
/// programs.
struct Hindrance {
  enum class Cause {
    Silent,    ///< nothing comes of it
    Late,      ///< what comes is too old: its line or this computer is too slow
    Held,      ///< a person must let it go
    Disobeys,  ///< it does something else than it is told
    Faulty,    ///< a part of it gives nothing
  };

  std::string name;  ///< of the device: `urg`, `base`, `levelling`, `heartbeat`
  Cause cause = Cause::Silent;
  std::string what;

  std::string line() const { return name + ": " + what; }
};

/// What is said when it is over.
inline const char* over(Hindrance::Cause cause) {
  switch (cause) {
    case Hindrance::Cause::Silent:
      return "reports";
    case Hindrance::Cause::Late:
      return "is in time again";
    case Hindrance::Cause::Held:
      return "is let go";
    case Hindrance::Cause::Disobeys:
      return "obeys again";
    case Hindrance::Cause::Faulty:
      return "works again";
  }
  return "";
}

inline std::vector<std::string> lines_of(const std::vector<Hindrance>& all) {
  std::vector<std::string> lines;
  for (const Hindrance& one : all) lines.push_back(one.line());
  return lines;
}

}  // namespace rubble::robot
