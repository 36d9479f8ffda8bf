#include "base/module.h"

#include <dlfcn.h>

#include <cstring>
#include <filesystem>
#include <system_error>
#include <vector>

#include "base/error.h"
#include "base/module_version.h"
#include "base/text/words.h"

namespace rubble {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> places(const std::string& file) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (!program.is_absolute()) return {};         // without /proc: the working folder is no place to take programs from
  const fs::path above = program.parent_path();  // tests and benchmarks lie a folder below the program
  return {(program / file).string(), (above / file).string(), (above / "lib" / "rubble" / file).string()};
}

/// Why `place` was not loaded, without its name: a caller says that.
std::string last_trouble(const std::string& place) {
  const char* said = dlerror();
  if (said == nullptr) return "the loader does not say why";
  const std::string trouble = said, head = place + ": ";
  return one_line(trouble.rfind(head, 0) == 0 ? trouble.substr(head.size()) : trouble);
}

/// Whether the module was made from the same headers; one that says nothing of them is older than this question.
bool is_of_this_build(void* module) {
  const auto* version = static_cast<const char*>(dlsym(module, "rubble_module_version"));
  return version != nullptr && std::strcmp(version, rubble_module_version) == 0;
}

}  // namespace

void* module_function(const std::string& what, const std::string& file, const char* symbol, const std::string& remedy) {
  std::string trouble;
  const auto function_in = [&](const std::string& place) -> void* {
    void* const module = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    const bool is_stale = module != nullptr && !is_of_this_build(module);
    void* const function = module == nullptr || is_stale ? nullptr : dlsym(module, symbol);
    if (function == nullptr && trouble.empty())
      trouble = one_line(place) + " cannot be loaded (" +
                (is_stale ? "it belongs to another version of rubble" : last_trouble(place)) + ")";
    return function;
  };
  for (const std::string& place : places(file)) {
    std::error_code error;
    if (!fs::exists(place, error)) continue;
    if (void* const function = function_in(place)) return function;
  }
  if (void* const function = function_in(file)) return function;
  throw RunError(what + ": " + trouble + "; " + remedy);
}

}  // namespace rubble
