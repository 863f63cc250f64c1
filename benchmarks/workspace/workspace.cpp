// Workspace of the machine: box and true volume of its travel, and the tracker's reach. Also the directions
// from which the ball can be pressed (not from below, with the reason) [VHMR 2, 5].
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/workspace/reach_volume.h"
#include "core/base/units.h"
#include "core/control/scene/press_check.h"
#include "models/setup/scene_file.h"

namespace enc::bench::workspace {
namespace {

void add(BenchResult& result, const std::string& id, double paper, double twin, const char* unit, Role role,
         double low, double high, const std::string& note, double error = kUnset) {
  Figure figure{"workspace." + id, paper, twin, unit, role, low, high, note};
  if (!std::isnan(error)) figure.least = twin - error, figure.most = twin + error;
  result.figures.push_back(std::move(figure));
}

// The paper's box determined the machine's geometry (sources/hexapod 2), so it is no prediction.
void add_box(BenchResult& result, const ReachVolume& reach) {
  constexpr std::array<double, 3> kPaper{160.0, 140.0, 50.0};  // mm [VHMR 2]
  const ReachVolume::Extents e = reach.extents();
  const Vec3 size = e.high - e.low;
  for (Eigen::Index a = 0; a < 3; ++a) {
    const double paper = kPaper[static_cast<std::size_t>(a)];
    add(result, fmt::format("box.{}.extent", "xyz"[a]), paper, size(a) * kMmPerM, "mm", Role::calibrated,
        0.95 * paper, 1.05 * paper,
        fmt::format("from {:.1f} to {:.1f} mm, the other two free, straight axes", e.low(a) * kMmPerM,
                    e.high(a) * kMmPerM));
  }
  add(result, "box.volume", 1.12e-3, size.prod(), "m3", Role::calibrated, 0.95 * 1.12e-3, 1.05 * 1.12e-3,
      "product of the three: a box around the reach, most of which is not reached");
  // Translation of an omega.6: a cylinder of 160 mm by 110 mm (vendor's sheet, from memory).
  constexpr double kOmega6 = std::numbers::pi * 0.08 * 0.08 * 0.11;  // m3
  add(result, "omega6.share", 0.5, size.prod() / kOmega6, "", Role::predicted, 0.45, 0.55,
      "of the workspace of a Force Dimension omega.6, which a held stylus needs for free motion, too; the "
      "paper: almost half [VHMR 5]");
}

// Halving the step estimates the remaining error of the last value.
template <class Volume>
std::array<double, 3> converged(Table& table, const char* what, double step, int halvings, Volume volume) {
  double before = kUnset, now = volume(step);
  for (int i = 0; i < halvings; ++i) {
    table.rows.push_back({what, fmt::format("{:g}", step * kMmPerM), fmt::format("{:.4e}", now),
                          i == 0 ? "" : fixed(100.0 * (now / before - 1.0), 2)});
    step /= 2.0;
    before = now;
    now = volume(step);
  }
  table.rows.push_back({what, fmt::format("{:g}", step * kMmPerM), fmt::format("{:.4e}", now),
                        fixed(100.0 * (now / before - 1.0), 2)});
  return {now, std::abs(now - before), step};
}

void add_volumes(const BenchContext& context, BenchResult& result, const ReachVolume& reach) {
  Table table{"workspace_convergence",
              "Volumes over the step of their grids",
              {"volume", "step (mm)", "m3", "change (%)"},
              {},
              "Midpoint rule over x and y. Straight: heights in closed form. Turned: heights found by "
              "bisection with a search for the best allowed turn, which may miss some."};
  const auto straight = converged(table, "straight", 4e-3, context.quick ? 1 : 3,
                                  [&](double step) { return reach.straight(step); });
  const auto turned = converged(table, "turned", context.quick ? 32e-3 : 24e-3, context.full ? 2 : 1,
                                [&](double step) { return reach.turned(step); });
  const double box = result.figures.back().twin;
  add(result, "straight.volume", kUnset, straight[0], "m3", Role::ours, kUnset, kUnset,
      fmt::format("where the tip gets with W's axes, which is how it is commanded; {:g} mm grid, range: "
                  "change at the last halving",
                  straight[2] * kMmPerM),
      straight[1]);
  add(result, "straight_of_box.percent", kUnset, 100.0 * straight[0] / box, "%", Role::ours, kUnset, kUnset,
      "the true volume is that share of the box; the paper's 1.12e-3 m3 is the box");
  add(result, "turned.volume", kUnset, turned[0], "m3", Role::ours, kUnset, kUnset,
      fmt::format(
          "with the best tilt and yaw within the machine's limits, {:g} mm grid; not used by the core",
          turned[2] * kMmPerM),
      turned[1]);
  result.tables.push_back(std::move(table));
}

void add_tracker(BenchResult& result, const models::Setup& setup, const Scene& scene) {
  const Vec3& size = setup.rig.tracker.volume;
  double farthest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 at =
        0.5 * size.cwiseProduct(Vec3(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1));
    farthest = std::max(farthest, (at - scene.X_WC.p()).norm());
  }
  add(result, "tracker.farthest.max", kUnset, farthest, "m", Role::ours, kUnset, 1.4,
      fmt::format("from C to the farthest corner of rig.tracker.volume_mm, {:g} x {:g} x {:g}; 0.09 mm "
                  "accuracy holds up to 1.4 m [VHMR 2]",
                  size.x() * kMmPerM, size.y() * kMmPerM, size.z() * kMmPerM));
}

// Directions from which a sphere is pressed, to its full depth.
struct Direction {
  double azimuth, polar;  // deg
  bool reached;
  Obstacle obstacle;
};
std::vector<Direction> directions(const Scene& scene, const Point<'W'>& centre, double step) {
  std::vector<Direction> all;
  const Object& ball = scene.objects.front();
  const int rows = static_cast<int>(std::lround(180.0 / step));
  all.reserve(static_cast<std::size_t>(2 * rows * rows));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < 2 * rows; ++column) {
      const double polar = (row + 0.5) * step;
      const double azimuth = (column + 0.5) * step;
      const Vec<'W'> n(std::sin(polar * kDegree) * std::cos(azimuth * kDegree),
                       std::sin(polar * kDegree) * std::sin(azimuth * kDegree), std::cos(polar * kDegree));
      const PressPoint press{centre + ball.radius * n, n};
      all.push_back({azimuth, polar, carried_to(scene, press, 0.0) && carried_to(scene, press, ball.limit),
                     in_the_way(scene, n, scene.tools.front())});
    }
  return all;
}
// Share of the sphere, %, by area.
template <class Which>
double share(const std::vector<Direction>& all, Which which) {
  double sum = 0.0, part = 0.0;
  for (const Direction& d : all) {
    sum += std::sin(d.polar * kDegree);
    if (which(d)) part += std::sin(d.polar * kDegree);
  }
  return sum > 0.0 ? 100.0 * part / sum : kUnset;
}

