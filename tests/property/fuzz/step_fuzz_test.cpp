// step() with every input that devices can produce: random scenes of both machines, 20 s each, and the checks
// on each tick.
#include <array>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/control/scene/scene.h"
#include "core/control/step.h"
#include "core/record/state_hash.h"
#include "models/shapes/shapes.h"
#include "tests/support/built.h"
#include "tests/support/by_hand.h"
#include "tests/support/scenes.h"
#include "trial/assemble/assemble.h"

namespace enc::test {
namespace {

// ---- Random scenes of both machines, with rigs that match them.

struct Random {
  std::mt19937_64 engine;
  double in(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine); }
  Vec3 vec(double size) { return {in(-size, size), in(-size, size), in(-size, size)}; }
  bool once_in(unsigned n) { return engine() % n == 0; }
  std::size_t of(std::size_t n) { return static_cast<std::size_t>(engine() % n); }
};

struct RandomScene {
  std::string what;
  Scene scene;
};
RandomScene draw_scene(std::uint64_t seed, Random& random);

Mesh wedge(double half_angle) {
  const double half = 0.08 * std::tan(half_angle);
  return prism({{-half, -0.05}, {half, -0.05}, {0.0, 0.03}}, 0.06);
}

SceneSpec hexapod_scene(Random& random, std::string& what) {
  const BehaviourSpec behaviour =
      random.once_in(2) ? lossy_ball() : spring(random.in(500.0, 20'000.0), random.in(0.002, 0.006));
  const Vec3 turn = random.vec(3.0);
  switch (random.of(8)) {
    case 0: {
      what = "two balls, display";
      return two_balls(behaviour);
    }
    case 1:
      what = "plane";
      return plane_scene(behaviour);
    case 2: {
      what = "plane without a tracker";
      SceneSpec spec = plane_scene(behaviour);
      spec.tracker.reset();
      spec.tools.clear();
      return spec;
    }
    case 3:
      what = "cube";
      return mesh_scene(box(0.06, 0.06, 0.06), -0.022, Vec3::Zero(), behaviour);
    case 4:
      what = "turned cube";
      return mesh_scene(box(0.06, 0.06, 0.06), -0.022, turn, behaviour);
    case 5:
      what = "wedge";
      return mesh_scene(wedge(random.in(0.25, 0.8)), -0.02, Vec3(0, 0, turn.z()), behaviour);
    case 6:
      what = "groove";
      return mesh_scene(groove(), -0.01, Vec3(0, 0, turn.z()), behaviour);
    default: {
      static const Mesh hare = models::hare_mesh();
      what = "hare";
      return mesh_scene(hare, -0.018, Vec3(0, 0, turn.z()), behaviour);
    }
  }
}

RigSpec drawn_rig(Random& random) {
  RigSpec rig;
  constexpr std::array kPredictions{Prediction::hold, Prediction::constant_velocity,
                                    Prediction::constant_acceleration};
  rig.tracker.prediction = kPredictions[random.of(3)];
  constexpr std::array kTares{Tare::start, Tare::free, Tare::window};
  rig.force.tare = kTares[random.of(3)];
  rig.force.filter = random.in(2.0, 50.0);
  rig.manipulator.speed = random.in(0.02, 0.2);
  rig.manipulator.acceleration = random.in(0.2, 3.0);
  rig.contact.softest = 0.0;
  if (random.once_in(4)) rig.admittance.damping = Damping::observed;
  return rig;
}

const std::vector<std::string> kArmScenes{"wall", "button", "keypad", "room", "hit_ball", "drum"};

RandomScene draw_scene(std::uint64_t seed, Random& random) {
  RandomScene drawn;
  if (seed % 4 == 3) {
    static std::map<std::string, models::Setup> setups;
    const std::string name = kArmScenes[random.of(kArmScenes.size())];
    if (!setups.contains(name))
      setups[name] = models::load(tests::source_dir() + "/models/scenes/" + name + ".toml", "", {});
    drawn.what = "arm, " + name;
    drawn.scene = trial::prepare_setup(setups[name]);
    return drawn;
  }
  const SceneSpec spec = hexapod_scene(random, drawn.what);
  SceneSpec with = spec;
  with.follow.inset = random.in(20e-6, 0.5e-3);
  if (with.tracker && with.tools.size() == 1) {
    ToolSpec other = with.tools.front();
    other.name = "other";
    for (Vec3& marker : other.markers) marker *= 1.3;
    with.tools.push_back(other);
  }
  drawn.scene = prepare(with, drawn_rig(random));
  return drawn;
}

// ---- Checks on each tick of a fuzz: modes have their causes, commands keep their limits. Empty: nothing is
// wrong.

// Counts ticks on which a mode outlives its cause (mode.h), by the core's own estimates.
class Modes {
 public:
  std::int64_t judged = 0;  // ticks on which a hold would have been wrong
  std::string judge(const Scene& scene, const State& state, const Outputs& out, bool well);

 private:
  double well_ = 0.0, far_ = 0.0, restore_ = 0.0, loose_ = 0.0, in_contact_ = 0.0;
  double alone_ = 0.0,
         same_force_ = 0.0;  // s of a constant force of that many N, with its tool out of view
};

// Checks the commands of a position-controlled machine and the targets of an arm.
class Limits {
 public:
  std::string judge(const Scene& scene, const State& state, const Outputs& out);

 private:
  std::string judge_machine(const Scene& scene, const State& state, const Outputs& out);
  std::string judge_arm(const Scene& scene, const State& state, const Outputs& out);
  static bool anew(const Outputs& out) { return out.mode == Mode::hold; }

  bool known_ = false;
  Vec3 before_{0, 0, 0}, velocity_{0, 0, 0};
};

constexpr double kGuard = 50e-6;  // m

std::string Modes::judge(const Scene& scene, const State& state, const Outputs& out, bool well) {
  const bool tool_known = std::isfinite(out.gap);
  const double dt = scene.dt;
  well_ = well ? well_ + dt : 0.0;
  judged += well_ > 1.5 ? 1 : 0;
  // After 1.5 s without a fault nothing holds. Exceptions: a stuck arm while the finger is there, and a tip
  // that is outside and on its way back.
  if (out.mode == Mode::hold && well_ > 1.5 && !recall<ImpedanceState>(state).aim.stuck &&
      !recall<CommandState>(state).following.lost && (out.why & kOutsideObject) == 0)
    return "hold goes on: " + why_text(out.why);
  if ((out.mode == Mode::hold) != ((out.why & kHoldReasons) != 0))
    return "hold without a reason, or a reason without";
  if (out.mode == Mode::hold) return {};
  const bool far =
      state.mode == Mode::follow && scene.has_tracker && tool_known && out.gap > scene.follow.pause;
  far_ = far ? far_ + dt : 0.0;
  if (far_ > 1.5 * dt) return "follow beyond the pause distance";
  restore_ = state.mode == Mode::restore ? restore_ + dt : 0.0;
  if (restore_ > 2.0 + 2.0 * dt) return "restore goes on";
  if (scene.impedance()) {
    if (state.mode == Mode::contact && out.gap > scene.contact.leave_gap)
      return "contact beyond the leave gap";
    return {};
  }
  if (state.mode != Mode::contact) {
    loose_ = in_contact_ = alone_ = 0.0;
    return {};
  }
  in_contact_ += dt;
  const double force = -out.force.xyz[2];
  const bool own = tool_known && (!scene.has_tracker || state.tool.value.tool == contact_of(state).tool);
  const bool near = own && out.gap <= scene.contact.leave_gap;
  const bool elsewhere = !own && (!tool_known || out.gap > scene.force.tare_clearance);
  const bool same = std::abs(force - same_force_) <= 0.15 * scene.force.contact;
  if (!same) same_force_ = force;
  alone_ = !own && same ? alone_ + dt : 0.0;
  // Late poses do not count, and their delay is unknown here: allow half as long again.
  const double longest = elsewhere && force <= 3.0 * scene.force.contact ? 7.5 : 90.0;
  const bool pressed = force >= 0.5 * scene.force.contact && (own ? out.gap <= 10e-3 : alone_ <= longest);
  const bool coming = in_contact_ < 0.5 && tool_known && out.gap <= 10e-3;
  loose_ = near || pressed || coming ? 0.0 : loose_ + dt;
  const bool damped = scene.admittance()->damping && !(tool_known && out.gap > 10e-3);
  if (loose_ > scene.contact.leave_time + (damped ? 5.0 : 0.0) + 3.0 * dt)
    return fmt::format("contact goes on: force {} N, gap {} mm", force, out.gap * 1e3);
  return {};
}

std::string Limits::judge(const Scene& scene, const State& state, const Outputs& out) {
  return scene.impedance() ? judge_arm(scene, state, out) : judge_machine(scene, state, out);
}

std::string Limits::judge_machine(const Scene& scene, const State& state, const Outputs& out) {
  if (!state.started) return {};
  if (!out.manipulator.tip.valid()) return "the command is not a pose";
  if (!scene.reach.contains(out.manipulator.tip)) return "the command is out of reach";
  const Vec3 at = out.manipulator.tip.p();
  if (!known_) before_ = at - scene.dt * recall<CommandState>(state).command_velocity.e();
  const Vec3 velocity = (at - before_) / scene.dt;
  const double change = (velocity - velocity_).norm() / scene.dt;
  known_ = true;
  before_ = at;
  velocity_ = velocity;
  if (velocity.norm() > scene.reach.speed * (1 + 1e-9)) return fmt::format("{} m/s", velocity.norm());
  if (change > scene.reach.acceleration * (1 + 1e-6)) return fmt::format("{} m/s^2", change);
  if (!state.entered || state.object < 0) return {};
  const Object& object = scene.objects[static_cast<std::size_t>(state.object)];
  const double outside =
      object.surface.nearest(object.X_WO.inverse() * (scene.X_WR * recall<CommandState>(state).command))
          .distance +
      scene.tip_radius;
  if (outside > kGuard) return fmt::format("the tip is sent {:.1f} um outside", outside * 1e6);
  return {};
}

std::string Limits::judge_arm(const Scene& scene, const State& state, const Outputs& out) {
  if (!out.arm.force.finite()) return {};
  const ArmRig& rig = scene.impedance()->rig;
  if (!(out.force_unfiltered.norm() <= rig.peak * (1 + 1e-9))) return "more force than the arm has";
  const Vec3 velocity = recall<ImpedanceState>(state).aim.velocity.e(),
             at = recall<ImpedanceState>(state).aim.target.e();
  // Along the normal of a ball that is hit the finger moves the prop, and the target follows the prop.
  const bool hit = out.mode == Mode::contact && state.object >= 0 &&
                   scene.objects[static_cast<std::size_t>(state.object)].interaction.kind == Interaction::hit;
  const Vec3 normal = hit ? Vec3(contact_of(state).X_WN.q() * Vec3::UnitZ()) : Vec3(Vec3::Zero());
  const auto of_the_arm = [&](const Vec3& v) { return Vec3(v - normal * normal.dot(v)); };
  if (velocity.norm() > rig.speed * (1 + 1e-9)) return fmt::format("target at {} m/s", velocity.norm());
  std::string what;
  // A hold, or an arm without measurements, begins anew at the arm's place.
  if (known_ && !anew(out) && of_the_arm(at - before_).norm() > rig.speed * scene.dt * (1 + 1e-6))
    what = fmt::format("target leaps by {} mm", 1e3 * (at - before_).norm());
  const double change = of_the_arm(velocity - velocity_).norm();
  const double most = recall<ImpedanceState>(state).aim.hurried ? rig.reach_acceleration : rig.acceleration;
  if (known_ && !anew(out) && change > most * scene.dt * (1 + 1e-6))
    what = fmt::format("target at {} m/s^2", change / scene.dt);
  known_ = recall<ImpedanceState>(state).aim.target.finite() && !anew(out);
  before_ = at;
  velocity_ = velocity;
  return what;
}

// ---- step() with every input that devices can produce: random scenes of both machines, 20 s each. Each tick
// checks four things. The command is within speed, acceleration and reach. The whole tip at the command is
// inside the object. No mode outlives its cause (mode.h). The hold ends when all is well again.
//
// ENCOUNTER_FUZZ_SCENES and ENCOUNTER_FUZZ_SEED lengthen and vary the test: 600 scenes take some minutes.

struct Tally {
  std::array<std::int64_t, kModes> ticks{};
  std::int64_t inside = 0, well = 0, not_following = 0;
};

// A hand, its tool and the devices, which report a machine that follows as the rig assumes, or at once.
class World {
 public:
  World(const Scene& scene, Random& random) : scene_(scene), random_(random), lags_(random.once_in(2)) {
    k_.dt = from_seconds(scene.dt);
    const Pose<'R', 'H'> zero = scene.reach.machine.zero();
    at_ = sent_ = zero.p();
    if (scene.impedance()) {
      joints_ = scene.impedance()->arm.zero();
      at_ = sent_ = scene.impedance()->arm.tip(joints_).e();
      // Half of the arms are at their targets; the others stay at home, and half of these need not follow.
      stuck_ = !lags_ && random.once_in(2);
      in.withheld = !lags_ && !stuck_;
    }
    honest_ = random.once_in(3);  // the devices report the truth, only the hand touches the tip
    jams_ = !scene.impedance() && random.once_in(4);
    if (!honest_ && random.once_in(3)) zero_jump_ = random.in(0.05, 0.4);
    FieldSpoiler count{random.engine, -1};
    fields(count, in);
    numbers_ = count.seen;
    pace_ = random.in(0.0, 1.0);
  }

  // Sets the devices' values for this tick before step(). Returns false if a value is wrong.
  bool sense() {
    if (k_.index % 2000 == 0) {  // new faults every 2 s
      constexpr std::array<unsigned, 5> kSpoil{0, 0, 500, 20, 3};
      spoil_every_ = kSpoil[random_.of(kSpoil.size())];
      seen_ = !random_.once_in(4);
      drift_ = random_.once_in(3) ? Vec3(0, 0, random_.in(-0.05, 0.05)) : Vec3(0, 0, 0);
    }
    if (honest_) spoil_every_ = 0;
    if (zero_.norm() > 0.1) drift_ = -0.5 * zero_;
    if (zero_jump_ > 0.0 && k_.index >= 2500) {  // after the first tare, and permanently
      zero_ = Vec3(0, 0, -zero_jump_);
      drift_ = Vec3(0, 0, 0);
    }
    // The tool goes out of view, and another one lies in its place or is taken up.
    if (scene_.tools.size() > 1 && !honest_ && random_.once_in(4000)) {
      other_until_ = k_.index + 500 + static_cast<std::int64_t>(random_.of(12'000));
      other_ = Vec3(random_.in(-0.15, 0.15), random_.in(-0.15, 0.15), random_.in(-0.01, 0.15));
    }
    if (random_.once_in(1500)) gone_until_ = k_.index + 50 + static_cast<std::int64_t>(random_.of(450));
    if (jams_ && random_.once_in(3000))
      jammed_until_ = k_.index + 200 + static_cast<std::int64_t>(random_.of(1800));
    const bool seen = seen_ && k_.index >= gone_until_;
    move_hand();
    machine();
    bool well = seen && spoil_every_ == 0 && zero_.norm() < 0.05;
    clean_ = seen && spoil_every_ == 0 && k_.index >= other_until_ ? clean_ + scene_.dt : 0.0;
    in.missed = 0;
    say_machine();
    if (scene_.has_tracker && seen && k_.index % 8 == 0) say_tool();
    if (scene_.has_display && k_.index % 16 == 0) in.dent = {DentSample{}, k_.t, Health::ok};
    if (spoil_every_ != 0 && random_.engine() % spoil_every_ == 0) {
      FieldSpoiler one{random_.engine, static_cast<int>(random_.of(static_cast<std::size_t>(numbers_)))};
      fields(one, in);
      in.withheld = scene_.impedance() && !lags_ && !stuck_;
      well = false;
    }
    return well;
  }
  void told(const Outputs& out, const State& state) {
    if (scene_.impedance() && lags_ && recall<ImpedanceState>(state).aim.target.finite())
      (void)scene_.impedance()->arm.inverse(scene_.X_WR.inverse() * recall<ImpedanceState>(state).aim.target,
                                            joints_);
    if (!scene_.impedance() && state.started) sent_ = out.manipulator.tip.p();
    ++k_.index;
    k_.t += k_.dt;
  }
  // Compares the core's estimates with the truth, and detects a machine that does not follow.
  std::string judge(const State& state, const Outputs& out) {
    if (scene_.has_tracker && clean_ > 0.4 && std::isfinite(out.gap)) {
      const double wrong = (out.view.tip.e() - hand_).norm();
      // Vision measures a finger with 0.5 mm of noise, so its tolerance is wider than a tool's.
      if (wrong > (scene_.impedance() ? 4e-3 + 0.2 * fastest_ : 1.5e-3 + 0.08 * fastest_))
        return fmt::format("the tool is {:.2f} mm from where it is believed", 1e3 * wrong);
    }
    if (honest_ && scene_.has_force && scene_.has_tracker)
      for (int i = 0; i < 3; ++i)
        if (recall<CommandState>(state).force_zero.e()[i] < zero_low_[i] - 0.05 ||
            recall<CommandState>(state).force_zero.e()[i] > zero_high_[i] + 0.05)
          return fmt::format("a zero of {:.3f} N is believed, which was {:.3f} to {:.3f} N",
                             recall<CommandState>(state).force_zero.e()[i], zero_low_[i], zero_high_[i]);
    const bool held = out.mode == Mode::hold;
    if (scene_.impedance()) {
      const bool off =
          stuck_ && recall<ImpedanceState>(state).aim.target.finite() &&
          recall<ImpedanceState>(state).aim.velocity.norm() < 1e-3 &&
          (recall<ImpedanceState>(state).aim.target.e() - scene_.X_WR.q() * at_ - scene_.X_WR.p()).norm() >
              6.5e-3 &&
          (hand_ - scene_.X_WR.q() * at_ - scene_.X_WR.p()).norm() > 0.05;
      off_ = off && !held && out.arm.force.finite() ? off_ + scene_.dt : 0.0;
      return off_ > 0.8 ? "an arm that is stuck goes unnoticed" : "";
    }
    const double most = 1e-3 + 2.0 * scene_.servo.lag * scene_.reach.speed;
    off_ = (sent_ - at_).norm() > most && !held ? off_ + scene_.dt : 0.0;
    return off_ > 0.1 ? "a machine that is jammed goes unnoticed" : "";
  }
  [[nodiscard]] const Tick& tick() const { return k_; }
  Inputs in;

 private:
  // The hand glides over the objects, stands or leaps; slowly or as fast as a hand can.
  void move_hand() {
    if (random_.once_in(pace_ < 0.5 ? 1500 : 300)) {
      aim_ = Vec3(random_.in(-0.07, 0.07), random_.in(-0.07, 0.07), random_.in(-0.03, 0.05));
      // A faster hand would press before the tracker shows it near.
      speed_ = honest_ ? random_.in(0.005, 0.1) : random_.once_in(4) ? 1.0 : random_.in(0.005, 0.2);
      if (random_.once_in(8)) aim_.z() += 0.15;
    }
    if (!honest_ && random_.once_in(5000)) {
      hand_ = aim_;
      clean_ = 0.0;
    }
    const Vec3 way = aim_ - hand_;
    const double far = way.norm();
    const double share = far > 1e-9 ? std::min(1.0, speed_ * scene_.dt / far) : 0.0;
    hand_ += share * way;
    fastest_ = std::max(share * far / scene_.dt, fastest_ - 1.0 * scene_.dt);
    zero_ += drift_ * scene_.dt;
    zero_low_ = zero_low_.cwiseMin(zero_);
    zero_high_ = zero_high_.cwiseMax(zero_);
    if (!honest_ && random_.once_in(4000))
      junk_ = random_.once_in(2) ? Vec3(0, 0, 0) : Vec3(random_.vec(6.0));
  }
  void machine() {
    if (scene_.impedance()) return;
    if (k_.index < jammed_until_) {
      velocity_ = Vec3::Zero();
      return;
    }
    if (!lags_) {
      velocity_ = (sent_ - at_) / scene_.dt;
      at_ = sent_;
      return;
    }
    const double w = scene_.servo.frequency, dt = scene_.dt;
    velocity_ += dt * (w * w * (sent_ - at_) - 2.0 * scene_.servo.damping * w * velocity_);
    at_ += dt * velocity_;
  }
  void say_machine() {
    if (scene_.impedance()) {
      in.arm = {{joints_, {}, scene_.impedance()->arm.tip(joints_), Vec<'R'>::zero()}, k_.t, Health::ok};
      return;
    }
    const Pose<'R', 'H'> pose(scene_.X_WR.q().conjugate(), at_);
    in.tip = {{pose, Vec<'R'>(velocity_), Vec<'R'>::zero()}, k_.t, Health::ok};
    const Pose<'W', 'H'> X_WH = scene_.X_WR * pose;
    // The tool presses the tip with 2 N/mm if they touch; another force may press, too.
    Vec3 force = junk_;
    if (!scene_.tools.empty()) {
      const Vec3 apart = X_WH.p() - hand_;
      const double deep = scene_.tip_radius + scene_.tools[0].tip.radius - apart.norm();
      if (deep > 0.0 && apart.norm() > 1e-9) force += std::min(40.0, 2000.0 * deep) * apart.normalized();
    }
    const Vec<'W'> dead = scene_.force.mass * Vec<'W'>(0, 0, -9.80665);
    in.wrench = {
        {(X_WH * scene_.X_HF).inverse() * (Vec<'W'>(force) + dead) + Vec<'F'>(zero_), Vec<'F'>::zero()},
        k_.t,
        Health::ok};
  }
  void say_tool() {
    const bool other = k_.index < other_until_;
    const Vec3 noisy = (other ? other_ : hand_) + random_.vec(20e-6);
    const std::int32_t tool = other ? 1 : 0;
    const Pose<'W', 'T'> X_WT(Quat::Identity(),
                              noisy - scene_.tools[static_cast<std::size_t>(tool)].tip.centre.e());
    in.tool = {{tool, scene_.X_WC.inverse() * X_WT}, k_.t - Duration(15'000'000), Health::ok};
  }

  const Scene& scene_;
  Random& random_;
  bool lags_;
  Tick k_;
  int numbers_ = 0;
  double pace_ = 0.0;
  Vec3 hand_{0, 0, 0.04}, aim_{0, 0, 0.04}, junk_{0, 0, 0}, zero_{0, 0, 0}, drift_{0, 0, 0};
  Vec3 at_, sent_, velocity_{0, 0, 0};
  PerJoint joints_{};
  Vec3 zero_low_{0, 0, 0}, zero_high_{0, 0, 0};
  double speed_ = 0.05, fastest_ = 0.0, clean_ = 0.0, off_ = 0.0;
  unsigned spoil_every_ = 0;
  std::int64_t gone_until_ = 0, jammed_until_ = 0, other_until_ = 0;
  Vec3 other_{0, 0, 0};
  double zero_jump_ = 0.0;  // N
  bool seen_ = true, honest_ = false, jams_ = false, stuck_ = false;
};

std::string fuzz(std::uint64_t seed, double length, Tally& tally) {
  Random random{std::mt19937_64(seed)};
  const RandomScene drawn = draw_scene(seed, random);
  const Scene& scene = drawn.scene;
  World world(scene, random);
  State state;
  Outputs out;
  Modes modes;
  Limits limits;
  const auto ticks = static_cast<std::int64_t>(length / scene.dt);
  for (std::int64_t i = 0; i < ticks; ++i) {
    const bool well = world.sense();
    step(scene, world.tick(), world.in, state, out);
    ++tally.ticks[static_cast<std::size_t>(out.mode)];
    tally.inside += state.entered ? 1 : 0;
    tally.not_following += (out.why & kNotFollowing) != 0 ? 1 : 0;
    std::string bad = limits.judge(scene, state, out);
    if (bad.empty()) bad = modes.judge(scene, state, out, well);
    if (bad.empty()) bad = world.judge(state, out);
    if (!bad.empty())
      return fmt::format("seed {} ({}), tick {}, {} ({}): {}", seed, drawn.what, i, mode_name(out.mode),
                         why_text(out.why), bad);
    world.told(out, state);
  }
  tally.well += modes.judged;
  return {};
}

std::uint64_t number_of(const char* variable, std::uint64_t otherwise) {
  const char* text = std::getenv(variable);
  return text != nullptr ? std::strtoull(text, nullptr, 10) : otherwise;
}

class StepFuzz : public testing::TestWithParam<int> {};

// Shards let ctest run the scenes in parallel.
TEST_P(StepFuzz, StaysWithinLimitsInsideAndWithinItsModes) {
  constexpr std::uint64_t kShards = 4;
  const std::uint64_t scenes = number_of("ENCOUNTER_FUZZ_SCENES", 96);
  const std::uint64_t first = number_of("ENCOUNTER_FUZZ_SEED", 1);
  const double length = scenes > 100 ? 20.0 : 6.0;
  const auto start = std::chrono::steady_clock::now();
  Tally tally;
  int bad = 0;
  const auto shard = static_cast<std::uint64_t>(GetParam());
  for (std::uint64_t i = shard; i < scenes; i += kShards) {
    const std::string what = fuzz(first + i, length, tally);
    bad += what.empty() ? 0 : 1;
    EXPECT_EQ(what, "");
  }
  std::string seen;
  for (int i = 0; i < kModes; ++i)
    seen += fmt::format(" {} {}", mode_name(static_cast<Mode>(i)), tally.ticks[static_cast<std::size_t>(i)]);
  fmt::print(
      "fuzz: seeds {}..{} (each {}th), {} s each, {} bad; ticks:{}; inside {}, well {}, not following {}; "
      "{:.1f} s\n",
      first + shard, first + scenes - 1, kShards, length, bad, seen, tally.inside, tally.well,
      tally.not_following, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  EXPECT_GT(tally.inside, 0);
  EXPECT_GT(tally.well, 0);
  const auto ticks = [&](Mode mode) { return tally.ticks[static_cast<std::size_t>(mode)]; };
  for (const Mode mode : {Mode::away, Mode::follow, Mode::contact, Mode::hold})
    EXPECT_GT(ticks(mode), 100) << mode_name(mode);
  if ((first + shard) % 4 != 3) {  // only for machines, not arms
    EXPECT_GT(ticks(Mode::restore), 100);
  }
  if (scenes > 100) {
    EXPECT_GT(tally.not_following, 100);
  }
}
INSTANTIATE_TEST_SUITE_P(Shard, StepFuzz, testing::Range(0, 4));

}  // namespace
}  // namespace enc::test
