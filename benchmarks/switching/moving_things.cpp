// Keys, ball, tiles and drum in the twin, judged by the truth.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/switching/crowd.h"
#include "benchmarks/switching/switching.h"
#include "sim/mujoco.h"
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

struct Bounce {
  double speed = kUnset, approach = kUnset, restitution = kUnset;
  double rendered = 0.0,
         momentum = kUnset;  // N s: impulse of the force that the arm is told, and of the ball
};
// A hand goes on evenly, as the law means it, up to what it presses; so that is put behind the ball, where it
// does not disturb the hit.
models::Setup even_hit(const BenchContext& context, double speed, double restitution) {
  models::Setup setup =
      live(context, "hit_ball",
           {fmt::format("user.approach_mm_s=[{}]", 1e3 * speed), "user.approach_from_mm=140",
            "tool.finger.mass_kg=1", "truth.hand.grip_stiffness_N_per_mm=10",
            "truth.hand.grip_damping_Ns_per_m=1500", "truth.hand.mass_kg=20",
            "truth.hand.stiffness_N_per_mm=5", "truth.hand.damping_Ns_per_m=500", "truth.hand.strength_N=1e6",
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

// Speeds along the normal at the ticks where they meet and part: of the true finger, and of the ball, which
// is the core's.
Bounce hit_once(const BenchContext& context, double speed, double restitution) {
  trial::Trial trial(even_hit(context, speed, restitution), options_of(context));
  const Object& ball = trial.scene().objects[0];
  Bounce bounce{speed};
  double parted = kUnset, now = 0.0;
  while (trial.tick() && !(now > parted + 0.03)) {
    const sim::Truth& truth = trial.world().truth();
    const Moved& moved = trial.state().moved[0];
    now = seconds(truth.t.time_since_epoch());
    const Vec3 normal = (truth.tool_tip - (ball.X_WO.origin() + moved.shift)).e().normalized();
    const double finger = -normal.dot(truth.tool_velocity.e());
    const bool met = std::isfinite(bounce.approach);
    if (met || moved.depth > 0.0) bounce.rendered -= trial.scene().dt * normal.dot(trial.outputs().felt.e());
    if (!met && moved.depth > 0.0) bounce.approach = finger;
    if (!met || moved.depth > 0.0 || std::isfinite(parted)) continue;
    parted = now;
    bounce.restitution = (-normal.dot(moved.velocity.e()) - finger) / bounce.approach;
    bounce.momentum = ball.interaction.mass * moved.velocity.norm();
  }
  return bounce;
}

void hit_balls(const BenchContext& context, BenchResult& result, const Adder& add) {
  const std::vector<double> set =
      context.quick ? std::vector<double>{0.8} : std::vector<double>{0.2, 0.4, 0.6, 0.8, 1.0};
  const std::vector<double> speeds =
      context.quick ? std::vector<double>{0.3} : std::vector<double>{0.1, 0.3, 0.6};
  std::vector<Bounce> hits(set.size() * speeds.size());
  in_parallel(hits.size(), [&](std::size_t i) {
    hits[i] = hit_once(context, speeds[i % speeds.size()], set[i / speeds.size()]);
  });
  Plot plot{"switching_restitution",
            "A ball that is hit in the twin",
            "restitution that is set",
            "restitution measured",
            false,
            false,
            {}};
  Table table{"switching_hits",
              "Hits in the twin",
              {"set", "wanted approach (m/s)", "at the touch (m/s)", "measured",
               "impulse of the rendered force (mN s)", "momentum of the ball (mN s)"},
              {}};
  double worst = 0.0;
  for (std::size_t k = 0; k < speeds.size(); ++k) {
    Series series{fmt::format("{:g} m/s", speeds[k]), {}, {}};
    series.mark = Mark::both;
    for (std::size_t i = 0; i < set.size(); ++i) {
      const Bounce& hit = hits[i * speeds.size() + k];
      series.x.push_back(set[i]);
      series.y.push_back(hit.restitution);
      const double error = std::abs(hit.restitution / set[i] - 1.0);
      worst = std::max(worst, std::isfinite(error) ? error : std::numeric_limits<double>::infinity());
      table.rows.push_back({fmt::format("{:g}", set[i]), fmt::format("{:g}", speeds[k]),
                            fmt::format("{:.3f}", hit.approach), fmt::format("{:.3f}", hit.restitution),
                            fmt::format("{:.1f}", 1e3 * hit.rendered),
                            fmt::format("{:.1f}", 1e3 * hit.momentum)});
    }
    plot.series.push_back(std::move(series));
  }
  plot.caption = "Speeds along the normal at the ticks where true finger and ball meet and part.";
  double most = 0.0;
  for (const Bounce& hit : hits) most = std::max(most, hit.rendered / hit.momentum);
  add("hit.impulse_over_momentum.max", most, "x",
      "of the force that the arm is told, 30 ms beyond the touch, over the ball's: eq. 2 adds its damping to "
      "the spring",
      kUnset, kUnset);
  add("hit.restitution_error.max", 100.0 * worst, "%", "measured over set, over all hits", kUnset, 5.0);
  result.plots.push_back(std::move(plot));
  result.tables.push_back(std::move(table));
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
  const Moved& now = trial.state().moved[static_cast<std::size_t>(moving)];
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
// takes the prop along.
struct Running {
  Mean there, back;  // prop's own motion and belt's together, as the finger goes with it and against it
  Mean felt;         // of the finger, while it is neither dragged nor held
};
Running running_surface(const BenchContext& context) {
  trial::Trial trial(live(context, "drum", {"user.slide_mm=25", "user.slide_mm_s=100"}), options_of(context));
  const Object& drum = trial.scene().objects[0];
  const Vec<'W'> way = drum.X_WO * Vec<'O'>(drum.interaction.way);
  const double grip = 0.3 * trial.setup().twin.arm.prop_friction;
  constexpr double kSlides = 0.020;  // m/s
  Running surface;
  while (trial.tick()) {
    const sim::Truth& truth = trial.world().truth();
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
  const double wanted = trial::prepare_setup(live(context, "drum")).objects[0].prop_speed();
  const Running drum = running_surface(context);
  const auto error = [&](const Mean& runs) { return 100.0 * std::abs(runs.value() / wanted - 1.0); };
  add("drum.speed_error", std::max(error(drum.there), error(drum.back)), "%",
      "of the touched surface, prop's own motion and belt's together, on average while the finger slides 25 "
      "mm "
      "along it, faster than it runs, or back; the worse of both",
      kUnset, 5.0);
  add("drum.felt_speed", 1e3 * drum.felt.value(), "mm/s",
      fmt::format("of the finger, where the surface neither drags nor holds it; the drum: {:g} mm/s",
                  1e3 * wanted),
      kUnset, kUnset);
}

}  // namespace enc::bench::switching
