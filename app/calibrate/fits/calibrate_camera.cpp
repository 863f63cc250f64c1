// `encounter calibrate camera POINTS.csv`: the camera's pose from positions of the device's tip, its
// uncertainty, and whether to average more frames or more places. `encounter calibrate camera RIG`: the same
// calibration on the twin, whose arm drives to the places.
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/words.h"
#include "app/fit/commands.h"
#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/units.h"
#include "models/files.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"
#include "trial/identify/camera/point_study.h"
#include "trial/identify/camera/registration_rig.h"
#include "trial/measure/record_table.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;  // prints NaN as null
using models::PointSet;
using trial::PointStudy;

std::string number(double x, double unit, int digits) {
  return std::isnan(x) ? "not known" : fmt::format("{:.{}f}", x * unit, digits);
}
std::string number(const models::Interval& i, double unit, int digits) {
  return fmt::format("{} +- {}", number(i.value, unit, digits),
                     std::isnan(i.half) ? "?" : number(i.half, unit, digits));
}

std::string axes_text(const PointSet& places, const PointStudy& s) {
  std::string out = fmt::format("{} pairs, {:.4g} frame{} of each, condition {:.2f}\n", places.size(),
                                s.frames, s.frames > 1.0 ? "s" : "", s.found.condition);
  out += fmt::format("{:6}{:>24}{:>12}{:>24}{:>18}{:>17}\n", "axis", "mean |error| left, mm", "rms, mm",
                     "left out, mm", "frame noise, mm", "that stays, mm");
  for (Eigen::Index a = 0; a < 3; ++a)
    out += fmt::format("{:<6}{:>24}{:>12}{:>24}{:>18}{:>17}\n", kNames[a],
                       number(s.found.mean_error(a), kMmPerM, 4), number(s.found.rms_error(a), kMmPerM, 4),
                       number(s.left_out[static_cast<std::size_t>(a)], kMmPerM, 4),
                       number(s.frame_noise(a), kMmPerM, 4), number(s.standing(a), kMmPerM, 4));
  return out;
}

std::string pose_text(const PointStudy& s) {
  const Vec3 angles = angles_xyz(s.found.X_WC.q()) * kDegPerRad;
  const auto halves = [](const std::array<models::Interval, 3>& of, double unit, int digits) {
    return fmt::format("{}, {}, {}", number(of[0].half, unit, digits), number(of[1].half, unit, digits),
                       number(of[2].half, unit, digits));
  };
  const Vec3 p = s.found.X_WC.p() * kMmPerM;
  return fmt::format(
      "\n[frames.W_C]\nposition_mm = [{:.4f}, {:.4f}, {:.4f}]  # +- {}\n"
      "rotation_deg = [{:.5f}, {:.5f}, {:.5f}]  # turns about W's axes +- {}\n\n",
      p.x(), p.y(), p.z(), halves(s.position, kMmPerM, 3), angles.x(), angles.y(), angles.z(),
      halves(s.turn, kDegPerRad, 4));
}

std::string fewer_text(const PointStudy& s) {
  if (s.fewer.empty()) return "";
  std::string out = "mean |error| at the pairs that were left out, mm: median, and 97.5 % below\n";
  out += fmt::format("{:>5}{:>8}{:>20}{:>20}{:>20}\n", "pairs", "frames", "x", "y", "z");
  for (const trial::FewerPoints& f : s.fewer) {
    out += fmt::format("{:>5}{:>8}", f.pairs, f.frames);
    for (Eigen::Index a = 0; a < 3; ++a)
      out += fmt::format(
          "{:>20}", fmt::format("{:.3f}, {:.3f}", f.error.median(a) * kMmPerM, f.error.high(a) * kMmPerM));
    out += "\n";
  }
  return out;
}

