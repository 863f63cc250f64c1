// Choice of the nearest of many objects (choice.cpp), and the motion of dynamic objects [VisHap 2.2, 2.3.3].
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/precision.h"
#include "benchmarks/switching/crowd.h"
#include "sim/bodies/mujoco.h"
#include "trial/trial.h"

namespace enc::bench::switching {
namespace {

// An ideal tracker of the finger, each tick: the remaining error is the display's.
const std::vector<std::string> kLiveFinger{
    "truth.tracker.rate_hz=1000",      "truth.tracker.latency_ms=0",      "truth.tracker.noise_mm=[0,0,0]",
    "truth.tracker.marker_noise_mm=0", "rig.tracker.prediction=\"hold\"", "rig.tracker.usual_age_ms=2"};

// Keys, ball, tiles and drum in the twin, judged by the ground truth.

models::Setup live(const BenchContext& context, const std::string& scene, std::vector<std::string> own = {}) {
  own.insert(own.begin(), kLiveFinger.begin(), kLiveFinger.end());
  return load_scene(context, scene, std::move(own));
}

trial::TrialOptions options_of(const BenchContext& context) { return {.seed = context.seed}; }

constexpr double kFelt = 0.1;  // N

struct Row {
  double meant = 0.0, felt = 0.0;  // ticks with force; ticks of them with the right key
  double step = 0.0;               // N: largest change of the force in the tick after a switch
  std::int32_t switches = 0;
};
Row slide_row(const BenchContext& context, const std::string& key) {
  trial::Trial trial(live(context, "keypad",
                          {"user.object=\"" + key + "\"", "user.slide_mm=40", "user.slide_mm_s=60",
                           "user.depth_mm=1.5", "user.approach_mm_s=[50]"}),
                     options_of(context));
  Row row;
  const Vec<'W'> beside(context.mutated("beside") ? 0.01 : 0.0, 0.0, 0.0);
  std::int32_t before = -1;
  double force = 0.0;
  while (trial.tick()) {
    const sim::Truth& truth = trial.world().truth();
    const double now = truth.contact_force.norm();
    const std::int32_t object = trial.outputs().object;
    if (before >= 0 && object != before) {
      ++row.switches;
      row.step = std::max(row.step, std::abs(now - force));
    }
    before = object;
    force = now;
    if (now < kFelt) continue;
    const NearestObject meant = brute_force(trial.scene(), truth.tool_tip + beside);
    row.meant += 1.0;
    row.felt += meant.object == object ? 1.0 : 0.0;
  }
  return row;
}

models::Setup shipped(const BenchContext& context, const std::string& scene,
                      const std::vector<std::string>& own = {}) {
  return load_scene(context, scene, own);
}

// Seeds for each judged shipped setting.
std::size_t seeds_of(const BenchContext& context) { return context.quick ? 1 : context.full ? 16 : 3; }

struct Bounce {
  double approach = kUnset, restitution = kUnset;
  // N s: impulse of the commanded force, of the finger's force on the prop, and of the ball
  double rendered = 0.0, given = 0.0, momentum = kUnset;
  double work = 0.0, energy = kUnset;  // J: work of the finger on the prop, and energy of the ball
  std::int32_t contacts = 0;           // with the ball
};
// A hand continues evenly up to its target, as the law assumes. So the target is put behind the ball, where
// it does not disturb the hit.
models::Setup even_hit(const BenchContext& context, double speed, double restitution) {
  models::Setup setup = shipped(
      context, "hit_ball",
      {fmt::format("user.approach_mm_s=[{}]", 1e3 * speed), "user.approach_from_mm=140",
       "tool.finger.mass_kg=1", "truth.hand.grip_stiffness_N_per_mm=10",
       "truth.hand.grip_damping_Ns_per_m=1500", "truth.hand.mass_kg=20", "truth.hand.stiffness_N_per_mm=5",
       "truth.hand.damping_Ns_per_m=500", "truth.hand.strength_N=1e6",
       // A soft hit lasts longer than a fast hand needs for 45 mm.
       "behaviour.hit_ball.interaction.travel_mm=70",
       fmt::format("behaviour.hit_ball.interaction.restitution={}", restitution)});
  BehaviourSpec wall = setup.scene.behaviours.front();
  wall.name = "behind";
  wall.interaction = InteractionSpec{};
  wall.interaction.kind = Interaction::slide;
  ObjectSpec behind;
  behind.name = "behind";
  behind.radius = 0.002;
  behind.position = setup.scene.objects.front().position - Vec3(0, 0, 0.032);
  behind.behaviour = wall.name;
  setup.scene.behaviours.push_back(wall);
  setup.scene.objects.push_back(behind);
  setup.scene.user->object = behind.name;
  return setup;
}

// Speeds along the normal: the true finger's before it touches the prop and at the parting of ball and prop;
// and the ball's, from the core.
Bounce hit_once(models::Setup setup, const BenchContext& context, std::uint64_t seed) {
  trial::Trial trial(std::move(setup), {.seed = seed});
  const double dt = trial.scene().dt;
  Bounce bounce;
  double parted = kUnset, now = 0.0, before = 0.0;
  bool pressed = false;
  const bool ends = context.mutated("ends_of_contacts"), twice = context.mutated("double_speed");
  while (trial.tick() && !(now > parted + 0.03)) {
    const sim::Truth& truth = trial.world().truth();
    const MoverState& moved = moved_in(trial.state())[0];
    const Vec3 normal = Vec3::UnitZ();  // the ball is hit from above
    const double finger = -normal.dot(truth.tool_velocity.e());
    now = seconds(truth.t.time_since_epoch());
    if (truth.touching && std::isnan(bounce.approach)) bounce.approach = before;
    before = finger;
    const bool presses = trial.outputs().mode == Mode::contact && trial.outputs().object == 0;
    bounce.contacts += (presses && !pressed) || (ends && pressed && !presses) ? 1 : 0;
    if (std::isfinite(bounce.approach) && std::isnan(parted)) {
      const double force = -normal.dot(truth.contact_force.e());
      bounce.given += dt * force;
      bounce.work -= dt * force * normal.dot(truth.tip_velocity.e());
    }
    if (presses) bounce.rendered -= dt * normal.dot(trial.outputs().force_unfiltered.e());
    if (pressed && !presses && std::isnan(parted)) {
      const double mass = trial.scene().objects[0].interaction.mass;
      const double speed = (twice ? 2.0 : 1.0) * moved.velocity.norm();
      parted = now;
      bounce.restitution = (speed - finger) / bounce.approach;
      bounce.momentum = mass * speed;
      bounce.energy = 0.5 * mass * speed * speed;
    }
    pressed = presses;
  }
  return bounce;
}

double least_of(const std::vector<Bounce>& hits, double (*of)(const Bounce&)) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double least = kInfinite;
  for (const Bounce& hit : hits) least = std::min(least, std::isfinite(of(hit)) ? of(hit) : -kInfinite);
  return least;
}
double most_of(const std::vector<Bounce>& hits, double (*of)(const Bounce&)) {
  double most = 0.0;
  for (const Bounce& hit : hits)
    most = std::max(most, std::isfinite(of(hit)) ? of(hit) : std::numeric_limits<double>::infinity());
  return most;
}

// The light hand of the scene gives way. Counts missing and additional contacts over all seeds.
void hit_by_hand(Bench& bench) {
  const BenchContext& context = bench.context;
  std::vector<double> wrong(seeds_of(context));
  in_parallel(wrong.size(), [&](std::size_t i) {
    const models::Setup planned = shipped(context, "hit_ball");
    trial::Trial trial(
        context.mutated("one_hit") ? shipped(context, "hit_ball", {"user.approach_mm_s=[200]"}) : planned,
        {.seed = context.seed + i});
    const double hits = static_cast<double>(planned.scene.user->approach.size());
    wrong[i] = std::abs(static_cast<double>(trial.run().contacts) - hits);
  });
  bench.figure("hit.wrong_contacts.max", *std::max_element(wrong.begin(), wrong.end()), "", exactly(0.0),
               "contacts that the core counts, less the hits that the scene's own hand makes");
}

// Hits with each restitution that is set, at each speed, by each seed.
struct Hits {
  std::vector<double> set, speeds;  // speeds: m/s
  std::size_t seeds;
  std::vector<Bounce> all;  // [set][speed][seed]

