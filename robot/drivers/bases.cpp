#include "base/error.h"
#include "robot/drivers/base_driver.h"
#include "robot/drivers/pioneer.h"

namespace rubble::robot {
namespace {

template <class Driver>
BaseKind row(const char* name) {
  return {name, [](const BaseSettings& settings) { return std::make_unique<Driver>(settings); }};
}

}  // namespace

const std::vector<BaseKind>& base_kinds() {
  static const std::vector<BaseKind> kinds = {
      row<Pioneer>("arcos"),
  };
  return kinds;
}

std::unique_ptr<BaseDriver> make_base(const std::string& name, const BaseSettings& settings) {
  std::string known;
  for (const BaseKind& kind : base_kinds()) {
    if (kind.name == name) return kind.make(settings);
    known += (known.empty() ? "" : ", ") + kind.name;
  }
  throw InputError("base driver '" + name + "': there is none of that name; known are " + known);
}

}  // namespace rubble::robot
