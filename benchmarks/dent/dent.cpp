// Measures the visible dent: position of the vertex under the tool, volume of the dent, and the time for a
// mesh of 10,242 vertices, against a straight double loop with face-accumulated normals.
#include "core/shape/deformation/dent.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "core/base/units.h"
#include "core/control/scene/scene.h"
#include "models/setup/scene_file.h"
#include "models/shapes/shapes.h"

namespace enc::bench::dent {
namespace {

// Positions and normals as a renderer keeps them, before and after.
struct Cloud {
  std::array<std::vector<float>, 6> before, after;
  explicit Cloud(const Mesh& ball) {
    for (auto& column : after) column.resize(ball.vertices.size());
    for (const auto& v : ball.vertices) {
      const double size = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      for (std::size_t k = 0; k < 3; ++k) {
        before[k].push_back(static_cast<float>(v[k]));
        before[k + 3].push_back(static_cast<float>(v[k] / size));
      }
    }
  }
  void update(const DentField<double>& field) {
    const auto& b = before;
    auto& a = after;
    apply(to_float(field), {b[0].data(), b[1].data(), b[2].data(), b[3].data(), b[4].data(), b[5].data()},
          {a[0].data(), a[1].data(), a[2].data(), a[3].data(), a[4].data(), a[5].data()}, b[0].size());
  }
};

// The reference: pushes each vertex in by a Gaussian of equal depth and width, in double, then sums the
// triangles' area-weighted normals at their corners and normalises them. All buffers exist beforehand.
struct DentReference {
  const Mesh& mesh;
  std::vector<Vec3> points, normals;
  explicit DentReference(const Mesh& ball)
      : mesh(ball), points(ball.vertices.size()), normals(ball.vertices.size()) {}
  void update(const Vec3& contact, const Vec3& n, double depth, double width) {
    const double scale = -1.0 / (width * width);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const auto& v = mesh.vertices[i];
      const Vec3 p(v[0], v[1], v[2]);
      points[i] = p - depth * std::exp(scale * (p - contact).squaredNorm()) * n;
      normals[i].setZero();
    }
    for (const auto& t : mesh.triangles) {
      const auto a = static_cast<std::size_t>(t[0]);
      const auto b = static_cast<std::size_t>(t[1]);
      const auto c = static_cast<std::size_t>(t[2]);
      const Vec3 face = (points[b] - points[a]).cross(points[c] - points[a]);
      normals[a] += face;
      normals[b] += face;
      normals[c] += face;
    }
    for (Vec3& normal : normals) normal.normalize();
  }
};

constexpr int kUpdates = 20;

// Ours; ours with a dent so wide that no vertex is skipped; straight: kUpdates each.
Race race(const Mesh& ball, const Surface& surface, const DentSample& dent, std::size_t rounds) {
  Cloud cloud(ball);
  DentReference straight(ball);
  const Vec3 n = dent.tip.centre.e().normalized();
  const Vec3 contact = surface.nearest(dent.tip.centre).point.e();
  const double radius = std::get<Sphere>(surface.shape()).radius;
  DentField<double> everywhere = dent_field(surface, dent);
  everywhere.reach = 100.0 * radius;
  const auto often = [](auto update) {
    return [update] {
      for (int i = 0; i < kUpdates; ++i) update();
    };
  };
  return {rounds,
          {often([&] { cloud.update(dent_field(surface, dent)); }), often([&] { cloud.update(everywhere); }),
           often([&] { straight.update(contact, n, dent.depth, std::sqrt(radius * dent.depth)); })}};
}

void run(Bench& bench) {
  const models::Setup setup = bench.setup();
  const Scene scene = prepare(setup.scene, setup.rig);
  const Surface& surface = scene.objects.front().surface;
  const double radius = setup.scene.objects.front().radius;
  const Mesh ball = models::geodesic_ball(32, radius);
  const double volume = 4.0 / 3.0 * M_PI * radius * radius * radius;
  Cloud cloud(ball);
  DentSample last;
  for (const double depth : {0.002, 0.004, 0.006}) {
    // The tool points at a vertex, so that one lies exactly under it.
    const Vec3 n = Vec3(ball.vertices[0][0], ball.vertices[0][1], ball.vertices[0][2]).normalized();
    const double tip_radius = scene.tools.front().tip.radius;
    const double pressed = (bench.context.mutated("shallower") ? 0.99 : 1.0) * depth;
    const Tip<'O'> tip{Point<'O'>(Vec3((radius - pressed + tip_radius) * n)), tip_radius};
    last = dent_of(surface, 0, tip);
    const DentField<double> field = dent_field(surface, last);
    cloud.update(field);
    const Vec3 before(cloud.before[0][0], cloud.before[1][0], cloud.before[2][0]);
    const Vec3 after(cloud.after[0][0], cloud.after[1][0], cloud.after[2][0]);
    const auto mm = std::lround(depth * kMmPerM);
    bench.figure(fmt::format("contact_error.{}mm.max", mm), 1e6 * ((before - after) - depth * n).norm(), "um",
                 at_most(1.0), "drawn vertex under the tool against the deflection");
    const double gained = (bench.context.mutated("turned_volume") ? -1.0 : 1.0) * volume_change(ball, field);
    bench.figure(fmt::format("volume_change.{}mm.value", mm), 100.0 * gained / volume, "%",
                 between(-5.0, 0.0), "of the ball's volume");
  }
  const Race raced = race(ball, surface, last, bench.context.quick ? 21 : 101);
  const auto us = [&](std::size_t way) { return 1e6 * raced.seconds(way) / kUpdates; };
  bench.cost("update.ours.median", us(0), "us",
             "10,242 vertices, positions and normals, 6 mm deep, thread CPU time");
  bench.cost("update.nothing_skipped.median", us(1), "us", "the same, every vertex computed");
  bench.cost("update.straight.median", us(2), "us", "double loop with std::exp and face-accumulated normals");
  bench.cost("straight_over_ours.median", raced.ratio(2, bench.context.mutated("nothing_skipped") ? 1 : 0),
             "x", at_least(4.0), "paired, interleaved in one run");
  bench.cost("straight_over_nothing_skipped.median", raced.ratio(2, 1), "x",
             "paired, interleaved in one run");
}

const Reads kReads{"dent", {.only = {"object.ball.radius_mm", "tool.stylus.tip_radius_mm"}}};
const Entry kEntry{"dent", "tennis_ball",
                   "the seen surface: contact vertex, volume, time of an update of 10,242 vertices", run};

}  // namespace
}  // namespace enc::bench::dent
