// What a camera and what it looks at are to each other.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "core/error.h"
#include "core/vision/rig/vision_check.h"
#include "models/schema/wording.h"
#include "models/setup/scene_check.h"
#include "models/setup/stereo_file.h"

namespace enc::models {
namespace {

// Why a finger at the object would not be seen, as far as the rig knows where its camera stands; empty where
// it would. Pinholes: what a lens does to the edge of an image does not matter here.
std::string unseen(const RigSpec& rig, const ObjectSpec& object) {
  const StereoRig& camera = rig.camera;
  const Point<'C'> at = pose_of<'W', 'C'>(rig.frames.W_C).inverse() * Point<'W'>(object.position);
  const double depth = at.xyz[2];
  if (!(depth > 0.0)) return "behind the camera";
  const MatchSpec& match = rig.vision.match;
  if (depth < match.nearest || depth > match.farthest)
    return fmt::format("{} mm before the camera, where {} to {} mm are matched",
                       mm(std::round(depth * 1e3) * 1e-3), mm(match.nearest), mm(match.farthest));
  const auto outside = [&](const Lens& lens, const Vec3& p) {
    const double column = lens.centre_x + lens.focal_x * p.x() / p.z();
    const double row = lens.centre_y + lens.focal_y * p.y() / p.z();
    return !(p.z() > 0.0 && column >= 0.0 && row >= 0.0 && column <= static_cast<double>(camera.width - 1) &&
             row <= static_cast<double>(camera.height - 1));
  };
  if (outside(camera.left, at.e())) return "outside of the left image";
  if (outside(camera.right, (camera.X_CD.inverse() * at).e())) return "outside of the right image";
  return {};
}

// A registration of another rig shows before anything moves: the camera would not see what is to be met.
void check_views(const Setup& setup) {
  std::string why;
  for (const ObjectSpec& object : setup.scene.objects) {
    const std::string of_this = unseen(setup.rig, object);
    if (of_this.empty()) return;
    if (why.empty()) why = fmt::format("object {} would be {}", quoted(object.name), of_this);
  }
  if (why.empty()) return;
  fail(
      setup, "rig.frames.W_C",
      fmt::format("a camera that stands there sees none of the {} object{}: {}; expected the registration of "
                  "this rig; make it by `encounter calibrate`",
                  setup.scene.objects.size(), setup.scene.objects.size() == 1 ? "" : "s", why));
}

// What the twin's camera is, beside what the rig says of it.
void check_twin(const Setup& setup) {
  const StereoRig& believed = setup.rig.camera;
  const sim::CameraTruth& truth = setup.twin.camera;
  if (believed.width != truth.width || believed.height != truth.height)
    fail(setup, "rig.camera.width_px",
         fmt::format("the rig's images are {} x {} px and the twin's {} x {}; expected the same; correct "
                     "'width_px' and 'height_px' here or in [truth.camera]",
                     believed.width, believed.height, truth.width, truth.height));
  if (!std::isnan(truth.back_at) && !(truth.back_at > truth.stalls_at))
    fail(setup, "truth.camera.back_at_s",
         fmt::format(
             "'back_at_s' is {:g}; expected more than 'stalls_at_s', at which the frames stop; correct "
             "one of them",
             truth.back_at));
}

}  // namespace

// Vision sees a bare fingertip, which only an arm meets.
void check_camera(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.camera) return;
  if (!s.tracker)
    fail(setup, "camera",
         "the scene has a [camera] and nothing that looks through it; expected a [tracker]; add it");
  if (!s.arm)
    fail(setup, "camera",
         "vision sees a bare finger, which has no markers; expected an [arm] that meets it; remove [camera]");
  if (s.tools.size() > 1)
    fail(setup, "camera",
         "vision sees one finger and tells no tools apart; expected one [[tool]]; remove the others");
  try {
    check_stereo(setup.rig.camera);
  } catch (const Error& e) {
    fail(setup, "rig.camera." + e.key(), e.what());
  }
  try {
    check(setup.rig.camera, setup.rig.vision);
  } catch (const Error& e) {
    fail(setup, e.key(), e.what());
  }
  check_views(setup);
  if (setup.rig.camera.driver == "sim") check_twin(setup);
}

void note_views(Setup& setup) {
  if (!setup.scene.camera) return;
  for (const ObjectSpec& object : setup.scene.objects)
    if (const std::string why = unseen(setup.rig, object); !why.empty())
      setup.notes.push_back(
          fmt::format("{}: warning: object {} is {}: no finger is seen there; move it, or "
                      "register the camera again",
                      place_of(setup, "object." + object.name), quoted(object.name), why));
}

}  // namespace enc::models
