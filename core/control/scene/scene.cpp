#include "core/control/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/base/error.h"
#include "core/control/scene/press_check.h"
#include "core/control/stages/step_context.h"
#include "core/control/task/tasks.h"
#include "core/machine/arm.h"

namespace enc {
namespace {

Response response_of(const BehaviourSpec& behaviour, const ObjectSpec& object, double lowest_slope) {
  try {
    return {behaviour.curves, lowest_slope, behaviour.reversal};
  } catch (const Error& e) {
    throw Error("behaviour '" + behaviour.name + "' of object '" + object.name + "': " + e.what(),
                "behaviour." + behaviour.name + (e.key() == "reversal" ? "." : ".curves.") + e.key());
  }
}

double limit_of(const BehaviourSpec& behaviour, const ObjectSpec& object) {
  const double curve = behaviour.curves.limit;
  const double own = std::isnan(behaviour.limit) ? curve : behaviour.limit;
  const double asked =
      object.limits.empty() ? object.limit : *std::max_element(object.limits.begin(), object.limits.end());
  const double limit = std::isnan(asked) ? own : asked;
  if (check_limits(object, curve).fault != LimitFault::none || !(limit > 0.0) ||
      limit > curve * (1.0 + 1e-12))
    throw Error("the deflection limit lies between 0 and that of the response, for at most 16 contacts",
                "object." + object.name + (object.limits.empty() ? ".limit" : ".limits"));
  return std::min(limit, curve);
}

// The deflection, at most `wanted`, up to which the object pushes back with at most `strength`. So the
// machine is not asked to hold more than it can.
double carried(const Response& response, double wanted, double strength) {
  if (response.press(wanted) <= strength) return wanted;
  ResponseState state;
  return response.deflection(state, strength, wanted);
}

Object make_object(const SceneSpec& scene, const ObjectSpec& spec, double lowest_slope, double strength) {
  if (spec.behaviour.empty() && scene.probe && &spec == &probed_object(scene))
    return {surface_of(spec), place_of(spec), {}, kUnset, kUnset, TangentialMode::stick, kUnset};
  const BehaviourSpec& behaviour = behaviour_of(scene.behaviours, spec);
  if (behaviour.tangential == TangentialMode::spring && !(behaviour.tangential_stiffness > 0.0))
    throw Error("behaviour '" + behaviour.name + "': tangential = \"spring\" needs a tangential stiffness",
                "object." + spec.name + ".behaviour");
  if (behaviour.tangential == TangentialMode::spring && behaviour.tangential_stiffness < lowest_slope)
    throw Error("behaviour '" + behaviour.name + "' gives sideways more than the loop renders stably",
                "object." + spec.name + ".behaviour");
  const auto too_shallow = [&](double limit) { return limit < scene.follow.inset; };
  if (too_shallow(limit_of(behaviour, spec)) ||
      std::any_of(spec.limits.begin(), spec.limits.end(), too_shallow))
    throw Error("the tip waits deeper than the deflection limit of object '" + spec.name +
                    "'; make the inset smaller",
                "follow.inset");
  const Response response = response_of(behaviour, spec, lowest_slope);
  const double wanted = limit_of(behaviour, spec);
  const double limit = carried(response, wanted, strength);
  if (limit < scene.follow.inset)
    throw Error("object '" + spec.name + "' is too hard: the machine could not carry the force at its inset",
                "object." + spec.name + ".behaviour");
  std::vector<double> limits = spec.limits;
  for (double& one : limits) one = std::min(one, limit);
  Object object{surface_of(spec),
                place_of(spec),
                response,
                limit,
                wanted,
                behaviour.tangential,
                behaviour.tangential_stiffness};
  object.limits = ContactLimits(limits);
  return object;
}

Tip<'T'> tip_of(const ToolSpec& tool) {
  const double size = tool.tip_axis.norm();
  if (tool.tip_shape != TipShape::sphere && !(std::abs(size - 1.0) <= 1e-3))
    throw Error("the axis of a tip is a unit vector", "tool." + tool.name + ".tip_axis");
  Tip<'T'> tip{Point<'T'>(tool.tip), tool.tip_radius, tool.tip_shape};
  if (tool.tip_shape == TipShape::sphere) return tip;
  tip.axis = Vec<'T'>(tool.tip_axis / size);
  if (tool.tip_shape == TipShape::cone) tip.half_angle = tool.tip_half_angle;
  if (tool.tip_shape == TipShape::edge) tip.length = tool.tip_edge;
  return tip;
}

double length_of(const ToolSpec& tool) {
  Vec3 middle = tool.markers.empty() ? tool.tip : Vec3::Zero();
  for (const Vec3& marker : tool.markers) middle += marker / static_cast<double>(tool.markers.size());
  return (middle - tool.tip).norm();
}

}  // namespace

Tool made_tool(const ToolSpec& spec) { return {tip_of(spec), length_of(spec)}; }

PushedPoint pushed_point(const SceneSpec& spec, const Scene& scene) {
  const PusherSpec& pusher = *spec.pusher;
  const std::size_t index = pressed_object(spec.objects, pusher.object, "pusher");
  const Object& object = scene.objects[index];
  if (pusher.depth > object.wanted * (1.0 + 1e-9))
    throw Error("the push is deeper than the deflection limit of object '" + spec.objects[index].name +
                    "'; lower it, or raise that limit",
                "pusher.depth");
  const SurfacePoint near = object.surface.nearest(object.X_OW * Point<'W'>(0, 0, 0));
  ResponseState rest;
  const double depth = object.response.deflection(rest, pusher.force, std::min(pusher.depth, object.limit));
  return {{object.X_WO * near.point, object.X_WO * near.normal}, depth, object.response.press(depth)};
}

namespace {

// The tool that the user holds; null if the scene has no tool.
const Tool* used_tool(const SceneSpec& spec, const Scene& scene) {
  if (scene.tools.empty()) return nullptr;
  const auto named = std::find_if(spec.tools.begin(), spec.tools.end(),
                                  [&](const ToolSpec& t) { return t.name == spec.user->tool; });
  return &scene.tools[named == spec.tools.end() ? 0 : static_cast<std::size_t>(named - spec.tools.begin())];
}

// A user's press must be possible from the first touch to the limit. An object without a prescribed press
// must be touchable somewhere.
void check_reach(const SceneSpec& spec, const Scene& scene) {
  const std::string advice =
      "; the tip reaches +-50, +-50 and +-25 (x, y, z of W, in millimetres) around the origin, straight axes";
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.indentation() != nullptr && scene.indentation()->object == static_cast<std::int32_t>(i))
      continue;  // this object is checked already
    const Object& object = scene.objects[i];
    const SurfacePoint near = object.surface.nearest(object.X_OW * Point<'W'>(0, 0, 0.0));
    const Point<'O'> top_O =
        near.distance < 0 ? near.point : object.surface.nearest(object.X_OW * Point<'W'>(0, 0, 0.1)).point;
    const SurfacePoint top = object.surface.nearest(top_O);
    if (!carried_to(scene, {object.X_WO * near.point, object.X_WO * near.normal}, 0.0) &&
        !carried_to(scene, {object.X_WO * top.point, object.X_WO * top.normal}, 0.0))
      throw Error("object '" + spec.objects[i].name + "' is outside the machine's reach" + advice,
                  "object." + spec.objects[i].name + ".position");
  }
  if (spec.pusher) {
    const PushedPoint pushed = pushed_point(spec, scene);
    if (!carried_to(scene, pushed.at, 0.0) || !carried_to(scene, pushed.at, pushed.depth))
      throw Error("the push ends where the machine does not reach" + advice, "pusher.depth");
  }
  if (!spec.user) return;
  const PressPoint press = press_point(spec, *spec.user);
  const double depth = scene.objects[pressed_object(spec.objects, spec.user->object, "user")].limit;
  if (!carried_to(scene, press, 0.0) || !carried_to(scene, press, depth))
    throw Error("the user presses where the machine does not reach" + advice, "user.polar");
  const Tool* tool = used_tool(spec, scene);
  if (tool == nullptr) return;
  if (const Obstacle way = in_the_way(scene, press.normal, *tool); way != Obstacle::none)
    throw Error("the user presses from where the machine carries its tip: its " +
                    std::string(obstacle_name(way)) + " is in the tool's way; press at most " +
                    std::to_string(std::lround(std::floor(steepest_press(scene, *tool) * 180.0 / M_PI))) +
                    " degrees off straight down",
                "user.polar");
}

}  // namespace

