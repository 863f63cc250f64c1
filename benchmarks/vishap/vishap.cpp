#include "benchmarks/vishap/vishap.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <deque>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/precision.h"
#include "benchmarks/kit/scenes.h"
#include "benchmarks/reaching/reach_runs.h"
#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "core/machine/arm_shape.h"
#include "sim/camera/camera_scene.h"
#include "sim/world.h"
#include "trial/assemble/assemble.h"
#include "trial/assemble/vision.h"
#include "trial/identify/camera/registration_rig.h"
#include "trial/measure/finger_measure.h"
#include "trial/measure/frame_force.h"

namespace enc::bench::vishap {
namespace {

constexpr double kMeets = 0.6, kNobody = 0.1;  // shares of frames
constexpr double kTilt = 0.5;                  // rad: largest tilt of a prop about the wall's normal
constexpr double kOutOfPlane = staged::Draw{}.tilt, kTowards = 0.4;
// rad rms: error of the normal of a 40 mm ball for a finger that is estimated 2 mm beside its true place.
constexpr double kFacingOff = 0.05;

double uniform(sim::Stream& stream, double low, double high) { return low + (high - low) * stream.uniform(); }

// The joint angles that the encoders measure.
PerJoint measured(const sim::ArmTruth& arm, const PerJoint& q) {
  PerJoint said{};
  for (std::size_t i = 0; i < said.size(); ++i) {
    const double step = 2.0 * M_PI / (arm.counts[i] * arm.machine.drives[i].ratio);
    said[i] = step * std::floor(q[i] / step + 0.5);
  }
  return said;
}

// The experiment of [VisHap 3] as a whole: camera, fingertip, world, PHANToM. A finger comes with a constant
// speed, meets the prop, presses, slides and leaves. The rendered force is drawn over the distance that
// vision measures (Fig 5).

struct RunSetup {
  std::string scene;
  std::vector<std::string> set;
  double seconds = kUnset;
  std::int64_t reaches = 0;  // random reaches that replace the scene's programme
  std::uint64_t seed = 1;
  bool frames = false;  // a second core measures the change by each picture
};

struct RunResult {
  double simulated = 0.0, cpu = 0.0, yardstick = kUnset;  // s
  trial::TrialResult result;
  std::vector<trial::FingerEncounter> meetings;
  std::vector<reaching::ReachOutcome> reaches;
  double far_speed = 0.0, slope = kUnset, believed = kUnset, r2 = kUnset;
  double step = 0.0;  // N: of Lambda f along the normal, from tick to tick in contact
  std::vector<trial::FrameForce::Change> frames;  // change by each picture
  std::vector<SeenForce> pictures;                // in contact
  std::vector<double> behind;                     // m: prop's middle from the finger, along the surface
  double off_button = 0.0;                        // m: prop from the middle of its object while it waits
  std::vector<double> off;                        // m: arrived place less the true place at its exposure
  std::vector<double> off_normal;                 // m: along the surface's normal
};

// True and rendered values at exposures whose pictures are still to arrive.
struct ExposureTruth {
  Time t{};
  Point<'W'> tip;
  double felt = 0.0, pushed = 0.0;
  bool contact = false;
};

class Onlooker {
 public:
  Onlooker(RunResult& ran, bool forgets_radius) : ran_(ran), forgets_radius_(forgets_radius) {}
  void see(const trial::Glance& glance) {
    finger_.see(glance);
    reach_.see(glance);
    const bool contact = glance.out.mode == Mode::contact;
    const double felt = -glance.out.force.xyz[2];
    if (contact && before_ && std::isfinite(felt) && std::isfinite(last_))
      ran_.step = std::max(ran_.step, std::abs(felt - last_));
    before_ = contact;
    last_ = felt;
    const trial::TrueDepth at = trial::true_depth(glance);
    const double pushed = at.normal.finite() ? -dot(glance.truth.contact_force, at.normal) : kUnset;
    line_.push_back({glance.tick.t, glance.truth.tool_tip, felt, pushed, contact});
    watch_prop(glance, at);
    if (line_.size() > 400) line_.pop_front();
    take(glance);
  }
  void finish() {
    ran_.meetings = finger_.meetings();
    ran_.reaches = reach_.reaches();
    ran_.far_speed = finger_.far_speed();
    ran_.slope = finger_.fit().slope();
    ran_.r2 = finger_.fit().r2();
    ran_.believed = finger_.believed().slope();
  }

