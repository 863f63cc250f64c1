// Registration of camera and arm through pictures [VisHap 2.2]: the arm visits eight places, the detector
// finds a ball at its tip in twenty noisy stereo pairs of each, and the registration aligns both sets.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/staged/staged.h"
#include "benchmarks/verdict/reference.h"
#include "core/base/units.h"
#include "core/control/scene/scene.h"
#include "sim/camera/stage.h"
#include "trial/assemble/vision.h"
#include "trial/identify/camera/registration_rig.h"

namespace enc::bench::registration_images {
namespace {

// One registration.
struct RegistrationCase {
  const sim::CameraModule* camera = nullptr;
  const models::Setup* setup = nullptr;
  const std::vector<trial::TipVisit>* visits = nullptr;
  const std::vector<Point<'W'>>* targets = nullptr;  // all over the volume in view
  std::uint64_t seed = 1;                            // seed of scenery and noise
  int samples = 0;                                   // of a pixel
  double rod = 0.0;  // m, radius of a rod from the tip to the arm's base, in the twin's picture; 0: no rod
};

// The frames of a place: errors against the truth in the assumed head; px of column, row and disparity, and m
// along C.
struct PlaceObservation {
  double depth = kUnset;  // m
  Vec3 bias_px{kUnset, kUnset, kUnset}, scatter_px{kUnset, kUnset, kUnset};
  Vec3 bias{kUnset, kUnset, kUnset}, scatter{kUnset, kUnset, kUnset};
};

struct RegistrationResult {
  Vec3 left_over{kUnset, kUnset, kUnset};  // mean |error| at the pairs, m; NaN: too few places were detected
  Vec3 elsewhere{kUnset, kUnset, kUnset};  // all over the volume in view
  std::vector<PlaceObservation> places;
  std::size_t frames = 0, found = 0, other = 0;  // other: more than 5 mm from the true place
  std::vector<double> seconds;                   // CPU time of the detection in a pair
};

Pose<'W', 'C'> camera_pose(const models::Setup& setup) { return pose_of<'W', 'C'>(setup.twin.frames.W_C); }

// The arm is at rest at a place: it is drawn once, and each frame is exposed with its own noise.
class StillEyes final : public trial::TipEyes {
 public:
  explicit StillEyes(const RegistrationCase& asked)
      : things_(trial::ball_at_tip(camera_pose(*asked.setup), asked.setup->twin.camera)),
        X_CW_(camera_pose(*asked.setup).inverse()),
        pair_(Rectifier(asked.setup->rig.camera).pair()),
        finder_(asked.setup->rig.camera, asked.setup->rig.vision.ball) {
    sim::StageSpec spec = trial::stage_of(asked.setup->twin.camera, asked.seed);
    spec.finish.samples = asked.samples;
    stage_ = asked.camera->stage(spec);
    if (asked.rod > 0.0) add_rod(trial::base_of(Arm(asked.setup->rig.arm.machine)).p(), asked.rod);
  }
  void move() override {
    finish();
    drawn_ = false;
  }
  std::optional<Point<'C'>> see(const trial::TipStand& tip) override {
    expose(tip);
    const double start = thread_seconds();
    last = finder_.find({pair.left.view(), pair.right.view()});
    seen.seconds.push_back(thread_seconds() - start);
    ++seen.frames;
    if (!last.found()) return {};
    ++seen.found;
    const Point<'C'> truth = X_CW_ * tip.truth;
    seen.other += (last.centre - truth).norm() > 5e-3 ? 1U : 0U;
    depth_ = truth.e().z();
    px_.push_back(last.at.e() - seen_at(pair_, truth).e());
    off_.push_back(last.centre.e() - truth.e());
    return last.centre;
  }
  // Stores the detections at the place.
  void finish() {
    if (px_.size() > 1) {
      PlaceObservation place{depth_};
      spread(px_, place.bias_px, place.scatter_px);
      spread(off_, place.bias, place.scatter);
      seen.places.push_back(place);
    }
    px_.clear();
    off_.clear();
  }
  RegistrationResult seen;
  staged::Pair pair;
  FoundBall last;

 private:
  void expose(const trial::TipStand& tip) {
    if (drawn_) {
      stage_->again(frame_++, pair.left, pair.right);
      return;
    }
    sim::CameraScene shown;
    shown.things = things_(tip);
    stage_->draw(shown, frame_++, pair.left, pair.right);
    drawn_ = true;
  }
  void add_rod(const Vec3& base, double radius) {
    things_ = [ball = things_, base, radius, X_CW = X_CW_](const trial::TipStand& tip) {
      std::vector<sim::Thing> things = ball(tip);
      const Vec3 to = base - tip.truth.e();
      sim::Thing rod;
      rod.shape = sim::ThingShape::capsule;
      rod.at = X_CW * Point<'W'>(Vec3(tip.truth.e() + 0.5 * to));
      rod.axes = (X_CW.q() * Quat::FromTwoVectors(Vec3::UnitZ(), to)).toRotationMatrix();
      rod.half = {radius, radius, 0.5 * to.norm()};
      things.push_back(rod);
      return things;
    };
  }
  static void spread(const std::vector<Vec3>& values, Vec3& mean, Vec3& rms) {
    const auto count = static_cast<double>(values.size());
    mean = rms = Vec3::Zero();
    for (const Vec3& v : values) mean += v / count;
    for (const Vec3& v : values) rms += (v - mean).cwiseAbs2() / (count - 1.0);
    rms = rms.cwiseSqrt();
  }