Reach reach_of(const RigSpec& rig) {
  const ManipulatorRig& m = rig.manipulator;
  return {
      m.speed,
      m.acceleration,
      Hexapod(m.geometry),
      {m.stem_radius, m.stem_length, m.gripper_radius, m.geometry.tip_height, m.geometry.platform_radius}};
}

const ToolSpec* clamped_tool(const SceneSpec& spec) {
  if (!spec.gripper) return nullptr;
  if (spec.tools.empty()) throw Error("a gripper needs a tool to clamp", "gripper.tool");
  if (spec.gripper->tool.empty()) return &spec.tools.front();
  const auto named = std::find_if(spec.tools.begin(), spec.tools.end(),
                                  [&](const ToolSpec& t) { return t.name == spec.gripper->tool; });
  if (named == spec.tools.end())
    throw Error("no tool '" + spec.gripper->tool + "' in the scene", "gripper.tool");
  return &*named;
}

LoopModel loop_of(const RigSpec& rig) {
  LoopModel loop;
  loop.hand_stiffness = rig.contact.hand_stiffness;
  loop.hand_damping = rig.contact.hand_damping;
  loop.filter_hz = rig.force.filter;
  loop.servo_hz = rig.manipulator.servo;
  loop.servo_damping = rig.manipulator.servo_damping;
  loop.delay = rig.manipulator.delay + 1.0 / rig.loop.rate;
  return loop;
}