bool is_allowed(const Direction& d) { return d.reached && d.obstacle == Obstacle::none; }
bool is_below(const Direction& d) { return d.polar > 150.0; }

void add_map(BenchResult& result, const std::vector<Direction>& all, const char* id, const char* title,
             const char* caption) {
  Plot plot{id, title, "azimuth, deg", "polar, deg (0: from above)", false, false, {}, caption};
  const auto series = [&](const char* name, auto which) {
    Series s{.name = name, .mark = Mark::points};
    for (const Direction& d : all)
      if (which(d)) s.x.push_back(d.azimuth), s.y.push_back(d.polar);
    if (!s.x.empty()) plot.series.push_back(std::move(s));
  };
  series("allowed", is_allowed);
  series("out of reach", [](const Direction& d) { return !d.reached && d.obstacle == Obstacle::none; });
  series("stem in the way", [](const Direction& d) { return d.reached && d.obstacle == Obstacle::stem; });
  series("gripper or platform in the way",
         [](const Direction& d) { return d.reached && d.obstacle > Obstacle::stem; });
  series("out of reach, and the machine in the way",
         [](const Direction& d) { return !d.reached && d.obstacle != Obstacle::none; });
  result.plots.push_back(std::move(plot));
}

void add_directions(const BenchContext& context, BenchResult& result, const Scene& scene) {
  const double step = context.quick ? 7.5 : 2.5;  // deg
  const Point<'W'> centre = scene.objects.front().X_WO.origin();
  const std::vector<Direction> all = directions(scene, centre, step);
  const std::string grid = fmt::format("of the sphere; {:g} deg grid", step);
  add(result, "directions.allowed.percent", kUnset, share(all, is_allowed), "%", Role::ours, kUnset, kUnset,
      grid);
  add(result, "directions.reach.percent", kUnset, share(all, [](const Direction& d) { return d.reached; }),
      "%", Role::ours, kUnset, kUnset, grid + ", by the reach alone");
  double whole = 180.0;
  for (const Direction& d : all)
    if (!is_allowed(d)) whole = std::min(whole, d.polar - 0.5 * step);
  add(result, "polar.allowed.max", kUnset, whole, "deg", Role::ours, kUnset, kUnset,
      "off straight down, allowed from all sides", 0.5 * step);
  const double steepest = steepest_press(scene, scene.tools.front());
  add(result, "directions.machine.percent", kUnset, 50.0 * (1.0 - std::cos(steepest)), "%", Role::ours,
      kUnset, kUnset, "of the sphere with nothing of the machine in the way, wherever the ball is");
  add(result, "polar.machine.max", kUnset, steepest / kDegree, "deg", Role::ours, kUnset, kUnset,
      "from there on the stem is in the tool's way, wherever the ball is");

  // The reach alone is not the reason: with a higher ball, the tip would get to its lower side.
  const Point<'W'> raised(centre.xyz[0], centre.xyz[1], 0.5 * scene.objects.front().radius);
  std::vector<Direction> below = directions(scene, raised, step);
  constexpr double kDrawn = 7.5;  // deg: spacing at which drawn points stay distinct
  add_map(result, directions(scene, centre, kDrawn), "workspace_directions",
          "From where can the ball be pressed?",
          "The ball of the scene, pressed to its limit along its radius. From the side and from below its "
          "surface is out of the tip's reach.");
  add_map(result, directions(scene, raised, kDrawn), "workspace_directions_raised",
          "From where, if the ball stood higher?",
          "Its centre half a radius above W: now its lower side is in reach. From further below than its "
          "stem allows it still cannot be pressed, because the stem would be in the tool's way.");
  std::erase_if(below, [](const Direction& d) { return !is_below(d); });
  add(result, "below.refused.percent", 100.0, share(below, [](const Direction& d) { return !is_allowed(d); }),
      "%", Role::predicted, 100.0, 100.0,
      "of the directions within 30 deg of straight up, the ball raised until its lower side is in reach; the "
      "paper: one cannot indent the ball from below [VHMR 5]");
  add(result, "below.reach.percent", kUnset, share(below, [](const Direction& d) { return d.reached; }), "%",
      Role::ours, kUnset, kUnset, "of the same, by the reach alone: it is the stem that refuses");
}

