#include "hw_drivers/hand/drive/reception.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "hw_drivers/hand/wire/coordinates.h"

namespace enc::hand {
namespace {

constexpr double kFarthest = 100.0;      // m: no hand is there
constexpr std::int64_t kRestart = 1000;  // frames back: the headset began anew
constexpr std::int64_t kMostNumber = 1LL << 60;

bool near(const Vec3& at) { return at.cwiseAbs().maxCoeff() < kFarthest; }

}  // namespace

// A headset that began anew is far back, or was silent meanwhile: no line is that late.
bool Reception::is_newer(const Packet& packet, Time came) noexcept {
  if (!packet.frame || !any_) return true;
  const bool restarted = *packet.frame < frame_ - kRestart || age(came, came_) > settings_.silent;
  return restarted || *packet.frame > frame_;
}

// True if the line belongs to a newer hand of the side that is asked for.
bool Reception::believed(std::string_view line, Time came, Packet& packet) noexcept {
  if (const LineFault wrong = read(line, packet); wrong != LineFault::nothing) {
    counts_.wrong += wrong == LineFault::empty ? 0 : 1;
    return false;
  }
  fake_ = fake_ || packet.fake;
  const Side side = settings_.side == "left" ? Side::left : Side::right;
  const auto possible = [](const std::optional<std::int64_t>& number) {
    return !number || (*number > -kMostNumber && *number < kMostNumber);
  };
  if (packet.side != side || packet.kind == Kind::pose) {
    ++counts_.other;
  } else if (!possible(packet.frame) || !possible(packet.stamp_ns)) {
    ++counts_.wrong;
  } else if (!is_newer(packet, came)) {
    ++counts_.old;
  } else {
    return true;
  }
  return false;
}

bool Reception::take(std::string_view line, Time came, Measurement<HandSample>& newest) noexcept {
  Packet packet;
  if (!believed(line, came, packet)) return false;
  const bool wrist = packet.kind == Kind::wrist;
  (wrist ? wrist_ : landmarks_) = packet;
  bool& has = wrist ? has_wrist_ : has_landmarks_;
  counts_.alone += has ? 1 : 0;
  has = true;
  if (!has_wrist_ || !has_landmarks_ || wrist_.frame != landmarks_.frame) return false;
  has_wrist_ = has_landmarks_ = false;
  HandSample hand;
  if (!make(hand)) {
    ++counts_.wrong;
    return false;
  }
  if (packet.frame && any_ && *packet.frame > frame_ && *packet.frame < frame_ + kRestart)
    counts_.missing += *packet.frame - frame_ - 1;
  if (packet.frame) frame_ = *packet.frame;
  any_ = true;
  came_ = came;
  ++counts_.hands;
  const Time t = time_of(came);
  newest = {hand, newest.health == Health::absent ? t : std::max(t, newest.t), Health::ok};
  return true;
}

// The quickest lines tie the headset's clock to the loop's. Without stamps a hand is as old as the quickest.
Time Reception::time_of(Time came) noexcept {
  const auto& stamp = landmarks_.stamp_ns ? landmarks_.stamp_ns : wrist_.stamp_ns;
  if (!stamp) return came - from_seconds(settings_.least_delay);
  if (stamped_ && *stamp < stamp_) {
    ++counts_.steps;
    tie_.forget();
  }
  stamped_ = true;
  stamp_ = *stamp;
  return tie_.here(*stamp, came);
}

bool Reception::make(HandSample& hand) const noexcept {
  hand.side = settings_.side == "left" ? HandSide::left : HandSide::right;
  hand.skin = settings_.skin;
  hand.wrist = pose_from_wire(std::span(wrist_.values).first(kPoseValues));
  if (!hand.wrist.valid() || !near(hand.wrist.p())) return false;
  for (std::size_t i = 0; i < kHandJoints; ++i) {
    const Vec3 at =
        from_wire(landmarks_.values[3 * i], landmarks_.values[3 * i + 1], landmarks_.values[3 * i + 2]);
    if (!near(at)) return false;
    hand.joints[i] = settings_.from_wrist() ? hand.wrist * Point<'K'>(at) : Point<'L'>(at);
  }
  return true;
}

}  // namespace enc::hand
