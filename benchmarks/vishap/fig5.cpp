// The force along the normal over the distance of the finger, as vision sees it [VisHap Fig 5]. The paper
// prints no units: "matches our model of the plane as shown in Figure 4 very well, i.e., the plane feels like
// a linear spring", and the button "very similar". The depth in the law is the prop's by its encoders, so
// vision judges a force that it did not set.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/statistics.h"
#include "benchmarks/vishap/vishap.h"
#include "core/base/units.h"
#include "core/control/task/impedance/impedance.h"
#include "trial/measure/finger_measure.h"

namespace enc::bench::vishap {
namespace {

struct LawAt {
  const Object& object;
  double free, factor;
  double begins = 0.0;  // m, distance that vision sees when the force begins
  [[nodiscard]] double at(double distance) const { return (*this)(std::max(0.0, begins - distance)); }
  double operator()(double depth) const {  // N
    const RenderedStiffness felt = felt_at(object.interaction, object.stiffness, free, depth);
    return factor * felt.stiffness * (depth - felt.sunk);
  }
};

// N^2, sum over the pictures.
double misfit(const std::vector<SeenForce>& pictures, const LawAt& law) {
  double sum = 0.0;
  for (const SeenForce& one : pictures) sum += std::pow(one.felt - law.at(one.distance), 2);
  return sum;
}

// The distance at which the force begins, by least squares: vision sees a finger a little beside its place.
double begins(const std::vector<SeenForce>& pictures, LawAt law) {
  constexpr double kFarthest = 2e-3, kStep = 0.02e-3;  // m
  double best = kUnset, least = HUGE_VAL;
  for (law.begins = -kFarthest; law.begins <= kFarthest; law.begins += kStep)
    if (const double off = misfit(pictures, law); off < least) {
      least = off;
      best = law.begins;
    }
  return best;
}

// %: mean force of the pictures between two depths over that of the law, less 100.
double force_error(const std::vector<SeenForce>& pictures, const LawAt& law, double low, double high) {
  double felt = 0.0, wanted = 0.0;
  for (const SeenForce& one : pictures) {
    const double depth = law.begins - one.distance;
    if (depth < low || depth >= high) continue;
    felt += one.felt;
    wanted += law(depth);
  }
  return wanted > 0.0 ? 100.0 * (felt / wanted - 1.0) : kUnset;
}

// Share of the force's variance that the law explains.
double explained(const std::vector<SeenForce>& pictures, const LawAt& law) {
  double sum = 0.0, square = 0.0;
  for (const SeenForce& one : pictures) {
    sum += one.felt;
    square += one.felt * one.felt;
  }
  return 1.0 - misfit(pictures, law) / (square - sum * sum / static_cast<double>(pictures.size()));
}

void tell_plane(Bench& bench, const std::vector<SeenForce>& pictures, const LawAt& law) {
  constexpr double kFrom = 1e-3;  // m
  trial::LineFit line;
  double felt = 0.0, pushed = 0.0;
  for (const SeenForce& one : pictures) {
    if (-one.distance < kFrom) continue;
    line.add(-one.distance, one.felt);
    felt += one.felt;
    pushed += one.pushed;
  }
  const double stiffness = law(1.0);
  bench.figure("fig5.wall.slope_error_percent", 100.0 * (line.slope() / stiffness - 1.0), "%", predicted(0.0),
               between(-10.0, 5.0),
               "slope of a straight line through the pictures below 1 mm, over the law's");
  bench.figure("fig5.wall.line_r2", line.r2(), "", predicted(1.0), between(0.9, 1.0), "of that line");
  bench.figure("fig5.wall.net_percent", law.factor * 100.0 * pushed / felt, "%", predicted(100.0),
               between(95.0, 105.0),
               "contact force over the commanded one: \"the net force that the user feels\"");
}

void tell_button(Bench& bench, const std::vector<SeenForce>& pictures, const LawAt& law) {
  const InteractionSpec& does = law.object.interaction;
  struct Part {
    const char *id, *words;
    double low, high;
    Bounds bounds;
  };
  // Before the trigger, seeds 1 to 6: -56 to 13 %; few pictures on a short, soft part of the curve.
  for (const Part& part :
       {Part{"first", "before the trigger", 0.5 * does.trigger, does.trigger, between(-75.0, 25.0)},
        Part{"after", "after it, above the board", does.trigger + does.gradual, does.bottom,
             between(-20.0, 20.0)},
        Part{"board", "on the board", does.bottom + does.gradual, 1.0, between(-20.0, 20.0)}})
    bench.figure(fmt::format("fig5.button.{}_error_percent", part.id),
                 force_error(pictures, law, part.low, part.high), "%", predicted(0.0), part.bounds,
                 fmt::format("mean force of the pictures {}, over the curve's", part.words));
}

}  // namespace

void add_fig5(Bench& bench, const std::string& scene, const std::vector<SeenForce>& pictures,
              const Object& object, double free) {
  // Mutants: a law half as stiff again, or that of the button four times softer: the beginning that is fitted
  // makes up for less.
  const bool button = object.interaction.kind == Interaction::click;
  const LawAt curve{object, free, !bench.context.mutated("other_law") ? 1.0 : button ? 0.25 : 1.5};
  const LawAt law{object, free, curve.factor, begins(pictures, curve)};
  // Seeds 1 to 6: 0.04 to 1.06 mm. The camera is registered anew with each.
  bench.figure(fmt::format("fig5.{}.begins_mm", scene), law.begins * kMmPerM, "mm", predicted(0.0),
               between(-0.5, 1.5),
               "distance that vision sees when the force of Fig 4's curve begins, by least squares");
  bench.figure(
      fmt::format("fig5.{}.r2", scene), explained(pictures, law), "", predicted(1.0), between(0.85, 1.0),
      fmt::format("share of the force's variance that Fig 4's curve from there explains, {} pictures",
                  pictures.size()));
  button ? tell_button(bench, pictures, law) : tell_plane(bench, pictures, law);
  Series felt{"twin"}, shape{"the law (shape of Fig 4)"};
  felt.mark = Mark::points;
  double deepest = 0.0;
  for (const SeenForce& one : pictures) {
    felt.add(one.distance * kMmPerM, one.felt);
    deepest = std::max(deepest, -one.distance);
  }
  shape.paper = true;
  constexpr double kFirst = -1e-3, kStep = 0.05e-3;  // m
  for (int i = 0; kFirst + i * kStep < deepest; ++i) {
    const double depth = kFirst + i * kStep;
    shape.add((law.begins - depth) * kMmPerM, law(std::max(0.0, depth)));
  }
  bench.plot({.id = "fig5_" + scene,
              .title = "Normal force over distance, " + scene + " (VisHap Fig 5)",
              .x_label = "distance that vision sees (mm), negative: under the surface",
              .y_label = "normal force (N)",
              .series = {shape, felt},
              .caption =
                  "Each picture in contact: the force at its exposure, over where it shows the finger. "
                  "The camera is registered."});
}

}  // namespace enc::bench::vishap
