// Keys, ball, tiles and drum in the twin, judged by the truth.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/switching/crowd.h"
#include "benchmarks/switching/switching.h"
#include "sim/bodies/mujoco.h"
#include "trial/trial.h"

namespace enc::bench::switching {
namespace {

models::Setup live(const BenchContext& context, const std::string& scene, std::vector<std::string> own = {}) {
  own.insert(own.begin(), kLiveFinger.begin(), kLiveFinger.end());
  return load_scene(context, scene, std::move(own));
}

trial::TrialOptions options_of(const BenchContext& context) {
  trial::TrialOptions options;
  options.seed = context.seed;
  return options;
}

constexpr double kFelt = 0.1;  // N

struct Row {
  double meant = 0.0, felt = 0.0;  // ticks with force; of those with the right key
  double step = 0.0;               // N: largest change of the force in the tick after a switch
  std::int32_t switches = 0;
};
Row slide_row(const BenchContext& context, const std::string& key) {
  trial::Trial trial(live(context, "keypad",
                          {"user.object=\"" + key + "\"", "user.slide_mm=40", "user.slide_mm_s=60",
                           "user.depth_mm=1.5", "user.approach_mm_s=[50]"}),
                     options_of(context));
  Row row;
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
    const Nearby meant = brute_force(trial.scene(), truth.tool_tip);
    row.meant += 1.0;
    row.felt += meant.object == object ? 1.0 : 0.0;
  }
  return row;
}

models::Setup shipped(const BenchContext& context, const std::string& scene,
                      const std::vector<std::string>& own = {}) {
  return load_scene(context, scene, own);
}

constexpr std::size_t kSeeds = 16;  // each of what is judged as it is shipped

struct Bounce {
  double approach = kUnset, restitution = kUnset;
  // N s: impulse of the force that the arm is told, that of the finger on the prop, and that of the ball
  double rendered = 0.0, given = 0.0, momentum = kUnset;
  double work = 0.0, energy = kUnset;  // J: of the finger on the prop, and of the ball
  std::int32_t contacts = 0;           // with the ball
};
// A hand goes on evenly, as the law means it, up to what it presses; so that is put behind the ball, where it
// does not disturb the hit.
models::Setup even_hit(const BenchContext& context, double speed, double restitution) {
  models::Setup setup = shipped(
      context, "hit_ball",
      {fmt::format("user.approach_mm_s=[{}]", 1e3 * speed), "user.approach_from_mm=140",
       "tool.finger.mass_kg=1", "truth.hand.grip_stiffness_N_per_mm=10",
       "truth.hand.grip_damping_Ns_per_m=1500", "truth.hand.mass_kg=20", "truth.hand.stiffness_N_per_mm=5",
       "truth.hand.damping_Ns_per_m=500", "truth.hand.strength_N=1e6",
       // A soft hit lasts longer than 45 mm take a fast hand.
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

// Speeds along the normal: of the true finger, before it touches the prop and where ball and prop part; and
// of the ball, which is the core's.
Bounce hit_once(models::Setup setup, std::uint64_t seed) {
  trial::TrialOptions options;
  options.seed = seed;
  trial::Trial trial(std::move(setup), options);
  const double dt = trial.scene().dt;
  Bounce bounce;
  double parted = kUnset, now = 0.0, before = 0.0;
  bool pressed = false;
  while (trial.tick() && !(now > parted + 0.03)) {
    const sim::Truth& truth = trial.world().truth();
    const Moved& moved = moved_in(trial.state())[0];
    const Vec3 normal = Vec3::UnitZ();  // the ball is hit from above
    const double finger = -normal.dot(truth.tool_velocity.e());
    now = seconds(truth.t.time_since_epoch());
    if (truth.touching && std::isnan(bounce.approach)) bounce.approach = before;
    before = finger;
    const bool presses = trial.outputs().mode == Mode::contact && trial.outputs().object == 0;
    bounce.contacts += presses && !pressed ? 1 : 0;
    if (std::isfinite(bounce.approach) && std::isnan(parted)) {
      const double force = -normal.dot(truth.contact_force.e());
      bounce.given += dt * force;
      bounce.work -= dt * force * normal.dot(truth.tip_velocity.e());
    }
    if (presses) bounce.rendered -= dt * normal.dot(trial.outputs().felt.e());
    if (pressed && !presses && std::isnan(parted)) {
      const double mass = trial.scene().objects[0].interaction.mass, speed = moved.velocity.norm();
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

// The hand of the scene: light, it gives way. Contacts that are one too many or too few, over all seeds.
void hit_by_hand(const BenchContext& context, const Adder& add) {
  std::vector<double> wrong(context.quick ? 1 : kSeeds);
  in_parallel(wrong.size(), [&](std::size_t i) {
    trial::TrialOptions options;
    options.seed = context.seed + i;
    trial::Trial trial(shipped(context, "hit_ball"), options);
    const double hits = static_cast<double>(trial.setup().scene.user->approach.size());
    wrong[i] = std::abs(static_cast<double>(trial.run().contacts) - hits);
  });
  add("hit.wrong_contacts.max", *std::max_element(wrong.begin(), wrong.end()), "",
      "contacts that the core counts, less the hits that the scene's own hand makes", 0.0, 0.0);
}

void hit_balls(const BenchContext& context, BenchResult& result, const Adder& add) {
  const std::vector<double> set =
      context.quick ? std::vector<double>{0.8} : std::vector<double>{0.2, 0.4, 0.6, 0.8, 1.0};
  const std::vector<double> speeds =
      context.quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3, 0.6};
  const std::size_t seeds = context.quick ? 1 : kSeeds;
  std::vector<Bounce> hits(set.size() * speeds.size() * seeds);
  const auto set_of = [&](std::size_t i) { return set[i / (speeds.size() * seeds)]; };
  in_parallel(hits.size(), [&](std::size_t i) {
    hits[i] =
        hit_once(even_hit(context, speeds[i / seeds % speeds.size()], set_of(i)), context.seed + i % seeds);
  });
  Plot plot{"switching_restitution",
            "A ball that is hit in the twin",
            "restitution that is set",
            "restitution measured, mean over seeds",
            false,
            false,
            {}};
  // Of what is softer a count of the encoders in the time of the speed's mean, 4 mm/s, is a fifth or more.
  constexpr double kSoft = 0.4;
  double worst = 0.0, off = 0.0, returned = 0.0;
  std::vector<Bounce> firm;
  for (std::size_t i = 0; i < hits.size(); ++i) {
    const double error = std::abs(hits[i].restitution / set_of(i) - 1.0);
    const double wrong = std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
    if (set_of(i) >= kSoft) firm.push_back(hits[i]);
    if (set_of(i) >= kSoft) worst = std::max(worst, wrong);
    off = std::max(off, wrong * set_of(i));
    returned = std::max(returned, hits[i].restitution);
  }
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    Series series{fmt::format("{:g} m/s", speeds[k]), {}, {}};
    series.mark = Mark::both;
    for (std::size_t j = 0; j < set.size(); ++j) {
      double sum = 0.0;
      for (std::size_t n = 0; n < seeds; ++n) sum += hits[(j * speeds.size() + k) * seeds + n].restitution;
      series.x.push_back(set[j]);
      series.y.push_back(sum / static_cast<double>(seeds));
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption =
      "Speeds along the normal: of the true finger before it touches the prop, and of both as they part.";
  result.plots.push_back(std::move(plot));
  const std::string hand = ", by a hand that goes on evenly, seen by the tracker that ships; over all hits";
  add("hit.restitution_error.max", 100.0 * worst, "%", "measured over set, which is 0.4 to 1" + hand, kUnset,
      10.0);
  add("hit.restitution_off.max", off, "", "measured less set, which is 0.2 to 1" + hand, kUnset, 0.1);
  add("hit.returned.max", returned, "", "restitution measured, set to 0.2 to 1" + hand, kUnset, 1.0);
  add("hit.contacts.least", least_of(hits, [](const Bounce& h) { return static_cast<double>(h.contacts); }),
      "", "of a hit" + hand, 1.0, 1.0);
  add("hit.contacts.max", most_of(hits, [](const Bounce& h) { return static_cast<double>(h.contacts); }), "",
      "of a hit" + hand, 1.0, 1.0);
  add("hit.impulse_over_momentum.least",
      least_of(firm, [](const Bounce& h) { return h.rendered / h.momentum; }), "x",
      "of the force that the arm is told, over the ball's" + hand, 0.9, 1.1);
  add("hit.impulse_over_momentum.max", most_of(firm, [](const Bounce& h) { return h.rendered / h.momentum; }),
      "x", "likewise", 0.9, 1.1);
  add("hit.finger_over_momentum.max", most_of(hits, [](const Bounce& h) { return h.given / h.momentum; }),
      "x", "of the true force of the finger, over the ball's: the arm's own mass is struck, too", kUnset,
      kUnset);
  add("hit.energy_over_work.max", most_of(hits, [](const Bounce& h) { return h.energy / h.work; }), "x",
      "of the ball, over the work of the true finger on the prop" + hand, kUnset, 1.0);
  hit_by_hand(context, add);
}

// How far a tile is at the end, in mm, and how fast.
struct TileEnd {
  double way = kUnset, speed = kUnset;
};
TileEnd push_tile(const BenchContext& context, const std::string& tile) {
  trial::Trial trial(live(context, "tiles", {"user.object=\"" + tile + "\""}), options_of(context));
  trial.run();
  const auto& objects = trial.setup().scene.objects;
  const auto named =
      std::find_if(objects.begin(), objects.end(), [&](const ObjectSpec& o) { return o.name == tile; });
  const auto moving = trial.scene().objects[static_cast<std::size_t>(named - objects.begin())].moving;
  const Moved& now = moved_in(trial.state())[static_cast<std::size_t>(moving)];
  return {now.shift.norm(), now.velocity.norm()};
}

struct Mean {
  double sum = 0.0, count = 0.0;
  void add(double value) {
    sum += value;
    count += 1.0;
  }
  [[nodiscard]] double value() const { return count > 0.0 ? sum / count : kUnset; }
};

// How fast the drum's surface runs, m/s, while a finger slides along it, faster than it runs and back, and
// takes the prop along; and what is felt, seen by the tracker that ships.
struct Running {
  Mean there, back;   // prop's own motion and belt's together, as the finger goes with it and against it
  Mean felt;          // of the finger, while it is neither dragged nor held
  double step = 0.0;  // N: of the force along the normal, from one ms to the next
  double sideways = 0.0, normal = 0.0;  // N s, while more than 1 N is felt
  [[nodiscard]] double error(double wanted) const {
    return 100.0 * std::max(std::abs(there.value() / wanted - 1.0), std::abs(back.value() / wanted - 1.0));
  }
};
Running running_surface(const BenchContext& context, std::uint64_t seed,
                        const std::vector<std::string>& own) {
  trial::TrialOptions options;
  options.seed = seed;
  trial::Trial trial(shipped(context, "drum", own), options);
  const Object& drum = trial.scene().objects[0];
  const Vec<'W'> way = drum.X_WO * Vec<'O'>(drum.interaction.way);
  const double grip = 0.3 * trial.setup().twin.arm.prop_friction;
  constexpr double kSlides = 0.020;  // m/s
  Running surface;
  double before = 0.0;
  while (trial.tick()) {
    const sim::Truth& truth = trial.world().truth();
    const double pressed = -truth.contact_force.xyz[2];
    surface.step = std::max(surface.step, std::abs(pressed - before));
    before = pressed;
    if (pressed > 1.0) {
      surface.sideways += std::hypot(truth.contact_force.xyz[0], truth.contact_force.xyz[1]);
      surface.normal += pressed;
    }
    if (truth.phase != sim::Phase::hold || truth.contact_force.norm() < kFelt) continue;
    const double finger = dot(truth.tool_velocity, way);
    const double runs = dot(truth.tip_velocity, way) + trial.world().arm->state().surface_speed;
    if (std::abs(finger) > kSlides) (finger > 0.0 ? surface.there : surface.back).add(runs);
    const double along = dot(truth.contact_force, way);
    const bool slips = std::abs(along) > grip * (truth.contact_force - along * way).norm();
    if (!slips && finger > 0.0) surface.felt.add(finger);
  }
  return surface;
}

void run_drum(const BenchContext& context, const Adder& add) {
  const models::Setup setup = shipped(context, "drum");
  const double wanted = trial::prepare_setup(setup).objects[0].prop_speed();
  std::vector<Running> slides(context.quick ? 1 : kSeeds), rests(slides.size());
  in_parallel(slides.size(), [&](std::size_t i) {
    slides[i] = running_surface(context, context.seed + i, {"user.slide_mm=25", "user.slide_mm_s=100"});
    rests[i] = running_surface(context, context.seed + i, {});
  });
  double error = 0.0, step = 0.0, sideways = 0.0;
  Mean felt;
  for (const Running& slide : slides) {
    error = std::max(error, slide.error(wanted));
    felt.add(slide.felt.value());
  }
  for (const std::vector<Running>* runs : {&slides, &rests})
    for (const Running& one : *runs) {
      step = std::max(step, one.step);
      sideways = std::max(sideways, one.sideways / one.normal);
    }
  const double friction = setup.twin.arm.prop_friction;
  add("drum.speed_error", error, "%",
      "of the touched surface, prop's own motion and belt's together, on average while the finger slides 25 "
      "mm "
      "along it, faster than it runs, or back, seen by the tracker that ships; the worse of both, of all "
      "seeds",
      kUnset, 10.0);
  add("drum.sideways.max", 100.0 * sideways, "%",
      fmt::format("of the normal force, where that is more than 1 N; friction: {:g} %", 100.0 * friction),
      kUnset, 110.0 * friction);
  add("drum.step.max", step, "N",
      "of the force along the normal, from one ms to the next, from touch to release", kUnset, 0.4);
  add("drum.felt_speed", 1e3 * felt.value(), "mm/s",
      fmt::format("of the finger, where the surface neither drags nor holds it; the drum: {:g} mm/s",
                  1e3 * wanted),
      kUnset, kUnset);
}

}  // namespace

void slide_over_keys(const BenchContext& context, BenchResult& result, const Adder& add) {
  const std::vector<std::string> all{"key_1", "key_4", "key_7", "key_10"};
  std::vector<Row> rows(context.quick ? 1 : all.size());
  in_parallel(rows.size(), [&](std::size_t i) { rows[i] = slide_row(context, all[i]); });
  Row sum;
  Table table{"switching_rows",
              "A finger slides over the rows of the keypad and back",
              {"first key", "switches", "felt = meant (%)", "largest step at a switch (N/ms)"},
              {}};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    sum.meant += rows[i].meant;
    sum.felt += rows[i].felt;
    sum.step = std::max(sum.step, rows[i].step);
    table.rows.push_back({all[i], std::to_string(rows[i].switches),
                          fmt::format("{:.1f}", 100.0 * rows[i].felt / rows[i].meant),
                          fmt::format("{:.2f}", rows[i].step)});
  }
  add("keys.felt_is_meant", 100.0 * sum.felt / sum.meant, "%",
      "of the time with a force: the key that is rendered is the one that the true finger is nearest to",
      90.0, 100.0);
  add("keys.step_at_switch.max", sum.step, "N",
      "true contact force, from one ms to the next: the prop comes to the next key under a finger that is "
      "pressed",
      kUnset, kUnset);
  result.tables.push_back(std::move(table));
}

void move_things(const BenchContext& context, BenchResult& result, const Adder& add) {
  hit_balls(context, result, add);
  const TileEnd bar = push_tile(context, "bar"), way = push_tile(context, "way");
  add("tile.end", 1e3 * bar.way, "mm", "pushed with 1.2 N: it stops at the end of its way, 30 mm", 29.99,
      30.01);
  add("tile.end_speed", 1e3 * bar.speed, "mm/s", "there", 0.0, 0.0);
  add("tile.blocked", 1e3 * way.way, "mm",
      "the other one, pushed first: it stops at its neighbour, 7.5 mm away", 7.49, 7.51);
  run_drum(context, add);
}

}  // namespace enc::bench::switching
