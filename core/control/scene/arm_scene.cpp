#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/QR>

#include "core/base/error.h"
#include "core/base/rotation.h"
#include "core/control/scene/scene.h"
#include "core/control/task/impedance/impedance.h"

namespace enc {
namespace {

std::string number(double x) {
  std::array<char, 32> text{};
  const auto [end, bad] =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, 3);
  return bad == std::errc() ? std::string(text.data(), end) : std::string("?");
}

void check_gains(const ArmRig& rig, double rate) {
  const auto positive = [](double value, const char* key) {
    if (!(value > 0.0)) throw Error("a gain of the control law is positive", std::string("rig.arm.") + key);
  };
  positive(rig.stiffness, "stiffness");
  positive(rig.damping, "damping");
  positive(rig.filter, "filter");
  if (rig.filter > 0.5 * rate)
    throw Error("the filter's corner is " + number(rig.filter) + " Hz; expected at most " +
                    number(0.5 * rate) + ", half of the loop's rate: there is nothing above; lower it",
                "rig.arm.filter");
  for (const auto& [settle, key] : {std::pair{rig.settle, "settle"}, {rig.reach_settle, "reach_settle"}})
    if (settle * rate < 1.0)
      throw Error("a leap of the finger is followed within " + number(1e3 * settle) +
                      " ms; expected a period of the loop or more; raise it",
                  std::string("rig.arm.") + key);
}

// Only the ratio at home is checked; elsewhere the law keeps it.
void check_damping(const Impedance& law) {
  const double ratio = damping_ratio(law.rig, law.home_mass);
  if (ratio >= 1.0) return;
  throw Error("the control law is under-damped: ratio " + number(ratio) + " for the " +
                  number(1e3 * law.home_mass) +
                  " g that are felt at the tip; expected 1 or more [VisHap 2.3.1]; raise it to " +
                  number(2.0 * std::sqrt(law.rig.stiffness * law.home_mass)) + ", or lower stiffness_N_per_m",
              "rig.arm.damping");
}

void check_button(const ObjectSpec& object, const BehaviourSpec& behaviour) {
  const InteractionSpec& button = behaviour.interaction;
  const std::string key = "behaviour." + behaviour.name + ".interaction.";
  if (!(button.after > 0.0) || !(button.floor > 0.0))
    throw Error("a button has three stiffnesses: before the trigger, after it and at the bottom",
                key + (button.after > 0.0 ? "floor" : "after"));
  if (!(button.after < behaviour.stiffness))
    throw Error("a button becomes softer when it is triggered: from " + number(1e-3 * behaviour.stiffness) +
                    " to " + number(1e-3 * button.after) + " N/mm; expected less; lower it",
                key + "after");
  if (!(button.floor > button.after))
    throw Error("the bottom of a button is stiffer than the button: " + number(1e-3 * button.floor) +
                    " N/mm; expected more than " + number(1e-3 * button.after) + "; raise it",
                key + "floor");
  const double over = button.trigger + button.gradual;
  if (!(button.bottom > over))
    throw Error("the bottom of a button is " + number(1e3 * button.bottom) + " mm deep; expected more than " +
                    number(1e3 * over) + ", where its trigger is over; raise it, or lower trigger_mm",
                key + "bottom");
  if (has_triangles(object.shape) || object.shape == ShapeKind::sphere)
    throw Error("object '" + object.name +
                    "' cannot click; expected a button or a plane; change its shape or its behaviour",
                "object." + object.name + ".behaviour");
}

Object arm_object(const SceneSpec& scene, const ObjectSpec& spec) {
  const BehaviourSpec& behaviour = behaviour_of(scene.behaviours, spec);
  const InteractionSpec& does = behaviour.interaction;
  if (does.kind == Interaction::press)
    throw Error("behaviour '" + behaviour.name +
                    "' is for a machine that measures force; an arm renders slide, "
                    "click, passive, hit, shift or spin",
                "object." + spec.name + ".behaviour");
  if (does.kind == Interaction::click) check_button(spec, behaviour);
  if (does.kind != Interaction::passive && !(behaviour.stiffness > 0.0))
    throw Error("behaviour '" + behaviour.name + "' has no stiffness", "object." + spec.name + ".behaviour");
  Object object{surface_of(spec),
                place_of(spec),
                {},
                kUnset,
                kUnset,
                behaviour.tangential,
                behaviour.tangential_stiffness};
  object.interaction = does;
  object.interaction.way.normalize();
  object.stiffness = behaviour.stiffness;
  return object;
}

// An arm that only holds a real object gives out no push of a law.
void check_arm_passivity(const ArmRig& rig, const Scene& scene) {
  const auto rendered = [](const Object& object) { return object.interaction.kind != Interaction::passive; };
  if (rig.passivity == PassivityForm::none || std::ranges::any_of(scene.objects, rendered)) return;
  refuse_passivity(scene.objects.empty() ? "the scene has no object"
                                         : "every object of the scene is a real one, which nothing renders",
                   "rig.arm.passivity");
}

// m, along the axis of R with the largest count.
double count_of(const Impedance& law, double dt) {
  double most = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec<'R'> way(Vec3(Vec3::Unit(axis)));
    most = std::max(
        most, loop_at(law, {}, dt, law.arm.zero(), way, law.rig.stiffness, Interaction::slide).steps.encoder);
  }
  return most;
}

