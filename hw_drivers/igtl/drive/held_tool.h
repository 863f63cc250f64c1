// Decides which of several visible tools a person holds. The held tool changes only when another one is
// picked up while this one lies still or is out of view. A tool on the table is visible all the time and is
// ignored.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc::igtl {

class HeldToolFinder {
 public:
  explicit HeldToolFinder(std::size_t tools) : seen_(tools) {}

  // True if this tool is the held one. Call it with the tool's position and the time of the tracker's clock
  // (ns). The only visible tool counts as held from its first pose on.
  [[nodiscard]] bool is(std::size_t tool, std::int64_t stamp_ns, const Vec3& place_C) noexcept {
    ToolHistory& one = seen_[tool];
    note(one, stamp_ns, place_C);
    if (held_ >= seen_.size()) held_ = tool;
    ToolHistory& held = seen_[held_];
    if (held.last == kNever) held.last = stamp_ns;  // after forget()
    const bool gone = stamp_ns - held.last > kGone.count();
    const bool came_after = one.since > held.last, picked_up = (place_C - one.lay).norm() > kPickedUp;
    if (gone ? came_after || !rests(one) : rests(held) && picked_up) held_ = tool;
    return tool == held_;
  }
  void forget() noexcept {  // call this when the tracker's clock has changed
    for (ToolHistory& one : seen_) one.last = one.moved = kNever;
  }

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  struct ToolHistory {
    std::int64_t since = 0, last = kNever,
                 moved = kNever;  // ns: came into view, last seen, last moved away from `place`
    Vec3 place = Vec3::Zero(), lay = Vec3::Zero();  // `lay`: its place before it was moved
  };
  [[nodiscard]] static bool rests(const ToolHistory& one) noexcept {
    return one.moved == kNever || one.last - one.moved > kRests.count();
  }
  static void note(ToolHistory& one, std::int64_t stamp_ns, const Vec3& place_C) noexcept {
    if (one.last == kNever || stamp_ns - one.last > kGone.count()) {  // the tool comes into view
      one.since = stamp_ns;
      one.place = one.lay = place_C;
    }
    one.last = stamp_ns;
    if (rests(one)) one.lay = one.place;
    if ((place_C - one.place).norm() <= kMoved) return;
    one.moved = stamp_ns;
    one.place = place_C;
  }

  static constexpr double kMoved = 5e-3;  // m: more than noise, tremor, or a knock on the table
  // m: more than a push that slides a tool on the table.
  static constexpr double kPickedUp = 50e-3;
  static constexpr Duration kGone{
      100'000'000};  // default of lost_age_ms: a run with this tool is in a hold by then
  static constexpr Duration kRests{2'000'000'000};  // longer than any pause of a moving hand
  std::vector<ToolHistory> seen_;
  std::size_t held_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace enc::igtl