 private:
  // Behind the finger in contact; at the object's place while the finger is near.
  void watch_prop(const trial::Glance& glance, const trial::TrueDepth& at) {
    constexpr double kPrepared = 0.3;  // s
    if (!at.normal.finite()) return;
    const double now = seconds(glance.truth.t.time_since_epoch());
    if (glance.out.mode == Mode::away) near_since_ = now;
    const Vec3 apart = (at.touching - glance.truth.tip).e(), n = at.normal.e();
    if (glance.out.mode == Mode::contact && glance.truth.touching)
      ran_.behind.push_back((apart - n.dot(apart) * n).norm());
    const Object& object = glance.scene.objects[static_cast<std::size_t>(glance.out.object)];
    if (glance.out.mode == Mode::follow && now - near_since_ > kPrepared)
      ran_.off_button = std::max(ran_.off_button, (glance.truth.tip - object.X_WO.origin()).norm());
  }
  void take(const trial::Glance& glance) {
    const Measurement<TrackedTool>& told = glance.in.tool;
    if (told.health != Health::ok || told.value.tool < 0 || told.t == newest_) return;
    newest_ = told.t;
    const auto then =
        std::find_if(line_.begin(), line_.end(), [&](const ExposureTruth& m) { return m.t == told.t; });
    if (then == line_.end()) return;
    const Point<'W'> at = glance.scene.X_WC * told.value.X_CT.origin();
    ran_.off.push_back((at - then->tip).norm());
    const std::int32_t object = glance.out.object;
    if (object < 0) return;
    const trial::PropTarget surface =
        trial::wanted_at(glance.scene.objects[static_cast<std::size_t>(object)], at);
    ran_.off_normal.push_back(dot(at - then->tip, surface.normal));
    if (!then->contact) return;
    const double radius = forgets_radius_ ? 0.0 : glance.truth.tool_radius;
    ran_.pictures.push_back({surface.distance - radius, then->felt, then->pushed});
  }

