#include "models/setup/calibration_files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/base/words.h"
#include "models/files.h"
#include "models/schema/schema_walk.h"
#include "models/schema/toml_reader.h"
#include "models/schema/toml_writer.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"
#include "models/setup/driver_table.h"
#include "models/setup/scene_check.h"
#include "models/setup/scene_file.h"

namespace enc::models {

// ---- Calibration of a rig.

namespace {

constexpr std::string_view kMadeBy = "encounter calibrate rig";
constexpr auto kSaid = Confidence::chosen;
constexpr auto kMust = Presence::needed;
constexpr Range kTurns{-360.0, 360.0};

void describe_file(Visitor& v, RigCalibration& file) {
  std::int64_t format = 1;
  v.value({"format", "this program reads version 1", kMadeBy, kSaid, {1.0, 1.0}, kMust}, &format);
  v.value({"title", "of the rig", kMadeBy, kSaid}, &file.title);
  v.value({"date", "day on which it was measured", kMadeBy, kSaid, kAny, kMust}, &file.date);
  table(v, "of", [&] {
    v.value({"manipulator", "driver, and address where it has one", kMadeBy, kSaid, kAny, kMust},
            &file.of.manipulator);
    v.value({"force", "likewise", kMadeBy, kSaid, kAny, kMust}, &file.of.force);
    v.value({"tracker", "likewise", kMadeBy, kSaid, kAny, kMust}, &file.of.tracker);
    table(v, "geometry", [&] { describe(v, file.of.geometry); });
  });
  table_if(v, "frames", file.W_C || file.H_F, [&] {
    part(v, "W_C", file.W_C, [&](PoseSpec& p) {
      v.value({"position_mm", "of the tracker in the world", kMadeBy, kSaid, {-1e4, 1e4}, kMust},
              &p.position);
      v.value({"rotation_deg", "about the fixed x, then y, then z axis", kMadeBy, kSaid, kTurns, kMust},
              &p.rotation);
    });
    part(v, "H_F", file.H_F, [&](Vec3& rotation) {
      v.value({"rotation_deg", "of the force sensor under the tip", kMadeBy, kSaid, kTurns, kMust},
              &rotation);
    });
  });
  part(v, "force", file.mass, [&](double& mass) {
    v.value({"mass_kg", "behind the sensor, without the tool", kMadeBy, kSaid, kNotNegative, kMust}, &mass);
  });
}

Vec3 rounded_place(const Vec3& place) {
  Vec3 near;
  for (Eigen::Index a = 0; a < 3; ++a) near(a) = to_si(unit_of("position_mm"), round_to(place(a) * 1e3, 1e4));
  return near;
}
Vec3 rounded_turn(const Vec3& turn) {
  Vec3 near;
  for (Eigen::Index a = 0; a < 3; ++a)
    near(a) = to_si(unit_of("rotation_deg"), round_to(turn(a) * (180.0 / M_PI), 1e5));
  return near;
}
RigCalibration rounded(RigCalibration file) {
  if (file.W_C) {
    file.W_C->position = rounded_place(file.W_C->position);
    file.W_C->rotation = rounded_turn(file.W_C->rotation);
  }
  if (file.H_F) file.H_F = rounded_turn(*file.H_F);
  if (file.mass) file.mass = round_to(*file.mass, 1e4);
  return file;
}

// "gcs 192.168.0.10 50000"; for a driver without an address, its name.
std::string device_of(const RigSpec& rig, const std::string& driver) {
  std::string device = driver;
  for (const char* key : {"address", "port"})
    if (const std::string text = driver_text(rig, driver, key); !text.empty()) device += " " + text;
  return device;
}

// The difference between two rigs; empty if they are equal.
std::string other_rig(const RigIdentity& was, const RigIdentity& is) {
  const auto differs = [](const char* what, const std::string& before, const std::string& now) {
    return before == now
               ? ""
               : fmt::format("its {} was {} and is {}", what, models::quoted(before), models::quoted(now));
  };
  for (const std::string& text :
       {differs("manipulator", was.manipulator, is.manipulator), differs("force sensor", was.force, is.force),
        differs("tracker", was.tracker, is.tracker)})
    if (!text.empty()) return text;
  constexpr double kLength = 1e-6, kAngle = 1e-6;  // m, rad
  const auto apart = [&](double HexapodGeometry::*side) {
    return std::abs(was.geometry.*side - is.geometry.*side);
  };
  for (const auto& [side, name] : {std::pair{&HexapodGeometry::base_radius, "base_radius_mm"},
                                   {&HexapodGeometry::platform_radius, "platform_radius_mm"},
                                   {&HexapodGeometry::height, "height_mm"},
                                   {&HexapodGeometry::tip_height, "tip_height_mm"},
                                   {&HexapodGeometry::stroke, "stroke_mm"}})
    if (!(apart(side) <= kLength))
      return fmt::format("rig.manipulator.geometry.{} was {:g} and is {:g}", name, 1e3 * was.geometry.*side,
                         1e3 * is.geometry.*side);
  for (const auto& [angle, name] : {std::pair{&HexapodGeometry::base_half_angle, "base_half_angle_deg"},
                                    {&HexapodGeometry::platform_half_angle, "platform_half_angle_deg"}})
    if (!(apart(angle) <= kAngle))
      return fmt::format("rig.manipulator.geometry.{} was {:g} and is {:g}", name,
                         180.0 / M_PI * was.geometry.*angle, 180.0 / M_PI * is.geometry.*angle);
  return "";
}

constexpr std::string_view kTrackerPlace = "rig.frames.W_C.position_mm",
                           kTrackerTurn = "rig.frames.W_C.rotation_deg",
                           kSensorTurn = "rig.frames.H_F.rotation_deg", kWeight = "rig.force.mass_kg";

}  // namespace

std::optional<std::chrono::sys_days> day_of(std::string_view text) {
  int year = 0;
  unsigned month = 0, day = 0;
  const auto number = [&](std::size_t from, std::size_t length, auto& value) {
    const char* end = text.data() + from + length;
    return std::from_chars(text.data() + from, end, value).ptr == end;
  };
  if (text.size() != 10 || text[4] != '-' || text[7] != '-' || !number(0, 4, year) || !number(5, 2, month) ||
      !number(8, 2, day) || year <= 0)
    return {};
  const std::chrono::year_month_day date{std::chrono::year(year), std::chrono::month(month),
                                         std::chrono::day(day)};
  return date.ok() ? std::optional(std::chrono::sys_days(date)) : std::nullopt;
}

std::string doubt_of(const CalibrationRig& calibration, std::chrono::sys_days today) {
  const auto day = day_of(calibration.date);
  if (!day)
    return "this rig has no day of calibration; expected a [calibration] with date = \"YYYY-MM-DD\", the day "
           "on which it was measured, or the file of `encounter calibrate rig RIG` "
           "(docs/guide/laboratory.md)";
  const std::int64_t age = (today - *day).count();
  if (age < -1)
    return fmt::format(
        "this rig was calibrated on {}, which is {} from now; expected a day that has been; "
        "see to the date, and to the clock of this PC",
        calibration.date, counted(-age, "day"));
  if (age > calibration.valid)
    return fmt::format(
        "this rig was calibrated on {}, {} ago; expected {} at most; calibrate it again "
        "(docs/guide/laboratory.md), or raise rig.calibration.valid_days if nothing was moved",
        calibration.date, counted(age, "day"), calibration.valid);
  return {};
}

RigIdentity identity_of(const RigSpec& rig) {
  return {device_of(rig, rig.manipulator.driver), device_of(rig, rig.force.driver),
          device_of(rig, rig.tracker.driver), rig.manipulator.geometry};
}

std::string rig_calibration_text(const RigCalibration& calibration) {
  RigCalibration file = rounded(calibration);
  return write_toml([&](Visitor& visitor) { describe_file(visitor, file); });
}

RigCalibration parse_rig_calibration(const std::string& text, const std::string& name) {
  RigCalibration file;
  const Places places = read_toml(text, name, [&](Visitor& visitor) { describe_file(visitor, file); });
  if (!day_of(file.date)) {
    const auto place = places.find("date");
    throw Error(fmt::format("{}: 'date' is {}; expected a day, as \"2026-11-28\"; calibrate again",
                            place == places.end() ? name + ":1:1" : place->second,
                            models::quoted(file.date)));
  }
  if (!places.contains("of") || !places.contains("of.geometry"))
    throw Error(
        fmt::format("{}:1:1: does not say which rig it is of; expected [of] and [of.geometry]; "
                    "calibrate again",
                    name));
  return file;
}

bool of_rig_calibration(std::string_view name) {
  return name == kTrackerPlace || name == kTrackerTurn || name == kSensorTurn || name == kWeight;
}

namespace {

// Reads the calibration at `path`, which must belong to this rig and have all of its tables.
RigCalibration read_measured(const Setup& setup, const std::string& path) {
  const RigSpec& rig = setup.rig;
  const std::string named = place_of(setup, "rig.calibration.file");
  constexpr std::size_t kLongest = 1U << 20U;
  std::string why;
  const std::string text = read_file(path, kLongest, why);
  if (!why.empty())
    throw Error(fmt::format(
        "{}: cannot read the calibration {}: {}; expected a file as `encounter calibrate rig RIG --out "
        "FILE` writes, beside the rig's; see to its name",
        named, models::quoted(path), why));
  RigCalibration file = parse_rig_calibration(text, path);
  std::string other = other_rig(file.of, identity_of(rig));
  if (other.empty() && file.title != rig.title)
    other = fmt::format("its title was {} and is {}", models::quoted(file.title), models::quoted(rig.title));
  if (!other.empty())
    throw Error(
        fmt::format("{}: the calibration {} is of another rig: {}; expected one of this rig; calibrate "
                    "it, or name its own file",
                    named, models::quoted(path), other));
  const auto lacks = [&](const std::string& driver, bool says, const char* what) {
    if (driver == "none" || says) return;
    throw Error(
        fmt::format("{}: the calibration {} does not say {}; expected all that this rig has, measured "
                    "together; calibrate it again",
                    named, models::quoted(path), what));
  };
  lacks(rig.tracker.driver, file.W_C.has_value(), "where the tracker is");
  lacks(rig.force.driver, file.H_F && file.mass, "how the force sensor is turned and what it carries");
  return file;
}

}  // namespace

void fill_measured(Setup& setup) {
  RigSpec& rig = setup.rig;
  if (rig.calibration.file.empty()) return;
  const std::string path = (std::filesystem::path(setup.rig_path).parent_path() / rig.calibration.file)
                               .lexically_normal()
                               .string();
  const RigCalibration file = read_measured(setup, path);
  if (!rig.calibration.date.empty() && rig.calibration.date != file.date)
    throw Error(
        fmt::format("{}: 'date' is {} and that of the calibration {} is {}; expected one of the two; remove "
                    "this one",
                    place_of(setup, "rig.calibration.date"), models::quoted(rig.calibration.date),
                    models::quoted(path), models::quoted(file.date)));
  const auto by_hand = [&](std::string_view name) { return place_of(setup, name).starts_with("--set"); };
  const auto take = [&](std::string_view name, auto& to, const auto& from) {
    if (by_hand(name)) return;
    to = from;
    setup.places[std::string(name)] = path + ":1:1";
  };
  if (file.W_C) {
    take(kTrackerPlace, rig.frames.W_C.position, file.W_C->position);
    take(kTrackerTurn, rig.frames.W_C.rotation, file.W_C->rotation);
  }
  if (file.H_F) take(kSensorTurn, rig.frames.H_F.rotation, *file.H_F);
  if (file.mass) take(kWeight, rig.force.mass, *file.mass);
  rig.calibration.date = file.date;
  setup.measured = path;
  rig.calibration.file.clear();  // a resolved scene needs no other file
}

void fill_truth(Setup& setup) {
  const auto take = [&](std::string_view name, auto& to, const auto& from) {
    if (!setup.places.contains(name)) to = from;
  };
  if (setup.rig.force.mass > 0.0)
    take("truth.hexapod.mass_kg", setup.twin.hexapod.mass, setup.rig.force.mass);
  const FramesRig& frames = setup.rig.frames;
  sim::FramesTruth& truth = setup.twin.frames;
  take("truth.frames.W_C.position_mm", truth.W_C.position, frames.W_C.position);
  take("truth.frames.W_C.rotation_deg", truth.W_C.rotation, frames.W_C.rotation);
  take("truth.frames.H_F.position_mm", truth.H_F.position, frames.H_F.position);
  take("truth.frames.H_F.rotation_deg", truth.H_F.rotation, frames.H_F.rotation);
  for (const auto& [side, name] : {std::pair{&HexapodGeometry::base_radius, "base_radius_mm"},
                                   {&HexapodGeometry::platform_radius, "platform_radius_mm"},
                                   {&HexapodGeometry::base_half_angle, "base_half_angle_deg"},
                                   {&HexapodGeometry::platform_half_angle, "platform_half_angle_deg"},
                                   {&HexapodGeometry::height, "height_mm"},
                                   {&HexapodGeometry::tip_height, "tip_height_mm"},
                                   {&HexapodGeometry::stroke, "stroke_mm"},
                                   {&HexapodGeometry::tilt_limit, "tilt_limit_deg"},
                                   {&HexapodGeometry::yaw_limit, "yaw_limit_deg"}})
    take(fmt::format("truth.hexapod.geometry.{}", name), setup.twin.hexapod.geometry.*side,
         setup.rig.manipulator.geometry.*side);
}

// ---- Calibration of a stereo head.

namespace {

constexpr std::string_view kSource = "encounter calibrate stereo";
constexpr HeadKeys kKeys{kSource, kMust};

void describe_file(Visitor& v, StereoFile& file) {
  std::int64_t format = 1;
  v.value({"format", "this program reads version 1", kSource, kSaid, {1.0, 1.0}, kMust}, &format);
  v.value({"title", "what it was made of", kSource, kSaid, kAny, kMust}, &file.title);
  describe_size(v, file.rig, kKeys);
  v.value({"reprojection_px", "rms that is left over", kSource, kSaid, kNotNegative, Presence::optional},
          &file.reprojection);
  v.value(
      {"epipolar_px", "rms, of pairs that were left out", kSource, kSaid, kNotNegative, Presence::optional},
      &file.epipolar);
  describe_lenses(v, file.rig, kKeys);
}

StereoFile rounded(StereoFile file) {
  file.reprojection = round_to(file.reprojection, 1e4);
  file.epipolar = round_to(file.epipolar, 1e4);
  for (Lens* lens : {&file.rig.left, &file.rig.right}) {
    for (double* px : {&lens->focal_x, &lens->focal_y, &lens->centre_x, &lens->centre_y})
      *px = round_to(*px, 1e4);
    for (double& k : lens->distortion) k = round_to(k, 1e6);
  }
  const Pose<'C', 'D'>& X_CD = file.rig.X_CD;
  file.rig.X_CD = {rotation_xyz(rounded_turn(angles_xyz(Quat(X_CD.q())))), rounded_place(X_CD.p())};
  return file;
}

[[noreturn]] void refuse(const std::string& key, const std::string& what, const std::string& wanted) {
  throw Error(fmt::format("{} {}; expected {}; calibrate again", key, what, wanted), key);
}

// True if a point farther from the axis appears farther from it, up to the image's corner.
bool unfolded(const Lens& lens, double width, double height) {
  const double x = std::max(lens.centre_x, width - 1.0 - lens.centre_x) / lens.focal_x;
  const double y = std::max(lens.centre_y, height - 1.0 - lens.centre_y) / lens.focal_y;
  const double corner = std::sqrt(x * x + y * y);
  const auto& [k1, k2, p1, p2, k3] = lens.distortion;
  double before = 0.0;
  for (int i = 1; i < 2000; ++i) {
    const double r = 0.005 * i;
    const double r2 = r * r;
    const double now = r * (1.0 + r2 * (k1 + r2 * (k2 + r2 * k3)));
    if (now >= corner) return true;
    if (now <= before) return false;
    before = now;
  }
  return false;
}

void check_lens(const Lens& lens, const StereoRig& rig, const std::string& side) {
  const auto width = static_cast<double>(rig.width), height = static_cast<double>(rig.height);
  const double longer = std::max(width, height);
  for (double focal : {lens.focal_x, lens.focal_y})
    if (!(focal > 0.1 * longer && focal < 20.0 * longer))
      refuse(side + ".focal_px", fmt::format("is {:.6g}", focal),
             fmt::format("{:.6g} to {:.6g} px for images of this width", 0.1 * longer, 20.0 * longer));
  if (std::abs(lens.focal_x / lens.focal_y - 1.0) > 0.2)
    refuse(side + ".focal_px", "differs by more than a fifth between rows and columns", "square pixels");
  if (!(lens.centre_x >= 0.0 && lens.centre_x < width && lens.centre_y >= 0.0 && lens.centre_y < height))
    refuse(side + ".centre_px", fmt::format("is {:.6g}, {:.6g}", lens.centre_x, lens.centre_y),
           fmt::format("a place in an image of {} x {} px", rig.width, rig.height));
  if (std::max(std::abs(lens.distortion[2]), std::abs(lens.distortion[3])) > 0.1 ||
      !unfolded(lens, width, height))
    refuse(side + ".distortion", "folds the image over before its corner",
           "a lens that sees each direction once");
}

}  // namespace

void check_stereo(const StereoRig& rig) {
  check_lens(rig.left, rig, "left");
  check_lens(rig.right, rig, "right");
  const Vec3 p = rig.X_CD.p();
  if (!rig.X_CD.valid() || !(p.x() > p.tail<2>().norm()) || p.x() < 1e-3 || p.x() > 10.0)
    refuse("right.position_mm",
           fmt::format("is {:.6g}, {:.6g}, {:.6g}", p.x() * 1e3, p.y() * 1e3, p.z() * 1e3),
           "a camera to the right of the left one, 1 mm to 10 m away");
  if (!(rig.X_CD.q().angularDistance(Quat::Identity()) < M_PI / 3.0))
    refuse("right.rotation_deg", "turns the right camera away", "less than 60 degrees");
}

std::string stereo_text(const StereoFile& given) {
  StereoFile file = rounded(given);
  return write_toml([&](Visitor& visitor) { describe_file(visitor, file); });
}

StereoFile parse_stereo(const std::string& text, const std::string& name) {
  StereoFile file;
  const Places places = read_toml(text, name, [&](Visitor& visitor) { describe_file(visitor, file); });
  const auto place = [&](const std::string& key) {
    const auto found = places.find(key);
    return found == places.end() ? name + ":1:1" : found->second;
  };
  for (const char* side : {"left", "right"})
    if (!places.contains(side))
      throw Error(
          fmt::format("{}: has no table [{}]; expected both cameras; calibrate again", place(""), side));
  try {
    check_stereo(file.rig);
  } catch (const Error& e) {
    throw Error(fmt::format("{}: {}", place(e.key()), e.what()));
  }
  return file;
}

bool of_calibration(std::string_view name) {
  constexpr std::string_view kCamera = "rig.camera.";
  if (!name.starts_with(kCamera)) return false;
  name.remove_prefix(kCamera.size());
  return name == "width_px" || name == "height_px" || stands_in(name, "left") || stands_in(name, "right");
}

void fill_camera(Setup& setup) {
  StereoRig& camera = setup.rig.camera;
  if (camera.driver == "none" || camera.calibration.empty()) return;
  for (const auto& [name, place] : setup.places)
    if (of_calibration(name))
      throw Error(
          fmt::format("{}: {} is said here and by the calibration {}; expected one of the two; remove "
                      "what is said here, or rig.camera.calibration",
                      place, name, models::quoted(camera.calibration)));
  const std::filesystem::path path = std::filesystem::path(setup.rig_path).parent_path() / camera.calibration;
  const StereoRig file = load_stereo(path.lexically_normal().string());
  camera.width = file.width;
  camera.height = file.height;
  camera.left = file.left;
  camera.right = file.right;
  camera.X_CD = file.X_CD;
  setup.calibration = std::exchange(camera.calibration, "");  // a resolved scene needs no other file
}

StereoRig load_stereo(const std::string& path) {
  constexpr std::size_t kLongest = 1U << 20U;
  std::string why;
  const std::string text = read_file(path, kLongest, why);
  if (!why.empty())
    throw Error(
        fmt::format("{}:1:1: cannot read this calibration: {}; expected a TOML file as `encounter calibrate "
                    "stereo FOLDER --out FILE` writes; see to its name",
                    path, why));
  return parse_stereo(text, path).rig;
}

}  // namespace enc::models
