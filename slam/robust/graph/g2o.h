#pragma once

#include <string>

#include "slam/robust/graph/pose_graph.h"

namespace rubble::slam {

/// The graph as text for g2o: VERTEX_SE2 and EDGE_SE2, the first node fixed; edges found wrong are left out. g2o
/// measures an edge's error along the axes of where it should end; the information is turned there, so that its chi2 is
/// the sum of squared_sigmas(). g2o knows no switchable loops: they count in full.
std::string to_g2o(const PoseGraph& graph);

}  // namespace rubble::slam
