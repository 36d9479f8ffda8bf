// What the program's commands have in common: a command is a row {name, about, footer, declare} of the table in
// commands.cpp and a file of its own in the wing of its subject. Only main.cpp knows how a command line is taken apart.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace rubble::app {

/// Exit codes of the program.
enum Exit : int { kOk = 0, kBroken = 1, kUsage = 2, kBadInput = 3, kFailed = 4, kInterrupted = 130 };

/// Where a command declares what it takes. The variables given are filled in before the command runs; what they hold
/// before is the default.
class Options {
 public:
  enum class Need { Required, Optional };

  virtual ~Options() = default;

  /// By position.
  virtual void argument(const std::string& name, std::string& value, const std::string& about,
                        Need need = Need::Required) = 0;
  /// All that are left, one at least where they are required.
  virtual void arguments(const std::string& name, std::vector<std::string>& values, const std::string& about,
                         Need need = Need::Required) = 0;
  virtual void text(const std::string& name, std::string& value, const std::string& about) = 0;
  virtual void required_text(const std::string& name, std::string& value, const std::string& about) = 0;
  /// May be given again and again, one value each time.
  virtual void texts(const std::string& name, std::vector<std::string>& values, const std::string& about) = 0;
  virtual void choice(const std::string& name, std::string& value, const std::vector<std::string>& choices,
                      const std::string& about) = 0;
  virtual void number(const std::string& name, double& value, double low, double high, const std::string& about) = 0;
  virtual void number(const std::string& name, std::optional<double>& value, double low, double high,
                      const std::string& about) = 0;
  virtual void whole(const std::string& name, int& value, int low, int high, const std::string& about) = 0;
  /// 0 to 2^63 - 1.
  virtual void seed(const std::string& name, std::uint64_t& value, const std::string& about) = 0;
  virtual void seed(const std::string& name, std::optional<std::uint64_t>& value, const std::string& about) = 0;
  virtual void flag(const std::string& name, bool& value, const std::string& about) = 0;
  /// `option` is an error without `other`.
  virtual void needs(const std::string& option, const std::string& other) = 0;
  /// `option` is an error beside `other`.
  virtual void excludes(const std::string& option, const std::string& other) = 0;
  /// Whether it stands on the command line; to be asked when the command runs.
  virtual bool given(const std::string& name) const = 0;
};

/// What a command does once its options are read. Returns the exit code.
using Action = std::function<int()>;

/// A row of the table of commands.
struct Command {
  std::string name;  ///< "run"; "batch merge" stands below "batch"
  std::string about;
  std::string footer;  ///< examples
  /// Declares what the command takes. `options` lives as long as the action.
  std::function<Action(Options& options)> declare;
};

/// All commands, in the order of the help; parents before what stands below them.
const std::vector<Command>& commands();

}  // namespace rubble::app
