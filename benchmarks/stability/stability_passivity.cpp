// The core's passivity controller in the loop of a wall, on the slide in MuJoCo: the energy output of the
// wall, with and without it.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <string_view>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/stability/stability.h"
#include "benchmarks/stiffness/push_study.h"
#include "core/control/safety/passivity/passivity.h"
#include "core/control/task/admittance/admittance_task.h"
#include "trial/measure/passivity_measure.h"
#include "trial/measure/press_measure.h"
#include "trial/trial.h"

namespace enc::bench::stability {
namespace {

constexpr double kPeak = 8.5;  // N, limit of a PHANToM
constexpr Stepping kTenths{Scheme::rk4, 10};

// A wall that only pushes outwards, up to the machine's limit.
struct RenderedWall {
  Device device;
  Wall wall;
  bool controlled = false, limited = true;
  double wave = 0.0;  // m, amplitude of a 40 mm wave under a finger that slides at 100 mm/s
};

class Loop {
 public:
  explicit Loop(const RenderedWall& r) : r_(r), slide_(r.device, {}, kTenths, 1.0) {}

  void throw_from(double x, double speed) {
    slide_.throw_from(x, speed);
    before_ = slide_.read() - surface();
    energy_ = {};
    contact_ = 0.0;
    touching_ = false;
  }
  // Runs one period, under a hand's push. Outwards is +x.
  void period(double hand) {
    const double apart = slide_.read() - surface(), moved = apart - before_, depth = std::max(0.0, -apart);
    before_ = apart;
    if (depth > 0.0 && !touching_) contact_ = 0.0;
    touching_ = depth > 0.0;
    const double before = slide_.work(), stood = surface();
    const double push = law(depth, moved);
    slide_.period(push, hand);
    ++periods_;
    contact_ += slide_.work() - before - push * (surface() - stood);
    given_ = std::max(given_, contact_);
  }
  [[nodiscard]] bool touching() const { return touching_; }
  [[nodiscard]] const Slide& slide() const { return slide_; }
  [[nodiscard]] double contact() const { return contact_; }  // J, true, of the present or last contact
  [[nodiscard]] double given() const { return given_; }      // J, true: largest output of any contact

 private:
  [[nodiscard]] double surface() const {
    const double turn = 2.0 * std::numbers::pi * 0.1 / 0.04 * r_.device.period;
    return r_.wave * std::sin(turn * static_cast<double>(periods_));
  }
  double law(double depth, double moved) {
    const double most = r_.limited ? kPeak : 1e9;
    const double asked =
        depth > 0.0
            ? std::clamp(r_.wall.stiffness * depth - r_.wall.damper * moved / r_.device.period, 0.0, most)
            : 0.0;
    if (!r_.controlled) return asked;
    if (!(depth > 0.0)) {
      energy_ = {};
      return 0.0;
    }
    const PassivityTick tick{moved, depth, std::min(most, r_.wall.stiffness * depth)};
    if (energy_.on)
      observe(energy_, tick, r_.device.count);
    else
      begin(energy_, tick, 0.0);
    const double per_newton = r_.device.period * r_.device.period / (2.0 * r_.device.mass);
    const double push = std::clamp(passive(energy_, asked, per_newton, r_.device.count), -most, most);
    hold(energy_, push, asked);
    return push;
  }

