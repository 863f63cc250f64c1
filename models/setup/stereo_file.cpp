#include "models/setup/stereo_file.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "models/files.h"
#include "models/schema/schema_walk.h"
#include "models/schema/toml_reader.h"
#include "models/schema/toml_writer.h"
#include "models/schema/units.h"
#include "models/schema/wording.h"
#include "models/setup/scene_file.h"

namespace enc::models {
namespace {

constexpr auto kKnown = Confidence::chosen;
constexpr auto kNeeded = Presence::needed;
constexpr std::string_view kSource = "encounter calibrate stereo";
constexpr HeadKeys kKeys{kSource, kNeeded};

void describe_file(Visitor& v, StereoFile& file) {
  std::int64_t format = 1;
  v.value({"format", "this program reads version 1", kSource, kKnown, {1.0, 1.0}, kNeeded}, &format);
  v.value({"title", "what it was made of", kSource, kKnown, kAny, kNeeded}, &file.title);
  describe_size(v, file.rig, kKeys);
  v.value({"reprojection_px", "rms that is left over", kSource, kKnown, kNotNegative, Presence::optional},
          &file.reprojection);
  v.value(
      {"epipolar_px", "rms, of pairs that were left out", kSource, kKnown, kNotNegative, Presence::optional},
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
  Vec3 position = file.rig.X_CD.p(), turn = angles_xyz(Quat(file.rig.X_CD.q()));
  for (double& x : position) x = to_si(unit_of("position_mm"), round_to(x * 1e3, 1e4));
  for (double& x : turn) x = to_si(unit_of("rotation_deg"), round_to(x * (180.0 / M_PI), 1e5));
  file.rig.X_CD = {rotation_xyz(turn), position};
  return file;
}

[[noreturn]] void refuse(const std::string& key, const std::string& what, const std::string& wanted) {
  throw Error(fmt::format("{} {}; expected {}; calibrate again", key, what, wanted), key);
}

// Whether what is farther from the axis is seen farther from it, up to the image's corner.
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

// The table or a key of it.
bool stands_in(std::string_view name, std::string_view table) {
  return name.starts_with(table) && (name.size() == table.size() || name[table.size()] == '.');
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
