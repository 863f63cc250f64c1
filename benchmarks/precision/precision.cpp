// Error against run time over the whole twin: the effect of time step and integrator on the force on the held
// tool or finger in scenes of both machines, and their cost, beside the shipped setting.
#include "trial/precision/precision.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/precision.h"
#include "trial/trial.h"

namespace enc::bench::precision {
namespace {

constexpr double kGlance = 8e-3;  // s, between two places of a fall
constexpr int kGlances = 25;

// A hand that approaches an object, and the machine that goes to meet it. Encoders with fine counts and
// friction without a jump keep the whole motion smooth.
struct SmoothCase {
  const char* name;
  const char* scene;
  const char* table;  // TOML table of its step
  bool steps;         // the machine moves in microns: only the hand moves smoothly
  std::vector<std::string> set;
};
const std::array<SmoothCase, 2>& smooth() {
  static const std::array<SmoothCase, 2> kSmooth{
      SmoothCase{"hand", "tennis_ball", "truth.world", true, {}},
      SmoothCase{"arm",
                 "wall",
                 "truth.arm",
                 false,
                 {"truth.arm.friction_form=smooth", "truth.arm.counts=[1e9, 1e9, 1e9]"}}};
  return kSmooth;
}

struct Way {
  std::vector<Vec3> at;  // positions of the tool's tip and, unless the machine steps, of the machine's in
                         // turn
  bool touched = false;
};

// The arm falls freely, its motors and friction left out: only MuJoCo's own step acts.
Way falling(const BenchContext& context, const std::string& integrator, double step) {
  trial::Trial trial(
      load_scene(context, "wall", {"truth.arm.friction_form=smooth", "truth.arm.integrator=" + integrator}),
      {.seconds = 1.0});
  sim::Physics& physics = trial.world().physics();
  physics.model()->opt.timestep = step;
  const int tip = physics.id(mjOBJ_BODY, "prop");
  const auto steps = std::lround(kGlance / step);
  Way way;
  for (int glance = 0; glance < kGlances; ++glance) {
    for (int i = 0; i < steps; ++i) mj_step(physics.model(), physics.data());
    mj_kinematics(physics.model(), physics.data());
    way.at.emplace_back(physics.data()->xpos + 3 * tip);
  }
  return way;
}

Way way_of(const BenchContext& context, const SmoothCase& smooth, const std::string& integrator,
           double step) {
  Way way;
  std::vector<std::string> set = smooth.set;
  set.push_back(fmt::format("{}.timestep_us={:g}", smooth.table, step * 1e6));
  set.push_back(fmt::format("{}.integrator={}", smooth.table, integrator));
  trial::TrialOptions options{.seed = context.seed};
  options.seconds = 1.0;  // nothing touches before
  options.watch = [&](const trial::Glance& glance) {
    way.at.push_back(glance.truth.tool_tip.e());
    if (!smooth.steps) way.at.push_back(glance.truth.tip.e());
    way.touched = way.touched || glance.truth.touching;
  };
  trial::Trial trial(load_scene(context, smooth.scene, set), options);
  trial.run();
  return way;
}

// Extrapolates the path to a step of zero. If the twin updates hand and servo once a step, RK4 has a
// first-order error, too: two steps measure it, and the remainder is second-order.
template <class WayWith>
Way converged(const WayWith& way_with, double coarse, bool alone) {
  Way fine = way_with("rk4", coarse / 40.0);
  if (alone) return fine;
  const Way finer = way_with("rk4", coarse / 80.0);
  fine.touched = fine.touched || finer.touched;
  for (std::size_t i = 0; i < fine.at.size(); ++i) fine.at[i] = 2.0 * finer.at.at(i) - fine.at[i];
  return fine;
}

double apart(const Way& a, const Way& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.at.size(); ++i) sum += (a.at[i] - b.at.at(i)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(a.at.size()));
}

// The order of the error in the step for a motion without contact, stiction or counts: theory has one for
// each integrator.
void add_orders(Bench& bench) {
  constexpr double kRounding = 1e-15;  // m
  Table table{"orders", "Error of a path without contact", {"path", "integrator", "timestep_us", "error_um"}};
  const auto fit = [&](const std::string& path, const std::string& integrator, const auto& way_with,
                       bool alone) {
    const double coarse = alone ? kGlance : 1e-3;
    const Way truth = bench.context.mutated("coarse_truth") ? way_with(integrator, coarse)
                                                            : converged(way_with, coarse, alone);
    std::vector<double> steps, errors;
    for (const double parts : {1.0, 2.0, 4.0, 8.0}) {
      steps.push_back(coarse / parts);
      const Way way = way_with(integrator, steps.back());
      errors.push_back(way.touched || truth.touched ? kUnset : apart(way, truth));
      table.add(path, integrator, fmt::format("{:g}", steps.back() * 1e6),
                fmt::format("{:.3g}", errors.back() * 1e6));
    }
    const bool fourth = integrator == "rk4" && alone;
    bench.figure(fmt::format("order.{}.{}", path, integrator), fitted_order(steps, errors, kRounding), "",
                 fourth ? at_least(3.5) : between(0.9, 1.1),
                 alone ? "power of the step with which the error falls: an arm that falls, by itself"
                       : "a hand on its way and the machine that goes to meet it: what the twin adds to the "
                         "physics is taken once a step");
  };
  for (const std::string& integrator : trial::Grid{}.integrators) {
    fit(
        "fall", integrator,
        [&](const std::string& with, double step) { return falling(bench.context, with, step); }, true);
    for (const SmoothCase& one : smooth())
      fit(
          one.name, integrator,
          [&](const std::string& with, double step) { return way_of(bench.context, one, with, step); },
          false);
  }
  bench.table(std::move(table));
}

using trial::PrecisionPoint;

// The judged quantity: the force on the hand, or the path of the tip.
struct Norm {
  const char* name;
  double PrecisionPoint::*error;
  double trial::Accuracy::*most;
  double unit;  // its printed unit: N, um
};
constexpr std::array kNorms{Norm{"force, N", &PrecisionPoint::error, &trial::Accuracy::force, 1.0},
                            Norm{"path, um", &PrecisionPoint::way, &trial::Accuracy::way, 1e-6}};

struct PrecisionAdvice {
  std::string scene;
  const Norm* norm = nullptr;
  const PrecisionPoint *advised = nullptr, *next = nullptr;  // points of the study; null: none
  double asked = kUnset, error = kUnset, next_error = kUnset;
  std::string failure{};  // failure of a judging run
  [[nodiscard]] bool meets() const { return error <= asked; }
  [[nodiscard]] bool has_next() const { return !std::isnan(next_error); }
  [[nodiscard]] bool next_fails() const { return next_error > asked; }
};

// A plausible requested error that separates settings: the middle of the widest gap, by ratio, between the
// error of a setting and those of all cheaper ones. Without a wide gap: 1.5 times the error of the cheapest.
double asked_of(const std::vector<PrecisionPoint>& points, double PrecisionPoint::*error) {
  constexpr double kWide = 1.3;
  const PrecisionPoint* least = nullptr;
  double asked = kUnset, widest = kWide;
  for (const PrecisionPoint& point : points) {
    if (!point.failure.empty()) continue;
    if (least == nullptr || point.cost() < least->cost()) least = &point;
    double best = kUnset;  // least error of the cheaper ones
    for (const PrecisionPoint& other : points)
      if (other.failure.empty() && other.cost() * trial::kAsDear < point.cost() && !(best <= other.*error))
        best = other.*error;
    if (!(best > widest * point.*error)) continue;
    widest = best / point.*error;
    asked = std::sqrt(best * point.*error);
  }
  return std::isnan(asked) && least != nullptr ? 1.5 * least->*error : asked;
}

std::string words(const PrecisionPoint* point) {
  return point != nullptr ? fmt::format("{} at {:g} us", point->integrator, point->step * 1e6) : "-";
}

bool same(const PrecisionPoint& a, const PrecisionPoint& b) {
  return a.integrator == b.integrator && std::abs(a.step - b.step) < 1e-9;
}

// Repeats these points, judged by RK4 at an eightieth of a period.
std::vector<PrecisionPoint> again(const BenchContext& context, const ForceStudy& study,
                                  const std::vector<const PrecisionPoint*>& points) {
  trial::PrecisionOptions options;
  options.rounds = 1;
  options.converged = 80;
  std::set<std::string> integrators;
  std::set<int> parts;
  for (const PrecisionPoint* point : points) {
    integrators.insert(point->integrator);
    parts.insert(static_cast<int>(std::lround(study.all.tick / point->step)));
  }
  options.grid = {{integrators.begin(), integrators.end()}, {parts.begin(), parts.end()}};
  options.shipped_too = false;
  options.twice = false;
  return force_study(context, study.scene, {}, options).all.points;
}

std::vector<PrecisionAdvice> carried_out(const BenchContext& context, const ForceStudy& study) {
  std::vector<PrecisionAdvice> all;
  std::vector<const PrecisionPoint*> points;
  for (const Norm& norm : kNorms) {
    PrecisionAdvice one{study.scene, &norm};
    one.asked = asked_of(study.all.points, norm.error);
    trial::Accuracy most;
    most.*norm.most = one.asked;
    one.advised = trial::cheapest(study.all.points, most);
    if (one.advised != nullptr) one.next = trial::next_cheaper(study.all.points, *one.advised);
    for (const PrecisionPoint* point : {one.advised, one.next})
      if (point != nullptr) points.push_back(point);
    all.push_back(std::move(one));
  }
  const std::vector<PrecisionPoint> judged = again(context, study, points);
  const auto error_of = [&](PrecisionAdvice& one, const PrecisionPoint* point) {
    if (point == nullptr) return kUnset;
    const auto at =
        std::find_if(judged.begin(), judged.end(), [&](const auto& j) { return same(j, *point); });
    if (!at->failure.empty()) one.failure = at->failure;
    return at->failure.empty() ? *at.*one.norm->error : kUnset;
  };
  for (PrecisionAdvice& one : all) {
    one.error = error_of(one, one.advised);
    one.next_error = error_of(one, one.next);
  }
  return all;
}

// Follows the advice of `check --advise`: judged by a converged run of another step.
void add_advice(Bench& bench, const std::vector<ForceStudy>& studies) {
  const std::vector<std::vector<PrecisionAdvice>> all =
      bench.each(studies, [&](const ForceStudy& study) { return carried_out(bench.context, study); });
  Table table{"advice",
              "Advice carried out: errors by another converged run",
              {"scene", "error of", "asked", "advised", "errs by", "next cheaper", "errs by", "judged"}};
  table.printed = true;
  std::size_t asked = 0, meets = 0, with_next = 0, next_fails = 0;
  for (const std::vector<PrecisionAdvice>& scene : all)
    for (const PrecisionAdvice& one : scene) {
      ++asked;
      meets += one.meets() ? 1 : 0;
      with_next += one.has_next() ? 1 : 0;
      next_fails += one.next_fails() ? 1 : 0;
      const auto printed = [&](double error) {
        return std::isnan(error) ? "-" : fmt::format("{:.4g}", error / one.norm->unit);
      };
      const bool holds = one.meets() && (!one.has_next() || one.next_fails());
      table.add(one.scene, one.norm->name, printed(one.asked), words(one.advised), printed(one.error),
                words(one.next), printed(one.next_error),
                !one.failure.empty() ? one.failure
                : holds              ? "holds"
                                     : "does not");
    }
  bench.figure("advice.meets", static_cast<double>(meets) / static_cast<double>(asked), "", at_least(0.9),
               fmt::format("share of {} pieces of advice in which the advised setting errs by no more than "
                           "was asked, by another converged run",
                           asked));
  bench.figure(
      "advice.next_fails", static_cast<double>(next_fails), "", at_least(10.0),
      fmt::format("of {} that have a next cheaper setting: it errs by more than was asked", with_next));
  bench.table(std::move(table));
}

struct Machine {
  const char* name;
  std::vector<std::string> scenes;
};
const std::array<Machine, 2>& machines() {
  static const std::array<Machine, 2> kMachines{
      Machine{"hexapod", {"session", "training", "tennis_ball", "plane", "stiffness"}},
      Machine{"arm", {"reaching", "wall", "keypad", "tiles", "drum", "button", "hit_ball", "room"}}};
  return kMachines;
}

// A mutant: the force of 100 ms ago beside the judge's.
class LateForce final : public trial::Quantities {
 public:
  explicit LateForce(const models::Setup& setup) {
    constexpr double kJudge = 50e-6;  // s: the judges have smaller steps
    if (setup.twin.stepping(setup.scene).timestep > kJudge) force_.resize(late_ = 100);
  }
  void see(const trial::Glance& glance) override { force_.push_back(glance.truth.contact_force.norm()); }
  [[nodiscard]] std::vector<double> all() const override { return {force_.begin(), force_.end() - late_}; }

