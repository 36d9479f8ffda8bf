#pragma once

#include <stdexcept>
#include <string>

namespace rubble {

/// Bad input from outside (file, key, number, device): what() is one line that names the place and the remedy.
/// The command line turns it into exit code 3.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The work itself could not be finished (robot lost, disk full): exit code 4.
class RunError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Bad command line: exit code 2.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// `path:line:column: message`, the form every error about a text file takes.
inline std::string at(const std::string& path, int line, int column, const std::string& message) {
  return path + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message;
}

}  // namespace rubble