// Advises what to average: more frames until their noise falls below the remaining error, then more places.
std::string advice_text(const PointStudy& s) {
  const double frame = s.frame_noise.norm(), stays = s.standing.norm();
  if (std::isnan(frame))
    return "average     frames of one place cannot be told apart here: give rows of one place the same "
           "`pair`\n";
  const double left = frame / std::sqrt(s.frames);
  const std::string now =
      fmt::format("a frame scatters by {:.3f} mm, the average of {:.4g} by {:.3f} mm; {:.3f} mm stay",
                  frame * kMmPerM, s.frames, left * kMmPerM, stays * kMmPerM);
  if (left > stays && stays > 0.0)
    return fmt::format("average     more frames: {}; worth it up to some {:.0f}\n", now,
                       std::ceil(std::pow(frame / stays, 2)));
  if (left > stays) return fmt::format("average     more frames: {}\n", now);
  return fmt::format(
      "average     more places, not more frames: {}; it is of the camera's calibration or of the arm\n", now);
}

std::string notes_text(const PointSet& places, const PointStudy& s) {
  std::string out;
  const auto say = [&](const std::string& what) { out += "note        " + what + "\n"; };
  if (s.found.condition > 10.0)
    say(fmt::format(
        "the places are nearly on a line (condition {:.0f}): the turn about it is known badly; add places "
        "to its sides",
        s.found.condition));
  if (s.scale.known() && std::abs(s.scale.value - 1.0) > std::max(s.scale.half, 1e-3))
    say(fmt::format(
        "the camera's set is {:+.2f} +- {:.2f} % larger than the device's: a baseline, a focal length or a "
        "length of the arm is believed wrongly",
        100.0 * (s.scale.value - 1.0), 100.0 * s.scale.half));
  if (places.size() > models::kFewestPairs && s.worst_error > 5.0 * s.usual_error && s.worst_error > 1e-4)
    say(fmt::format(
        "pair {} is {:.2f} mm off by the others, which are {:.2f} mm off: measure it again, or leave it out",
        places[s.worst].number, s.worst_error * kMmPerM, s.usual_error * kMmPerM));
  if (places.size() < 6)
    say("fewer than 6 pairs: what is left over is small because the pose follows the pairs");
  return out;
}

Json json_of(const Vec3& v, double unit) { return {v.x() * unit, v.y() * unit, v.z() * unit}; }
Json json_of(const std::array<models::Interval, 3>& of, double models::Interval::*what, double unit) {
  return json_of(Vec3(of[0].*what, of[1].*what, of[2].*what), unit);
}

Json study_json(const PointSet& places, const PointStudy& s) {
  Json json;
  json["pairs"] = places.size();
  json["frames"] = s.frames;
  json["condition"] = s.found.condition;
  json["scale"] = s.found.scale;
  json["position_mm"] = json_of(s.found.X_WC.p(), kMmPerM);
  json["position_half_mm"] = json_of(s.position, &models::Interval::half, kMmPerM);
  json["rotation_deg"] = json_of(angles_xyz(s.found.X_WC.q()), kDegPerRad);
  json["turn_half_deg"] = json_of(s.turn, &models::Interval::half, kDegPerRad);
  json["mean_error_mm"] = json_of(s.found.mean_error, kMmPerM);
  json["rms_error_mm"] = json_of(s.found.rms_error, kMmPerM);
  json["left_out_mm"] = json_of(s.left_out, &models::Interval::value, kMmPerM);
  json["left_out_half_mm"] = json_of(s.left_out, &models::Interval::half, kMmPerM);
  json["frame_noise_mm"] = json_of(s.frame_noise, kMmPerM);
  json["standing_mm"] = json_of(s.standing, kMmPerM);
  json["fewer"] = Json::array();
  for (const trial::FewerPoints& f : s.fewer)
    json["fewer"].push_back({{"pairs", f.pairs},
                             {"frames", f.frames},
                             {"median_mm", json_of(f.error.median, kMmPerM)},
                             {"high_mm", json_of(f.error.high, kMmPerM)}});
  return json;
}

