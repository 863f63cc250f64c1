#include "benchmarks/vishap/arm_play.h"

#include <algorithm>
#include <cmath>

#include "core/base/rotation.h"
#include "core/machine/arm_shape.h"
#include "sim/camera/skin_tones.h"
#include "sim/world.h"
#include "trial/assemble/prepare.h"
#include "trial/assemble/vision.h"
#include "trial/camera/arm_things.h"
#include "trial/measure/finger_measure.h"

namespace enc::bench::vishap {
namespace {

constexpr double kMeets = 0.6, kNobody = 0.1;  // shares of frames
constexpr double kTilt = 0.5;                  // rad: how a prop may face, about the wall's normal
constexpr double kOutOfPlane = staged::Draw{}.tilt, kTowards = 0.4;
// rad rms: a finger that is believed 2 mm beside where it is turns the normal of a ball of 40 mm by so much.
constexpr double kFacingOff = 0.05;

double between(sim::Stream& stream, double low, double high) { return low + (high - low) * stream.uniform(); }

// What the encoders say of the joints.
PerJoint measured(const sim::ArmTruth& arm, const PerJoint& q) {
  PerJoint said{};
  for (std::size_t i = 0; i < said.size(); ++i) {
    const double step = 2.0 * M_PI / (arm.counts[i] * arm.machine.drives[i].ratio);
    said[i] = step * std::floor(q[i] / step + 0.5);
  }
  return said;
}

}  // namespace

ArmPlay::ArmPlay(const models::Setup& setup, const sim::CameraModule& camera, std::uint64_t seed)
    : setup_(setup),
      scene_(trial::prepare_setup(setup)),
      spec_(trial::stage_of(setup.twin.camera, seed)),
      camera_(camera),
      stage_(camera.stage(spec_)),
      stream_(seed, "arm play"),
      X_CW_(pose_of<'W', 'C'>(setup.twin.frames.W_C).inverse()),
      X_WR_(sim::arm_base(setup.twin.arm)),
      normal_(trial::wanted_at(scene_.objects.front(), Point<'W'>(0, 0, 0)).normal),
      skin_(sim::skin_colour(setup.twin.camera.skin)) {}

AugmentedSpec ArmPlay::believed(const Belief& belief) const {
  AugmentedSpec spec;
  spec.camera = setup_.rig.camera;
  spec.segmentation = setup_.rig.vision.segmentation;
  spec.arm = setup_.rig.arm.machine;
  spec.prop = setup_.scene.prop->size;
  spec.X_WR = scene_.X_WR;
  spec.X_WC = scene_.X_WC * Pose<'C', 'C'>(Quat::Identity(), Vec3(belief.camera_off.e()));
  return spec;
}

void ArmPlay::pose_arm(const Point<'W'>& tip, Frame& frame) {
  const ArmMachine& machine = setup_.twin.arm.machine;
  const Arm arm(machine);
  PerJoint q{};
  if (!arm.inverse(X_WR_.inverse() * tip, q)) q = arm.zero();
  const auto tilted = [&](const Quat& from, double by) {
    const double way = between(stream_, 0.0, 2.0 * M_PI);
    return from * Quat(Eigen::AngleAxisd(by, Vec3(std::cos(way), std::sin(way), 0.0)));
  };
  facing_ = tilted(rotation_z_to(normal_.e()), between(stream_, 0.0, kTilt));
  frame.moment = {};
  frame.moment.joints = measured(setup_.twin.arm, q);
  frame.moment.q_WN = tilted(facing_, kFacingOff * stream_.normal());
  frame.shown.things.clear();
  for (const ArmPart& part : arm_shape(machine, q, X_WR_))
    frame.shown.things.push_back(trial::thing_of(part, X_CW_));
  const Point<'W'> at = X_WR_ * arm.tip(q);
  frame.shown.things.push_back(trial::thing_of(prop_shape(setup_.scene.prop->size, at, facing_), X_CW_));
}

void ArmPlay::draw(Frame& frame) {
  stage_->draw(frame.shown, frames_++, frame.pair.left, frame.pair.right, &frame.pair.truth);
}

void ArmPlay::rest(Frame& frame) {
  frame.shown = {};
  frame.meets = false;
  pose_arm(X_WR_ * Arm(setup_.twin.arm.machine).tip({}), frame);
  draw(frame);
}

void ArmPlay::next(Frame& frame) {
  const auto place = [&] {
    return Point<'W'>(between(stream_, -0.07, 0.05), between(stream_, -0.08, 0.08),
                      between(stream_, -0.02, 0.08));
  };
  const Point<'W'> tip = place(), elsewhere = place();
  frame.shown = {};
  pose_arm(tip, frame);
  frame.meets = stream_.uniform() < kMeets;
  frame.shown.hand = frame.meets || stream_.uniform() > kNobody / (1.0 - kMeets);
  frame.shown.look.skin = skin_;
  const double radius = 0.5 * frame.shown.look.finger_width;
  // A finger that comes to the wall, as far out of the image's plane as where fingertips are judged.
  Vec<'C'> along;
  do {
    const double side = between(stream_, 0.0, 2.0 * M_PI), tilt = between(stream_, -kOutOfPlane, kOutOfPlane);
    along = Vec<'C'>(std::cos(tilt) * std::cos(side), std::cos(tilt) * std::sin(side), std::sin(tilt));
  } while (dot(X_CW_.inverse() * along, normal_) > -kTowards);
  const double above = frame.meets ? radius + between(stream_, 0.0, 0.025) : between(stream_, 0.03, 0.12);
  const Vec<'W'> normal = frame.meets ? Vec<'W'>(Vec3(facing_ * Vec3::UnitZ())) : normal_;
  frame.shown.pose.tip = X_CW_ * ((frame.meets ? tip : elsewhere) + above * normal);
  frame.shown.pose.along = along;
  frame.shown.pose.roll = between(stream_, 0.0, 2.0 * M_PI);
  if (frame.shown.hand) frame.moment.finger = frame.shown.pose.tip;
  draw(frame);
}

void ArmPlay::without_arm(const Frame& frame, staged::Pair& pair) {
  sim::Shown shown = frame.shown;
  shown.things.clear();
  stage_->draw(shown, frames_ - 1, pair.left, pair.right, &pair.truth);
}

Image ArmPlay::empty() {
  sim::StageSpec quiet = spec_;
  quiet.sensor.noise = 0.0;
  Image left, right;
  camera_.stage(quiet)->draw(sim::Shown{}, 0, left, right);
  return left;
}

}  // namespace enc::bench::vishap
