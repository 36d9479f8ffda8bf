#include "slam/peers/mrpt_kinds.h"

#include "base/error.h"
#include "slam/mrpt/mrpt_slam.h"
#include "slam/peers/mrpt_mapper.h"
#include "slam/process/mapper_server.h"
#include "slam/process/process_mapper.h"

namespace rubble::slam {
namespace {

/// After how much motion MRPT's builders match a scan and put one into the map.
template <class Config>
void bind_steps(Binder& binder, Config& c) {
  binder.number("localize_distance_m", c.localize_distance, 0.0, 10.0);
  binder.degrees("localize_turn_deg", c.localize_turn, 0.0, 180.0);
  binder.number("insert_distance_m", c.insert_distance, 0.0, 10.0);
  binder.degrees("insert_turn_deg", c.insert_turn, 0.0, 180.0);
}

}  // namespace

void bind(Binder& binder, MrptIcpConfig& c) {
  binder.number("resolution_m", c.resolution, 0.01, 1.0);
  bind_steps(binder, c);
  binder.number("min_goodness", c.min_goodness, 0.0, 1.0);
}

void bind(Binder& binder, MrptRbpfConfig& c) {
  binder.number("resolution_m", c.resolution, 0.01, 1.0);
  binder.integer("particles", c.particles, 1, 10000);
  bind_steps(binder, c);
}

namespace {

std::unique_ptr<MapBuilder> builder_of(const robot::RobotModel& model, const MrptIcpConfig& config, std::uint64_t) {
  return mrpt_slam().icp_builder(model, config);
}
std::unique_ptr<MapBuilder> builder_of(const robot::RobotModel& model, const MrptRbpfConfig& config,
                                       std::uint64_t seed) {
  return mrpt_slam().rbpf_builder(model, config, seed);
}

/// Parameters of a mapper that runs in a process of its own: this program, asked to serve it.
template <class Config>
class OwnProcess : public MapperParameters {
 public:
  explicit OwnProcess(std::string kind) : kind_(std::move(kind)) {}

  void bind(Binder& binder) override {
    bind_fields(binder, config_);
    binder.number("timeout_s", timeout_, 0.01, 86400.0);
  }
  std::unique_ptr<Mapper> make(const robot::RobotModel& model, const MapperSetting& setting) const override {
    if (!program_serves_mappers())
      throw InputError("mapper.kind: " + kind_ +
                       " needs a process of its own; call rubble::slam::serve_mapper_if_asked(argc, argv) first in "
                       "main()");
    MapperProcess process;
    process.name = kind_;
    process.argv = {"/proc/self/exe", "mapper-process", kind_};
    process.timeout = timeout_;
    if (!setting.run_folder.empty()) process.log = setting.run_folder + "/mapper.log";
    OwnProcess same = *this;  // binding needs a mutable object; nothing is changed
    YamlWriter writer;
    same.bind(writer);
    process.parameters = writer.yaml();
    return std::make_unique<ProcessMapper>(model, process, setting.seed);
  }
  std::unique_ptr<Mapper> make_here(const robot::RobotModel& model, const MapperSetting& setting) const override {
    return std::make_unique<MrptMapper>(model, config_.resolution, builder_of(model, config_, setting.seed));
  }
  std::unique_ptr<MapperParameters> copy() const override { return std::make_unique<OwnProcess>(*this); }

 private:
  std::string kind_;
  Config config_;
  double timeout_ = 60.0;  ///< a mapping step of many particles on a loaded machine takes seconds [s]
};

}  // namespace

std::unique_ptr<MapperParameters> mrpt_icp_parameters() {
  return std::make_unique<OwnProcess<MrptIcpConfig>>("mrpt-icp");
}

std::unique_ptr<MapperParameters> mrpt_rbpf_parameters() {
  return std::make_unique<OwnProcess<MrptRbpfConfig>>("mrpt-rbpf");
}

}  // namespace rubble::slam