  [[nodiscard]] double set_of(std::size_t i) const { return set[i / (speeds.size() * seeds)]; }
  [[nodiscard]] double speed_of(std::size_t i) const { return speeds[i / seeds % speeds.size()]; }
};
Hits all_hits(const BenchContext& context) {
  Hits hits;
  hits.set = context.quick ? std::vector<double>{0.8} : std::vector<double>{0.2, 0.4, 0.6, 0.8, 1.0};
  hits.speeds = context.quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3, 0.6};
  hits.seeds = seeds_of(context);
  hits.all.resize(hits.set.size() * hits.speeds.size() * hits.seeds);
  in_parallel(hits.all.size(), [&](std::size_t i) {
    hits.all[i] =
        hit_once(even_hit(context, hits.speed_of(i), hits.set_of(i)), context, context.seed + i % hits.seeds);
  });
  return hits;
}

Plot restitution_plot(const Hits& hits) {
  Plot plot{"switching_restitution", "A ball that is hit in the twin", "restitution that is set",
            "restitution measured, mean over seeds"};
  for (std::size_t k = 0; k < hits.speeds.size(); ++k) {
    Series series{fmt::format("{:g} m/s", hits.speeds[k])};
    series.mark = Mark::both;
    for (std::size_t j = 0; j < hits.set.size(); ++j) {
      double sum = 0.0;
      for (std::size_t n = 0; n < hits.seeds; ++n)
        sum += hits.all[(j * hits.speeds.size() + k) * hits.seeds + n].restitution;
      series.add(hits.set[j], sum / static_cast<double>(hits.seeds));
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "Speeds along the normal: of the true finger before it touches the prop, and of both as they part.";
  return plot;
}

constexpr const char* kEvenHand =
    ", by a hand that goes on evenly, seen by the tracker that ships; over all hits";
// Below this restitution, one encoder count in the speed's averaging time, 4 mm/s, is a fifth of the speed
// or more.
constexpr double kSoft = 0.4;

void add_restitutions(const Hits& hits, Bench& bench) {
  double worst = 0.0, off = 0.0, returned = 0.0;
  for (std::size_t i = 0; i < hits.all.size(); ++i) {
    const double set = hits.set_of(i);
    const double error = std::abs(hits.all[i].restitution / set - 1.0);
    const double wrong = std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    if (set >= kSoft) worst = std::max(worst, wrong);
    off = std::max(off, wrong * set);
    returned = std::max(returned, hits.all[i].restitution);
  }
  const std::string hand = kEvenHand;
  // Not 5 %: the law keeps 5 % of the parting speed back, so that no hit gives more than it got.
  bench.figure("hit.restitution_error.max", 100.0 * worst, "%", at_most(7.0),
               "measured over set, which is 0.4 to 1" + hand);
  bench.figure("hit.restitution_off.max", off, "", at_most(0.1),
               "measured less set, which is 0.2 to 1" + hand);
  bench.figure("hit.returned.max", returned, "", at_most(1.0),
               "restitution measured, set to 0.2 to 1" + hand);
}

// Contacts, impulses and energies.
void add_impulses(const Hits& hits, Bench& bench) {
  std::vector<Bounce> firm;
  for (std::size_t i = 0; i < hits.all.size(); ++i)
    if (hits.set_of(i) >= kSoft) firm.push_back(hits.all[i]);
  const std::string hand = kEvenHand;
  const auto contacts = [](const Bounce& h) { return static_cast<double>(h.contacts); };
  const auto rendered = [](const Bounce& h) { return h.rendered / h.momentum; };
  bench.figure("hit.contacts.least", least_of(hits.all, contacts), "", exactly(1.0), "of a hit" + hand);
  bench.figure("hit.contacts.max", most_of(hits.all, contacts), "", exactly(1.0), "of a hit" + hand);
  bench.figure("hit.impulse_over_momentum.least", least_of(firm, rendered), "x", between(0.9, 1.1),
               "of the force that the arm is told, over the ball's" + hand);
  bench.figure("hit.impulse_over_momentum.max", most_of(firm, rendered), "x", between(0.9, 1.1), "likewise");
  bench.figure("hit.finger_over_momentum.max",
               most_of(hits.all, [](const Bounce& h) { return h.given / h.momentum; }), "x",
               "of the true force of the finger, over the ball's: the arm's own mass is struck, too");
  bench.figure("hit.energy_over_work.max",
               most_of(hits.all, [](const Bounce& h) { return h.energy / h.work; }), "x", at_most(1.0),
               "of the ball, over the work of the true finger on the prop" + hand);
}

void hit_balls(Bench& bench) {
  const Hits hits = all_hits(bench.context);
  bench.result.plots.push_back(restitution_plot(hits));
  add_restitutions(hits, bench);
  add_impulses(hits, bench);
  hit_by_hand(bench);
}

// Place of a tile at the end, in mm, and its speed.
struct TileEnd {
  double way = kUnset, speed = kUnset;
};
TileEnd push_tile(const BenchContext& context, const std::string& tile) {
  trial::Trial trial(live(context, "tiles", {"user.object=\"" + tile + "\""}), options_of(context));
  double fastest = 0.0;
  while (trial.tick())
    for (const MoverState& mover : moved_in(trial.state()))
      fastest = std::max(fastest, mover.velocity.norm());
  const auto& objects = trial.setup().scene.objects;
  const auto named =
      std::find_if(objects.begin(), objects.end(), [&](const ObjectSpec& o) { return o.name == tile; });
  const auto moving = trial.scene().objects[static_cast<std::size_t>(named - objects.begin())].moving;
  const MoverState& now = moved_in(trial.state())[static_cast<std::size_t>(moving)];
  return {now.shift.norm(), context.mutated("on_its_way") ? fastest : now.velocity.norm()};
}

struct Mean {
  double sum = 0.0, count = 0.0;
  void add(double value) {
    sum += value;
    count += 1.0;
  }
  [[nodiscard]] double value() const { return count > 0.0 ? sum / count : kUnset; }
};

// Speed of the drum's surface, m/s, while a finger slides along it, faster than the surface and back, and
// takes the prop along; and the rendered force, with the tracker that ships.
struct DrumRun {
  Mean there, back;   // sum of the prop's own motion and the belt's, as the finger moves with the drum and
                      // against it
  Mean felt;          // speed of the finger, while it is neither dragged nor held
  double step = 0.0;  // N: of the force along the normal, from one ms to the next
  double sideways = 0.0, normal = 0.0;  // N s, while the force exceeds 1 N
  [[nodiscard]] double error(double wanted) const {
    return 100.0 * std::max(std::abs(there.value() / wanted - 1.0), std::abs(back.value() / wanted - 1.0));
  }
};
DrumRun running_surface(const BenchContext& context, std::uint64_t seed,
                        const std::vector<std::string>& own) {
  trial::Trial trial(shipped(context, "drum", own), {.seed = seed});
  const Object& drum = trial.scene().objects[0];
  const Vec<'W'> way = drum.X_WO * Vec<'O'>(drum.interaction.way);
  const double grip = 0.3 * trial.setup().twin.arm.prop_friction;
  constexpr double kSlides = 0.020;  // m/s
  DrumRun surface;
  double before = 0.0;
  int tick = 0;
  const bool across = context.mutated("across"), belt = !context.mutated("turned_belt");
  const int every = context.mutated("by_the_second") ? 1000 : 1;  // ticks
  while (trial.tick()) {
    const sim::Truth& truth = trial.world().truth();
    const double pressed = -truth.contact_force.xyz[2];
    surface.step = std::max(surface.step, std::abs(pressed - before));
    if (++tick % every == 0) before = pressed;
    if (pressed > 1.0) {
      surface.sideways += std::hypot(truth.contact_force.xyz[across ? 2 : 0], truth.contact_force.xyz[1]);
      surface.normal += pressed;
    }
    if (truth.phase != sim::Phase::hold || truth.contact_force.norm() < kFelt) continue;
    const double finger = dot(truth.tool_velocity, way);
    const double runs =
        dot(truth.tip_velocity, way) + (belt ? 1.0 : -1.0) * trial.world().arm->state().surface_speed;
    if (std::abs(finger) > kSlides) (finger > 0.0 ? surface.there : surface.back).add(runs);
    const double along = dot(truth.contact_force, way);
    const bool slips = std::abs(along) > grip * (truth.contact_force - along * way).norm();
    if (!slips && finger > 0.0) surface.felt.add(finger);
  }
  return surface;
}

void run_drum(Bench& bench) {
  const BenchContext& context = bench.context;
  const models::Setup setup = shipped(context, "drum");
  const double wanted = trial::prepare_setup(setup).objects[0].prop_speed();
  std::vector<DrumRun> slides(seeds_of(context)), rests(slides.size());
  in_parallel(slides.size(), [&](std::size_t i) {
    slides[i] = running_surface(context, context.seed + i, {"user.slide_mm=25", "user.slide_mm_s=100"});
    rests[i] = running_surface(context, context.seed + i, {});
  });
  double error = 0.0, step = 0.0, sideways = 0.0;
  Mean felt;
  for (const DrumRun& slide : slides) {
    error = std::max(error, slide.error(wanted));
    felt.add(slide.felt.value());
  }
  for (const std::vector<DrumRun>* runs : {&slides, &rests})
    for (const DrumRun& one : *runs) {
      step = std::max(step, one.step);
      sideways = std::max(sideways, one.sideways / one.normal);
    }
  const double friction = setup.twin.arm.prop_friction;
  bench.figure("drum.speed_error", error, "%", at_most(7.0),
               "of the touched surface, prop's own motion and belt's together, on average while the finger "
               "slides 25 mm along it, faster than it runs, or back, seen by the tracker that ships; the "
               "worse of both, of all seeds");
  bench.figure(
      "drum.sideways.max", 100.0 * sideways, "%", at_most(110.0 * friction),
      fmt::format("of the normal force, where that is more than 1 N; friction: {:g} %", 100.0 * friction));
  bench.figure("drum.step.max", step, "N", at_most(0.4),
               "of the force along the normal, from one ms to the next, from touch to release");
  bench.figure("drum.felt_speed", 1e3 * felt.value(), "mm/s",
               fmt::format("of the finger, where the surface neither drags nor holds it; the drum: {:g} mm/s",
                           1e3 * wanted));
}

// A finger slides over the keys, row by row, pressed: checks that the rendered key is the intended one.
void slide_over_keys(Bench& bench) {
  const std::vector<std::string> all{"key_1", "key_4", "key_7", "key_10"};
  std::vector<Row> rows(bench.context.quick ? 1 : all.size());
  in_parallel(rows.size(), [&](std::size_t i) { rows[i] = slide_row(bench.context, all[i]); });
  Row sum;
  Table table{"switching_rows",
              "A finger slides over the rows of the keypad and back",
              {"first key", "switches", "felt = meant (%)", "largest step at a switch (N/ms)"}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    sum.meant += rows[i].meant;
    sum.felt += rows[i].felt;
    sum.step = std::max(sum.step, rows[i].step);
    table.rows.push_back({all[i], std::to_string(rows[i].switches),
                          fixed(100.0 * rows[i].felt / rows[i].meant, 1), fixed(rows[i].step, 2)});
  }
  bench.figure(
      "keys.felt_is_meant", 100.0 * sum.felt / sum.meant, "%", between(90.0, 100.0),
      "of the time with a force: the key that is rendered is the one that the true finger is nearest to");
  bench.figure("keys.step_at_switch.max", sum.step, "N",
               "true contact force, from one ms to the next: the prop comes to the next key under a finger "
               "that is pressed");
  bench.result.tables.push_back(std::move(table));
}

// Ball, tiles and drum in the twin.
void move_things(Bench& bench) {
  const BenchContext& context = bench.context;
  hit_balls(bench);
  TileEnd bar = push_tile(context, "bar"), way = push_tile(context, "way");
  if (context.mutated("exchange_tiles")) std::swap(bar, way);
  bench.figure("tile.end", 1e3 * bar.way, "mm", between(29.99, 30.01),
               "pushed with 1.2 N: it stops at the end of its way, 30 mm");
  bench.figure("tile.end_speed", 1e3 * bar.speed, "mm/s", exactly(0.0), "there");
  bench.figure("tile.blocked", 1e3 * way.way, "mm", between(7.49, 7.51),
               "the other one, pushed first: it stops at its neighbour, 7.5 mm away");
  run_drum(bench);
}

void run(Bench& bench) {
  add_choice(bench);
  bench.progress(0.5);
  slide_over_keys(bench);
  bench.progress(0.8);
  move_things(bench);
  add_force_precision(bench);
}

const Reads kReads{"switching", {.scenes = {"keypad", "hit_ball", "tiles", "drum"}}};
const Entry kEntry{
    "switching", "keypad",
    "the nearest of many objects: right, without chatter, in time; keys, a hit ball, tiles and a drum", run};

}  // namespace
}  // namespace enc::bench::switching
