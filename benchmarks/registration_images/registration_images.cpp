// Registration of camera and arm through pictures [VisHap 2.2]: the arm is driven to eight places, a ball at
// its tip is found in twenty noisy stereo pairs of each, and both are laid over each other.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/registration_images/images.h"
#include "benchmarks/staged/staged.h"
#include "benchmarks/verdict/reference.h"
#include "core/base/units.h"
#include "trial/identify/camera/driven_arm.h"
#include "trial/identify/camera/registration_rig.h"

namespace enc::bench::registration_images {
namespace {

constexpr std::size_t kPairs = 8, kFrames = 20, kFewFrames = 5;
constexpr const char* kAxisNames = "xyz";

std::vector<double> along(const std::vector<Seen>& all, Vec3 Seen::*what, Eigen::Index axis) {
  std::vector<double> values;
  values.reserve(all.size());
  for (const Seen& one : all) values.push_back((one.*what)(axis)*kMmPerM);
  return values;
}

void add_axes(Bench& bench, const std::string& name, const std::vector<Seen>& all, Vec3 Seen::*what,
              double paper, const std::string& note) {
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
void add_frames(Bench& bench, const std::vector<Seen>& all) {
  constexpr std::array<const char*, 3> kNames{"column", "row", "disparity"};
  std::size_t frames = 0, found = 0, other = 0;
  std::vector<double> seconds;
  std::array<std::vector<double>, 3> bias, scatter;
  for (const Seen& one : all) {
    frames += one.frames;
    found += one.found;
    other += one.other;
    seconds.insert(seconds.end(), one.seconds.begin(), one.seconds.end());
    for (const PlaceSeen& place : one.places)
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

Plot over_depth(const std::vector<Seen>& all) {
  Plot plot{.id = "depth",
            .title = "The ball in the picture: error over its depth",
            .x_label = "depth (mm)",
            .y_label = "error (mm)",
            .caption = "Each point is a place of a seed."};
  Series scatter{.name = "scatter of a frame, along the view", .mark = Mark::points};
  Series bias{.name = "mean of a place, along the view, |error|", .mark = Mark::points};
  Series aside{.name = "mean of a place, across it, |error|", .mark = Mark::points};
  for (const Seen& one : all)
    for (const PlaceSeen& place : one.places) {
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

Table table_of_doubts(Bench& bench, const Asked& base, const std::string& file, std::size_t seeds) {
  std::vector<models::Setup> setups;
  for (const Variant& v : variants()) {
    std::vector<std::string> set = bench.context.set;
    set.insert(set.end(), v.set.begin(), v.set.end());
    setups.push_back(models::load_rig_setup(file, set));
  }
  std::vector<trial::TipVisit> visits = *base.visits;
  for (trial::TipVisit& visit : visits) visit.frames.resize(kFewFrames);
  std::vector<Asked> all;
  for (std::size_t i = 0; i < variants().size(); ++i)
    for (std::size_t s = 0; s < seeds; ++s) {
      all.push_back(base);
      all.back().setup = &setups[i];
      all.back().visits = &visits;
      all.back().samples = variants()[i].samples;
      all.back().rod = variants()[i].rod;
      all.back().seed += s;
    }
  const std::vector<Seen> seen = bench.each(all, registered);
  Table table{
      "doubts",
      "Registration through pictures, five frames at each place: what it depends on, median over seeds",
      {"rig", "frames found (%)", "frames 5 mm off", "left over x (mm)", "y (mm)", "z (mm)",
       "elsewhere x (mm)", "y (mm)", "z (mm)", "bias of a place (px of disparity)"}};
  for (std::size_t i = 0; i < variants().size(); ++i) {
    const std::vector<Seen> some(seen.begin() + static_cast<std::ptrdiff_t>(i * seeds),
                                 seen.begin() + static_cast<std::ptrdiff_t>((i + 1) * seeds));
    double frames = 0, found = 0;
    std::size_t other = 0;
    std::vector<double> bias;
    for (const Seen& one : some) {
      frames += static_cast<double>(one.frames);
      found += static_cast<double>(one.found);
      other += one.other;
      for (const PlaceSeen& place : one.places) bias.push_back(place.bias_px.z());
    }
    std::vector<std::string> row{variants()[i].name, fmt::format("{:.1f}", 100.0 * found / frames),
                                 fmt::format("{}", other)};
    for (Vec3 Seen::*what : {&Seen::left_over, &Seen::elsewhere})
      for (Eigen::Index a = 0; a < 3; ++a) {
        const double value = median(along(some, what, a));
        row.push_back(std::isnan(value) ? "none" : fmt::format("{:.3f}", value));
      }
    row.push_back(bias.empty() ? "none" : fmt::format("{:.3f}", rms(bias)));
    table.rows.push_back(std::move(row));
  }
  table.note =
      "None: fewer than four places show the ball in half of their frames, and nothing is registered.";
  return table;
}

// m: how far a tip moves at a place while its frames are taken.
double most_motion(const std::vector<trial::TipVisit>& visits) {
  double most = 0.0;
  for (const trial::TipVisit& visit : visits)
    for (const trial::TipStand& tip : visit.frames)
      most = std::max(most, (tip.truth - visit.frames.front().truth).norm());
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
  Asked asked{&staged::camera(bench.context), &setup, &visits, &places.targets,
              staged::test_seed(bench.context)};
  std::vector<Asked> all(bench.context.count(20, 2), asked);
  for (std::size_t i = 0; i < all.size(); ++i) all[i].seed += i;
  const std::vector<Seen> seen = bench.each(all, registered);
  add_axes(bench, "", seen, &Seen::left_over, paper,
           "mean |error| at the 8 pairs themselves, 20 frames each: the plain reading of the paper");
  add_axes(bench, "held_out.", seen, &Seen::elsewhere, paper,
           "mean |error| of the same registration all over the volume in view");
  add_frames(bench, seen);
  bench.figure("still.max", most_motion(visits) * kUmPerM, "um", at_most(5.0),
               "how far the tip moves at a place: what is drawn once for all of its frames");
  bench.plot(over_depth(seen));
  bench.picture({"pair", "The ball at the tip, as both cameras see it",
                 "Magenta: the edge in each of 72 directions; white: the centre.", marked_pair(asked)});
  if (!bench.context.quick) bench.table(table_of_doubts(bench, asked, file, 2));
  bench.result.note =
      "a place is drawn once for each seed, because nothing moves there; sensor noise is drawn anew for each "
      "of its frames";
}

const Entry kEntry{
    "registration_images", "vishap",
    "camera and arm from pictures of a ball at the tip: error per axis, frame errors (VisHap 2.2)", run};

}  // namespace
}  // namespace enc::bench::registration_images
