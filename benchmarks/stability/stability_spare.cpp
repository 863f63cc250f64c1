// The passivity controller of the hexapod in the twin, where what it renders is softer than its loop bears:
// what a hand gets out, by the truth of the twin; and what the controller costs at the shipped ball.
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/stability/stability.h"
#include "benchmarks/stiffness/push_study.h"
#include "core/control/task/render/render.h"
#include "trial/measure/passivity_measure.h"
#include "trial/measure/press_measure.h"
#include "trial/trial.h"

namespace enc::bench::stability {
namespace {

// A hand, and the one that the rig expects, N/m and N s/m.
struct SpareHand {
  double stiffness, damping, believed;
};
struct Pushes {
  double out = 0.0;    // J: more than in, at any moment of a contact, true
  double put = 0.0;    // J, the most that a contact held
  double swing = 0.0;  // m, peak to peak, of the tip while it is held
  std::int64_t bounces = 0;
};

// J and m, tick by tick. A contact lasts until the tip is back.
class Watch {
 public:
  explicit Watch(Pushes& all) : all_(all) {}
  void see(const trial::Glance& glance) {
    const sim::Truth& truth = glance.truth;
    const bool on = glance.out.mode == Mode::contact || glance.out.mode == Mode::restore;
    given_ = on ? given_ - truth.work.contact : 0.0;
    all_.out = std::max(all_.out, given_);
    all_.put = std::max(all_.put, -given_);
    const double pushed = truth.contact_force.norm();
    const bool held = truth.phase == sim::Phase::hold;
    if (held && before_ > 0.0 && pushed == 0.0) ++all_.bounces;
    before_ = pushed;
    ticks_ = held ? ticks_ + 1 : 0;
    if (ticks_ == 0) low_ = -(high_ = -HUGE_VAL);
    if (ticks_ < 1000) return;  // it settles
    low_ = std::min(low_, truth.tip.xyz[2]);
    high_ = std::max(high_, truth.tip.xyz[2]);
    all_.swing = std::max(all_.swing, high_ - low_);
  }

 private:
  Pushes& all_;
  double given_ = 0.0, before_ = 0.0, low_ = HUGE_VAL, high_ = -HUGE_VAL;
  int ticks_ = 0;
};

Pushes pushed(const BenchContext& context, double object, const SpareHand& grip, bool controlled) {
  const models::Setup setup = stiffness::with_stiffness(
      stiffness::push_setup(context.models, {},
                            {fmt::format("truth.pusher.stiffness_N_per_mm={}", grip.stiffness * 1e-3),
                             fmt::format("truth.pusher.damping_Ns_per_m={}", grip.damping),
                             fmt::format("rig.contact.hand_stiffness_N_per_mm={}", grip.believed * 1e-3),
                             fmt::format("rig.contact.hand_damping_Ns_per_m={}", grip.damping),
                             "pusher.hold_s=6", fmt::format("pusher.repeats={}", context.quick ? 2 : 12),
                             fmt::format("rig.admittance.passivity={}", controlled ? "controlled" : "none")}),
      object);
  Pushes all;
  Watch watch(all);
  trial::TrialOptions options;
  options.seed = context.seed;
  options.work = true;
  options.watch = [&](const trial::Glance& glance) { watch.see(glance); };
  trial::Trial(setup, std::move(options)).run();
  return all;
}

struct SparePush {
  double object;
  SpareHand grip;
  Pushes off{}, on{};
};

// What the shipped ball is felt like.
struct Ball {
  double press, release, in, out, acted;  // N, N, J, J, s
};
Ball ball(const BenchContext& context, bool controlled) {
  const models::Setup setup =
      load_scene(context, "tennis_ball",
                 {fmt::format("rig.admittance.passivity={}", controlled ? "controlled" : "none")});
  trial::PressMeasure presses(setup);
  trial::PassivityMeasure passivity;
  trial::TrialOptions options;
  options.seed = context.seed;
  options.watch = [&](const trial::Glance& glance) {
    presses.see(glance);
    passivity.see(glance);
  };
  trial::Trial(setup, std::move(options)).run();
  return {presses.rmse_press(), presses.rmse_release(), presses.energy_in(), presses.energy_out(),
          passivity.worst().acted};
}

void add_ball(Bench& bench) {
  const Ball off = ball(bench.context, false), on = ball(bench.context, true);
  bench.figure(
      "spare.ball.press", on.press - off.press, "N", between(-0.02, 0.02),
      fmt::format("what the controller adds to the error of the press, RMSE, of {:.3f} N", off.press));
  bench.figure("spare.ball.release", on.release - off.release, "N", between(-0.02, 0.02),
               fmt::format("and of the release, of {:.3f} N", off.release));
  bench.figure("spare.ball.energy", 100.0 * (on.out / off.out - 1.0), "%", between(-1.0, 1.0),
               fmt::format("to what the ball gives back, of {:.1f} mJ", 1e3 * off.out));
  bench.figure("spare.ball.acted", 1e3 * on.acted, "ms", "in which it held the tip back, of five presses");
}

// J that came out of a contact more than was put in, at any moment of it, the most of all: by forces and ways
// of the truth, along its normal and across it.
struct GivenOut {
  double along = 0.0, across = 0.0;
};

class ContactWork {
 public:
  void see(const trial::Glance& glance) {
    const bool on = glance.out.mode == Mode::contact || glance.out.mode == Mode::restore;
    const Vec3 tip = glance.truth.tip.e(), force = glance.truth.contact_force.e();
    if (on) {
      const Vec3 normal = (recall<Rendering>(*glance.state).contact.X_WN * Vec<'N'>(0, 0, 1)).e();
      const Vec3 mean = 0.5 * (force + force_), way = tip - tip_;
      const double along = mean.dot(normal) * way.dot(normal);
      now_ = {now_.along - along, now_.across - (mean.dot(way) - along)};
      most_ = {std::max(most_.along, now_.along), std::max(most_.across, now_.across)};
    } else {
      now_ = GivenOut{};
    }
    tip_ = tip;
    force_ = force;
  }
  [[nodiscard]] const GivenOut& most() const { return most_; }

