#include "hw_drivers/igtl/drive/reception.h"

#include <algorithm>
#include <limits>

namespace enc::igtl {
namespace {

constexpr std::int64_t kNoStamp = std::numeric_limits<std::int64_t>::min();
// ns: an earlier stamp by more than this means that the clock was set back. Two sources of a tool may differ
// by one frame; a datagram without a number may be late.
constexpr std::int64_t kTwoSources = 50'000'000, kOvertaken = 1'000'000'000;

// PLUS capitalises the first letter.
bool same_name(std::string_view a, std::string_view b) noexcept {
  const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return a.size() == b.size() && !a.empty() && small(a[0]) == small(b[0]) && a.substr(1) == b.substr(1);
}

// Compares a pose with its copy in single precision.
bool same(const Pose<'C', 'T'>& a, const Pose<'C', 'T'>& b) noexcept {
  constexpr double kShare = 1e-6, kAngle = 1e-5;
  return (a.p() - b.p()).norm() <= kShare * (1.0 + a.p().norm()) && a.q().angularDistance(b.q()) <= kAngle;
}

// Bitwise equal: a measuring tracker never gives equal poses twice.
bool equal(const Pose<'C', 'T'>& a, const Pose<'C', 'T'>& b) noexcept {
  return a.xyz == b.xyz && a.xyzw == b.xyzw;
}

// Replaces the pose by the exact one from the metadata, if present. Returns false if the two disagree.
bool sharpen(const Message& message, Pose<'C', 'T'>& X_CT) noexcept {
  const std::string_view text = value_of(message.metadata, kPoseKey);
  if (text.empty()) return true;
  Pose<'C', 'T'> exact;
  if (!read_pose(text, exact) || !same(exact, X_CT)) return false;
  X_CT = exact;
  return true;
}

}  // namespace

Reception::Reception(const IgtlSettings& settings, std::span<const std::string> tools, bool lockstep)
    : lockstep_(lockstep),
      ordered_(settings.streams()),
      tie_(from_seconds(settings.least_delay)),
      in_hand_(tools.size()) {
  for (const std::string& tool : tools) {
    devices_.emplace_back(tool + settings.suffix);
    tools_.emplace_back(tool);
  }
  stamps_ns_.assign(devices_.size(), kNoStamp);
  behind_ns_ = stamps_ns_;
  again_.assign(devices_.size(), 0);
  poses_.resize(devices_.size());
}

std::string Reception::expected() const {
  std::string text;
  for (const Name<20>& device : devices_)
    text.append(text.empty() ? "'" : " or '").append(device.view()).append("'");
  return text;
}

void Reception::count_wrong(MessageFault why) noexcept {
  const bool none = why == MessageFault::no_checksum;
  if (none) ++counts_.no_checksum;
  ++(none || why == MessageFault::checksum ? counts_.checksum : counts_.wrong);
}

// A stamp that comes twice is a repeated message. A stamp that comes a third time stands still.
void Reception::count_old(std::size_t tool, std::int64_t stamp_ns) noexcept {
  const bool stands = stamp_ns == stamps_ns_[tool] && again_[tool]++ > 0;
  ++(stands ? counts_.standing : counts_.old);
}

void Reception::set_back() noexcept {
  ++counts_.steps;
  tie_.forget();
  in_hand_.forget();
  std::fill(stamps_ns_.begin(), stamps_ns_.end(), kNoStamp);
  std::fill(behind_ns_.begin(), behind_ns_.end(), kNoStamp);
  newest_ns_ = kNoStamp;
}

// Called for a stamp that is not newer than the last one of its tool. A newer stamp follows after an
// overtaken message, or after one from a second source that lags a little. If the order is known, two
// increasing stamps in the past mean that the clock was set back.
bool Reception::goes_back(std::size_t tool, std::int64_t stamp_ns) noexcept {
  std::int64_t& behind = behind_ns_[tool];
  const bool again = behind != kNoStamp && stamp_ns > behind && stamp_ns < stamps_ns_[tool];
  behind = stamp_ns;
  return again && (numbered_ || ordered_);
}

bool Reception::is_newer(const Message& message) noexcept {
  if (!message.numbered) return true;
  // Message numbers wrap around: less than half the range ahead counts as newer.
  const std::uint32_t ahead = message.number - number_;
  if (numbered_ && (ahead == 0 || ahead >= 0x80000000U)) {
    ++counts_.old;
    return false;
  }
  if (numbered_) counts_.missing += ahead - 1;
  numbered_ = true;
  number_ = message.number;
  return true;
}

bool Reception::take(std::span<const std::byte> bytes, Time now, Measurement<TrackedTool>& newest) noexcept {
  Message message;
  if (const MessageFault why = read(bytes, message); why != MessageFault::nothing) {
    count_wrong(why);
    return false;
  }
  heard_ = true;
  last_ = now;
  // A stream loses and reorders nothing, and its servers number messages arbitrarily.
  if (!ordered_ && !is_newer(message)) return false;
  if (int code = 0; message.type.view() == "STATUS" && read_status(message.content, code) && code != 1)
    counts_.status = code;
  if (message.type.view() == "TDATA") return take_all(message, now, newest);
  const bool position = message.type.view() == "POSITION";
  if (!position && message.type.view() != "TRANSFORM") return false;
  if (!says_valid(message.metadata)) {
    ++counts_.unseen;
    return false;
  }
  ToolMessage told{message.device, {}, message.stamp_ns};
  if (!(position ? read_position(message.content, told.X_CT) : read_transform(message.content, told.X_CT)) ||
      !sharpen(message, told.X_CT)) {
    ++counts_.wrong;
    return false;
  }
  return take_one(told, now, newest);
}

// Takes all tools of one frame; at most one of them is in the hand.
bool Reception::take_all(const Message& message, Time now, Measurement<TrackedTool>& newest) noexcept {
  const std::size_t count = elements_of(message.content);
  if (count == 0 && !message.content.empty()) ++counts_.wrong;
  bool news = false;
  for (std::size_t i = 0; i < count; ++i) {
    Element element;
    if (read_element(message.content, i, element) && (count > 1 || sharpen(message, element.X_CT)))
      news = take_one({element.name, element.X_CT, message.stamp_ns}, now, newest) || news;
    else
      ++counts_.wrong;
  }
  return news;
}

bool Reception::take_one(const ToolMessage& told, Time now, Measurement<TrackedTool>& newest) noexcept {
  const auto named = [&](const Name<20>& name) { return same_name(name.view(), told.device.view()); };
  auto name = std::find_if(devices_.begin(), devices_.end(), named);
  auto tool = static_cast<std::size_t>(name - devices_.begin());
  if (name == devices_.end())
    tool = static_cast<std::size_t>(std::find_if(tools_.begin(), tools_.end(), named) - tools_.begin());
  if (tool == tools_.size()) {
    if (counts_.unknown++ == 0) counts_.stranger = told.device;
    return false;
  }
  std::int64_t& last = stamps_ns_[tool];
  const std::int64_t least = numbered_ || ordered_ ? kTwoSources : kOvertaken;
  if (newest_ns_ != kNoStamp && newest_ns_ - told.stamp_ns > least) set_back();
  if (told.stamp_ns <= last) {
    if (!goes_back(tool, told.stamp_ns)) {
      count_old(tool, told.stamp_ns);
      return false;
    }
    set_back();
  }
  last = told.stamp_ns;
  again_[tool] = 0;
  behind_ns_[tool] = kNoStamp;
  newest_ns_ = std::max(newest_ns_, last);
  const Time t = lockstep_ ? Time(Duration(told.stamp_ns)) : tie_.here(told.stamp_ns, now);
  if (!in_hand_.is(tool, told.stamp_ns, told.X_CT.p())) {
    ++counts_.aside;
    return false;
  }
  if (counts_.poses > 0 && equal(poses_[tool], told.X_CT)) ++counts_.repeated;
  poses_[tool] = told.X_CT;
  TrackedTool seen;
  seen.X_CT = told.X_CT;
  seen.tool = static_cast<std::int32_t>(tool);
  newest = {seen, std::max(t, newest.t), Health::ok};
  ++counts_.poses;
  return true;
}

}  // namespace enc::igtl