// Outline of the straight reach in the plane of W's z and x, or of z and y.
Series upright_outline(const ReachVolume& reach, bool along_x) {
  Series edge{"reach, straight axes"};
  std::vector<std::array<double, 2>> lower;
  for (int i = -200; i <= 200; ++i) {
    const double at = i * 0.5e-3;  // m
    const auto c = along_x ? reach.column(at, 0.0) : reach.column(0.0, at);
    if (c.high < c.low) continue;
    edge.x.push_back(at * kMmPerM), edge.y.push_back(c.high * kMmPerM);
    lower.push_back({at * kMmPerM, c.low * kMmPerM});
  }
  for (auto p = lower.rbegin(); p != lower.rend(); ++p) edge.x.push_back((*p)[0]), edge.y.push_back((*p)[1]);
  if (!edge.x.empty()) edge.x.push_back(edge.x.front()), edge.y.push_back(edge.y.front());
  return edge;
}

// Points of the same plane that the tip reaches with some turn.
Series upright_turned(const ReachVolume& reach, bool along_x) {
  Series turned{.name = "reach, any allowed turn", .mark = Mark::points};
  for (int i = -22; i <= 22; ++i)
    for (int j = -10; j <= 10; ++j) {
      const double at = i * 5e-3;  // m
      const double z = j * 5e-3;
      const Vec3 p = along_x ? Vec3(at, 0, z) : Vec3(0, at, z);
      if (reach.turned_slack(p) >= 0.0) turned.x.push_back(at * kMmPerM), turned.y.push_back(z * kMmPerM);
    }
  return turned;
}