namespace {

// Distance along a ray to a triangle; infinite if the ray misses it [Moeller and Trumbore 1997]. A ray
// through an edge must not slip through between two triangles, so they extend a little beyond it.
double way_to(const Vec3& from, const Vec3& along, const Vec3& a, const Vec3& b, const Vec3& c) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  constexpr double kBeyond = 1e-9;
  const Vec3 ab = b - a;
  const Vec3 ac = c - a;
  const Vec3 p = along.cross(ac);
  const double size = ab.dot(p);
  if (size == 0.0) return kNever;
  const double u = (from - a).dot(p) / size;
  const Vec3 q = (from - a).cross(ab);
  const double v = along.dot(q) / size;
  const double way = ac.dot(q) / size;
  return u >= -kBeyond && v >= -kBeyond && u + v <= 1.0 + kBeyond && way >= 0.0 ? way : kNever;
}

// First point of the mesh, in O, on a line along -axis from outside through `through`; and the normal of the
// face there.
std::pair<Point<'O'>, Vec<'O'>> first_met(const Mesh& mesh, const Vec3& through, const Vec3& axis) {
  const auto corner = [&](std::int32_t i) { return Vec3(mesh.vertices[static_cast<std::size_t>(i)].data()); };
  double far = 0.0;
  for (const auto& vertex : mesh.vertices) far = std::max(far, (Vec3(vertex.data()) - through).norm());
  const Vec3 from = through + 1.1 * far * axis;
  double nearest = std::numeric_limits<double>::infinity();
  Vec3 normal = axis;
  for (const auto& t : mesh.triangles) {
    const Vec3 a = corner(t[0]), b = corner(t[1]), c = corner(t[2]);
    const double way = way_to(from, -axis, a, b, c);
    if (way >= nearest) continue;
    nearest = way;
    normal = (b - a).cross(c - a).normalized();
  }
  if (!std::isfinite(nearest))
    throw Error("the line along which the user presses passes the mesh by; change polar, azimuth or offset",
                "user.polar");
  return {Point<'O'>(Vec3(from - nearest * axis)), Vec<'O'>(normal)};
}

}  // namespace

