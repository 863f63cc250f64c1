// What the eye sees, measured: where the vertex under the tool goes, how much volume the dent takes, and how
// long a mesh of 10,242 vertices takes, against a straight double loop with face-accumulated normals.
#include "core/dent/dent.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/statistics.h"
#include "core/world/scene.h"
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

// The reference: each vertex pushed in by a Gaussian of the same depth and width, in double, then the
// triangles' area-weighted normals summed up at their corners and normalised. All buffers exist beforehand.
struct Straight {
  const Mesh& mesh;
  std::vector<Vec3> points, normals;
  explicit Straight(const Mesh& ball)
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

struct Times {
  double ours, ours_all, straight, ratio, ratio_all;
};

template <class Update>
double time_of(Update update) {
  constexpr int kUpdates = 20;
  const double start = thread_seconds();
  for (int i = 0; i < kUpdates; ++i) update();
  return (thread_seconds() - start) / kUpdates;
}

// `all`: a dent so wide that every vertex is computed and none is skipped.
Times interleaved(const Mesh& ball, const Surface& surface, const DentSample& dent, int rounds) {
  Cloud cloud(ball);
  Straight straight(ball);
  const Vec3 n = dent.tip.centre.e().normalized();
  const Vec3 contact = surface.nearest(dent.tip.centre).point.e();
  const double radius = std::get<Sphere>(surface.shape()).radius;
  DentField<double> everywhere = dent_field(surface, dent);
  everywhere.reach = 100.0 * radius;
  std::vector<double> ours;
  std::vector<double> all;
  std::vector<double> theirs;
  std::vector<double> ratio;
  std::vector<double> ratio_all;
  for (int i = 0; i <= rounds; ++i) {
    double a = 0;
    double b = 0;
    double c = 0;
    const auto run_ours = [&] { a = time_of([&] { cloud.update(dent_field(surface, dent)); }); };
    const auto run_all = [&] { b = time_of([&] { cloud.update(everywhere); }); };
    const auto run_theirs = [&] {
      c = time_of([&] { straight.update(contact, n, dent.depth, std::sqrt(radius * dent.depth)); });
    };
    if (i % 2 == 0) run_ours();  // who goes first alternates
    run_theirs();
    run_all();
    if (i % 2 != 0) run_ours();
    if (i == 0) continue;  // warm-up
    ours.push_back(a);
    all.push_back(b);
    theirs.push_back(c);
    ratio.push_back(c / a);
    ratio_all.push_back(c / b);
  }
  return {median(ours), median(all), median(theirs), median(ratio), median(ratio_all)};
}

}  // namespace

BenchResult run(const BenchContext& context) {
  BenchResult result{"dent", "tennis_ball", 0, 0, {}};
  const auto add = [&](const std::string& id, double twin, const char* unit, double low, double high,
                       const char* note) {
    result.figures.push_back({id, kUnset, twin, unit, Role::ours, low, high, note});
  };
  const models::Setup setup = load_scene(context, "tennis_ball");
  const Scene scene = prepare(setup.scene, setup.rig);
  const Surface& surface = scene.objects.front().surface;
  const double radius = setup.scene.objects.front().radius;
  const Mesh ball = models::geodesic_ball(32, radius);
  const double volume = 4.0 / 3.0 * M_PI * radius * radius * radius;
  Cloud cloud(ball);
  DentSample last;
  for (const double depth : {0.002, 0.004, 0.006}) {
    // The tool points at a vertex, so that there is one exactly under it.
    const Vec3 n = Vec3(ball.vertices[0][0], ball.vertices[0][1], ball.vertices[0][2]).normalized();
    const double tip_radius = scene.tools.front().tip.radius;
    const Tip<'O'> tip{Point<'O'>(Vec3((radius - depth + tip_radius) * n)), tip_radius};
    last = dent_of(surface, 0, tip);
    const DentField<double> field = dent_field(surface, last);
    cloud.update(field);
    const Vec3 before(cloud.before[0][0], cloud.before[1][0], cloud.before[2][0]);
    const Vec3 after(cloud.after[0][0], cloud.after[1][0], cloud.after[2][0]);
    const auto mm = static_cast<int>(std::lround(1e3 * depth));
    add(fmt::format("dent.contact_error.{}mm.max", mm), 1e6 * ((before - after) - depth * n).norm(), "um",
        kUnset, 1.0, "drawn vertex under the tool against the deflection");
    add(fmt::format("dent.volume_change.{}mm.value", mm), 100.0 * volume_change(ball, field) / volume, "%",
        -5.0, 0.0, "of the ball's volume");
  }
  const Times times = interleaved(ball, surface, last, context.quick ? 21 : 101);
  add("dent.update.ours.median", 1e6 * times.ours, "us", kUnset, kUnset,
      "10,242 vertices, positions and normals, 6 mm deep, thread CPU time");
  add("dent.update.nothing_skipped.median", 1e6 * times.ours_all, "us", kUnset, kUnset,
      "the same, every vertex computed");
  add("dent.update.straight.median", 1e6 * times.straight, "us", kUnset, kUnset,
      "double loop with std::exp and face-accumulated normals");
  add("dent.straight_over_ours.median", times.ratio, "x", 8.0, kUnset, "paired, interleaved in one run");
  add("dent.straight_over_nothing_skipped.median", times.ratio_all, "x", kUnset, kUnset,
      "paired, interleaved in one run");
  return result;
}

}  // namespace enc::bench::dent