bool gets_to(const Scene& scene, const Point<'W'>& p) {
  const Impedance& law = *scene.impedance();
  PerJoint q{};
  return law.arm.reaches(scene.X_WR.inverse() * p, law.rig.least_dexterity, q);
}

// Share of a unit direction along which the tip can move: 1 for a machine with three joints.
double share_along(const Mat3& jacobian, const Vec3& way) {
  Eigen::ColPivHouseholderQR<Mat3> ways(jacobian);
  ways.setThreshold(1e-5);
  const Vec3 along = ways.householderQ().transpose() * way;
  return along.head(ways.rank()).norm();
}

// Smallest such share of a unit normal for a machine with few joints (assumed: no source).
constexpr double kLeastAlong = 0.1;

// A flat object has one normal and is rendered along it. A machine with few joints may be unable to move that
// way.
void check_ways(const SceneSpec& spec, const Scene& scene) {
  const Impedance& law = *scene.impedance();
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const ObjectSpec& object = spec.objects[i];
    const Object& made = scene.objects[i];
    const bool flat = object.shape == ShapeKind::plane || object.shape == ShapeKind::button;
    if (!flat || made.interaction.kind == Interaction::passive || made.met_in_its_middle()) continue;
    const SurfacePoint near = made.surface.nearest(made.X_OW * Point<'W'>(0, 0, 0));
    PerJoint q{};
    static_cast<void>(law.arm.inverse(scene.X_WR.inverse() * (made.X_WO * near.point), q));
    const Vec<'R'> normal = scene.X_WR.inverse() * (made.X_WO * near.normal);
    if (share_along(law.arm.jacobian(q), normal.e()) >= kLeastAlong) continue;
    throw Error(
        "object '" + object.name + "' faces a way that this machine of " + std::to_string(law.arm.joints()) +
            " joints does not go, so it cannot push along its normal; expected a normal that the machine "
            "moves along; turn the object, or use a rig that goes there",
        "object." + object.name + ".normal");
  }
}

