// The shape of a hand, and its drawing.
#include "sim/camera/hand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/error.h"
#include "sim/camera/scenery.h"

namespace enc::sim {
namespace {

constexpr double kFinger = 0.088;            // m, from the middle of the tip's cap to the knuckle
constexpr double kWrist = -kFinger - 0.080;  // m
constexpr int kAround = 24;                  // corners of a round section

// A ring of a body of revolution: position along the axis, half axes, and the axial part of its normals.
struct Ring {
  double z, x, y, tilt;
};

class Builder {
 public:
  HandMesh mesh;

  void capsule(const Vec3& from, const Vec3& to, double radius) {
    const double length = (to - from).norm();
    std::vector<Ring> rings;
    for (int i = 0; i <= 8; ++i) {
      // The two middle rings are the ends of the cylinder.
      const double angle = (i <= 4 ? -0.5 + 0.125 * i : 0.125 * (i - 5) + 0.125) * std::numbers::pi;
      rings.push_back(ring(i <= 4 ? 0.0 : length, angle, radius, radius, radius));
    }
    rings.insert(rings.begin() + 5, ring(length, 0.0, radius, radius, radius));
    solid(from, (to - from) / length, Vec3(0, 1, 0), rings);
  }
  void ellipsoid(const Vec3& at, const Vec3& half) {  // half axes along y, x, z
    std::vector<Ring> rings;
    for (int i = 0; i <= 12; ++i)
      rings.push_back(ring(0.0, (-0.5 + i / 12.0) * std::numbers::pi, half.x(), half.y(), half.z()));
    solid(at, Vec3(0, 0, 1), Vec3(0, 1, 0), rings);
  }
  // Open at its ends, which are inside of another body or out of the picture. A collar, if requested, nearly
  // closes the end at `from`.
  void oval(const Vec3& from, const Vec3& to, double y0, double z0, double y1, double z1, bool collar) {
    std::vector<Ring> rings;
    if (collar) rings = {{0.0, 0.6 * y0, 0.5 * z0, -1.0}, {0.0, y0, z0, -1.0}};
    const double length = (to - from).norm();
    rings.push_back({0.0, y0, z0, 0.0});
    rings.push_back({length, y1, z1, 0.0});
    solid(from, (to - from) / length, Vec3(0, 1, 0), rings);
  }

 private:
  static Ring ring(double middle, double angle, double x, double y, double z) {
    return {middle + z * std::sin(angle), x * std::cos(angle), y * std::cos(angle), std::sin(angle)};
  }
  void solid(const Vec3& from, const Vec3& z, const Vec3& about_x, const std::vector<Ring>& rings);
};

void Builder::solid(const Vec3& from, const Vec3& z, const Vec3& about_x, const std::vector<Ring>& rings) {
  const Vec3 x = (about_x - z * z.dot(about_x)).normalized(), y = z.cross(x);
  const int first = static_cast<int>(mesh.vertices.size() / 3);
  for (const Ring& r : rings)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kAround, c = std::cos(angle), s = std::sin(angle);
      const Vec3 at = from + r.z * z + r.x * c * x + r.y * s * y;
      // The normal of an oval is steeper at its narrow ends.
      const double wide = std::max(r.x, 1e-9), high = std::max(r.y, 1e-9);
      const Vec3 out = (c / wide * x + s / high * y).normalized();
      const Vec3 normal = std::sqrt(std::max(0.0, 1.0 - r.tilt * r.tilt)) * out + r.tilt * z;
      for (int k = 0; k < 3; ++k) {
        mesh.vertices.push_back(static_cast<float>(at(k)));
        mesh.normals.push_back(static_cast<float>(normal(k)));
      }
    }
  for (int r = 0; r + 1 < static_cast<int>(rings.size()); ++r)
    for (int i = 0; i < kAround; ++i) {
      const int a = first + r * kAround + i, b = first + r * kAround + (i + 1) % kAround;
      for (const int corner : {a, b, b + kAround, a, b + kAround, a + kAround}) mesh.faces.push_back(corner);
    }
}

void folded_finger(Builder& hand, const Vec3& knuckle, double size) {
  const Vec3 first = knuckle + size * Vec3(0.020, 0, -0.032);
  const Vec3 second = first + size * Vec3(-0.027, 0, -0.004);
  const Vec3 third = second + size * Vec3(-0.008, 0, 0.018);
  hand.capsule(knuckle, first, 0.0092 * size);
  hand.capsule(first, second, 0.0086 * size);
  hand.capsule(second, third, 0.0080 * size);
}

void palm(Builder& hand) {
  const Vec3 index(-kFinger, 0, 0), middle(-kFinger + 0.003, -0.0215, 0.001),
      ring(-kFinger - 0.004, -0.0415, -0.001), little(-kFinger - 0.014, -0.0590, -0.005);
  const double wrist = -kFinger - 0.085;
  hand.capsule(index, {wrist, -0.010, -0.004}, 0.0125);
  hand.capsule(middle, {wrist, -0.021, -0.003}, 0.0130);
  hand.capsule(ring, {wrist, -0.032, -0.004}, 0.0125);
  hand.capsule(little, {wrist, -0.043, -0.006}, 0.0115);
  hand.ellipsoid({-kFinger - 0.046, -0.027, -0.006}, {0.042, 0.050, 0.0165});
  folded_finger(hand, middle, 1.05);
  folded_finger(hand, ring, 1.0);
  folded_finger(hand, little, 0.88);
}

void thumb(Builder& hand) {
  const Vec3 root(-kFinger - 0.070, 0.000, -0.012), joint(-kFinger - 0.036, 0.024, -0.020),
      bend(-kFinger - 0.006, 0.020, -0.030), end(-kFinger + 0.012, 0.002, -0.036);
  hand.capsule(root, joint, 0.0140);
  hand.capsule(joint, bend, 0.0108);
  hand.capsule(bend, end, 0.0098);
}

}  // namespace

