#pragma once

#include <memory>

#include "slam/mappers.h"

namespace rubble::slam {

/// `mapper.kind: mrpt-icp` and `mrpt-rbpf`: MRPT's map builders for comparison with ours, on the same measurements.
/// Each runs in a process of its own, for MRPT's random generator is one for the whole process and keeps half a pair of
/// normal deviates over reseeding: so a run's bits depend on its seed alone, not on what ran before it.
std::unique_ptr<MapperParameters> mrpt_icp_parameters();
std::unique_ptr<MapperParameters> mrpt_rbpf_parameters();

}  // namespace rubble::slam