PressPoint press_point(const SceneSpec& spec, const UserSpec& user) {
  const ObjectSpec& object = spec.objects[pressed_object(spec.objects, user.object, "user")];
  const Vec3 axis(std::sin(user.polar) * std::cos(user.azimuth),
                  std::sin(user.polar) * std::sin(user.azimuth), std::cos(user.polar));
  const Vec3 side = axis.unitOrthogonal();
  const Pose<'W', 'O'> X_WO = place_of(object);
  const Point<'W'> through(Vec3(object.position + user.offset * side));
  if (has_triangles(object.shape)) {
    const auto [point, normal] =
        first_met(scaled_mesh(object), (X_WO.inverse() * through).e(), (X_WO.inverse() * Vec<'W'>(axis)).e());
    return {X_WO * point, X_WO * normal};
  }
  const double out = object.shape == ShapeKind::sphere ? object.radius : 0.0;
  const SurfacePoint at = surface_of(object).nearest(X_WO.inverse() * (through + Vec<'W'>(Vec3(out * axis))));
  return {X_WO * at.point, X_WO * at.normal};
}

Scene::Scene() = default;
Scene::~Scene() = default;
Scene::Scene(const Scene&) = default;
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(const Scene&) = default;
Scene& Scene::operator=(Scene&&) noexcept = default;

namespace {

// The task that the scene file asks for; rendering if it asks for none.
template <class... Task>
void choose(std::variant<Task...>& task, const SceneSpec& spec, const Scene& scene) {
  const auto ask = [&]<class One>(std::type_identity<One>) {
    if constexpr (requires { One::asked(spec, scene); })
      if (auto made = One::asked(spec, scene)) task = std::move(*made);
  };
  (ask(std::type_identity<Task>{}), ...);
}

// The law of the rendered object, until another task is chosen.
void set_law(const RigSpec& rig, Scene& scene) {
  if (rig.admittance.damping == Damping::observed)
    std::get<AdmittanceTask>(scene.task)
        .damping.emplace(rig.admittance, loop_of(rig), scene.filter_gain,
                         stages::kAlongShare * rig.manipulator.acceleration, scene.dt);
  std::get<AdmittanceTask>(scene.task).passivity = rig.admittance.passivity;
  std::get<AdmittanceTask>(scene.task).hand_stiffness = rig.contact.hand_stiffness;
}

void check_passivity(const RigSpec& rig, const Scene& scene) {
  const char* why = scene.admittance() == nullptr ? "the scene renders nothing"
                    : scene.objects.empty()       ? "the scene has no object"
                    : !scene.has_force            ? "the scene has no [force]"
                                                  : nullptr;
  if (rig.admittance.passivity != PassivityForm::none && why != nullptr)
    refuse_passivity(why, "rig.admittance.passivity");
}

}  // namespace

Scene prepare(const SceneSpec& spec, const RigSpec& rig) {
  if (spec.arm) return prepare_arm(spec, rig);
  Scene scene;
  keep_settings(spec, rig, scene);
  scene.reach = reach_of(rig);
  scene.X_WR = Pose<'W', 'H'>::identity() * scene.reach.machine.zero().inverse();
  scene.force = rig.force;
  scene.tip_radius = spec.probe ? spec.probe->radius : rig.manipulator.tip_radius;
  scene.servo = {2.0 * std::numbers::pi * rig.manipulator.servo, rig.manipulator.servo_damping,
                 rig.manipulator.delay, scene.dt};
  scene.filter_gain = 1.0 - std::exp(-2.0 * std::numbers::pi * rig.force.filter * scene.dt);
  set_law(rig, scene);
  scene.has_manipulator = spec.manipulator.has_value();
  scene.has_force = spec.force.has_value();
  scene.has_display = spec.display.has_value();
  if (const ToolSpec* tool = clamped_tool(spec)) {
    scene.clamped_tool = static_cast<std::int32_t>(tool - spec.tools.data());
    scene.grip_force = rig.gripper.force;
    scene.force.mass += tool->mass;  // the tool is behind the sensor, too
  }
  if (!scene.has_manipulator)
    throw Error("a scene needs [manipulator]: something has to carry the surface", "manipulator");
  scene.lowest_slope =
      std::isnan(rig.contact.softest) ? lowest_stable_stiffness(loop_of(rig)) : rig.contact.softest;
  scene.strength = rig.manipulator.payload - scene.force.mass * kStandardGravity;
  if (!(scene.strength > 0.0))
    throw Error("the machine does not even carry what is mounted on it (force.mass)",
                "rig.manipulator.payload");
  for (const ObjectSpec& object : spec.objects)
    scene.objects.push_back(make_object(spec, object, scene.lowest_slope, scene.strength));
  for (const ToolSpec& tool : spec.tools) scene.tools.push_back(made_tool(tool));
  choose(scene.task, spec, scene);
  check_passivity(rig, scene);
  check_room(spec, scene);
  check_reach(spec, scene);
  return scene;
}