HandMesh bare_hand() {
  Builder hand;
  palm(hand);
  thumb(hand);
  hand.ellipsoid({kWrist - 0.002, -0.0265, -0.004}, {0.0300, 0.020, 0.0185});
  // The forearm is as long as the sleeve may leave bare.
  hand.oval({kWrist, -0.0265, -0.004}, {kWrist - 0.40, -0.0265, -0.026}, 0.0285, 0.0190, 0.0400, 0.0330,
            true);
  return hand.mesh;
}

HandMesh sleeve_mesh() {
  Builder arm;
  const Vec3 cuff(kWrist, -0.0265, -0.005), end(kWrist - 0.020, -0.0265, -0.005),
      elbow(kWrist - 0.45, -0.0265, -0.03);
  arm.oval(cuff, end, 0.0460, 0.0390, 0.0460, 0.0390, true);
  arm.oval(cuff, elbow, 0.0430, 0.0360, 0.0580, 0.0500, false);
  return arm.mesh;
}

HandMesh unit_tube() {
  Builder tube;
  tube.oval({-0.5, 0, 0}, {0.5, 0, 0}, 1.0, 1.0, 1.0, 1.0, false);
  return tube.mesh;
}

Mat3 hand_axes(const HandPose& pose) {
  const double length = pose.along.norm();
  const Vec3 along = length > 0.0 ? Vec3(pose.along.e() / length) : Vec3(0, -1, 0);
  // Without roll the back of the hand faces the camera as far as it can.
  const Vec3 to_camera = Vec3(0, 0, -1) + along * along.z();
  const Vec3 up = to_camera.norm() > 1e-3 ? Vec3(to_camera.normalized())
                                          : Vec3((Vec3(0, -1, 0) + along * along.y()).normalized());
  const Vec3 back = std::cos(pose.roll) * up + std::sin(pose.roll) * along.cross(up);
  Mat3 axes;
  axes.col(0) = along;
  axes.col(1) = back.cross(along);  // a right hand
  axes.col(2) = back;
  return axes;
}

namespace {

constexpr int kPieces = 12;  // pieces of the finger, each a little wider
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

// Hands differ less in size than their fingers.
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

// MuJoCo stores a mesh about its middle and along its principal axes.
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

void HandDrawing::show(const CameraScene& shown, mjvScene& scene) {
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