std::string study_text(const PointSet& places, const PointStudy& s) {
  return axes_text(places, s) + pose_text(s) + fewer_text(s) + advice_text(s) + notes_text(places, s) +
         "intervals   95 %, from leaving out one pair at a time\n";
}

// Smallest share of a place's frames that show the ball. A single frame that hides it does not repeat the
// place.
constexpr double kFound = 0.5;

// rms of a frame about the place's mean, along the axes of C, m.
Vec3 scatter_of(const models::SeenPlace& place) {
  const Vec3 mean = place.average().camera.e();
  Vec3 squares = Vec3::Zero();
  for (const models::PointPair& frame : place.frames) squares += (frame.camera.e() - mean).cwiseAbs2();
  return (squares / std::max(1.0, static_cast<double>(place.frames.size()) - 1.0)).cwiseSqrt();
}

std::string places_text(const trial::GuidedRun& run, std::size_t frames) {
  std::string out;
  for (const models::SeenPlace& place : run.points) {
    const Vec3 rms = scatter_of(place) * kMmPerM;
    out += fmt::format(
        "place {:<6}{} of {} frames found the ball; a frame scatters by {:.3f} {:.3f} {:.3f} mm along C\n",
        place.number, place.frames.size(), frames, rms.x(), rms.y(), rms.z());
  }
  return out;
}
Json places_json(const trial::GuidedRun& run, std::size_t frames) {
  Json list = Json::array();
  for (const models::SeenPlace& place : run.points)
    list.push_back({{"found", place.frames.size()},
                    {"frames", frames},
                    {"scatter_mm", json_of(scatter_of(place), kMmPerM)}});
  return list;
}

[[noreturn]] void refuse_few(const models::Setup& setup, const trial::GuidedRun& run, std::size_t pairs,
                             const trial::PictureEyes* eyes) {
  if (eyes == nullptr || run.seen.size() < pairs)
    throw Error(fmt::format(
        "{}: {} places of the arm were seen and {} are wanted; expected the camera to look at the "
        "arm; see truth.frames.W_C and truth.arm.misplaced_mm, or ask for fewer --pairs",
        models::place_of(setup, "truth.frames.W_C"), run.points.size(), pairs));
  throw Error(fmt::format(
      "{}: the ball at the tip was found at {} places and {} are wanted; otherwise: {}; expected "
      "a ball whose colour nothing else has, wholly in view; see rig.vision.ball_hue_deg, "
      "rig.vision.ball_radius_mm and truth.camera.exposure",
      models::place_of(setup, "rig.vision.ball_hue_deg"), run.points.size(), pairs, word_of(eyes->loss())));
}

// Mean error of the result against X_WC over the volume in view.
Vec3 mean_error(const PointStudy& study, const Pose<'W', 'C'>& X_WC, const std::vector<Point<'W'>>& targets) {
  Vec3 mean = Vec3::Zero();
  for (const Point<'W'>& p : targets)
    mean += trial::target_error(study.found.X_WC, X_WC, p).cwiseAbs() / static_cast<double>(targets.size());
  return mean;
}

// Refuses options that apply to a rig only.
void refuse(bool given, const std::string& option, const CameraOptions& options) {
  if (given)
    throw Error(fmt::format("{} is of a rig; {} is none; expected the command without it; remove it", option,
                            models::quoted(options.what)));
}

int calibrate_points(const CameraOptions& options) {
  refuse(!options.out.empty(), "--out", options);
  refuse(options.force, "--force", options);
  refuse(!options.set.empty(), "--set", options);
  refuse(options.pairs.has_value(), "--pairs", options);
  refuse(options.frames.has_value(), "--frames", options);
  refuse(options.through_images, "--through-images", options);
  const std::string csv =
      trial::read_table(options.what, "table", "a CSV file with camera_x_m, ..., device_x_m, ..., pair");
  refuse_poses(csv, options.what, "pairs of points");
  const PointSet places = models::parse_points(csv, options.what);
  const PointStudy study = trial::study_points(places, options.seed.value_or(1));
  fmt::print("{}\n", options.json ? study_json(places, study).dump(2) : study_text(places, study));
  return 0;
}

