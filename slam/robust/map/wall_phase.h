#pragma once

#include <vector>

namespace rubble::slam {

/// Where in the cells of a raster those walls lie that run along one of its axes. Lengths in cells.
///
/// Walls no thicker than a cell count by the middle between their two faces, as far as any are seen from both sides.
/// Faces by themselves would mislead: those of a board lie a fifth of a cell to either side of it, and the walls around
/// an arena, seen from one side and most often, lie where the map's scale puts them. Their directions on the circle of
/// a cell all but cancel, and what is left may point to the border of two cells.
class WallPhase {
 public:
  /// A hit on a wall, at `across` and `along` it, on the face that looks up the axis across or down.
  void add(double across, double along, bool up);
  /// How far a raster that begins at `origin` must move for walls to lie in the middle of cells, -0.5..0.5; zero where
  /// they may lie anywhere (Rayleigh's test).
  double shift(double origin) const;

 private:
  /// Circular mean of places in a cell.
  class Mean {
   public:
    void add(double place);
    bool sure() const;
    double place() const;
    double count() const { return count_; }

   private:
    double cosine_ = 0.0;
    double sine_ = 0.0;
    double count_ = 0.0;
  };
  struct Hit {
    int strip;  ///< of the wall, across it
    float across;
    bool up;
  };

  Mean middles() const;

  Mean faces_;
  std::vector<Hit> hits_;
};

}  // namespace rubble::slam
