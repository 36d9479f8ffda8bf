#include "robot/drivers/mrpt_scanner.h"

#include <filesystem>

#include "base/error.h"
#include "base/module.h"
#include "robot/drivers/host_clock.h"
#include "robot/drivers/mrpt_module.h"
#include "robot/drivers/port_word.h"

namespace rubble::robot {
namespace {

namespace fs = std::filesystem;

// Least time from the last beam to the delivery, measured with MRPT 2.5.8: over a serial line it waits for a time-out
// of 100 ms at the end of every scan.
constexpr double kTcpDelivery = 0.002, kSerialDelivery = 0.101;

MrptScannerFactory load_factory() {
  return reinterpret_cast<MrptScannerFactory>(
      module_function("MRPT's drivers", "rubble_mrpt_devices.so", kMrptScannerSymbol,
                      "install libmrpt-hwdrivers-dev and build again, or use the scanner by `driver: scip`"));
}

/// MRPT's names for the port; classes take those that they know.
void name_port(const std::string& word, std::vector<std::pair<std::string, std::string>>& parameters) {
  if (word.empty()) return;
  const PortWord parts = parse_port_word(word);
  if (parts.kind == PortKind::Tcp) {
    for (const char* key : {"IP_DIR", "ip_address"}) parameters.emplace_back(key, parts.host);
    for (const char* key : {"PORT_DIR", "port"}) parameters.emplace_back(key, parts.port);
  } else {
    parameters.emplace_back("COM_port_LIN", fs::absolute(parts.path).string());
  }
}

}  // namespace

std::unique_ptr<Scanner> mrpt_scanner(const MrptScannerConfig& config) {
  MrptScannerConfig full = config;
  full.parameters.clear();
  name_port(config.port, full.parameters);
  full.parameters.insert(full.parameters.end(), config.parameters.begin(), config.parameters.end());
  if (config.delivery < 0.0) full.delivery = config.port.rfind("tcp:", 0) == 0 ? kTcpDelivery : kSerialDelivery;
  static const MrptScannerFactory factory = load_factory();
  std::string trouble;
  std::unique_ptr<Scanner> scanner(factory(full, &host_now, trouble));
  if (!scanner) throw InputError(trouble);
  return scanner;
}

}  // namespace rubble::robot
