#include "app/view/moment/depict.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "app/built.h"
#include "core/control/world/moving.h"
#include "core/machine/arm_shape.h"
#include "models/setup/scene_file.h"
#include "sim/bodies/model.h"
#include "sim/spec/twin_spec.h"

namespace enc::app {
namespace {

constexpr sim::Colour kForce{0.85F, 0.10F, 0.15F, 1.0F};
constexpr sim::Colour kNormal{0.10F, 0.55F, 0.35F, 1.0F};
constexpr sim::Colour kLeg{0.82F, 0.84F, 0.87F, 1.0F};
constexpr sim::Colour kJacket{0.30F, 0.34F, 0.42F, 1.0F};
constexpr sim::Colour kMarkerArm{0.35F, 0.38F, 0.45F, 1.0F};
constexpr sim::Colour kHandle{0.16F, 0.42F, 0.72F, 1.0F};
constexpr sim::Colour kProp{0.90F, 0.55F, 0.20F, 1.0F};
constexpr std::size_t kMostNamed = 12;  // most objects with a label

sim::Colour colour_of(Material material) {
  switch (material) {
    case Material::metal:
      return {0.72F, 0.74F, 0.78F, 1.0F};
    case Material::dark:
      return {0.20F, 0.22F, 0.26F, 1.0F};
    case Material::painted:
      return {0.30F, 0.42F, 0.62F, 1.0F};
    case Material::plate:
      break;
  }
  return {0.90F, 0.55F, 0.20F, 1.0F};
}

Point<'W'> middle_of_objects(const Moment& m) {
  Vec3 sum = Vec3::Zero();
  for (const Object& object : m.scene.objects) sum += object.X_WO.p();
  return Point<'W'>(Vec3(sum / static_cast<double>(std::max<std::size_t>(1, m.scene.objects.size()))));
}

// Draws the rods between a tool's shaft and its markers, at MuJoCo's present poses. Returns one of its
// markers, if any. `called`: the tool's body; `tipped`: the geom at its tip.
Point<'W'> add_tool_frame(const Moment& m, sim::ViewRequest& request, const char* called,
                          const char* tipped) {
  const mjModel* model = m.model;
  const mjData* data = m.data;
  const int body = mj_name2id(model, mjOBJ_BODY, called);
  const int tip = mj_name2id(model, mjOBJ_GEOM, tipped);
  if (body < 0 || tip < 0) return {};
  const auto at = [&](int g) {
    return Point<'W'>(data->geom_xpos[3 * g], data->geom_xpos[3 * g + 1], data->geom_xpos[3 * g + 2]);
  };
  std::vector<Point<'W'>> markers;
  Vec3 middle = Vec3::Zero();
  for (int g = model->body_geomadr[body]; g < model->body_geomadr[body] + model->body_geomnum[body]; ++g) {
    if (g == tip || model->geom_type[g] != mjGEOM_SPHERE || model->geom_contype[g] != 0) continue;
    markers.push_back(at(g));
    middle += markers.back().e();
  }
  if (markers.empty()) return {};
  middle /= static_cast<double>(markers.size());
  const Point<'W'> top(middle);
  for (const Point<'W'>& marker : markers) request.rods.push_back({top, marker, 0.0018, kMarkerArm});
  const Vec<'W'> shaft = top - at(tip);  // the handle covers its upper half
  request.rods.push_back({top - 0.5 * shaft, top - 0.08 * shaft, 0.0075, kHandle});
  return markers.front();
}

// Draws the frames of both tools of a session, or of a clamped tool; returns a marker of the held one.
Point<'W'> add_tool_frames(const Moment& m, sim::ViewRequest& request) {
  const std::optional<UserSpec>& user = m.setup.scene.user;
  const Point<'W'> clamped = add_tool_frame(m, request, "clamped_tool", "haptic_tip");
  if (clamped.finite()) return clamped;
  const Point<'W'> first = add_tool_frame(m, request, "tool", "tool_tip");
  const Point<'W'> other = add_tool_frame(m, request, "other_tool", "other_tool_tip");
  const std::int32_t held = m.truth.tool;
  const bool changed = user && user->session && held >= 0 &&
                       m.setup.scene.tools[static_cast<std::size_t>(held)].name == user->session->other_tool;
  return changed ? other : first;
}

// Draws both arrows beside their points, to the viewer's right and left, because tool and tip hide their
// axis.
void add_arrows(const Moment& m, sim::ViewRequest& request, double scale) {
  const sim::Truth& truth = m.truth;
  const double azimuth = request.camera.azimuth;
  const double beside = scale * (m.scene.indentation() ? 0.048 : 0.020);  // a real ball hides more
  const Vec<'W'> right(beside * std::sin(azimuth), -beside * std::cos(azimuth), 0);
  if (touching(m.truth)) {
    const Vec<'W'> along = scale * m.look.force_scale * truth.contact_force;
    const Point<'W'> to = truth.tip + right;
    request.arrows.push_back({to - along, along, 0.0035 * scale, kForce});
    request.labels.push_back(
        {fmt::format("force of the {}: {:.1f} N", m.look.presser(m), truth.contact_force.norm()),
         to - 0.6 * along, false});
  }
  const Contact& contact = contact_of(m.state);
  if (m.out.mode != Mode::contact || !contact.X_WN.valid()) return;
  const Vec<'W'> normal = contact.X_WN * Vec<'N'>(0, 0, scale * 0.06);
  const Point<'W'> from = contact.X_WN.origin() - right;
  request.arrows.push_back({from, normal, 0.0030 * scale, kNormal});
  request.labels.push_back({"normal of the surface (N)", from + 0.6 * normal, true});
}

// The most visible point of an object: on its flank, away from tool and arrows.
Point<'W'> flank(const Moment& m, std::size_t object) {
  const ObjectSpec& spec = m.setup.scene.objects[object];
  const Pose<'W', 'O'>& X_WO = m.scene.objects[object].X_WO;
  const Vec<'W'> shift = shift_of(m.scene.objects[object], moved_in(m.state));
  if (has_triangles(spec.shape)) {
    const Ball around = m.scene.objects[object].surface.bound();
    const Point<'O'> aside = around.centre + Vec<'O'>(Vec3(0.4 * around.radius * Vec3(0.75, -0.6, 0.1)));
    return X_WO * m.scene.objects[object].surface.nearest(aside).point + shift;
  }
  if (spec.shape == ShapeKind::sphere)
    return X_WO * Point<'O'>(Vec3(0.8 * spec.radius * Vec3(0.75, -0.6, 0.1))) + shift;
  const bool button = spec.shape == ShapeKind::button;
  return X_WO * Point<'O'>(button ? 0.4 * spec.width : 0.072, button ? -0.4 * spec.height : 0.04, 0) + shift;
}

// Labels a place; a missing part has no words and no label.
void label(sim::ViewRequest& request, const std::string& words, const Point<'W'>& at, bool left) {
  if (!words.empty()) request.labels.push_back({words, at, left});
}

// Names the objects, in the right margin. More than four, such as the keys of a keypad, take both margins.
void add_object_labels(const Moment& m, sim::ViewRequest& request) {
  const std::size_t count = std::min(m.scene.objects.size(), kMostNamed);
  const double azimuth = request.camera.azimuth;
  const auto across = [&](const Point<'W'>& p) {
    return std::sin(azimuth) * p.xyz[0] - std::cos(azimuth) * p.xyz[1];
  };
  std::vector<Point<'W'>> at;
  double middle = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    at.push_back(count > 4 ? m.scene.objects[i].X_WO.origin() : flank(m, i));
    middle += across(at[i]) / static_cast<double>(count);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool real = m.scene.indentation() && m.scene.indentation()->object == static_cast<int>(i);
    const std::string& name = m.setup.scene.objects[i].name;
    request.labels.push_back({count > 4 ? name : fmt::format("{} ({})", name, real ? "real" : "virtual"),
                              at[i], count > 4 && across(at[i]) < middle});
  }
}

// ---- the hexapod

const char* hexapod_presser(const Moment& m) {
  return m.scene.indentation() ? "ball" : m.pushed ? "pusher" : "tool";
}

// Each leg as a rod in a jacket, from its base joint to its platform joint.
void add_legs(const Moment& m, sim::ViewRequest& request) {
  const Hexapod& machine = *m.machine;
  const Pose<'W', 'R'>& X_WR = m.X_WR;
  const Pose<'W', 'H'> X_WH = X_WR * m.platform;
  for (int leg = 0; leg < 6; ++leg) {
    const Point<'W'> from = X_WR * Point<'R'>(machine.base_joint(leg));
    const Point<'W'> to = X_WH * Point<'H'>(machine.platform_joint(leg));
    request.rods.push_back({from, to, 0.0055, kLeg});
    request.rods.push_back({from, from + 0.55 * (to - from), 0.0105, kJacket});
    request.rods.push_back({from, from, 0.0145, kMarkerArm});  // joints, as balls
    request.rods.push_back({to, to, 0.0125, kMarkerArm});
  }
  request.floor = X_WR * Point<'R'>(0, 0, -0.020);
}

void add_hexapod_labels(const Moment& m, sim::ViewRequest& request, const Point<'W'>& marker) {
  const sim::Truth& truth = m.truth;
  const auto in_H = [&](double x, double y, double z) { return m.X_WR * m.platform * Point<'H'>(x, y, z); };
  request.labels.push_back({m.scene.indentation() ? "probe" : "haptic-tip", truth.tip, false});
  add_object_labels(m, request);
  if (truth.tool_tip.finite()) request.labels.push_back({"tool's tip", truth.tool_tip, true});
  if (request.title.empty()) return;  // a close-up has no more labels
  const SeenParts seen = seen_parts(m.setup.scene);
  if (marker.finite()) label(request, seen.tool, marker, true);
  label(request, seen.gripper, in_H(0.02, -0.022, -0.09), true);
  label(request, seen.force_sensor, in_H(0.03, -0.025, -0.1437), false);
  request.labels.push_back({"platform", in_H(-0.09, -0.07, -0.186), true});
  const Hexapod& machine = *m.machine;
  const Vec3 base = machine.base_joint(0);
  const Point<'W'> leg = m.X_WR * Point<'R'>(base);
  request.labels.push_back({"six legs (hexapod)", leg + 0.4 * (in_H(0, 0, -0.19) - leg), false});
}

void aim_at_hexapod(const Moment& m, bool close_up, sim::Camera& camera) {
  camera.azimuth = 1.75;  // view from the front and a little from the right
  camera.distance = close_up ? 0.22 : 1.52;
  camera.look_at = close_up ? m.truth.tip + Vec<'W'>(0, 0, 0.012) : Point<'W'>(0, 0, -0.092);
  const std::optional<UserSpec>& user = m.setup.scene.user;
  if (!close_up && user && user->session && !user->session->other_tool.empty()) {  // the other one is high up
    camera.distance = 1.78;
    camera.look_at = Point<'W'>(0, 0, -0.046);
  }
}

Point<'W'> hexapod_target(const Moment& m) { return (m.X_WR * m.out.manipulator.tip).origin(); }

// The hexapod carries 12 N.
constexpr MachineLook kHexapodLook{.force_scale = 0.005,
                                   .removed = false,
                                   .presser = hexapod_presser,
                                   .add_parts = add_legs,
                                   .add_labels = add_hexapod_labels,
                                   .aim = aim_at_hexapod,
                                   .target = hexapod_target};

// ---- the arm

// Draws links and base as rods. The prop is a body of the simulated world.
void add_links(const Moment& m, sim::ViewRequest& request) {
  for (const ArmPart& part : arm_shape(m.setup.twin.arm.machine, m.truth.joints, m.X_WR)) {
    const Vec<'W'> half(Vec3(part.half.z() * part.axes.col(2)));
    request.rods.push_back({part.middle - half, part.middle + half, part.half.x(), colour_of(part.material),
                            part.form == PartForm::cylinder});
  }
}

// Draws the belt on the drum's prop, with its two rollers.
void add_belt(const Moment& m, sim::ViewRequest& request) {
  const int front = mj_name2id(m.model, mjOBJ_GEOM, "prop_front");
  if (front < 0 || !m.setup.scene.prop || m.setup.scene.prop->kind != PropKind::drum) return;
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Mat3 axes = RowMajor::Map(m.data->geom_xmat + std::ptrdiff_t{9} * front);
  const Point<'W'> middle(Vec3(Vec3::Map(m.data->geom_xpos + std::ptrdiff_t{3} * front)));
  const Vec3 half = 0.5 * m.setup.scene.prop->size;
  const Vec<'W'> ahead(Vec3((half.x() - half.z()) * axes.col(0))), across(Vec3(half.y() * axes.col(1)));
  for (const Point<'W'>& roller : {middle - ahead, middle + ahead})
    request.rods.push_back({roller - across, roller + across, half.z(), kProp, true});
  request.boxes.push_back({middle, Quat(axes), Vec3(half.x() - half.z(), half.y(), half.z()), kProp});
}

void add_arm(const Moment& m, sim::ViewRequest& request) {
  add_links(m, request);
  add_belt(m, request);
  const Vec3 foot = (m.X_WR * Point<'R'>(0, 0, -0.200)).e(), there = middle_of_objects(m).e();
  request.floor = Point<'W'>(0.5 * (foot.x() + there.x()), 0.5 * (foot.y() + there.y()), foot.z());
}

// Labels the arm, its prop and the finger that touches it.
void add_arm_labels(const Moment& m, sim::ViewRequest& request, const Point<'W'>&) {
  const sim::Truth& truth = m.truth;
  const SeenParts seen = seen_parts(m.setup.scene);
  label(request, seen.prop, truth.tip, false);
  add_object_labels(m, request);
  if (truth.tool_tip.finite()) label(request, seen.tool, truth.tool_tip, true);
  if (!request.title.empty()) request.labels.push_back({"arm", m.X_WR * Point<'R'>(0, 0, 0), true});
}

// An arm is smaller than the hexapod, and stands behind its tip.
void aim_at_arm(const Moment& m, bool close_up, sim::Camera& camera) {
  camera.azimuth = 2.2;
  camera.distance = close_up ? 0.22 : 1.00;
  camera.look_at = close_up ? m.truth.tip : middle_of_objects(m) + Vec<'W'>(-0.05, 0, 0.04);
}

// The arm carries a few newtons.
constexpr MachineLook kArmLook{.force_scale = 0.015,
                               .removed = true,
                               .presser = [](const Moment&) { return "finger"; },
                               .add_parts = add_arm,
                               .add_labels = add_arm_labels,
                               .aim = aim_at_arm,
                               .target = [](const Moment& m) { return m.out.arm.target; }};

}  // namespace

