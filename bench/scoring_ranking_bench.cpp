#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numeric>
#include <string>
#include <vector>

#include "base/planar.h"
#include "base/rigid.h"
#include "scoring/alignment/feature_score.h"
#include "scoring/scorecard.h"
#include "scoring/walls/resample.h"
#include "tests/support/scoring_damage.h"
#include "tests/support/scoring_grounds.h"

/// Does the score put maps of one arena in the right order? Pairs of maps of which one has more damage of the same kind
/// than the other; and maps distorted in several ways, whose order is that of the trajectory error the distortion
/// means.
namespace rubble::scoring {
namespace {

using namespace testing;

std::vector<Damage> damages() {
  return {bending({0.1, 0.3, 0.5, 0.8, 1.1}),
          phantom_walls({3, 8, 15, 25, 40}),
          erased_walls({5, 15, 30, 50, 75}),
          thickening({0, 1, 2, 3, 4}),
          lost_coverage({0.95, 0.85, 0.7, 0.55, 0.4}),
          salting({0.005, 0.01, 0.02, 0.04, 0.07}),
          scale_error({1.005, 1.015, 1.03, 1.05, 1.08})};
}

double score_of(const OccupancyGrid& map, const OccupancyGrid& truth) {
  return score_map(moved(map, 0.4, 1.0, 2.0), truth).score;
}

void BM_RankPairs(benchmark::State& state) {
  int pairs = 0;
  int right = 0;
  for (auto _ : state) {
    pairs = right = 0;
    for (const Damage& damage : damages()) {
      int of_kind = 0;
      int right_of_kind = 0;
      for (std::uint64_t seed = 1; seed <= 3; ++seed) {
        const OccupancyGrid truth = maze_of(seed, 9, 7);
        std::vector<double> scores;
        for (const double level : damage.levels) scores.push_back(score_of(damage.apply(truth, level, seed), truth));
        for (std::size_t i = 0; i < scores.size(); ++i)
          for (std::size_t j = i + 1; j < scores.size(); ++j) {
            ++of_kind;
            right_of_kind += scores[i] > scores[j] ? 1 : 0;
            if (scores[i] <= scores[j])
              std::printf("wrong order: %s %g scores %.4f, %g scores %.4f (seed %d)\n", damage.name.c_str(),
                          damage.levels[i], scores[i], damage.levels[j], scores[j], static_cast<int>(seed));
          }
      }
      std::printf("%-20s %d of %d pairs in the right order\n", damage.name.c_str(), right_of_kind, of_kind);
      pairs += of_kind;
      right += right_of_kind;
    }
  }
  state.counters["pairs"] = pairs;
  state.counters["right"] = right;
}
BENCHMARK(BM_RankPairs)->Unit(benchmark::kSecond)->Iterations(1);

/// A distortion of the plane: where a true place is drawn, and back.
struct Distortion {
  std::string name;
  std::function<TPoint2D(const TPoint2D&)> drawn;
  std::function<TPoint2D(const TPoint2D&)> origin;
};

Distortion distortion(int kind, double size, double width, double height) {
  const double cx = 0.5 * width;
  const double cy = 0.5 * height;
  const auto sheared = [](std::string name, std::function<double(double)> dy) {
    return Distortion{std::move(name), [dy](const TPoint2D& p) { return TPoint2D(p.x, p.y + dy(p.x)); },
                      [dy](const TPoint2D& p) { return TPoint2D(p.x, p.y - dy(p.x)); }};
  };
  if (kind == 0) return sheared("bend", [=](double x) { return size * (x - cx) * (x - cx) / (cx * cx); });
  if (kind == 1) return sheared("jump", [=](double x) { return x > cx ? size : 0.0; });
  if (kind == 2) return sheared("wave", [=](double x) { return 0.5 * size * std::sin(6.283 * x / width); });
  if (kind == 3) {
    const double f = 1.0 + size / cx;
    return {"scale", [=](const TPoint2D& p) { return TPoint2D(cx + f * (p.x - cx), cy + f * (p.y - cy)); },
            [=](const TPoint2D& p) { return TPoint2D(cx + (p.x - cx) / f, cy + (p.y - cy) / f); }};
  }
  // One half turned about the middle of the seam, as after a wrong turn estimate.
  const auto hinge = [=](const TPoint2D& p, double angle) {
    const TPoint2D d(p.x - cx, p.y - cy);
    return TPoint2D(cx + std::cos(angle) * d.x - std::sin(angle) * d.y,
                    cy + std::sin(angle) * d.x + std::cos(angle) * d.y);
  };
  const double angle = size / cx;
  return {"hinge", [=](const TPoint2D& p) { return p.x > cx ? hinge(p, angle) : p; },
          [=](const TPoint2D& p) { return hinge(p, -angle).x > cx ? hinge(p, -angle) : p; }};
}

OccupancyGrid distorted(const OccupancyGrid& truth, const Distortion& d) {
  OccupancyGrid out = padded(truth, 40);
  for (int y = 0; y < out.height(); ++y)
    for (int x = 0; x < out.width(); ++x) {
      const Cell from = truth.cell(d.origin(out.centre({x, y})));
      out[{x, y}] = truth.inside(from) ? truth[from] : Occupancy::Unknown;
    }
  return out;
}

/// RMSE of a trajectory through the middle of every pallet, after the best rigid fit: ATE.
double trajectory_error_of(const Distortion& d, double width, double height) {
  std::vector<TPoint2D> truth;
  std::vector<TPoint2D> drawn;
  for (double y = 0.6; y < height; y += 1.2)
    for (double x = 0.6; x < width; x += 1.2) {
      truth.emplace_back(x, y);
      drawn.push_back(d.drawn({x, y}));
    }
  const PlanarTransform T(fit_rigid(drawn, truth));
  double sum = 0.0;
  for (std::size_t i = 0; i < truth.size(); ++i) sum += (T(drawn[i]) - truth[i]).sqrNorm();
  return std::sqrt(sum / static_cast<double>(truth.size()));
}

std::vector<double> ranks(const std::vector<double>& values) {
  std::vector<double> out;
  for (const double v : values) {
    double rank = 0.0;
    for (const double w : values) rank += w < v ? 1.0 : w == v ? 0.5 : 0.0;
    out.push_back(rank);
  }
  return out;
}

double spearman(const std::vector<double>& a, const std::vector<double>& b) {
  const std::vector<double> x = ranks(a);
  const std::vector<double> y = ranks(b);
  const double mean = 0.5 * static_cast<double>(a.size());
  double xy = 0.0;
  double xx = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xy += (x[i] - mean) * (y[i] - mean);
    xx += (x[i] - mean) * (x[i] - mean);
    yy += (y[i] - mean) * (y[i] - mean);
  }
  return xy / std::sqrt(xx * yy);
}

FeatureVerdict features_at(const OccupancyGrid& map, const OccupancyGrid& truth, const TPose2D& T_truth_map) {
  const OccupancyGrid map_known = crop_to_known(map, 0.0);
  const OccupancyGrid truth_known = crop_to_known(truth, 0.0);
  return judge_features(map_known, features_of(map_known), truth_known, truth_features(truth_known), T_truth_map);
}

std::string text_of(const FeatureVerdict& verdict) {
  char text[160];
  std::string out;
  for (const KindScore& kind : verdict.kinds) {
    std::snprintf(text, sizeof text, "%s %.3f/%.3f%s ", name_of(kind.kind), kind.match.error, kind.stranger,
                  kind.usable ? "" : " (few)");
    out += text;
  }
  std::snprintf(text, sizeof text, "features %.3f", verdict.score);
  return out + text;
}

void BM_RankAcrossKinds(benchmark::State& state) {
  std::vector<double> score;
  std::vector<double> minus_psi;
  std::vector<double> minus_error;
  std::vector<double> features;
  std::vector<double> minus_raw;
  for (auto _ : state) {
    for (std::uint64_t seed = 1; seed <= 2; ++seed) {
      const OccupancyGrid truth = maze_of(seed, 9, 7);
      const double width = 9 * 1.2;
      const double height = 7 * 1.2;
      for (int kind = 0; kind < 5; ++kind)
        for (const double size : {0.1, 0.25, 0.45, 0.7}) {
          const Distortion d = distortion(kind, size, width, height);
          const OccupancyGrid map = moved(distorted(truth, d), 0.4, 1.0, 2.0);
          const MapScore s = score_map(map, truth);
          const FeatureVerdict verdict = features_at(map, truth, s.T_truth_map);
          features.push_back(verdict.score);
          minus_raw.push_back(-verdict.kinds.front().match.error);
          score.push_back(s.score);
          minus_psi.push_back(-s.psi_m);
          minus_error.push_back(-trajectory_error_of(d, width, height));
          std::printf("%-6s %.2f m  trajectory error %.3f m  score %.3f  psi %.3f m  %s\n", d.name.c_str(), size,
                      -minus_error.back(), s.score, s.psi_m, text_of(verdict).c_str());
        }
    }
  }
  state.counters["maps"] = static_cast<double>(score.size());
  state.counters["spearman_score"] = spearman(score, minus_error);
  state.counters["spearman_psi"] = spearman(minus_psi, minus_error);
  state.counters["spearman_features"] = spearman(features, minus_error);
  state.counters["spearman_eq7"] = spearman(minus_raw, minus_error);
}
BENCHMARK(BM_RankAcrossKinds)->Unit(benchmark::kSecond)->Iterations(1);

/// Eq. (7) against strangers: other arenas of the same kind and size at their best pose, and the arena's own map with
/// gaps and phantom walls.
void BM_FeaturesOfStrangers(benchmark::State& state) {
  double sum = 0.0;
  double worst = 0.0;
  double own = 0.0;
  double least_own = 1.0;
  int pairs = 0;
  for (auto _ : state)
    for (const char* kind : {"yellow", "orange", "maze"})
      for (std::uint64_t seed = 7301; seed < 7309; ++seed) {
        const OccupancyGrid truth = truth_of({kind, 8, 7, seed});
        const OccupancyGrid stranger = moved(truth_of({kind, 8, 7, seed + 500}), 0.4, 1.0, 2.0);
        const OccupancyGrid damaged = moved(with_gaps(with_phantoms(truth, 6, seed), 12, seed), 0.4, 1.0, 2.0);
        const FeatureVerdict of_stranger = features_at(stranger, truth, score_map(stranger, truth).T_truth_map);
        const FeatureVerdict of_own = features_at(damaged, truth, score_map(damaged, truth).T_truth_map);
        sum += of_stranger.score;
        worst = std::max(worst, of_stranger.score);
        own += of_own.score;
        least_own = std::min(least_own, of_own.score);
        ++pairs;
        std::printf("%-6s %d  stranger %s  damaged %s\n", kind, static_cast<int>(seed), text_of(of_stranger).c_str(),
                    text_of(of_own).c_str());
      }
  state.counters["pairs"] = pairs;
  state.counters["stranger"] = sum / pairs;
  state.counters["stranger_worst"] = worst;
  state.counters["damaged"] = own / pairs;
  state.counters["damaged_least"] = least_own;
}
BENCHMARK(BM_FeaturesOfStrangers)->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
}  // namespace rubble::scoring
