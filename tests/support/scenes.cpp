#include "tests/support/scenes.h"

#include <algorithm>

namespace enc::test {

BehaviourSpec spring(double stiffness, double limit) {
  BehaviourSpec behaviour;
  behaviour.name = "spring";
  behaviour.stiffness = stiffness;
  behaviour.curves = {{stiffness, 0, 0, 0}, {stiffness, 0, 0, 0}, limit};
  return behaviour;
}

BehaviourSpec lossy_ball() {
  BehaviourSpec behaviour;
  behaviour.name = "lossy";
  const std::array<double, 4> press{0.4e3, 1.07e6, -0.22e9, 0.0152e12};  // N/m^k
  behaviour.curves.press = press;
  for (std::size_t i = 0; i < 4; ++i) behaviour.curves.release[i] = 0.8 * press[i];
  behaviour.curves.limit = 0.006;
  return behaviour;
}

SceneSpec ball_scene(const BehaviourSpec& behaviour) {
  SceneSpec spec;
  spec.title = "ball";
  spec.behaviours = {behaviour};
  ObjectSpec ball;
  ball.name = "ball";
  ball.radius = kBallRadius;
  ball.position = Vec3(0, 0, kTop - kBallRadius);
  ball.behaviour = behaviour.name;
  spec.objects = {ball};
  ToolSpec stylus;
  stylus.name = "stylus";
  stylus.tip = Vec3(0.01, -0.02, -0.120);
  stylus.tip_radius = kToolRadius;
  spec.tools = {stylus};
  spec.manipulator.emplace();
  spec.force.emplace();
  spec.tracker.emplace();
  return spec;
}

SceneSpec plane_scene(const BehaviourSpec& behaviour) {
  SceneSpec spec = ball_scene(behaviour);
  spec.objects[0].name = "plane";
  spec.objects[0].shape = ShapeKind::plane;
  spec.objects[0].radius = kUnset;
  spec.objects[0].position = Vec3(0, 0, kTop);
  return spec;
}

SceneSpec mesh_scene(Mesh mesh, double z, const Vec3& rotation, const BehaviourSpec& behaviour) {
  SceneSpec spec = ball_scene(behaviour);
  ObjectSpec& object = spec.objects[0];
  object.name = "mesh";
  object.shape = ShapeKind::mesh;
  object.radius = kUnset;
  object.position = Vec3(0, 0, z);
  object.rotation = rotation;
  object.surface = std::make_shared<const Mesh>(std::move(mesh));
  return spec;
}

Mesh prism(const std::vector<std::array<double, 2>>& corners, double length) {
  Mesh mesh;
  const auto n = static_cast<std::int32_t>(corners.size());
  for (const double y : {-0.5 * length, 0.5 * length})
    for (const auto& [x, z] : corners) mesh.vertices.push_back({x, y, z});
  for (std::int32_t i = 1; i + 1 < n; ++i) {
    mesh.triangles.push_back({0, i, i + 1});
    mesh.triangles.push_back({n, n + i + 1, n + i});
  }
  for (std::int32_t i = 0; i < n; ++i) {
    const std::int32_t j = (i + 1) % n;
    mesh.triangles.push_back({i, n + j, j});
    mesh.triangles.push_back({i, n + i, n + j});
  }
  return mesh;
}

Mesh box(double x, double y, double z) {
  const double a = 0.5 * x, c = 0.5 * z;
  return prism({{-a, -c}, {a, -c}, {a, c}, {-a, c}}, y);
}

Mesh groove() {
  return prism({{0.0, -0.03},
                {0.045, -0.03},
                {0.045, 0.03},
                {0.025, 0.03},
                {0.0, -0.005},
                {-0.025, 0.03},
                {-0.045, 0.03},
                {-0.045, -0.03}},
               0.06);
}

SceneSpec two_balls(const BehaviourSpec& behaviour) {
  SceneSpec spec = ball_scene(behaviour);
  spec.objects.push_back(spec.objects[0]);
  spec.objects[0].position.x() = -0.034;
  spec.objects[1].position.x() = 0.034;
  spec.objects[1].name = "other";
  spec.display.emplace();
  return spec;
}

SceneSpec rig_scene() {
  SceneSpec spec = ball_scene();
  spec.behaviours.clear();
  spec.objects[0].behaviour.clear();
  spec.objects[0].position = Vec3(0, 0, 0.052);
  spec.tools.clear();
  spec.tracker.reset();
  spec.probe.emplace();
  return spec;
}

Loop::Loop(Scene made) : scene(std::move(made)) {
  k.index = -1;
  k.dt = from_seconds(scene.dt);
  k.t = Time(-k.dt);
  out.manipulator.tip = scene.reach.machine.zero();
  before_ = out.manipulator.tip.p();
}

void Loop::sense() {
  in.missed = 0;
  in.tip = {{out.manipulator.tip, Vec<'R'>(velocity_), Vec<'R'>(acceleration_)}, k.t, Health::ok};
  const Pose<'W', 'F'> X_WF = scene.X_WR * out.manipulator.tip * scene.X_HF;
  const Vec<'W'> carried =
      scene.force.mass * (Vec<'W'>(0, 0, -9.80665) - scene.X_WR * Vec<'R'>(acceleration_));
  in.wrench = {{X_WF.inverse() * (force + carried) + force_zero, Vec<'F'>::zero()}, k.t, Health::ok};
  if (!tool_seen || !scene.has_tracker) return;
  const auto index = static_cast<std::size_t>(tool);
  const Vec3 markers = tool_tip.e() - tool_turn * scene.tools[index].tip.centre.e();
  in.tool = {{tool, scene.X_WC.inverse() * Pose<'W', 'T'>(tool_turn, markers)}, k.t, Health::ok};
}

const Outputs& Loop::tick(int n) {
  for (int i = 0; i < n; ++i) {
    ++k.index;
    k.t += k.dt;
    sense();
    if (spoil) spoil(in);
    step(scene, k, in, state, out);
    judge();
  }
  return out;
}

void Loop::judge() {
  if (!state.started) {
    out.manipulator.tip = scene.reach.machine.zero();  // without a command the machine stays in place
    return;
  }
  const Vec3 at = out.manipulator.tip.p();
  const Vec3 velocity = (at - before_) / scene.dt;
  acceleration_ = (velocity - velocity_) / scene.dt;
  velocity_ = velocity;
  before_ = at;
  worst_speed = std::max(worst_speed, velocity_.norm() / scene.reach.speed);
  worst_acceleration = std::max(worst_acceleration, acceleration_.norm() / scene.reach.acceleration);
  always_reachable =
      always_reachable && out.manipulator.tip.valid() && scene.reach.contains(out.manipulator.tip);
  if (out.object < 0 || !state.entered) return;
  const Object& object = scene.objects[static_cast<std::size_t>(out.object)];
  worst_outside = std::max(worst_outside,
                           object.surface.nearest(object.X_WO.inverse() * tip()).distance + scene.tip_radius);
}

}  // namespace enc::test