// ---- Checks that the chains of poses close. They build a ground truth with plain matrices from the numbers
// of the files. Then they run the readings that devices would take of it through the stages of a tick, and
// compare the results.

namespace {

using Mat4 = Eigen::Matrix4d;

Mat4 matrix(const Mat3& turn, const Vec3& place) {
  Mat4 M = Mat4::Identity();
  M.topLeftCorner<3, 3>() = turn;
  M.topRightCorner<3, 1>() = place;
  return M;
}
Mat3 turn_of(const Mat4& M) { return M.topLeftCorner<3, 3>(); }
Vec3 place_in(const Mat4& M) { return M.topRightCorner<3, 1>(); }
Vec3 placed(const Mat4& M, const Vec3& p) { return turn_of(M) * p + place_in(M); }
Mat4 back(const Mat4& M) {
  const Mat3 turn = turn_of(M).transpose();
  return matrix(turn, -turn * place_in(M));
}

// Rotation about fixed x, then y, then z, written out.
Mat4 matrix(const PoseSpec& spec) {
  const double cx = std::cos(spec.rotation.x()), sx = std::sin(spec.rotation.x());
  const double cy = std::cos(spec.rotation.y()), sy = std::sin(spec.rotation.y());
  const double cz = std::cos(spec.rotation.z()), sz = std::sin(spec.rotation.z());
  Mat3 turn;
  turn << cy * cz, sx * sy * cz - cx * sz, cx * sy * cz + sx * sz,  //
      cy * sz, sx * sy * sz + cx * cz, cx * sy * sz - sx * cz,      //
      -sy, sx * cy, cx * cy;
  return matrix(turn, spec.position);
}

template <char A, char B>
Pose<A, B> pose(const Mat4& M) {
  return {Quat(turn_of(M)), place_in(M)};
}

// Arbitrary positions and rotations; all these poses differ.
const PoseSpec kTool{{0.012, -0.021, 0.034}, {0.3, -0.5, 0.7}};
const PoseSpec kTip{{0.004, -0.003, 0.006}, {0.02, -0.03, 0.05}};
const PoseSpec kHeadset{{0.5, 0.2, -0.3}, {-0.2, 0.4, 1.1}};

class Chains {
 public:
  Chains(const SceneSpec& spec, const RigSpec& rig, const Scene& scene)
      : spec_(spec), rig_(rig), scene_(scene), W_R_(base()), W_T_(matrix(kTool)), W_H_(matrix(kTip)) {}

  double residual() {
    compare(scene_.X_WS * pose<'S', 'G'>(matrix(kHeadset)) * scene_.X_GL,
            matrix(rig_.frames.W_S) * matrix(kHeadset) * matrix(rig_.frames.G_L));
    tool_and_tip();
    for (std::size_t i = 0; i < scene_.objects.size(); ++i) object(spec_.objects[i], scene_.objects[i]);
    return worst_;
  }

 private:
  void add(double apart) {  // NaN counts as an infinite residual
    worst_ = std::max(worst_, std::isfinite(apart) ? apart : std::numeric_limits<double>::infinity());
  }
  void compare(const Vec3& said, const Vec3& truth) { add((said - truth).norm()); }
  template <char A, char B>
  void compare(const Pose<A, B>& said, const Mat4& truth) {
    compare(said.p(), place_in(truth));
    add((said.q().toRotationMatrix() - turn_of(truth)).norm());
  }

  // H is W at the machine's zero.
  [[nodiscard]] Mat4 base() const {
    if (scene_.impedance() != nullptr) {
      const Arm& arm = scene_.impedance()->arm;
      return matrix(Mat3::Identity(), -arm.tip(arm.zero()).e());
    }
    const HexapodGeometry& g = rig_.manipulator.geometry;
    return matrix(Mat3::Identity(), -Vec3(0, 0, g.height + g.tip_height));
  }