 private:
  std::ptrdiff_t late_ = 0;  // ticks
  std::vector<double> force_;
};

ForceStudy study_of(const BenchContext& context, const std::string& scene) {
  trial::PrecisionOptions options;
  options.rounds = context.full ? 3 : 1;
  if (context.mutated("late_force"))
    options.quantities = [](const models::Setup& setup, trial::TrialOptions&) {
      return std::make_unique<LateForce>(setup);
    };
  return force_study(context, scene, {}, options);
}

// Combines all scenes of a machine, which share one rig. Error: the worst of each setting over its scene's
// bound. Cost: relative to the shipped setting, the median of the scenes.
std::vector<trial::PrecisionPoint> together(const std::vector<ForceStudy>& studies) {
  std::vector<trial::PrecisionPoint> all = studies.front().all.points;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<double> cost;
    all[i].error = 0.0;
    for (const ForceStudy& study : studies) {
      const std::vector<trial::PrecisionPoint>& points = study.all.points;
      const trial::PrecisionPoint* shipped = trial::shipped(points);
      const trial::PrecisionPoint& point = points[i];
      if (!point.failure.empty()) all[i].failure = study.scene + ": " + point.failure;
      all[i].error = std::max(all[i].error, point.error / accuracy_of(study.all));
      if (shipped != nullptr) cost.push_back(point.cost() / shipped->cost());
    }
    all[i].cpu = cost.empty() ? kUnset : median(cost);
    all[i].yards = kUnset;
  }
  return all;
}