  RenderedWall r_;
  Slide slide_;
  Passivity energy_;
  double before_ = 0.0, contact_ = 0.0, given_ = 0.0;
  bool touching_ = false;
  std::int64_t periods_ = 0;
};

// Results of many bounces.
struct BounceResult {
  double given = 0.0;   // J: largest energy out less energy in, at any moment of a contact
  double kept = -1.0;   // J: the largest at the end of a contact
  double parted = 0.0;  // speed after the bounce over the speed before, mean
};
BounceResult bounce(const RenderedWall& r, int times, double slowest, double fastest) {
  std::mt19937_64 draw(20);
  std::uniform_real_distribution<double> even(0.0, 1.0);
  Loop loop(r);
  BounceResult all;
  for (int i = 0; i < times; ++i) {
    const double speed = slowest + (fastest - slowest) * even(draw);
    loop.throw_from(speed * r.device.period * even(draw), -speed);
    const std::int64_t most = std::llround(1.0 / r.device.period);  // a second is enough for the parting
    bool met = false;
    for (std::int64_t k = 0; k < most && !(met && !loop.touching()); ++k) {
      loop.period(0.0);
      met = met || loop.touching();
    }
    all.kept = std::max(all.kept, loop.contact());
    all.parted += std::abs(loop.slide().speed()) / speed / times;
  }
  all.given = loop.given();
  return all;
}

// Presses against the wall with 1 N for `seconds`: largest energy output in one contact, J.
double pressed(const RenderedWall& r, double seconds) {
  Loop loop(r);
  loop.throw_from(2e-3, 0.0);
  for (int i = 0; i < std::lround(seconds / r.device.period); ++i) loop.period(-1.0);
  return loop.given();
}

// Three times the passive limit, and the stable limit.
double beyond(double damping) {
  const Device device{0.1, damping, 1e-3};
  return 3.0 * std::max(2.0 * damping / device.period, certificate::critical_stiffness(loop_of(device)));
}

struct Row {
  double damping = 0.2, stiffness = 0.0, count = 0.0;
  BounceResult off{}, on{};
  double off_pressed = 0.0, on_pressed = 0.0;
};
Row measured(Row row, const BenchContext& context) {
  RenderedWall r{{0.1, row.damping, 1e-3}, {row.stiffness, 0.0}};
  r.device.count = row.count;
  const int times = context.full ? 1000 : 100;
  row.off = bounce(r, times, 0.02, 0.3);
  const double seconds = context.full ? 30.0 : 3.0;
  r.wave = 1e-3;
  row.off_pressed = pressed(r, seconds);
  r.controlled = true;
  row.on_pressed = pressed(r, seconds);
  r.wave = 0.0;
  row.on_pressed = std::max(row.on_pressed, pressed(r, seconds));
  row.on = bounce(r, times, 0.02, 0.3);
  if (context.mutated("exchange_control")) {
    std::swap(row.on, row.off);
    std::swap(row.on_pressed, row.off_pressed);
  }
  return row;
}

// Gain of speed at a wall that is held for a period against one that follows continuously, % [fidelity d1:
// 0.1 kg at 0.2 m/s, damping ratio 0.1].
double gained(double stiffness, bool controlled) {
  RenderedWall r{{0.1, 0.0, 1e-3}, {stiffness, 0.2 * std::sqrt(0.1 * stiffness)}, controlled, false};
  const double held = bounce(r, 200, 0.2, 0.2).parted;
  r.controlled = false;
  r.device.period = 1e-5;
  return 100.0 * (held / bounce(r, 1, 0.2, 0.2).parted - 1.0);
}

void add_cost_of_control(Bench& bench) {
  constexpr int kTimes = 200'000;
  std::vector<double> seconds;
  double kept = 0.0;
  for (int k = 0; k < 15; ++k) {
    Passivity now;
    begin(now, {-1e-4, 1e-3, 1.0}, 1e-4);
    const double start = thread_seconds();
    for (int i = 0; i < kTimes; ++i) {
      const double moved = 1e-4 * ((i % 7) - 3), asked = 1.0 + (i % 5);
      observe(now, {moved, 1e-3 - moved, 1.0}, 3e-5);
      const double push = passive(now, asked, 5e-6, 3e-5);
      hold(now, push, asked);
      kept += push;
    }
    seconds.push_back((thread_seconds() - start) / kTimes);
  }
  bench.cost("passivity.time.median", 1e9 * median(seconds), "ns",
             kept == 0.0 ? "of a tick: nothing was pushed" : "of a tick, observer and controller");
}

// The passivity controller of the hexapod in the twin, with an object softer than its loop allows: the true
// energy output to the hand, and the cost of the controller at the shipped ball.

// A hand, and the hand that the rig expects, N/m and N s/m.
struct SpareHand {
  double stiffness, damping, believed;
};
struct Pushes {
  double out = 0.0;    // J: energy out less energy in, largest at any moment of a contact, true
  double put = 0.0;    // J, largest energy put into a contact
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
                             "pusher.hold_s=6", fmt::format("pusher.repeats={}", context.full ? 12 : 2),
                             fmt::format("rig.admittance.passivity={}", controlled ? "controlled" : "none")}),
      object);
  Pushes all;
  Watch watch(all);
  trial::TrialOptions options{
      .seed = context.seed, .work = true, .watch = [&](const trial::Glance& glance) { watch.see(glance); }};
  trial::Trial(setup, std::move(options)).run();
  return all;
}

struct SparePush {
  double object;
  SpareHand grip;
  Pushes off{}, on{};
};

