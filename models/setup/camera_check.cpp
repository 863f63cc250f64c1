// What a camera and what it looks at are to each other.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/spec/vision/vision_check.h"
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
  if (!(depth > 0.0)) return "behind it";
  const MatchSpec& match = rig.vision.match;
  if (depth < match.nearest || depth > match.farthest)
    return fmt::format("{} mm before it, where {} to {} mm are matched", mm(std::round(depth * 1e3) * 1e-3),
                       mm(match.nearest), mm(match.farthest));
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
  const std::vector<ObjectSpec>& objects = setup.scene.objects;
  const auto seen = [&](const ObjectSpec& object) { return unseen(setup.rig, object).empty(); };
  if (objects.empty() || std::any_of(objects.begin(), objects.end(), seen)) return;
  fail(setup, "rig.frames.W_C",
       fmt::format("a camera that stands there would have object {} {}{}; expected the registration of this "
                   "rig; make it by `encounter calibrate camera`",
                   quoted(objects.front().name), unseen(setup.rig, objects.front()),
                   objects.size() > 1 ? ", and none of the others in view" : ""));
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

// Vision sees a bare fingertip.
void check_camera(const Setup& setup) {
  const SceneSpec& s = setup.scene;
  if (!s.camera) return;
  if (!s.tracker)
    fail(setup, "camera",
         "the scene has a [camera] and nothing that looks through it; expected a [tracker]; add it");
  if (!checks_of(s).bare_finger)
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
  if (setup.rig.camera.driver == "sim") check_twin(setup);  // what is seen depends on the size
  check_views(setup);
}

void note_views(Setup& setup) {
  if (!setup.scene.camera) return;
  const std::vector<ObjectSpec>& objects = setup.scene.objects;
  const auto hidden = [&](const ObjectSpec& object) { return !unseen(setup.rig, object).empty(); };
  const auto first = std::find_if(objects.begin(), objects.end(), hidden);
  if (first == objects.end()) return;
  const auto others = std::count_if(objects.begin(), objects.end(), hidden) - 1;
  setup.notes.push_back(fmt::format(
      "{}: warning: a camera that stands at [frames.W_C] has object {} {}{}, where no finger is seen; "
      "move it, or register the camera again",
      place_of(setup, "object." + first->name), quoted(first->name), unseen(setup.rig, *first),
      others > 0 ? fmt::format(", and {} more out of view", others) : ""));
}

}  // namespace enc::models
