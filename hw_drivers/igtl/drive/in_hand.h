// Which of several tools in view a person holds. It stays the same one until another is picked up: while it
// lies still itself, or is no longer in view. What lies on the table is in view all the time and is passed
// over.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "core/base/frames.h"
#include "core/base/time.h"

namespace enc::igtl {

class InHand {
 public:
  explicit InHand(std::size_t tools) : seen_(tools) {}

  // Whether this tool is the one, seen there at that time of the tracker's clock, ns. With one in view at a
  // time it always is, from its first pose on.
  [[nodiscard]] bool is(std::size_t tool, std::int64_t stamp_ns, const Vec3& place_C) noexcept {
    Seen& one = seen_[tool];
    note(one, stamp_ns, place_C);
    if (held_ >= seen_.size()) held_ = tool;
    Seen& held = seen_[held_];
    if (held.last == kNever) held.last = stamp_ns;  // after forget()
    const bool gone = stamp_ns - held.last > kGone.count();
    const bool came_after = one.since > held.last, picked_up = (place_C - one.lay).norm() > kPickedUp;
    if (gone ? came_after || !rests(one) : rests(held) && picked_up) held_ = tool;
    return tool == held_;
  }
  void forget() noexcept {  // the tracker's clock is another now
    for (Seen& one : seen_) one.last = one.moved = kNever;
  }

 private:
  static constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::min();
  struct Seen {
    std::int64_t since = 0, last = kNever, moved = kNever;  // ns: in view, seen, moved away from `place`
    Vec3 place = Vec3::Zero(), lay = Vec3::Zero();          // `lay`: where it was before it was moved
  };
  [[nodiscard]] static bool rests(const Seen& one) noexcept {
    return one.moved == kNever || one.last - one.moved > kRests.count();
  }
  static void note(Seen& one, std::int64_t stamp_ns, const Vec3& place_C) noexcept {
    if (one.last == kNever || stamp_ns - one.last > kGone.count()) {  // it comes into view
      one.since = stamp_ns;
      one.place = one.lay = place_C;
    }
    one.last = stamp_ns;
    if (rests(one)) one.lay = one.place;
    if ((place_C - one.place).norm() <= kMoved) return;
    one.moved = stamp_ns;
    one.place = place_C;
  }

  static constexpr double kMoved = 5e-3;         // m: more than noise, tremor, and a table that is knocked
  static constexpr double kPickedUp = 50e-3;     // m: more than a tool on a table is pushed by
  static constexpr Duration kGone{100'000'000};  // as lost_age_ms ships: by then a run that follows it holds
  static constexpr Duration kRests{2'000'000'000};  // longer than a hand on its way stands still
  std::vector<Seen> seen_;
  std::size_t held_ = std::numeric_limits<std::size_t>::max();
};

}  // namespace enc::igtl