// The arm must reach some part of each object, and the point that the user presses.
void check_arm_reach(const SceneSpec& spec, const Scene& scene) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    const Object& object = scene.objects[i];
    const Point<'W'> home(0, 0, 0);
    const SurfacePoint near = object.surface.nearest(object.X_OW * home);
    if (gets_to(scene, object.met_in_its_middle() ? object.X_WO.origin() : object.X_WO * near.point))
      continue;
    throw Error("the arm does not get to object '" + spec.objects[i].name +
                    "', or only near a singular pose; move it nearer to the origin of W, the arm's home",
                "object." + spec.objects[i].name + ".position");
  }
  // other users choose points within reach
  if (!spec.user || spec.user->kind != UserKind::press_release) return;
  const Object& pressed = scene.objects[pressed_object(spec.objects, spec.user->object, "user")];
  if (!pressed.met_in_its_middle() && !gets_to(scene, press_point(spec, *spec.user).point))
    throw Error(
        "the user presses where the arm does not get, or only near a singular pose; change polar, azimuth "
        "or offset",
        "user");
}

}  // namespace

double damping_ratio(const ArmRig& rig, double mass) {
  return rig.damping / (2.0 * std::sqrt(rig.stiffness * mass));
}

namespace {

// The law of the rig's arm with the scene's prop, for a loop of period `dt`.
Impedance law_of(const SceneSpec& spec, const RigSpec& rig, double dt) {
  Impedance law{Arm(rig.arm.machine), rig.arm};
  if (spec.prop) {
    law.prop = spec.prop->kind;
    law.prop_mass = spec.prop->mass;
  }
  law.filter_gain = 2.0 * std::numbers::pi * rig.arm.filter * dt;
  check_gains(rig.arm, rig.loop.rate);
  const PerJoint home = law.arm.zero();
  law.home_mass = law.arm.felt_mass(law.arm.jacobian(home), law.arm.mass(home, law.prop_mass));
  check_damping(law);
  law.motors = Motors(law.arm, motor_ratings(rig.arm), dt);
  if (rig.arm.passivity == PassivityForm::controlled) {
    if (!rig.arm.loop)
      throw Error(
          "the passivity controller has to know the encoders' counts; expected a table [arm.loop]; write "
          "it, as models/rigs/vishap.toml has it, or set passivity to none",
          "rig.arm.passivity");
    law.count = count_of(law, dt);
  }
  return law;
}

}  // namespace

void keep_settings(const SceneSpec& spec, const RigSpec& rig, Scene& scene) {
  scene.X_WC = pose_of<'W', 'C'>(rig.frames.W_C);
  scene.X_WS = pose_of<'W', 'S'>(rig.frames.W_S);
  scene.X_GL = pose_of<'G', 'L'>(rig.frames.G_L);
  scene.X_HF = pose_of<'H', 'F'>(rig.frames.H_F);
  scene.follow = spec.follow;
  scene.tracker = rig.tracker;
  scene.display = rig.display;
  scene.contact = rig.contact;
  scene.loop = rig.loop;
  scene.has_tracker = spec.tracker.has_value();
  scene.dt = 1.0 / rig.loop.rate;
}

Scene prepare_arm(const SceneSpec& spec, const RigSpec& rig) {
  if (spec.manipulator)
    throw Error("a scene has one machine: [manipulator] or [arm]; remove one", "manipulator");
  Scene scene;
  keep_settings(spec, rig, scene);
  Impedance law = law_of(spec, rig, scene.dt);
  scene.X_WR = {Quat::Identity(), Vec3(-law.arm.tip(law.arm.zero()).e())};
  static_cast<Impedance&>(scene.task.emplace<ImpedanceTask>()) = std::move(law);
  scene.tip_radius = 0.0;  // a prop has its surface in front
  if (!scene.has_tracker) throw Error("an arm needs [tracker]: it goes where the finger is", "arm");
  for (const ObjectSpec& object : spec.objects) scene.objects.push_back(arm_object(spec, object));
  check_arm_passivity(rig.arm, scene);
  if (std::vector<Mover> movers = make_movers(spec.objects, scene.objects); !movers.empty())
    scene.task = DynamicObjectTask{*scene.impedance(), std::move(movers)};
  for (const ToolSpec& tool : spec.tools) scene.tools.push_back(made_tool(tool));
  check_arm_reach(spec, scene);
  check_ways(spec, scene);
  return scene;
}

}  // namespace enc