  std::unique_ptr<sim::Stage> stage_;
  trial::TipThings things_;
  Pose<'C', 'W'> X_CW_;
  RectifiedPair pair_;
  BallFinder finder_;
  std::uint64_t frame_ = 0;
  bool drawn_ = false;
  double depth_ = kUnset;
  std::vector<Vec3> px_, off_;
};

RegistrationResult registered(const RegistrationCase& asked) {
  StillEyes eyes(asked);
  const trial::GuidedRun run = trial::see_visits(*asked.visits, eyes, 0.5);
  eyes.finish();
  RegistrationResult seen = std::move(eyes.seen);
  if (run.points.size() < models::kFewestPairs) return seen;
  const models::Registration found = models::register_points(models::averages(run.points));
  seen.left_over = found.mean_error;
  seen.elsewhere = Vec3::Zero();
  for (const Point<'W'>& place : *asked.targets)
    seen.elsewhere += trial::target_error(found.X_WC, camera_pose(*asked.setup), place).cwiseAbs() /
                      static_cast<double>(asked.targets->size());
  return seen;
}

// A pair with the detected outline, as a PNG.
std::string marked_pair(const RegistrationCase& asked) {
  StillEyes eyes(asked);
  eyes.see(asked.visits->front().frames.front());
  for (std::size_t side = 0; side < 2; ++side) {
    Image& image = side == 0 ? eyes.pair.left : eyes.pair.right;
    for (const Pixel& edge : eyes.last.edges[side])
      if (!std::isnan(edge.column)) staged::mark(image, edge.column, edge.row, {255, 40, 200}, 0);
    const Pixel& centre = eyes.last.outline[side].centre;
    if (!std::isnan(centre.column)) staged::mark(image, centre.column, centre.row, {255, 255, 255}, 3);
  }
  return staged::png({eyes.pair.left, eyes.pair.right});
}

constexpr std::size_t kPairs = 8, kFrames = 20, kFewFrames = 5;
constexpr const char* kAxisNames = "xyz";

std::vector<double> along(const std::vector<RegistrationResult>& all, Vec3 RegistrationResult::*what,
                          Eigen::Index axis) {
  std::vector<double> values;
  values.reserve(all.size());
  for (const RegistrationResult& one : all) values.push_back((one.*what)(axis)*kMmPerM);
  return values;
}

void add_axes(Bench& bench, const std::string& name, const std::vector<RegistrationResult>& all,
              Vec3 RegistrationResult::*what, double paper, const std::string& note) {
  for (Eigen::Index a = 0; a < 3; ++a) {
    const std::vector<double> values = along(all, what, a);
    const Value value = median_of(values);
    const std::string id = fmt::format("{}{}_mm", name, kAxisNames[a]);
    if (name.empty())
      bench.figure(id, value, "mm", predicted(paper), at_most(paper), note);
    else
      bench.figure(id, value, "mm", at_most(paper), note);
    bench.figure(fmt::format("{}worst.{}_mm", name, kAxisNames[a]), value.most, "mm", at_most(paper),
                 fmt::format("the worst of {} seeds", all.size()));
  }
}

// Over all places of all seeds, px.
void add_frames(Bench& bench, const std::vector<RegistrationResult>& all) {
  constexpr std::array<const char*, 3> kNames{"column", "row", "disparity"};
  std::size_t frames = 0, found = 0, other = 0;
  std::vector<double> seconds;
  std::array<std::vector<double>, 3> bias, scatter;
  for (const RegistrationResult& one : all) {
    frames += one.frames;
    found += one.found;
    other += one.other;
    seconds.insert(seconds.end(), one.seconds.begin(), one.seconds.end());
    for (const PlaceObservation& place : one.places)
      for (std::size_t i = 0; i < 3; ++i) {
        bias[i].push_back(place.bias_px(static_cast<Eigen::Index>(i)));
        scatter[i].push_back(place.scatter_px(static_cast<Eigen::Index>(i)));
      }
  }
  bench.figure("found.percent", 100.0 * static_cast<double>(found) / static_cast<double>(frames), "%",
               at_least(99.0), fmt::format("of {} pairs", frames));
  bench.figure("other.count", static_cast<double>(other), "frames", exactly(0.0),
               "in which it was found more than 5 mm from where it is");
  for (std::size_t i = 0; i < 3; ++i) {
    bench.figure(fmt::format("frame.scatter.{}_px", kNames[i]), rms(scatter[i]), "px", at_most(0.05),
                 "rms of a frame about the mean of its place");
    bench.figure(fmt::format("frame.bias.{}_px", kNames[i]), rms(bias[i]), "px", at_most(0.15),
                 "rms over places of the mean of a place: what no averaging takes away");
  }
  bench.cost("find.time.median", median(seconds) * kMsPerS, "ms", "CPU time of finding the ball in a pair");
}

Plot over_depth(const std::vector<RegistrationResult>& all) {
  Plot plot{.id = "depth",
            .title = "The ball in the picture: error over its depth",
            .x_label = "depth (mm)",
            .y_label = "error (mm)",
            .caption = "Each point is a place of a seed."};
  Series scatter{.name = "scatter of a frame, along the view", .mark = Mark::points};
  Series bias{.name = "mean of a place, along the view, |error|", .mark = Mark::points};
  Series aside{.name = "mean of a place, across it, |error|", .mark = Mark::points};
  for (const RegistrationResult& one : all)
    for (const PlaceObservation& place : one.places) {
      scatter.add(place.depth * kMmPerM, place.scatter.z() * kMmPerM);
      bias.add(place.depth * kMmPerM, std::abs(place.bias.z()) * kMmPerM);
      aside.add(place.depth * kMmPerM, place.bias.head<2>().norm() * kMmPerM);
    }
  plot.series = {bias, aside, scatter};
  return plot;
}

struct Variant {
  std::string name;
  std::vector<std::string> set{};
  int samples = 0;
  double rod = 0.0;
};

const std::vector<Variant>& variants() {
  static const std::vector<Variant> kAll{
      {"as the rig is"},
      {"smooth edges: 4 samples of a pixel", {}, 4},
      {"another room: clutter", {"truth.camera.scenery=\"clutter\""}},
      {"another room: of the hues of skin", {"truth.camera.scenery=\"skin_hued\""}},
      {"green ball, in a room that has green things",
       {"truth.camera.ball_rgb=[0.05,0.5,0.12]", "rig.vision.ball_hue_deg=129",
        "rig.vision.ball_hue_within_deg=25"}},
      {"noise 4.5 of 255", {"truth.camera.noise_of_255=4.5"}},
      {"exposure a quarter", {"truth.camera.exposure=0.25"}},
      {"exposure 1.5 times", {"truth.camera.exposure=1.5"}},
      {"exposure 2.5 times", {"truth.camera.exposure=2.5"}},
      {"lens bends (k1 -0.2), and is believed to",
       {"truth.camera.distortion=[-0.2,0,0,0,0]", "rig.camera.left.distortion=[-0.2,0,0,0,0]",
        "rig.camera.right.distortion=[-0.2,0,0,0,0]"}},
      {"lens bends (k1 -0.02), believed not to", {"truth.camera.distortion=[-0.02,0,0,0,0]"}},
      {"focal length believed 0.5 % too long",
       {"rig.camera.left.focal_px=[724.6,724.6]", "rig.camera.right.focal_px=[724.6,724.6]"}},
      {"right camera believed turned by 0.05 deg about y", {"rig.camera.right.rotation_deg=[0,0.05,0]"}},
      {"right camera believed turned by 0.05 deg about x", {"rig.camera.right.rotation_deg=[0.05,0,0]"}},
      {"ball of 8 mm", {"truth.camera.ball_radius_mm=8", "rig.vision.ball_radius_mm=8"}},
      {"ball partly hidden by a rod of 4 mm", {}, 0, 0.004},
      {"ball partly hidden by a rod of 8 mm", {}, 0, 0.008},
  };
  return kAll;
}

// Results of each variant with `seeds` seeds, variant by variant.
std::vector<RegistrationResult> seen_by_variants(Bench& bench, const RegistrationCase& base,
                                                 const std::string& file, std::size_t seeds) {
  std::vector<models::Setup> setups;
  for (const Variant& v : variants()) {
    std::vector<std::string> set = bench.context.set;
    set.insert(set.end(), v.set.begin(), v.set.end());
    setups.push_back(models::load_rig_setup(file, set));
  }
  std::vector<trial::TipVisit> visits = *base.visits;
  for (trial::TipVisit& visit : visits) visit.frames.resize(kFewFrames);
  std::vector<RegistrationCase> all;
  for (std::size_t i = 0; i < variants().size(); ++i)
    for (std::size_t s = 0; s < seeds; ++s) {
      all.push_back(base);
      all.back().setup = &setups[i];
      all.back().visits = &visits;
      all.back().samples = variants()[i].samples;
      all.back().rod = variants()[i].rod;
      all.back().seed += s;
    }
  return bench.each(all, registered);
}

std::vector<std::string> row_of(const Variant& variant, const std::vector<RegistrationResult>& seen) {
  double frames = 0, found = 0;
  std::size_t other = 0;
  std::vector<double> bias;
  for (const RegistrationResult& one : seen) {
    frames += static_cast<double>(one.frames);
    found += static_cast<double>(one.found);
    other += one.other;
    for (const PlaceObservation& place : one.places) bias.push_back(place.bias_px.z());
  }
  std::vector<std::string> row{variant.name, fixed(100.0 * found / frames, 1), fmt::format("{}", other)};
  for (Vec3 RegistrationResult::*what : {&RegistrationResult::left_over, &RegistrationResult::elsewhere})
    for (Eigen::Index a = 0; a < 3; ++a) {
      const double value = median(along(seen, what, a));
      row.push_back(std::isnan(value) ? "none" : fixed(value, 3));
    }
  row.push_back(bias.empty() ? "none" : fixed(rms(bias), 3));
  return row;
}

Table table_of_doubts(Bench& bench, const RegistrationCase& base, const std::string& file,
                      std::size_t seeds) {
  const std::vector<RegistrationResult> seen = seen_by_variants(bench, base, file, seeds);
  Table table{
      "doubts",
      "Registration through pictures, five frames at each place: what it depends on, median over seeds",
      {"rig", "frames found (%)", "frames 5 mm off", "left over x (mm)", "y (mm)", "z (mm)",
       "elsewhere x (mm)", "y (mm)", "z (mm)", "bias of a place (px of disparity)"}};
  for (std::size_t i = 0; i < variants().size(); ++i) {
    const std::vector<RegistrationResult> some(seen.begin() + static_cast<std::ptrdiff_t>(i * seeds),
                                               seen.begin() + static_cast<std::ptrdiff_t>((i + 1) * seeds));
    table.rows.push_back(row_of(variants()[i], some));
  }
  table.note =
      "None: fewer than four places show the ball in half of their frames, and nothing is registered.";
  return table;
}

// m: largest motion of a tip at a place while its frames are taken.
double most_motion(const std::vector<trial::TipVisit>& visits, bool first_place) {
  double most = 0.0;
  for (const trial::TipVisit& visit : visits)
    for (const trial::TipStand& tip : visit.frames)
      most = std::max(
          most,
          (tip.truth - (first_place ? visits : std::vector{visit}).front().frames.front().truth).norm());
  return most;
}

void run(Bench& bench) {
  const Reference reference = Reference::load(bench.context.models, "registration.csv");
  const double paper = reference.number(reference.row({{"quantity", "mean_error_mm"}}), "value");
  const std::string file = bench.context.models + "/rigs/vishap.toml";
  const models::Setup setup = models::load_rig_setup(file, bench.context.set);
  const trial::RegistrationRig rig = trial::registration_rig(setup);
  const trial::RegistrationPlaces places = trial::places_of(rig, kPairs);
  trial::DrivenArm arm(setup);
  const std::vector<trial::TipVisit> visits =
      trial::visit_places(arm, places.visited, rig.camera.rate, kFrames);
  RegistrationCase asked{&staged::camera(bench.context), &setup, &visits, &places.targets,
                         staged::test_seed(bench.context)};
  std::vector<RegistrationCase> all(bench.context.count(bench.context.full ? 20 : 6, 2), asked);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].seed += i;
  const std::vector<RegistrationResult> seen = bench.each(all, registered);
  add_axes(bench, "", seen, &RegistrationResult::left_over, paper,
           "mean |error| at the 8 pairs themselves, 20 frames each: the plain reading of the paper");
  add_axes(bench, "held_out.", seen, &RegistrationResult::elsewhere, paper,
           "mean |error| of the same registration all over the volume in view");
  add_frames(bench, seen);
  bench.figure("still.max", most_motion(visits, bench.context.mutated("first_place")) * kUmPerM, "um",
               at_most(5.0), "how far the tip moves at a place: what is drawn once for all of its frames");
  bench.plot(over_depth(seen));
  bench.picture({"pair", "The ball at the tip, as both cameras see it",
                 "Magenta: the edge in each of 72 directions; white: the centre.", marked_pair(asked)});
  if (bench.context.full) bench.table(table_of_doubts(bench, asked, file, 2));
  bench.result.note =
      "a place is drawn once for each seed, because nothing moves there; sensor noise is drawn anew for each "
      "of its frames";
}

const Entry kEntry{
    "registration_images", "vishap",
    "camera and arm from pictures of a ball at the tip: error per axis, frame errors (VisHap 2.2)", run};

}  // namespace
}  // namespace enc::bench::registration_images
