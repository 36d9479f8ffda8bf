#include "base/error.h"
#include "robot/drivers/base_driver.h"
#include "robot/drivers/pioneer.h"

namespace rubble::robot {
namespace {

class NoBase : public BaseDriver {
 public:
  explicit NoBase(const BaseSettings& /*settings*/) {}
  void opened(Stamp /*now*/, LineKind /*line*/) override {}
  void receive(std::string_view /*bytes*/, Stamp /*now*/) override {}
  void advance(Stamp /*now*/) override {}
  std::string take_output(Stamp /*now*/) override { return ""; }
  Stamp deadline() const override { return Stamp::never(); }
  bool ready() const override { return true; }
  Stamp last_report() const override { return Stamp::never(); }
  std::string state() const override { return "not connected"; }
  void drive(const Drive& /*drive*/) override {}
  void enable(bool /*on*/) override {}
  void stop() override {}
  std::vector<Odometry> take_odometry() override { return {}; }
  bool motors_on() const override { return false; }
};

template <class Driver>
BaseKind row(const char* name) {
  return {name, [](const BaseSettings& settings) { return std::make_unique<Driver>(settings); }};
}

}  // namespace

const std::vector<BaseKind>& base_kinds() {
  static const std::vector<BaseKind> kinds = {
      row<Pioneer>("arcos"),
      row<NoBase>(kNoBase),
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
