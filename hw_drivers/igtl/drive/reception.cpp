#include "hw_drivers/igtl/drive/reception.h"

#include <algorithm>
#include <limits>

namespace enc::igtl {
namespace {

constexpr std::int64_t kNoStamp = std::numeric_limits<std::int64_t>::min();

// What is said twice, once in single precision.
bool same(const Pose<'C', 'T'>& a, const Pose<'C', 'T'>& b) noexcept {
  constexpr double kShare = 1e-6, kAngle = 1e-5;
  return (a.p() - b.p()).norm() <= kShare * (1.0 + a.p().norm()) && a.q().angularDistance(b.q()) <= kAngle;
}

}  // namespace

Reception::Reception(const IgtlSettings& settings, std::span<const std::string> tools, bool lockstep)
    : lockstep_(lockstep), tie_(from_seconds(settings.least_delay)) {
  for (const std::string& tool : tools) devices_.emplace_back(tool + settings.suffix);
  stamps_ns_.assign(devices_.size(), kNoStamp);
}

void Reception::set_back() noexcept {
  ++counts_.steps;
  tie_.forget();
  std::fill(stamps_ns_.begin(), stamps_ns_.end(), kNoStamp);
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
  if (int code = 0; message.type.view() == "STATUS" && read_status(message.content, code) && code != 1)
    counts_.status = code;
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
  std::int64_t& last_stamp = stamps_ns_[static_cast<std::size_t>(tool - devices_.begin())];
  if (numbered_ && message.stamp_ns < last_stamp) set_back();  // a newer number
  if (message.stamp_ns <= last_stamp) {
    ++counts_.old;
    return false;
  }
  last_stamp = message.stamp_ns;
  seen.tool = static_cast<std::int32_t>(tool - devices_.begin());
  const Time t = lockstep_ ? Time(Duration(message.stamp_ns)) : tie_.here(message.stamp_ns, now);
  newest = {seen, std::max(t, newest.t), Health::ok};
  ++counts_.poses;
  return true;
}

}  // namespace enc::igtl
