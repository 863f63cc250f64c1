// Do the chains of poses close? A truth is put together with plain matrices from the numbers of the files;
// what the devices would read of it goes through the stages of a tick, and what these say is compared with
// it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "core/control/scene/scene.h"
#include "core/control/stages/walk.h"
#include "core/control/task/state.h"
#include "core/machine/arm.h"

namespace enc {
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

// About fixed x, then y, then z, written out.
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

// Somewhere, and turned: no pose of these is like another.
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
  void add(double apart) {  // what is no number is no residual
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
    stages::Walk walk(scene_, tick, in);
    std::visit([&](const auto& task) { go_through(task, walk, state); }, scene_.task);
    compare(walk.X_WH, W_H_);
    compare(walk.X_WH * scene_.X_HF, W_H_ * matrix(rig_.frames.H_F));
    if (in.tool.health == Health::ok) {
      compare(walk.X_WT_newest, W_T_);
      compare(walk.tip_newest.e(), placed(W_T_, spec_.tools[0].tip));
    }
    if (scene_.has_force) compare(walk.felt.e(), kForce);
  }

  template <class Task>
  void go_through(const Task& task, stages::Walk& walk, State& state) const {
    typename Task::Memory memory;
    track(walk, task, state, memory);
    if constexpr (std::is_base_of_v<Commanded, typename Task::Memory>) {
      memory.tared = rig_.force.tare_time;
      sense(walk, state, memory, false);
    }
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

  // What is nearest to a place, asked in O and asked in W. A normal says nothing of the turn about itself.
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
    const Nearest in_O = object.surface.nearest(Point<'O'>(p));
    const stages::NearestInWorld in_W = stages::nearest(object, Point<'W'>(placed(W_O, p)));
    compare(in_W.point.e(), placed(W_O, in_O.point.e()));
    compare(in_W.normal.e(), turn_of(W_O) * in_O.normal.e());
    add(std::abs(in_W.distance - in_O.distance));
  }

  const Vec3 kForce{1.0, -2.0, 3.0};  // on the tip, in W, N
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
