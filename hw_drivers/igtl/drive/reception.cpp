#include "hw_drivers/igtl/drive/reception.h"

#include <algorithm>

namespace enc::igtl {
namespace {

// What is said twice, once in single precision.
bool same(const Pose<'C', 'T'>& a, const Pose<'C', 'T'>& b) noexcept {
  constexpr double kShare = 1e-6, kAngle = 1e-5;
  return (a.p() - b.p()).norm() <= kShare * (1.0 + a.p().norm()) && a.q().angularDistance(b.q()) <= kAngle;
}

}  // namespace

Reception::Reception(const IgtlSettings& settings, std::span<const std::string> tools, bool lockstep)
    : lockstep_(lockstep), tie_(from_seconds(settings.least_delay)) {
  for (const std::string& tool : tools) devices_.emplace_back(tool + settings.suffix);
}

bool Reception::take(std::span<const std::byte> datagram, Time now, Stamped<TrackedTool>& newest) noexcept {
  Message message;
  if (read(datagram, message) != Wrong::nothing) {
    ++counts_.wrong;
    return false;
  }
  heard_ = true;
  last_ = now;
  if (message.numbered) {
    // Numbers go round: what is less than half a round ahead is newer.
    const std::uint32_t ahead = message.number - number_;
    if (numbered_ && (ahead == 0 || ahead >= 0x80000000U)) {
      ++counts_.old;
      return false;
    }
    if (numbered_) counts_.missing += ahead - 1;
    numbered_ = true;
    number_ = message.number;
  }
  if (message.type.view() != "TRANSFORM") return false;
  const auto tool = std::find_if(devices_.begin(), devices_.end(), [&](const Name<20>& device) {
    return device.view() == message.device.view();
  });
  TrackedTool seen;
  Pose<'C', 'T'> exact;
  bool wrong = tool == devices_.end() || !read_transform(message.content, seen.X_CT);
  if (const std::string_view pose = value_of(message.metadata, kPoseKey); !wrong && !pose.empty()) {
    wrong = !read_pose(pose, exact) || !same(exact, seen.X_CT);
    seen.X_CT = exact;
  }
  if (wrong) {
    ++counts_.wrong;
    return false;
  }
  if (message.stamp_ns <= stamp_ns_) {
    ++counts_.old;
    return false;
  }
  stamp_ns_ = message.stamp_ns;
  seen.tool = static_cast<std::int32_t>(tool - devices_.begin());
  const Time t = lockstep_ ? Time(Duration(message.stamp_ns)) : tie_.here(message.stamp_ns, now);
  newest = {seen, std::max(t, newest.t), Health::ok};
  ++counts_.poses;
  return true;
}

}  // namespace enc::igtl
