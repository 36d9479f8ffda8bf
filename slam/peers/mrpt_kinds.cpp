#include "slam/peers/mrpt_kinds.h"

#include "base/error.h"
#include "slam/peers/mrpt_icp_mapper.h"
#include "slam/peers/mrpt_rbpf_mapper.h"
#include "slam/process/mapper_server.h"
#include "slam/process/process_mapper.h"

namespace rubble::slam {
namespace {

/// Parameters of a mapper that runs in a process of its own: this program, asked to serve it.
template <class Config, class Kind>
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
    return std::make_unique<Kind>(model, config_, setting.seed);
  }
  std::unique_ptr<MapperParameters> copy() const override { return std::make_unique<OwnProcess>(*this); }

 private:
  std::string kind_;
  Config config_;
  double timeout_ = 60.0;  ///< a mapping step of many particles on a loaded machine takes seconds [s]
};

}  // namespace

std::unique_ptr<MapperParameters> mrpt_icp_parameters() {
  return std::make_unique<OwnProcess<MrptIcpConfig, MrptIcpMapper>>("mrpt-icp");
}

std::unique_ptr<MapperParameters> mrpt_rbpf_parameters() {
  return std::make_unique<OwnProcess<MrptRbpfConfig, MrptRbpfMapper>>("mrpt-rbpf");
}

}  // namespace rubble::slam