// The slice from above at the height z, m.
Series plan_outline(const ReachVolume& reach, double z) {
  Series edge{fmt::format("z = {:g} mm", z * kMmPerM)};
  for (int degree = 0; degree <= 360; degree += 2) {
    const Vec3 out(std::cos(degree * kDegree), std::sin(degree * kDegree), 0.0);
    double in = 0.0;  // the slice is one piece around the axis: step outwards until it ends
    while (in < 0.12) {
      const auto c = reach.column((in + 0.25e-3) * out.x(), (in + 0.25e-3) * out.y());
      if (z < c.low || z > c.high) break;
      in += 0.25e-3;
    }
    edge.x.push_back(in * out.x() * kMmPerM), edge.y.push_back(in * out.y() * kMmPerM);
  }
  return edge;
}

// The paper's box around the middle, with its half sides, mm.
Series paper_box(double half_x, double half_y) {
  Series box{"paper's box",
             {-half_x, half_x, half_x, -half_x, -half_x},
             {-half_y, -half_y, half_y, half_y, -half_y}};
  box.paper = true;
  return box;
}

// Outlines of the reach in the planes through W's axes, with the paper's box.
void add_slices(BenchResult& result, const ReachVolume& reach) {
  const auto upright = [&](const char* id, const char* title, const char* label, bool along_x, double half) {
    result.plots.push_back(
        {id,
         title,
         label,
         "z, mm",
         false,
         false,
         {upright_turned(reach, along_x), upright_outline(reach, along_x), paper_box(half, 25)},
         "The box touches the reach; it is not in it."});
  };
  upright("workspace_xz", "Reach of the haptic-tip, y = 0", "x, mm", true, 80.0);
  upright("workspace_yz", "Reach of the haptic-tip, x = 0", "y, mm", false, 70.0);

  Plot plan{"workspace_xy",
            "Reach of the haptic-tip from above, straight axes",
            "x, mm",
            "y, mm",
            false,
            false,
            {},
            "Horizontal slices. Below -13 mm they fall into pieces, see the sections."};
  for (const double z : {-0.010, 0.0, 0.010, 0.020}) plan.series.push_back(plan_outline(reach, z));
  plan.series.push_back(paper_box(80, 70));
  result.plots.push_back(std::move(plan));
}

void run(Bench& bench) {
  const BenchContext& context = bench.context;
  BenchResult& result = bench.result;
  const models::Setup setup = load_scene(context, "tennis_ball");
  const Scene scene = prepare(setup.scene, setup.rig);
  const ReachVolume reach(scene.reach.machine);
  add_box(result, reach);
  add_volumes(context, result, reach);
  if (context.progress) context.progress(0.6);
  add_tracker(result, setup, scene);
  add_directions(context, result, scene);
  add_slices(result, reach);
  result.note =
      "Nothing here runs in time: geometry alone. The tip's commands keep W's axes, so 'straight' is what a "
      "scene can use.";
}

}  // namespace

const Reads kReads{
    "workspace",
    {.only = {"rig.manipulator.geometry", "rig.manipulator.tip_radius_mm", "rig.manipulator.stem_radius_mm",
              "rig.manipulator.stem_length_mm", "rig.manipulator.gripper_radius_mm", "rig.tracker.volume_mm",
              "rig.frames.W_C", "object.ball.position_mm", "object.ball.radius_mm", "object.ball.limit_mm",
              "tool.stylus.tip_mm", "tool.stylus.tip_radius_mm", "tool.stylus.markers_mm"}}};
const Entry kEntry{
    "workspace", "tennis_ball",
    "box and volume of the tip's travel, tracker's reach, directions from which the ball can be pressed",
    run};

}  // namespace enc::bench::workspace