// Results for the shipped ball.
struct Ball {
  double press, release, in, out, acted;  // N, N, J, J, s
};
Ball ball(const BenchContext& context, bool controlled) {
  std::vector<std::string> set{
      fmt::format("rig.admittance.passivity={}", controlled ? "controlled" : "none")};
  if (controlled && context.mutated("hasty_press"))
    set.insert(set.end(), {"user.press_s=0.5", "user.release_s=0.5"});
  const models::Setup setup = load_scene(context, "tennis_ball", set);
  trial::PressMeasure presses(setup);
  trial::PassivityMeasure passivity;
  trial::TrialOptions options{.seed = context.seed};
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

// J: energy out of a contact less energy in, largest at any moment of all contacts: from true forces and
// paths, along the normal and across it.
struct EnergySurplus {
  double along = 0.0, across = 0.0;
};

class ContactWork {
 public:
  void see(const trial::Glance& glance) {
    const bool on = glance.out.mode == Mode::contact || glance.out.mode == Mode::restore;
    const Vec3 tip = glance.truth.tip.e(), force = glance.truth.contact_force.e();
    if (on) {
      const Vec3 normal = (recall<AdmittanceState>(*glance.state).contact.X_WN * Vec<'N'>(0, 0, 1)).e();
      const Vec3 mean = 0.5 * (force + force_), way = tip - tip_;
      const double along = mean.dot(normal) * way.dot(normal);
      now_ = {now_.along - along, now_.across - (mean.dot(way) - along)};
      most_ = {std::max(most_.along, now_.along), std::max(most_.across, now_.across)};
    } else {
      now_ = EnergySurplus{};
    }
    tip_ = tip;
    force_ = force;
  }
  [[nodiscard]] const EnergySurplus& most() const { return most_; }

 private:
  EnergySurplus now_, most_;
  Vec3 tip_ = Vec3::Zero(), force_ = Vec3::Zero();
};

struct Lesson {
  std::string scene;
  std::uint64_t seed;
  bool controlled;
  EnergySurplus given{};
};

// Scenes that ship, with their hands that reach, bounce and tremble.
void add_sessions(Bench& bench) {
  const BenchContext& context = bench.context;
  std::vector<Lesson> lessons;
  for (const char* scene : {"session", "training"})
    for (std::uint64_t i = 0; i < (context.full ? 16U : 1U); ++i)
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
    if (context.mutated("exchange_control")) lesson.controlled = !lesson.controlled;
    return lesson;
  });
  for (const char* scene : {"session", "training"}) {
    std::array<EnergySurplus, 2> most;
    for (const Lesson& one : lessons) {
      if (one.scene != scene) continue;
      EnergySurplus& all = most.at(one.controlled ? 1 : 0);
      all = {worse(all.along, one.given.along), worse(all.across, one.given.across)};
    }
    const std::string key = std::string("spare.") + scene;
    // In few hands of training nothing comes out without the controller, either: that would judge nothing.
    const bool judged = std::string_view(scene) == "session";
    bench.figure(
        key + ".energy.max", 1e3 * most[1].along, "mJ", judged ? at_most(0.1) : Bounds{},
        fmt::format("the same of the scene {} as it ships, along the normal of each contact", scene));
    bench.figure(key + ".none.energy.max", 1e3 * most[0].along, "mJ", "without the controller");
    bench.figure(key + ".across.max", 1e3 * most[1].across, "mJ",
                 "across it, where the tip goes under its tool and takes it along; nothing controls that");
  }
}

// Three walls beyond the bound of stability and three of a fixed stiffness; then all again with counts.
struct Rows {
  std::vector<Row> all;
  std::size_t beyond, exact;  // how many of the first are beyond the bound; have no counts
};
Rows measured_rows(Bench& bench) {
  std::vector<Row> rows;
  for (const double damping : {0.05, 0.2, 1.0}) rows.push_back({damping, beyond(damping)});
  const std::size_t unstable = rows.size();
  for (const double stiffness : {1e3, 1e4, 1e5}) rows.push_back({0.2, stiffness});
  const std::size_t exact = rows.size();
  for (std::size_t i = 0; i < exact; ++i) rows.push_back({rows[i].damping, rows[i].stiffness, 30e-6});
  return {bench.each(rows, [&](const Row& row) { return measured(row, bench.context); }), unstable, exact};
}

Table energy_table(const std::vector<Row>& rows) {
  Table table{"passivity",
              "Energy that a sampled wall gives out",
              {"b (N s/m)", "K (N/m)", "count (um)", "bounce: out (mJ)", "parts at", "pressed: out (mJ)",
               "controlled: out (mJ)", "parts at", "pressed: out (mJ)"},
              {},
              "0.1 kg, 1 kHz, at most 8.5 N, 20 to 300 mm/s. Out: more than in, at any moment of a contact. "
              "Parts at: over the speed at which it met. Pressed: by 1 N for 30 s, on a surface that waves "
              "by 1 mm under a finger that slides at 100 mm/s."};
  for (const Row& r : rows)
    table.add(r.damping, fixed(r.stiffness, 0), r.count * 1e6, fixed(r.off.given * 1e3, 3),
              fixed(r.off.parted, 3), fixed(r.off_pressed * 1e3, 3), fixed(r.on.given * 1e3, 4),
              fixed(r.on.parted, 3), fixed(r.on_pressed * 1e3, 4));
  return table;
}

