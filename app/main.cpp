// The command line: parses, dispatches, and turns every failure into one line and an exit code.
#include <malloc.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <limits>
#include <memory>
#include <new>
#include <sstream>
#include <vector>

#include "app/command.h"
#include "app/terminal.h"
#include "base/error.h"
#include "base/text/input_file.h"
#include "base/text/words.h"
#include "scenarios/run/run.h"
#include "slam/process/mapper_server.h"

namespace rubble::app {
namespace {

/// A number from low to high; unlike CLI::Range it refuses NaN.
CLI::Validator between(double low, double high) {
  const auto check = [low, high](const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() && *end == '\0' && value >= low && value <= high) return std::string();
    std::ostringstream message;
    message << "'" << text << "' is not a number from " << low << " to " << high;
    return message.str();
  };
  return CLI::Validator(check, "");
}

/// 0 to 2^63 - 1 without a sign: what every reader of results can hold.
CLI::Validator whole_number() {
  const auto check = [](const std::string& text) {
    std::int64_t value = 0;
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool good = end.ec == std::errc() && end.ptr == text.data() + text.size() && value >= 0;
    return good ? std::string() : "'" + text + "' is not a whole number from 0 to 9223372036854775807";
  };
  return CLI::Validator(check, "");
}

/// A shell's empty variable gives an option nothing.
std::string nothing_given(const std::string& text) {
  return text.empty() ? "needs a value, and '' is none" : std::string();
}

/// For values that may look like options themselves: --slurm-option=--time=10.
CLI::Validator some_text() { return CLI::Validator(nothing_given, ""); }

/// An option whose value was forgotten takes the next one's name for it.
CLI::Validator some_value() {
  const auto check = [](const std::string& text) {
    return text.rfind("--", 0) == 0 ? "needs a value, and " + text + " is an option" : nothing_given(text);
  };
  return CLI::Validator(check, "");
}

/// One command's options, declared to CLI11.
class ParsedOptions : public Options {
 public:
  explicit ParsedOptions(CLI::App& command) : command_(command) {}

  void argument(const std::string& name, std::string& value, const std::string& about, Need need) override {
    command_.add_option(name, value, about)->required(need == Need::Required);
  }
  void arguments(const std::string& name, std::vector<std::string>& values, const std::string& about,
                 Need need) override {
    command_.add_option(name, values, about)->required(need == Need::Required);
  }
  void text(const std::string& name, std::string& value, const std::string& about) override {
    command_.add_option(name, value, about)->check(some_value());
  }
  void required_text(const std::string& name, std::string& value, const std::string& about) override {
    command_.add_option(name, value, about)->required()->check(some_value());
  }
  void texts(const std::string& name, std::vector<std::string>& values, const std::string& about) override {
    command_.add_option(name, values, about)->allow_extra_args(false)->take_all()->check(some_text());
  }
  void choice(const std::string& name, std::string& value, const std::vector<std::string>& choices,
              const std::string& about) override {
    command_.add_option(name, value, about)->check(CLI::IsMember(choices));
  }
  void number(const std::string& name, double& value, double low, double high, const std::string& about) override {
    command_.add_option(name, value, about)->check(between(low, high));
  }
  void number(const std::string& name, std::optional<double>& value, double low, double high,
              const std::string& about) override {
    command_.add_option(name, value, about)->check(between(low, high));
  }
  void whole(const std::string& name, int& value, int low, int high, const std::string& about) override {
    command_.add_option(name, value, about)->check(CLI::Range(low, high));
  }
  void seed(const std::string& name, std::uint64_t& value, const std::string& about) override {
    command_.add_option(name, value, about)->check(whole_number());
  }
  void seed(const std::string& name, std::optional<std::uint64_t>& value, const std::string& about) override {
    command_.add_option(name, value, about)->check(whole_number());
  }
  void flag(const std::string& name, bool& value, const std::string& about) override {
    command_.add_flag(name, value, about);
  }
  void excludes(const std::string& option, const std::string& other) override {
    command_.get_option(option)->excludes(command_.get_option(other));
  }
  void needs(const std::string& option, const std::string& other) override {
    command_.get_option(option)->needs(command_.get_option(other));
  }
  bool given(const std::string& name) const override { return command_.count(name) > 0; }

 private:
  CLI::App& command_;
};

/// A row of the table, ready to be parsed.
struct Declared {
  CLI::App* parser = nullptr;
  std::unique_ptr<ParsedOptions> options;
  Action action;
};

/// Declares all commands; "batch merge" below "batch".
std::vector<Declared> declare(CLI::App& app) {
  std::vector<Declared> declared;
  for (const Command& command : commands()) {
    CLI::App* parent = &app;
    std::string name = command.name;
    if (const auto space = name.find(' '); space != std::string::npos) {
      parent = app.get_subcommand(name.substr(0, space));
      name = name.substr(space + 1);
    }
    CLI::App* parser = parent->add_subcommand(name, command.about);
    parser->footer(command.footer);
    auto options = std::make_unique<ParsedOptions>(*parser);
    Action action = command.declare(*options);
    declared.push_back({parser, std::move(options), std::move(action)});
  }
  return declared;
}

std::vector<std::string> names_of(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(command->get_name());
  return names;
}

/// The command that was being read, "batch merge" below "batch"; none: the program itself.
const CLI::App& innermost(const CLI::App& app) {
  const auto chosen = app.get_subcommands();
  return chosen.empty() ? app : innermost(*chosen.back());
}

/// "'--sed' is no option of run, did you mean '--seed'?"; empty when nothing like it is one.
std::string option_hint(const CLI::App& app) {
  const CLI::App& command = innermost(app);
  std::vector<std::string> options;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) options.push_back("--" + name);
  for (const std::string& word : app.remaining(true)) {
    if (word.rfind("--", 0) != 0) continue;
    const std::string name = word.substr(0, word.find('='));
    if (const std::string hint = did_you_mean(name, options); !hint.empty())
      return in_quotes(name) + " is no option of " + command.get_name() + hint;
  }
  return "";
}