// The largest of the scenes' floors, as a share of what each scene is allowed.
double floor_of(const std::vector<ForceStudy>& studies) {
  double most = 0.0;
  for (const ForceStudy& study : studies)
    most = std::max(most, study.all.second.error / accuracy_of(study.all));
  return most;
}

void add_plot(Bench& bench, const Machine& machine, const std::vector<ForceStudy>& studies,
              const std::vector<trial::PrecisionPoint>& all) {
  bench.plot(force_plot(
      {.id = machine.name,
       .title =
           fmt::format("Error against run time: {} scenes of the {}", machine.scenes.size(), machine.name),
       .x_label = "CPU time over that of what ships",
       .y_label = "force error over what a scene shall hold",
       .caption =
           fmt::format("True force while something touches, against a converged run of the same hand; steps "
                       "of a whole haptic period (left) to an eighth (right). A scene shall hold {:g} N, or "
                       "twice what two converged runs differ by. What failed stands at the upper edge.",
                       kForceAccuracy)},
      all, &trial::PrecisionPoint::cpu, {{"allowed", 1.0}, {"floor, largest", floor_of(studies)}}));
}

void add_machine(Bench& bench, const Machine& machine, const std::vector<ForceStudy>& studies, Table& table) {
  for (const ForceStudy& study : studies) {
    const auto& points = study.all.points;
    for (const trial::PrecisionPoint& point : points)
      table.add(study.scene, point.integrator, fmt::format("{:g}", point.step * 1e6),
                point.failure.empty() ? fixed(point.error, 4) : "",
                point.failure.empty() ? fixed(point.way * 1e6, 2) : "", fixed(1.0 / point.cpu, 0),
                point.shipped ? "ships" : "", point.failure);
    const trial::PrecisionPoint* shipped = trial::shipped(points);
    if (shipped == nullptr) continue;  // --set has replaced its step
    bench.figure(study.scene + ".error.rms", shipped->error, "N", at_most(accuracy_of(study.all)),
                 fmt::format("force at what ships, {} at {:g} us; two converged runs differ by {:.4f} N",
                             shipped->integrator, shipped->step * 1e6, study.all.second.error));
    bench.figure(study.scene + ".path.rms", shipped->way * 1e6, "um",
                 fmt::format("the tip's path; the two by {:.2f}", study.all.second.way * 1e6));
  }
  const std::vector<trial::PrecisionPoint> all = together(studies);
  const trial::PrecisionPoint* best = cheapest(all, {1.0});
  const trial::PrecisionPoint* shipped = trial::shipped(all);
  add_plot(bench, machine, studies, all);
  if (shipped == nullptr || bench.context.quick) return;  // a single scene is not enough
  bench.cost(fmt::format("{}.default_over_cheapest.cpu", machine.name),
             best != nullptr ? 1.0 / best->cpu : kUnset, "x",
             best != nullptr
                 ? fmt::format("the cheapest setting that all of its scenes hold with: {} at {:g} us",
                               best->integrator, best->step * 1e6)
                 : "no setting holds in all of its scenes");
}

void run(Bench& bench) {
  Table table{
      "points",
      "Error against run time",
      {"scene", "integrator", "timestep_us", "force_N", "path_um", "times_real_time", "ships", "failure"}};
  std::vector<std::string> scenes;
  for (const Machine& machine : machines())
    for (const std::string& scene : machine.scenes)
      if (!bench.context.quick || scene == machine.scenes.back()) scenes.push_back(scene);
  const std::vector<ForceStudy> studies =
      bench.each(scenes, [&](const std::string& scene) { return study_of(bench.context, scene); });
  for (const Machine& machine : machines()) {
    std::vector<ForceStudy> own;
    for (const ForceStudy& study : studies)
      if (std::find(machine.scenes.begin(), machine.scenes.end(), study.scene) != machine.scenes.end())
        own.push_back(study);
    add_machine(bench, machine, own, table);
  }
  bench.table(std::move(table));
  add_orders(bench);
  if (bench.context.full) add_advice(bench, studies);
}

const Reads kReads{"precision", {.scenes = {"*"}}};
const Entry kEntry{"precision", "the twin", "error against run time, both machines: integrator and time step",
                   run};

}  // namespace
}  // namespace enc::bench::precision