  // Tracker: W C T. Machine: W R H. Force sensor: W R H F.
  void tool_and_tip() {
    const Tick tick;
    Inputs in;
    in.withheld = true;
    State state;
    state.started = true;
    if (scene_.has_tracker && !scene_.tools.empty())
      in.tool = {{0, pose<'C', 'T'>(back(matrix(rig_.frames.W_C)) * W_T_)}, tick.t, Health::ok};
    if (scene_.impedance() != nullptr)
      W_H_ = read_arm(in);
    else
      read_machine(in);
    std::visit([&](const auto& task) { track_once(task, tick, in, state); }, scene_.task);
  }

  template <class Task>
  void track_once(const Task& task, const Tick& tick, const Inputs& in, State& state) {
    typename Task::Context context(scene_, tick, in);
    typename Task::Memory memory;
    track(context, task, state, memory);
    if constexpr (std::is_base_of_v<CommandState, typename Task::Memory>) {
      memory.tared = rig_.force.tare_time;
      sense(context, state, memory, false);
    }
    compare(context.X_WH, W_H_);
    compare(context.X_WH * scene_.X_HF, W_H_ * matrix(rig_.frames.H_F));
    if (in.tool.health == Health::ok) {
      compare(context.X_WT_newest, W_T_);
      compare(context.tip_newest.e(), placed(W_T_, spec_.tools[0].tip));
    }
    if (scene_.has_force) compare(context.force_unfiltered.e(), kForce);
  }

  void read_machine(Inputs& in) const {
    const Mat4 R_W = back(W_R_);
    const Vec3 acceleration(0.3, -0.2, 0.1);  // in W, m/s^2
    in.tip = {{pose<'R', 'H'>(R_W * W_H_), Vec<'R'>::zero(), Vec<'R'>(Vec3(turn_of(R_W) * acceleration))},
              {},
              Health::ok};
    const Vec3 load = scene_.force.mass * (Vec3(0, 0, -kStandardGravity) - acceleration);
    const Mat4 F_W = back(W_H_ * matrix(rig_.frames.H_F));
    in.wrench = {{Vec<'F'>(Vec3(turn_of(F_W) * (kForce + load))), Vec<'F'>::zero()}, {}, Health::ok};
  }

  // An arm's tip keeps the axes of R.
  [[nodiscard]] Mat4 read_arm(Inputs& in) const {
    ArmSample& arm = in.arm.value;
    arm.joints.fill(0.01);
    arm.tip = scene_.impedance()->arm.tip(arm.joints);
    arm.velocity = Vec<'R'>::zero();
    in.arm.health = Health::ok;
    return W_R_ * matrix(Mat3::Identity(), arm.tip.e());
  }

  // Compares the surface point nearest to a position, queried in O and queried in W. A normal does not
  // determine the rotation about itself.
  void object(const ObjectSpec& spec, const Object& object) {
    Mat4 W_O = matrix({spec.position, spec.rotation});
    if (!has_triangles(spec.shape)) {
      W_O = matrix(object.X_WO.q().toRotationMatrix(), spec.position);
      if (spec.shape != ShapeKind::sphere) compare(turn_of(W_O).col(2), spec.normal.normalized());
    }
    compare(object.X_WO, W_O);
    compare(object.X_OW, back(W_O));
    const Ball bound = object.surface.bound();
    const Vec3 way(0.61, -0.37, 0.83);  // outside of it
    const Vec3 p = std::isfinite(bound.radius) ? Vec3(bound.centre.e() + 1.5 * bound.radius * way) : way;
    const SurfacePoint in_O = object.surface.nearest(Point<'O'>(p));
    const stages::NearestInWorld in_W = stages::nearest(object, Point<'W'>(placed(W_O, p)));
    compare(in_W.point.e(), placed(W_O, in_O.point.e()));
    compare(in_W.normal.e(), turn_of(W_O) * in_O.normal.e());
    add(std::abs(in_W.distance - in_O.distance));
  }

  const Vec3 kForce{1.0, -2.0, 3.0};  // acts on the tip, in W, N
  const SceneSpec& spec_;
  const RigSpec& rig_;
  const Scene& scene_;
  Mat4 W_R_, W_T_, W_H_;
  double worst_ = 0.0;
};

}  // namespace

double chain_residual(const SceneSpec& spec, const RigSpec& rig, const Scene& scene) {
  return Chains(spec, rig, scene).residual();
}

}  // namespace enc
