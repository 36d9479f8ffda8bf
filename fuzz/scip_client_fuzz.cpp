// What a scanner may send to our driver: cut into replies, read in every way the driver reads them.
#include <cmath>
#include <cstdlib>

#include "robot/drivers/scip/scip_receiver.h"
#include "robot/drivers/scip/scip_reply.h"
#include "robot/drivers/scip/scip_scan.h"

namespace {

using namespace rubble::robot;

void require(bool law) {
  if (!law) std::abort();
}

void read_scan(const scip::Reply& reply, const scip::Geometry& geometry) {
  const auto sweep = scip::sweep_of(reply, geometry.steps());
  const auto old = scip::old_sweep_of(reply, geometry.steps());
  for (const auto& found : {sweep, old}) {
    if (!found) continue;
    require(found->values.size() == geometry.steps() && found->clock_ms < (1u << 24));
    const LaserScan scan = scip::scan_of(*found, geometry, {4.0, false}, {});
    require(scan.ranges.size() == geometry.steps() && scan.codes.size() == geometry.steps());
    for (const float range : scan.ranges) require(std::isnan(range) || range >= 0.0f);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  scip::Receiver receiver;
  receiver.expect_echo("MD00440046010", 15);
  const scip::Geometry small{1024, 44, 46, 384, 20, 5600, 600};
  // The first byte says how the bytes arrive: in pieces of so many.
  const std::size_t piece = size == 0 ? 1 : 1 + data[0] % 64;
  for (std::size_t at = 1; at < size; at += piece) {
    receiver.push(data + at, std::min(piece, size - at), {static_cast<std::int64_t>(at)});
    while (const auto reply = receiver.next()) {
      require(!reply->lines.empty() && reply->begun <= reply->ended);
      const auto status = scip::status_of(*reply);
      require(!status || !status->empty());
      if (const auto entries = scip::entries_of(*reply, true)) {
        if (const auto geometry = scip::geometry_of(*entries)) read_scan(*reply, *geometry);
      }
      if (const auto entries = scip::entries_of(*reply, false)) {
        for (const auto& [key, value] : *entries)
          if (const auto geometry = scip::geometry_of_firmware(value)) scip::laser_of(*geometry, key);
        if (const auto geometry = scip::geometry_of(*entries)) require(geometry->steps() > 1);
      }
      read_scan(*reply, small);
    }
  }
  return 0;
}