void refuse_armless(const CameraOptions& options) {
  if (models::load_rig(options.what).arm.driver == "none")
    throw Error(
        fmt::format("{}: has no arm; expected a rig whose arm is driven through the camera's view; run: "
                    "encounter calibrate rig {}",
                    options.what, shell_word(options.what)));
}

// Result of the twin's arm, with its errors, which only a twin knows.
struct ArmResult {
  trial::GuidedRun run;
  PointStudy study;
  std::size_t frames;  // of a place
  bool by_images;
  Vec3 error, apart;  // m, mean |error| over the volume in view: in W, and between camera and arm
  double time;        // s of experiment
};

Json json_of(const ArmResult& arm) {
  Json json = study_json(arm.run.points, arm.study);
  if (arm.by_images) json["places"] = places_json(arm.run, arm.frames);
  json["true_error_mm"] = json_of(arm.error, kMmPerM);
  json["camera_to_arm_error_mm"] = json_of(arm.apart, kMmPerM);
  json["time_s"] = arm.time;
  return json;
}

std::string text_of(const ArmResult& arm) {
  const auto axes = [](const Vec3& v) {
    return fmt::format("{} {} {} mm", number(v.x(), kMmPerM, 4), number(v.y(), kMmPerM, 4),
                       number(v.z(), kMmPerM, 4));
  };
  return fmt::format(
      "{}{}truth       all over the volume in view, mean |error| of x, y, z: {} in W, {} between camera and "
      "arm\n"
      "procedure   {:.1f} s of experiment: the arm was driven to each place and rested there\n",
      arm.by_images ? places_text(arm.run, arm.frames) : "", study_text(arm.run.points, arm.study),
      axes(arm.error), axes(arm.apart), arm.time);
}

int calibrate_arm(const CameraOptions& options, const trial::DriverSource& modules) {
  refuse_armless(options);
  const std::size_t pairs = options.pairs.value_or(8), frames = options.frames.value_or(20);
  const std::uint64_t seed = options.seed.value_or(1);
  const models::Setup setup = models::load_rig_setup(options.what, options.set);
  const trial::RegistrationRig rig = trial::registration_rig(setup);
  std::optional<models::OutFile> file;  // refuse it before the arm moves
  if (!options.out.empty()) file.emplace(options.out, models::existing(options.force));
  std::optional<trial::PictureEyes> eyes;  // also before the arm moves
  if (options.through_images) eyes.emplace(trial::twin_eyes(setup, modules, seed));
  trial::DrivenArm arm(setup);
  const trial::RegistrationPlaces places = trial::places_of(rig, pairs);
  const std::vector<trial::TipVisit> visits =
      trial::visit_places(arm, places.visited, rig.camera.rate, frames);
  const trial::GuidedRun run =
      eyes ? trial::see_visits(visits, *eyes, kFound) : trial::see_visits(visits, rig.X_WC, rig.camera, seed);
  if (run.points.size() < pairs) refuse_few(setup, run, pairs, eyes ? &*eyes : nullptr);
  if (file) {
    file->write(models::points_text(run.points));
    file->keep();
  }
  const PointStudy study = trial::study_points(run.points, seed);
  const Vec3 error = mean_error(study, rig.X_WC, places.targets);
  const Vec3 apart = mean_error(study, arm.as_it_believes(rig.X_WC), places.targets);
  const double time = run.seconds.back() + static_cast<double>(frames) / rig.camera.rate;
  const ArmResult result{run, study, frames, eyes.has_value(), error, apart, time};
  fmt::print("{}", options.json ? json_of(result).dump(2) + "\n" : text_of(result));
  return 0;
}

}  // namespace

int calibrate_camera(const CameraOptions& options, const trial::DriverSource& modules) {
  return is_rig(options.what) ? calibrate_arm(options, modules) : calibrate_points(options);
}

}  // namespace enc::app