  RunResult& ran_;
  bool forgets_radius_;
  double near_since_ = 0.0;
  trial::FingerMeasure finger_;
  reaching::ReachMeasure reach_;
  std::deque<ExposureTruth> line_;
  Time newest_{};
  bool before_ = false;
  double last_ = kUnset;
};

RunResult run_one(const BenchContext& context, const RunSetup& asked) {
  RunResult ran;
  Onlooker look(ran, asked.frames && context.mutated("forgets_radius"));
  Yardstick yardstick;
  const auto spend = yardstick.watch();
  trial::TrialOptions options{.seed = asked.seed,
                              .seconds = asked.seconds,
                              .drivers = modules_of(context),
                              .watch = [&](const trial::Glance& glance) {
                                look.see(glance);
                                spend(glance);
                              }};
  trial::FrameForce frames;
  if (asked.frames)
    options.law = [&](const Scene& scene, const Tick& tick, const Inputs& in, State& state, Outputs& out) {
      frames.step(scene, tick, in, state, out);
    };
  models::Setup setup = load_scene(context, asked.scene, asked.set);
  if (asked.reaches > 0) reaching::reach_at_random(setup, asked.reaches);
  trial::Trial trial(std::move(setup), options);
  const double start = thread_seconds();
  ran.result = trial.run();
  ran.cpu = thread_seconds() - start;
  ran.simulated = ran.result.simulated;
  ran.yardstick = yardstick.seconds();
  look.finish();
  ran.frames = frames.changes();
  if (ran.result.diverged_at >= 0)
    throw Error("a run of " + asked.scene + " diverged: " + ran.result.divergence);
  return ran;
}

void append(std::vector<double>& all, const std::vector<double>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

// Joins what more presses show. Slopes, pictures a second and cost stay those of the first run.
void join(RunResult& all, const RunResult& more) {
  all.meetings.insert(all.meetings.end(), more.meetings.begin(), more.meetings.end());
  all.frames.insert(all.frames.end(), more.frames.begin(), more.frames.end());
  all.pictures.insert(all.pictures.end(), more.pictures.begin(), more.pictures.end());
  append(all.behind, more.behind);
  append(all.off, more.off);
  append(all.off_normal, more.off_normal);
  all.step = std::max(all.step, more.step);
  all.far_speed = std::max(all.far_speed, more.far_speed);
}

// Presses and slides once for each speed, mm/s.
std::vector<std::string> strokes(const std::string& speeds) {
  return {"user.approach_mm_s=[" + speeds + "]",
          "user.press_s=2",
          "user.hold_s=0.3",
          "user.release_s=2",
          "user.rest_s=1.5",
          "user.depth_mm=10",
          "user.slide_mm=20",
          "user.slide_mm_s=60",
          "user.repeats=1"};
}

// Half the width and height, and half the focal length.
std::vector<std::string> quarter_size() {
  std::vector<std::string> set;
  for (const char* of : {"rig", "truth"})
    for (const char* key : {"camera.width_px=320", "camera.height_px=240"})
      set.push_back(fmt::format("{}.{}", of, key));
  for (const char* eye : {"left", "right"}) {
    set.push_back(fmt::format("rig.camera.{}.focal_px=[360.5,360.5]", eye));
    set.push_back(fmt::format("rig.camera.{}.centre_px=[159.5,119.5]", eye));
  }
  set.emplace_back("truth.camera.focal_px=360.5");
  return set;
}

void tell_misses(Bench& bench, const std::vector<trial::FingerEncounter>& meetings) {
  for (const double v : {50.0, 100.0, 200.0, 300.0}) {
    double most = 0.0, n = 0.0;
    for (const trial::FingerEncounter& m : meetings) {
      if (std::isnan(m.touched) || std::abs(1e3 * m.approach_speed - v) > 1.0) continue;
      most = std::max(most, m.miss);
      ++n;
    }
    if (n == 0.0) continue;  // not asked for
    bench.figure(fmt::format("wall.miss_mm.{:.0f}.max", v), most * kMmPerM, "mm", predicted(0.0),
                 v <= 200.0 ? at_most(2.0) : Bounds{},
                 fmt::format("from the prop's middle to the finger, along the wall, of {:.0f} touches at "
                             "{:.0f} mm/s; 640 x 480 at 20 Hz",
                             n, v));
  }
}

void tell_wall(Bench& bench, const RunResult& ran) {
  tell_misses(bench, ran.meetings);
  bench.figure("wall.slope", ran.slope, "N/m",
               "contact force over true depth, 2 to 5 mm, while pressed and slid");
  bench.figure("wall.believed_slope", ran.believed, "N/m", "the same over the depth that the core believes");
  bench.figure("wall.force_step.max", trial::greatest_change(ran.frames, true), "N", at_most(0.2),
               "what a picture in contact changes of Lambda f along the normal until the next, beside a core "
               "that is not told of it");
  bench.figure("wall.force_step.before.max", trial::greatest_change(ran.frames, false), "N",
               "the same of a picture before the touch, which says when that begins");
  bench.figure("wall.force_step.tick.max", ran.step, "N",
               "of Lambda f along the normal from tick to tick in contact, mostly the finger's own doing: at "
               "300 mm/s the wall's spring alone gains 0.18 N in each");
  bench.figure("wall.far_speed.max", ran.far_speed * kMmPerM, "mm/s", predicted(0.0), at_most(0.1),
               "of the arm's tip while the finger is far, from a second after it went: \"motionless\"");
  bench.figure(
      "wall.behind_mm.rms", rms(ran.behind) * kMmPerM, "mm", predicted(0.0), between(0.5, 4.0),
      "prop's middle from the finger along the wall, in contact, sliding at 60 mm/s and back: \"directly "
      "behind the finger\"");
  bench.figure("wall.place.rms", rms(ran.off) * kMmPerM, "mm",
               "told fingertip against the true one at its exposure");
  bench.figure("wall.place_normal.mean", mean(ran.off_normal) * kMmPerM, "mm",
               "the same along the normal, in the mean");
  bench.figure("wall.frames.rate", ran.result.vision.rate(), "Hz", calibrated(20.0), between(19.8, 20.2),
               "that the haptic loop received");
  bench.figure(
      "wall.frames.jitter",
      ran.result.vision.intervals.empty()
          ? kUnset
          : (*std::max_element(ran.result.vision.intervals.begin(), ran.result.vision.intervals.end()) -
             *std::min_element(ran.result.vision.intervals.begin(), ran.result.vision.intervals.end())) *
                kMmPerM,
      "ms", "longest less shortest interval of them");
}

void tell_objects(Bench& bench, const std::string& scene, const RunResult& ran) {
  double right = 0.0, felt = 0.0, all = 0.0, in_time = 0.0;
  for (const reaching::ReachOutcome& r : ran.reaches) {
    if (std::isnan(r.met)) continue;
    ++all;
    right += r.chosen == r.aim ? 1.0 : 0.0;
    felt += r.felt == r.aim ? 1.0 : 0.0;
    in_time += r.lead() >= r.travel() ? 1.0 : 0.0;
  }
  bench.figure(scene + ".felt_percent", 100.0 * felt / all, "%", at_least(95.0),
               fmt::format("of {:.0f} random reaches that the camera saw: the object that is rendered when "
                           "the finger has met the prop is the one that the person reached for",
                           all));
  bench.figure(
      scene + ".object_percent", 100.0 * right / all, "%",
      "of these: it was chosen already when the finger came to where it is, with the prop or without; an "
      "ideal that is told when the finger touches names 99 % (docs/reference/reaching.md)");
  const auto tail = [&](double reaching::ReachOutcome::*what) {
    return tail_of(reaching::felts(ran.reaches, what), 0.95);
  };
  const Tail after = tail(&reaching::ReachOutcome::felt_after);
  bench.figure(scene + ".felt_after_ms." + after.word, 1e3 * after.value, "ms",
               "from where the finger passes the place of the key until a key is felt");
  const Tail depth = tail(&reaching::ReachOutcome::felt_depth);
  bench.figure(scene + ".felt_depth_mm." + depth.word, 1e3 * depth.value, "mm",
               "how far the finger has gone beyond that place by then");
  bench.figure(scene + ".lead_percent", 100.0 * in_time / all, "%", "of these: the prop is there in time");
}

// The camera's pose as `encounter calibrate camera` finds it with 8 places of 20 frames, as settings.
std::vector<std::string> registered(const BenchContext& context) {
  const models::Setup setup = load_scene(context, "camera/wall");
  const trial::RegistrationRig rig = trial::registration_rig(setup);
  trial::KinematicArm arm(rig.believed, rig.arm);
  const std::vector<trial::TipVisit> visits =
      trial::visit_places(arm, trial::places_of(rig, 8).visited, rig.camera.rate, 20);
  const trial::GuidedRun run = trial::see_visits(visits, rig.X_WC, rig.camera, context.seed);
  const Pose<'W', 'C'> found = models::register_points(models::averages(run.points)).X_WC;
  const Vec3 p = found.p() * kMmPerM, turn = angles_xyz(Quat(found.q())) * kDegPerRad;
  return {fmt::format("rig.frames.W_C.position_mm=[{:.6f},{:.6f},{:.6f}]", p.x(), p.y(), p.z()),
          fmt::format("rig.frames.W_C.rotation_deg=[{:.6f},{:.6f},{:.6f}]", turn.x(), turn.y(), turn.z())};
}

void add_fig5(Bench& bench, const std::string& scene, const RunResult& ran) {
  const models::Setup setup = load_scene(bench.context, "camera/" + scene);
  const Scene prepared = trial::prepare_setup(setup);
  add_fig5(bench, scene, ran.pictures, prepared.objects.front(), setup.rig.arm.stiffness);
}

void tell_cost(Bench& bench, const RunResult& wall, const RunResult& button) {
  bench.cost("wall.real_time", wall.simulated / wall.cpu, "x",
             "640 x 480: simulated over CPU seconds of one thread, the drawing of the pictures included");
  const double tick = wall.cpu / static_cast<double>(wall.result.ticks);
  bench.cost("wall.tick_over_yardstick.mean", tick / wall.yardstick, "x",
             "a tick of all this over a fixed piece of work of the same run (kit/cost.h)");
  bench.cost("button.step.p99_9", percentile(button.result.step_ns, 0.999) * 1e-3, "us",
             "step() alone, in a run with vision; the period is 1,000 us");
}

// More presses of the wall, two a run: the motors are cold at its start, and more in a row would be too hot.
void add_presses(const std::vector<std::string>& camera, std::uint64_t seed, std::vector<RunSetup>& asked) {
  for (std::uint64_t i = 1; i < 20; ++i) {
    std::vector<std::string> set = strokes(i % 2 == 0 ? "100, 200" : "50, 300");
    set.insert(set.end(), camera.begin(), camera.end());
    asked.push_back({"camera/wall", std::move(set), kUnset, 0, seed + i, true});
  }
}

// The camera sees a finger, which meets the prop: miss, force, time, and Fig 5.
void add_whole_stack(Bench& bench) {
  const BenchContext& context = bench.context;
  const std::vector<std::string> camera = registered(context);
  const auto with = [&](std::vector<std::string> set, const std::vector<std::string>& more) {
    set.insert(set.end(), more.begin(), more.end());
    return set;
  };
  const std::vector<std::string> wall = with(strokes(context.quick ? "200" : "100, 200"), camera);
  constexpr double kTwice = 1.0;  // s: of the two runs that must be equal
  std::vector<RunSetup> asked{
      {"camera/wall", wall, kUnset, 0, context.seed, true},
      {"camera/button", with({"user.approach_mm_s=[50]", "user.press_s=2", "user.release_s=2"}, camera),
       kUnset, 0, context.seed},
      {"camera/wall", wall, kTwice, 0, context.seed},
      {"camera/wall", wall, kTwice, 0, context.seed + (context.mutated("other_seed") ? 1 : 0)}};
  if (context.full) {
    asked.push_back({"camera/keypad", {"truth.hand.aborted=0"}, kUnset, 100, context.seed});
    asked.push_back({"camera/wall", with(wall, quarter_size()), kUnset, 0, context.seed});
    add_presses(camera, context.seed, asked);
  }
  constexpr std::size_t kMore = 6;  // first of more presses of the wall
  const std::vector<RunResult> ran =
      bench.each(asked, [&](const RunSetup& one) { return run_one(context, one); });
  RunResult presses = ran[0];
  for (std::size_t i = kMore; i < ran.size(); ++i) join(presses, ran[i]);
  tell_wall(bench, presses);
  add_fig5(bench, "wall", presses);
  add_fig5(bench, "button", ran[1]);
  bench.figure(
      "button.waits_mm.max", ran[1].off_button * kMmPerM, "mm", predicted(0.0), at_most(1.0),
      "of the prop from the middle of the button while the finger is near and does not touch: \"stationary "
      "at the position of the button\"");
  tell_cost(bench, ran[0], ran[1]);
  bench.figure("wall.same_hash.count", ran[2].result.hash == ran[3].result.hash ? 1.0 : 0.0, "", exactly(1.0),
               "two runs of a second, at a time on two threads, give the same state hash");
  if (!context.full) return;
  tell_objects(bench, "keypad", ran[4]);
  bench.cost("wall.small.real_time", ran[5].simulated / ran[5].cpu, "x", "320 x 240: the same");
}

void run(Bench& bench) {
  add_whole_stack(bench);
  add_device_removal(bench);
  // A stroke, as the camera sees it.
  if (bench.context.full)
    add_force_precision(bench, {"user.approach_mm_s=[100]", "user.approach_from_mm=40", "user.press_s=0.6",
                                "user.hold_s=0.3", "user.release_s=0.4", "user.rest_s=0.3"});
}

const Reads kReads{"vishap", {.scenes = {"camera/wall", "camera/button", "camera/keypad"}}};
const Entry kEntry{"vishap", "camera/wall", "the whole stack of VisHap: a finger that is seen meets the prop",
                   run};

}  // namespace

ArmPlay::ArmPlay(const models::Setup& setup, const sim::CameraModule& camera, std::uint64_t seed)
    : setup_(setup),
      scene_(trial::prepare_setup(setup)),
      spec_(trial::stage_of(setup.twin.camera, seed)),
      camera_(camera),
      stage_(camera.stage(spec_)),
      stream_(seed, "arm play"),
      X_CW_(pose_of<'W', 'C'>(setup.twin.frames.W_C).inverse()),
      X_WR_(sim::arm_base(setup.twin.arm)),
      normal_(trial::wanted_at(scene_.objects.front(), Point<'W'>(0, 0, 0)).normal),
      skin_(sim::skin_colour(setup.twin.camera.skin)) {}

AugmentedSpec ArmPlay::believed(const Belief& belief) const {
  AugmentedSpec spec;
  spec.camera = setup_.rig.camera;
  spec.segmentation = setup_.rig.vision.segmentation;
  spec.arm = setup_.rig.arm.machine;
  spec.prop = setup_.scene.prop->size;
  spec.X_WR = scene_.X_WR;
  spec.X_WC = scene_.X_WC * Pose<'C', 'C'>(Quat::Identity(), Vec3(belief.camera_off.e()));
  return spec;
}

void ArmPlay::pose_arm(const Point<'W'>& tip, Frame& frame) {
  const ArmMachine& machine = setup_.twin.arm.machine;
  const Arm arm(machine);
  PerJoint q{};
  if (!arm.inverse(X_WR_.inverse() * tip, q)) q = arm.zero();
  const auto tilted = [&](const Quat& from, double by) {
    const double way = uniform(stream_, 0.0, 2.0 * M_PI);
    return from * Quat(Eigen::AngleAxisd(by, Vec3(std::cos(way), std::sin(way), 0.0)));
  };
  facing_ = tilted(rotation_z_to(normal_.e()), uniform(stream_, 0.0, kTilt));
  frame.moment = {};
  frame.moment.joints = measured(setup_.twin.arm, q);
  frame.moment.q_WN = tilted(facing_, kFacingOff * stream_.normal());
  frame.shown.things.clear();
  for (const ArmPart& part : arm_shape(machine, q, X_WR_))
    frame.shown.things.push_back(trial::thing_of(part, X_CW_));
  const Point<'W'> at = X_WR_ * arm.tip(q);
  frame.shown.things.push_back(trial::thing_of(prop_shape(setup_.scene.prop->size, at, facing_), X_CW_));
}

void ArmPlay::draw(Frame& frame) {
  stage_->draw(frame.shown, frames_++, frame.pair.left, frame.pair.right, &frame.pair.truth);
}

void ArmPlay::rest(std::vector<Frame>& with, std::vector<staged::Pair>& without) {
  Frame frame;
  pose_arm(X_WR_ * Arm(setup_.twin.arm.machine).tip({}), frame);
  draw(frame);
  const std::uint64_t first = frames_ - 1;
  for (Frame& one : with) {
    if (&one != with.data()) stage_->again(frames_++, frame.pair.left, frame.pair.right);
    one = frame;
  }
  staged::Pair bare;
  without_arm(frame, bare);
  for (std::size_t i = 0; i < without.size(); ++i) {
    stage_->again(first + i, bare.left, bare.right);
    without[i] = bare;
  }
}

void ArmPlay::next(Frame& frame) {
  const auto place = [&] {
    return Point<'W'>(uniform(stream_, -0.07, 0.05), uniform(stream_, -0.08, 0.08),
                      uniform(stream_, -0.02, 0.08));
  };
  const Point<'W'> tip = place(), elsewhere = place();
  frame.shown = {};
  pose_arm(tip, frame);
  frame.meets = stream_.uniform() < kMeets;
  frame.shown.hand = frame.meets || stream_.uniform() > kNobody / (1.0 - kMeets);
  frame.shown.look.skin = skin_;
  const double radius = 0.5 * frame.shown.look.finger_width;
  // A finger that comes to the wall, as far out of the image's plane as the judged fingertips.
  Vec<'C'> along;
  do {
    const double side = uniform(stream_, 0.0, 2.0 * M_PI), tilt = uniform(stream_, -kOutOfPlane, kOutOfPlane);
    along = Vec<'C'>(std::cos(tilt) * std::cos(side), std::cos(tilt) * std::sin(side), std::sin(tilt));
  } while (dot(X_CW_.inverse() * along, normal_) > -kTowards);
  const double above = frame.meets ? radius + uniform(stream_, 0.0, 0.025) : uniform(stream_, 0.03, 0.12);
  const Vec<'W'> normal = frame.meets ? Vec<'W'>(Vec3(facing_ * Vec3::UnitZ())) : normal_;
  frame.shown.pose.tip = X_CW_ * ((frame.meets ? tip : elsewhere) + above * normal);
  frame.shown.pose.along = along;
  frame.shown.pose.roll = uniform(stream_, 0.0, 2.0 * M_PI);
  if (frame.shown.hand) frame.moment.finger = frame.shown.pose.tip;
  draw(frame);
}

void ArmPlay::without_arm(const Frame& frame, staged::Pair& pair) {
  sim::CameraScene shown = frame.shown;
  shown.things.clear();
  stage_->draw(shown, frames_ - 1, pair.left, pair.right, &pair.truth);
}

Image ArmPlay::empty() {
  sim::StageSpec quiet = spec_;
  quiet.sensor.noise = 0.0;
  Image left, right;
  camera_.stage(quiet)->draw(sim::CameraScene{}, 0, left, right);
  return left;
}

}  // namespace enc::bench::vishap
