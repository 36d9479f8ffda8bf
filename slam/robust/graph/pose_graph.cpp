#include "slam/robust/graph/pose_graph.h"

#include <cmath>

#include "base/angle.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

Linearised linearise(const GraphEdge& edge, const TPose2D& from, const TPose2D& to) {
  const double c = std::cos(from.phi);
  const double s = std::sin(from.phi);
  const double dx = to.x - from.x;
  const double dy = to.y - from.y;
  const double ahead = c * dx + s * dy;
  const double aside = -s * dx + c * dy;
  Linearised lin;
  lin.r << ahead - edge.T_from_to.x, aside - edge.T_from_to.y, wrap_angle(to.phi - from.phi - edge.T_from_to.phi);
  lin.by_from << -c, -s, aside, s, -c, -ahead, 0, 0, -1;
  lin.by_to << c, s, 0, -s, c, 0, 0, 0, 1;
  return lin;
}

TPose2D disagreement(const PoseGraph& graph, const GraphEdge& edge) {
  const TPose2D T_from_to =
      graph.nodes[static_cast<std::size_t>(edge.to)] - graph.nodes[static_cast<std::size_t>(edge.from)];
  return T_from_to - edge.T_from_to;
}

double squared_sigmas(const PoseGraph& graph, const GraphEdge& edge) {
  const Linearised lin =
      linearise(edge, graph.nodes[static_cast<std::size_t>(edge.from)], graph.nodes[static_cast<std::size_t>(edge.to)]);
  return lin.r.dot(edge.information * lin.r);
}

}  // namespace rubble::slam