/// What stands on the command line behind the program's name: "help run" is "run --help". CLI11 takes it backwards.
std::vector<std::string> words_of(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words.front() == "help") {
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  std::reverse(words.begin(), words.end());
  return words;
}

int dispatch(int argc, char** argv) {
  CLI::App app(
      "rubble: simulate, map and score rescue arenas.\n"
      "Exit codes: 0 ok, 1 an expectation failed, 2 usage, 3 bad input, 4 run failed, 130 interrupted.");
  app.name("rubble");
  app.set_version_flag("--version", [] { return scenarios::versions().json(-1); });
  app.require_subcommand(1);
  app.footer(
      "rubble SUBCOMMAND --help, or help SUBCOMMAND, tells more.\n"
      "Also: mapper-process KIND   a mapper of ours as a program of its own, see docs/mapper_protocol.md\n"
      "      test                  in a checkout, ./rubble test builds and runs the tests; ./rubble test --help");
  const std::vector<Declared> declared = declare(app);
  try {
    app.parse(words_of(argc, argv));
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    std::string message = error.what();
    if (const auto most = message.find(": At Most 1 required but received"); most != std::string::npos)
      message.replace(most, std::string::npos, " is given more than once, and takes one value");
    std::replace(message.begin(), message.end(), '\n', ' ');
    const auto chosen = app.get_subcommands();
    if (chosen.empty() && argc > 1 && argv[1][0] != '-') {
      const std::string hint = did_you_mean(argv[1], names_of(app));
      throw UsageError(in_quotes(argv[1]) + " is no subcommand" + (hint.empty() ? "; see rubble --help" : hint));
    }
    if (const std::string hint = option_hint(app); !hint.empty()) throw UsageError(hint);
    const std::string command = chosen.empty() ? "" : " " + chosen.front()->get_name();
    throw UsageError(message + "; see rubble" + command + " --help");
  }
  const Declared* chosen = nullptr;  // of a command and its parent the command, which stands behind
  for (const Declared& command : declared)
    if (command.parser->parsed()) chosen = &command;
  return chosen->action();
}

/// One line whatever stands in it: names and values of foreign files may hold line breaks and terminal escapes.
int complain(const std::string& message, int code) {
  end_progress();
  std::fprintf(stderr, "rubble: %s\n", one_line(message).c_str());
  return code;
}

/// A path that cannot be looked at is bad input, a disk that fails is not.
int complain(const std::filesystem::filesystem_error& error) {
  const std::error_code why = error.code();
  const bool is_disk = why == std::errc::no_space_on_device || why == std::errc::io_error;
  return complain(error.path1().string() + ": cannot be used (" + why.message() +
                      "); check the path, its permissions and the free space",
                  is_disk ? kFailed : kBadInput);
}

/// What was printed counts only when it arrived.
int delivered(int code) {
  std::cout.flush();
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0 && std::cout.good()) return code;
  if (code != kOk && code != kBroken) return code;  // it has had its one line
  const std::string why = errno != 0 ? std::string(" (") + std::strerror(errno) + ")" : "";
  return complain("standard output: cannot be written" + why + "; free some space and give the command again", kFailed);
}

int guarded(int argc, char** argv) {
  try {
    return dispatch(argc, argv);
  } catch (const UsageError& error) {
    return complain(error.what(), kUsage);
  } catch (const InputError& error) {
    return complain(error.what(), kBadInput);
  } catch (const Interrupted& error) {
    return complain(error.what(), kInterrupted);
  } catch (const std::filesystem::filesystem_error& error) {
    return complain(error);
  } catch (const std::bad_alloc&) {
    std::fputs(
        "rubble: out of memory; give a smaller file, arena, map or sweep, fewer --workers, or a computer with more of "
        "it\n",
        stderr);
    return kFailed;
  } catch (const std::exception& error) {
    return complain(error.what(), kFailed);
  }
}

}  // namespace
}  // namespace rubble::app

/// Images and grids come and go by the megabyte. Given back each time, the kernel clears every page of them anew: a
/// fifth of the time of `rubble score`.
static void keep_freed_memory() {
#ifdef __GLIBC__
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

int main(int argc, char** argv) {
  keep_freed_memory();
  if (const auto code = rubble::slam::serve_mapper_if_asked(argc, argv)) return *code;
  rubble::app::end_by_interrupts();
  return rubble::app::delivered(rubble::app::guarded(argc, argv));
}