const MachineLook& look_of(const models::Setup& setup) {
  return *sim::PerMachine<const MachineLook*>{&kHexapodLook, &kArmLook}.of(setup.scene);
}

void shift_objects(const Moment& m, mjData* data) {
  for (std::size_t i = 0; i < m.scene.objects.size(); ++i)
    sim::shift_seen(m.model, data, i, shift_of(m.scene.objects[i], moved_in(m.state)));
}

int dent_object(const Moment& m, mjModel* model) {
  if (m.out.object < 0 || m.out.view.tool < 0 || !m.truth.tool_tip.finite()) return -1;
  const Tip<'T'>& tip = m.scene.tools[static_cast<std::size_t>(m.out.view.tool)].tip;
  const Pose<'W', 'T'> turned(m.q_WT, Vec3(0, 0, 0));
  const Vec<'W'> shift = shift_of(m.scene.objects[static_cast<std::size_t>(m.out.object)], moved_in(m.state));
  const Pose<'W', 'T'> X_WT(m.q_WT, m.truth.tool_tip - shift - turned * Vec<'T'>(Vec3(tip.centre.e())));
  return sim::dent_seen(model, m.data, m.scene, static_cast<std::size_t>(m.out.object), X_WT * tip);
}

void show(const Moment& m, mjData* data, sim::ViewRequest& request) {
  shift_objects(m, data);
  request.data = data;
  request.dent = [&m](mjModel* model) { return dent_object(m, model); };
}

