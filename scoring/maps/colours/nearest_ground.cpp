#include "scoring/maps/colours/nearest_ground.h"

#include <array>
#include <cstdint>
#include <cstring>

namespace rubble::scoring {
namespace {

// Of a pixel's 65536th part.
constexpr std::uint32_t kStraight = 65536;
constexpr std::uint32_t kDiagonal = 91750;              // 1.4
constexpr std::uint32_t kKnight = 143976;               // 2.1969
constexpr std::uint32_t kFar = std::uint32_t{1} << 31;  // 20,000 pixels a side are less

struct Step {
  int dx, dy;
  std::uint32_t length;
};

/// What comes before a pixel in the order of rows; the pass back looks the other way.
constexpr std::array<Step, 8> kBefore{{{-1, -2, kKnight},
                                       {1, -2, kKnight},
                                       {-2, -1, kKnight},
                                       {-1, -1, kDiagonal},
                                       {0, -1, kStraight},
                                       {1, -1, kDiagonal},
                                       {2, -1, kKnight},
                                       {-1, 0, kStraight}}};

}  // namespace

void carry_ground(const cv::Mat& no_ground, cv::Mat& values) {
  const int width = no_ground.cols, height = no_ground.rows;
  const std::size_t bytes = values.elemSize();
  cv::Mat distance(height, width, CV_32S);
  const auto look = [&](int x, int y, int way) {
    const bool at_rim = x < 2 || y < 2 || x >= width - 2 || y >= height - 2;
    std::uint32_t* const own = distance.ptr<std::uint32_t>(y) + x;
    const Step* nearest = nullptr;
    for (const Step& step : kBefore) {
      const int u = x + way * step.dx, v = y + way * step.dy;
      if (at_rim && (u < 0 || v < 0 || u >= width || v >= height)) continue;
      const std::uint32_t here = distance.ptr<std::uint32_t>(v)[u] + step.length;
      if (here >= *own) continue;
      *own = here;
      nearest = &step;
    }
    if (nearest != nullptr)
      std::memcpy(values.ptr(y) + bytes * static_cast<std::size_t>(x),
                  values.ptr(y + way * nearest->dy) + bytes * static_cast<std::size_t>(x + way * nearest->dx), bytes);
  };
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const bool ground = no_ground.ptr(y)[x] == 0;
      distance.ptr<std::uint32_t>(y)[x] = ground ? 0 : kFar;
      if (!ground) look(x, y, 1);
    }
  for (int y = height - 1; y >= 0; --y)
    for (int x = width - 1; x >= 0; --x)
      if (distance.ptr<std::uint32_t>(y)[x] > kStraight) look(x, y, -1);
}

}  // namespace rubble::scoring
