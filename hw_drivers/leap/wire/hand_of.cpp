#include "hw_drivers/leap/wire/hand_of.h"

#include <cmath>
#include <cstddef>

#include "core/base/units.h"

namespace enc::leap {
namespace {

constexpr double kFarthest = 100.0;  // m: no hand is there
constexpr std::size_t kDigits = 5, kJoints = 4, kIndex = 1, kTip = 3;

Vec3 from_mm(const leapc::Vector& at) { return kMillimetre * Vec3(at.v[0], at.v[1], at.v[2]); }
leapc::Vector to_mm(const Vec3& at) {
  const Eigen::Vector3f mm = (at / kMillimetre).cast<float>();
  return {{mm.x(), mm.y(), mm.z()}};
}
bool near(const Vec3& at) { return at.allFinite() && at.cwiseAbs().maxCoeff() < kFarthest; }

// A digit's joints are the begin of its second bone, and the ends of this bone and the next two. The first
// bone lies in the palm, and the thumb's has no length.
std::size_t place_of(std::size_t digit, std::size_t joint) { return 1 + kJoints * digit + joint; }

}  // namespace

bool hand_of(const leapc::Hand& said, HandSample& hand) noexcept {
  constexpr double kLength = 0.01;
  hand.side = said.type == leapc::kLeft ? HandSide::left : HandSide::right;
  const leapc::Quaternion& turned = said.palm.orientation;
  const Quat q(turned.w, turned.x, turned.y, turned.z);
  const Vec3 wrist = from_mm(said.arm.end);
  if (!(std::abs(q.norm() - 1.0) < kLength) || !near(wrist)) return false;
  hand.wrist = {q.normalized(), wrist};
  hand.joints[0] = Point<'L'>(wrist);
  for (std::size_t digit = 0; digit < kDigits; ++digit)
    for (std::size_t joint = 0; joint < kJoints; ++joint) {
      const auto& bones = said.digits[digit].bones;
      const Vec3 at = from_mm(joint == 0 ? bones[1].begin : bones[joint].end);
      if (!near(at)) return false;
      hand.joints[place_of(digit, joint)] = Point<'L'>(at);
    }
  const double width = said.digits[kIndex].bones[kTip].width;
  constexpr double kWidest = 100.0;  // mm
  if (!(width >= 0.0 && width < kWidest)) return false;
  hand.skin = 0.5 * kMillimetre * width;
  return true;
}

leapc::Hand said_of(const HandSample& hand) noexcept {
  leapc::Hand said;
  said.type = hand.side == HandSide::left ? leapc::kLeft : leapc::kRight;
  const Eigen::Quaternionf q = hand.wrist.q().cast<float>();
  said.palm.orientation = {q.x(), q.y(), q.z(), q.w()};
  said.arm.end = to_mm(hand.wrist.p());
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    leapc::Digit& of = said.digits[digit];
    of.id = static_cast<std::int32_t>(digit);
    of.bones[0].end = to_mm(hand.joints[place_of(digit, 0)].e());
    for (std::size_t bone = 1; bone < of.bones.size(); ++bone) {
      of.bones[bone].begin = to_mm(hand.joints[place_of(digit, bone - 1)].e());
      of.bones[bone].end = to_mm(hand.joints[place_of(digit, bone)].e());
      of.bones[bone].width = static_cast<float>(2.0 * hand.skin / kMillimetre);
    }
  }
  return said;
}

}  // namespace enc::leap
