#include "base/module.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>
#include <vector>

#include "base/error.h"
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

std::string last_trouble() {
  const char* trouble = dlerror();
  return trouble == nullptr ? "the loader does not say why" : one_line(trouble);
}

}  // namespace

void* module_function(const std::string& what, const std::string& file, const char* symbol, const std::string& remedy) {
  std::string trouble;
  const auto function_in = [&](const std::string& place) -> void* {
    void* const module = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    void* const function = module == nullptr ? nullptr : dlsym(module, symbol);
    if (function == nullptr && trouble.empty()) trouble = last_trouble();
    return function;
  };
  for (const std::string& place : places(file)) {
    std::error_code error;
    if (!fs::exists(place, error)) continue;
    if (void* const function = function_in(place)) return function;
  }
  if (void* const function = function_in(file)) return function;
  throw RunError(what + ": " + file + " cannot be loaded (" + trouble + "); " + remedy);
}

}  // namespace rubble