void name_objects(const Moment& m, sim::ViewRequest& request) {
  request.labels.clear();
  if (m.scene.objects.size() < 2) return;
  constexpr std::size_t kMostSigns = 4;  // more would cover each other
  for (std::size_t i = 0; i < m.scene.objects.size(); ++i) {
    if (m.scene.objects.size() > kMostSigns && m.out.object != static_cast<std::int32_t>(i)) continue;
    request.signs.push_back({m.setup.scene.objects[i].name, flank(m, i)});
  }
}

sim::Camera camera_for(const Moment& m, bool close_up) {
  sim::Camera camera;
  camera.elevation = close_up ? -0.38 : -0.22;  // looks down into the surface deformation
  camera.opening = 0.52;
  m.look.aim(m, close_up, camera);
  return camera;
}

sim::ViewRequest depict(const Moment& m, const sim::Camera& camera, bool close_up) {
  sim::ViewRequest request;
  request.model = m.model;
  request.camera = camera;
  if (!close_up)
    request.title = fmt::format("{}, at {:.2f} s", m.setup.scene.title, seconds(m.now.t.time_since_epoch()));
  m.look.add_parts(m, request);
  const Point<'W'> marker = add_tool_frames(m, request);
  add_arrows(m, request, close_up ? 0.5 : 1.0);
  m.look.add_labels(m, request, marker);
  return request;
}

sim::ViewRequest depict_frame(const Moment& m, const sim::Camera& camera, bool close_up) {
  sim::ViewRequest request = depict(m, camera, close_up);
  request.labels.clear();
  const char* gap = close_up ? "\n" : "     ";  // the tool is in the middle of a close-up
  const std::string force =
      touching(m.truth) ? fmt::format("{}{:.1f} N", gap, m.truth.contact_force.norm()) : "";
  request.title = fmt::format("{}{:.2f} s{}{}{}", close_up ? "" : m.setup.scene.title + "\n",
                              seconds(m.now.t.time_since_epoch()), gap, mode_name(m.out.mode), force);
  return request;
}

}  // namespace enc::app
