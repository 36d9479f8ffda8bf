#include "slam/robust/graph/g2o.h"

#include <cstdio>

#include "slam/robust/matching/scan_fit.h"

namespace rubble::slam {

using mrpt::math::TPose2D;

namespace {

void append(std::string& text, double value) {
  char number[40];
  std::snprintf(number, sizeof number, " %.17g", value);
  text += number;
}

void append(std::string& text, const TPose2D& T) {
  append(text, T.x);
  append(text, T.y);
  append(text, T.phi);
}

}  // namespace

std::string to_g2o(const PoseGraph& graph) {
  std::string text;
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    text += "VERTEX_SE2 " + std::to_string(i);
    append(text, graph.nodes[i]);
    text += '\n';
  }
  if (!graph.nodes.empty()) text += "FIX 0\n";
  for (const GraphEdge& edge : graph.edges) {
    if (!edge.on) continue;
    const Eigen::Matrix3d information = turned(edge.information, -edge.T_from_to.phi);
    text += "EDGE_SE2 " + std::to_string(edge.from) + " " + std::to_string(edge.to);
    append(text, edge.T_from_to);
    for (int row = 0; row < 3; ++row)
      for (int column = row; column < 3; ++column)
        append(text, 0.5 * (information(row, column) + information(column, row)));
    text += '\n';
  }
  return text;
}

}  // namespace rubble::slam