 private:
  GivenOut now_, most_;
  Vec3 tip_ = Vec3::Zero(), force_ = Vec3::Zero();
};

struct Lesson {
  std::string scene;
  std::uint64_t seed;
  bool controlled;
  GivenOut given{};
};

// Scenes that ship, with their hands that reach, bounce and tremble.
void add_sessions(Bench& bench) {
  const BenchContext& context = bench.context;
  std::vector<Lesson> lessons;
  for (const char* scene : {"session", "training"})
    for (std::uint64_t i = 0; i < (context.quick ? 1U : context.full ? 16U : 4U); ++i)
      for (const bool controlled : {false, true}) lessons.push_back({scene, context.seed + i, controlled});
  lessons = bench.each(lessons, [&](const Lesson& asked) {
    Lesson lesson = asked;
    ContactWork work;
    trial::TrialOptions options;
    options.seed = asked.seed;
    options.watch = [&](const trial::Glance& glance) { work.see(glance); };
    trial::Trial(
        load_scene(context, asked.scene,
                   {fmt::format("rig.admittance.passivity={}", asked.controlled ? "controlled" : "none")}),
        std::move(options))
        .run();
    lesson.given = work.most();
    return lesson;
  });
  for (const char* scene : {"session", "training"}) {
    std::array<GivenOut, 2> most;
    for (const Lesson& one : lessons) {
      if (one.scene != scene) continue;
      GivenOut& all = most.at(one.controlled ? 1 : 0);
      all = {worse(all.along, one.given.along), worse(all.across, one.given.across)};
    }
    const std::string key = std::string("spare.") + scene;
    bench.figure(
        key + ".energy.max", 1e3 * most[1].along, "mJ", at_most(0.1),
        fmt::format("the same of the scene {} as it ships, along the normal of each contact", scene));
    bench.figure(key + ".none.energy.max", 1e3 * most[0].along, "mJ", "without the controller");
    bench.figure(key + ".across.max", 1e3 * most[1].across, "mJ",
                 "across it, where the tip goes under its tool and takes it along; nothing controls that");
  }
}

}  // namespace

void add_spare(Bench& bench) {
  std::vector<SparePush> rows;
  for (const SpareHand& grip : {SpareHand{130.0, 2.0, 130.0}, SpareHand{700.0, 4.0, 700.0},
                                SpareHand{2000.0, 8.0, 2000.0}, SpareHand{2000.0, 8.0, 700.0}})
    for (const double object : {10.0, 30.0, 100.0, 1000.0}) rows.push_back({object, grip});
  rows = bench.each(rows, [&](const SparePush& row) {
    SparePush found = row;
    found.off = pushed(bench.context, row.object, row.grip, false);
    found.on = pushed(bench.context, row.object, row.grip, true);
    return found;
  });
  Table table{"spare",
              "Energy that a hand gets out of what the hexapod renders",
              {"hand (N/m)", "believed (N/m)", "K (N/m)", "out (mJ)", "in (mJ)", "swing (mm)", "bounces",
               "controlled: out (mJ)", "in (mJ)", "swing (mm)", "bounces"},
              {},
              "Pushed 15 mm deep and held for 6 s, 12 times. Out: more than in, at any moment of a contact; "
              "in: the most that it held."};
  double with = 0.0, without = 0.0, mistaken = 0.0, firm = 0.0;
  std::int64_t bounces = 0;
  for (const SparePush& r : rows) {
    table.add(r.grip.stiffness, r.grip.believed, r.object, fmt::format("{:.3f}", r.off.out * 1e3),
              fmt::format("{:.1f}", r.off.put * 1e3), fmt::format("{:.2f}", r.off.swing * 1e3), r.off.bounces,
              fmt::format("{:.4f}", r.on.out * 1e3), fmt::format("{:.1f}", r.on.put * 1e3),
              fmt::format("{:.2f}", r.on.swing * 1e3), r.on.bounces);
    const bool known = r.grip.believed >= r.grip.stiffness;
    double& most = known ? with : mistaken;
    most = worse(most, r.on.out);
    without = std::max(without, r.off.out);
    bounces += r.off.bounces;
    if (r.object >= 1000.0) firm = std::max(firm, std::abs(r.on.put / r.off.put - 1.0));
  }
  bench.figure("spare.energy.max", 1e3 * with, "mJ", at_most(0.1),
               "more out than in, at any moment of all contacts, with the controller; hands as believed");
  bench.figure("spare.none.energy.max", 1e3 * without, "mJ", at_least(1.0),
               fmt::format("the same without it; {} bounces off the hand", bounces));
  bench.figure("spare.mistaken.energy.max", 1e3 * mistaken, "mJ",
               "with it, of a hand three times as stiff as the rig believes");
  bench.figure("spare.firm.energy", 100.0 * firm, "%", at_most(1.0),
               "by which what is put into a wall of 1 N/mm, which is stable, differs with it");
  add_sessions(bench);
  add_ball(bench);
  bench.table(std::move(table));
}

}  // namespace enc::bench::stability
