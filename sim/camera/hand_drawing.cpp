#include <algorithm>

#include "core/base/error.h"
#include "sim/camera/hand.h"
#include "sim/camera/scenery.h"

namespace enc::sim {
namespace {

constexpr int kPieces = 12;  // of the finger, each a little wider
constexpr double kFingerLength = 0.088;

mjvGeom taken(const mjModel* model, mjvScene& scene, const char* name) {
  const int id = mj_name2id(model, mjOBJ_GEOM, name);
  mjvGeom* end = scene.geoms + scene.ngeom;
  mjvGeom* found = std::find_if(scene.geoms, end,
                                [&](const mjvGeom& g) { return g.objtype == mjOBJ_GEOM && g.objid == id; });
  if (found == end) throw Error("the scenery has no hand", {}, ErrorKind::device);
  const mjvGeom geom = *found;
  std::copy(found + 1, end, found);
  --scene.ngeom;
  return geom;
}

// Hands differ less than their fingers do.
double size_of(const HandLook& look) { return 0.5 + 0.5 * look.finger_width / 0.016; }

void place(mjvGeom& geom, const Vec3& at, const Mat3& axes) {
  for (int i = 0; i < 3; ++i) {
    geom.pos[i] = static_cast<float>(at(i));
    for (int j = 0; j < 3; ++j) geom.mat[3 * i + j] = static_cast<float>(axes(i, j));
  }
}

mjvGeom& appended(const mjvGeom& from, const Rgb& colour, mjvScene& scene) {
  if (scene.ngeom >= scene.maxgeom) throw Error("too many things in the picture", {}, ErrorKind::device);
  mjvGeom& geom = scene.geoms[scene.ngeom++];
  geom = from;
  geom.segid = scene.ngeom - 1;
  std::copy(colour.begin(), colour.end(), geom.rgba);
  return geom;
}

}  // namespace

HandDrawing::HandDrawing(const mjModel* model, mjvScene& scene)
    : model_(model),
      skin_(taken(model, scene, kSkinGeom)),
      sleeve_(taken(model, scene, kSleeveGeom)),
      tube_(taken(model, scene, kTubeGeom)),
      background_(scene.ngeom),
      sleeve_at_(kPieces + 2) {}

// MuJoCo keeps a mesh about its middle and along its principal axes.
void HandDrawing::add_mesh(const mjvGeom& mesh, const Vec3& at, const Mat3& axes, const Rgb& colour,
                           mjvScene& scene) const {
  const int id = mesh.dataid / 2;
  const Eigen::Map<const Vec3> middle(model_->mesh_pos + 3 * static_cast<std::ptrdiff_t>(id));
  const mjtNum* q = model_->mesh_quat + 4 * static_cast<std::ptrdiff_t>(id);
  place(appended(mesh, colour, scene), at + axes * middle,
        axes * Quat(q[0], q[1], q[2], q[3]).toRotationMatrix());
}

void HandDrawing::add_finger(const HandPose& pose, const HandLook& look, mjvScene& scene) const {
  const Mat3 axes = hand_axes(pose);
  const double radius = 0.5 * look.finger_width;
  mjvGeom& cap = appended(skin_, look.skin, scene);
  cap.type = mjGEOM_SPHERE;
  cap.dataid = -1;
  cap.size[0] = cap.size[1] = cap.size[2] = static_cast<float>(radius);
  place(cap, pose.tip.e(), axes);
  const double piece = size_of(look) * kFingerLength / kPieces;
  for (int i = 0; i < kPieces; ++i) {
    const double wide = radius * (1.0 + (look.taper - 1.0) * (i + 0.5) / kPieces);
    add_mesh(tube_, pose.tip.e() - (i + 0.5) * piece * axes.col(0),
             axes * Vec3(piece, wide, wide).asDiagonal(), look.skin, scene);
  }
}

void HandDrawing::show(const Shown& shown, mjvScene& scene) {
  scene.ngeom = background_;
  if (shown.hand) add_hand(shown.pose, shown.look, scene);
  things_ = scene.ngeom;
  for (const Thing& thing : shown.things) add_thing(thing, scene);
}

void HandDrawing::add_thing(const Thing& thing, mjvScene& scene) const {
  mjvGeom& geom = appended(skin_, thing.colour, scene);
  geom.dataid = -1;
  Vec3 size = thing.half;
  switch (thing.shape) {
    case ThingShape::sphere:
      geom.type = mjGEOM_SPHERE;
      break;
    case ThingShape::capsule:
      geom.type = mjGEOM_CAPSULE;
      break;
    case ThingShape::cylinder:
      geom.type = mjGEOM_CYLINDER;
      break;
    case ThingShape::box:
      geom.type = mjGEOM_BOX;
      break;
  }
  if (thing.shape != ThingShape::box) size.y() = size.x();
  if (thing.shape == ThingShape::sphere) size.z() = size.x();
  for (int i = 0; i < 3; ++i) geom.size[i] = static_cast<float>(size(i));
  place(geom, thing.at.e(), thing.axes);
}

void HandDrawing::add_hand(const HandPose& pose, const HandLook& look, mjvScene& scene) const {
  add_finger(pose, look, scene);
  const double scale = size_of(look);
  const Mat3 axes = scale * hand_axes(pose);
  add_mesh(skin_, pose.tip.e(), axes, look.skin, scene);
  add_mesh(sleeve_, pose.tip.e() - axes.col(0) * (std::clamp(look.bare, 0.0, 0.35) / scale), axes,
           look.sleeve, scene);
}

}  // namespace enc::sim