void add_energies(const Rows& rows, Bench& bench) {
  double bounced = 0.0, slid = 0.0, stiff = 0.0, without = HUGE_VAL, counted = 0.0;
  for (std::size_t i = 0; i < rows.all.size(); ++i) {
    const Row& r = rows.all[i];
    if (i < rows.beyond) {
      bounced = worse(bounced, r.on.given);
      slid = worse(slid, r.on_pressed);
      without = std::min(without, r.off.given);
    }
    double& kept = i < rows.exact ? stiff : counted;
    kept = worse(kept, r.on.kept);
  }
  bench.figure("passivity.bounces.energy.max", 1e3 * bounced, "mJ", at_most(1e-3),
               "more out than in, at any moment of the bounces at three times the bound of stability, with "
               "the controller");
  bench.figure("passivity.sliding.energy.max", 1e3 * slid, "mJ", at_most(1e-3),
               "the same, pressed by 1 N, at rest and while it slides over a wave");
  bench.figure("passivity.none.energy.min", 1e3 * without, "mJ", at_least(0.1),
               "the bounces without it: the least of the three");
  bench.figure("passivity.stiff.energy.max", 1e3 * stiff, "mJ", at_most(0.01),
               "that a bounce gains with it, walls to 1e5 N/m; F v T of one cycle is 2.55 mJ");
  bench.figure("passivity.counts.energy.max", 1e3 * counted, "mJ", at_most(1.5),
               "the same with counts of 30 um");
}

// Objects under hands, each pushed without and with the controller.
std::vector<SparePush> spare_pushes(Bench& bench) {
  std::vector<SparePush> rows;
  for (const SpareHand& grip : {SpareHand{130.0, 2.0, 130.0}, SpareHand{700.0, 4.0, 700.0},
                                SpareHand{2000.0, 8.0, 2000.0}, SpareHand{2000.0, 8.0, 700.0}})
    for (const double object : {10.0, 30.0, 100.0, 1000.0}) rows.push_back({object, grip});
  return bench.each(rows, [&](const SparePush& row) {
    SparePush found = row;
    found.off = pushed(bench.context, row.object, row.grip, false);
    found.on = pushed(bench.context, row.object, row.grip, true);
    if (bench.context.mutated("exchange_control")) std::swap(found.on, found.off);
    return found;
  });
}

Table spare_table(const std::vector<SparePush>& rows) {
  Table table{"spare",
              "Energy that a hand gets out of what the hexapod renders",
              {"hand (N/m)", "believed (N/m)", "K (N/m)", "out (mJ)", "in (mJ)", "swing (mm)", "bounces",
               "controlled: out (mJ)", "in (mJ)", "swing (mm)", "bounces"},
              {},
              "Pushed 15 mm deep and held for 6 s, 12 times. Out: more than in, at any moment of a contact; "
              "in: the most that it held."};
  for (const SparePush& r : rows)
    table.add(r.grip.stiffness, r.grip.believed, r.object, fixed(r.off.out * 1e3, 3),
              fixed(r.off.put * 1e3, 1), fixed(r.off.swing * 1e3, 2), r.off.bounces, fixed(r.on.out * 1e3, 4),
              fixed(r.on.put * 1e3, 1), fixed(r.on.swing * 1e3, 2), r.on.bounces);
  return table;
}

}  // namespace

void add_passivity(Bench& bench) {
  const Rows rows = measured_rows(bench);
  add_energies(rows, bench);
  bench.figure("passivity.none.gain", gained(bench.context.mutated("stiff_for_soft") ? 1e4 : 1e3, false), "%",
               between(7.0, 11.0),
               "by which it parts faster from 1e3 N/m, held for 1 ms, than from a wall without sampling; no "
               "controller; theory: 9");
  bench.figure("passivity.gain", gained(1e3, true), "%",
               "the same with it: the damper of that law takes more than sampling gives out, so there is "
               "nothing to take");
  add_cost_of_control(bench);
  bench.table(energy_table(rows.all));
}

void add_spare(Bench& bench) {
  const std::vector<SparePush> rows = spare_pushes(bench);
  double with = 0.0, without = 0.0, mistaken = 0.0, firm = 0.0;
  std::int64_t bounces = 0;
  for (const SparePush& r : rows) {
    const bool known = r.grip.believed >= r.grip.stiffness;
    double& most = known ? with : mistaken;
    most = worse(most, r.on.out);
    without = std::max(without, r.off.out);
    bounces += r.off.bounces;
    if (r.object >= (bench.context.mutated("soft_for_firm") ? 100.0 : 1000.0))
      firm = std::max(firm, std::abs(r.on.put / r.off.put - 1.0));
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
  bench.table(spare_table(rows));
}

}  // namespace enc::bench::stability
