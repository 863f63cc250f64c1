#include "hw_drivers/v4l2/drive/pairs.h"

#include <algorithm>
#include <cmath>

namespace enc::v4l2 {
namespace {

Duration distance(Duration a, Duration b) noexcept { return a > b ? a - b : b - a; }

}  // namespace

std::int64_t Pairs::FrameQueue::add(const Shot& shot) noexcept {
  const bool full = count == kHeld;
  if (full) drop(1);
  shots[count++] = shot;
  return full ? 1 : 0;
}

void Pairs::FrameQueue::drop(std::size_t oldest) noexcept {
  std::copy(shots.begin() + static_cast<std::ptrdiff_t>(oldest),
            shots.begin() + static_cast<std::ptrdiff_t>(count), shots.begin());
  count -= oldest;
}

std::size_t Pairs::nearest(Duration stamp) const noexcept {
  std::size_t best = 0;
  for (std::size_t i = 1; i < rights_.count; ++i)
    if (distance(rights_.shots[i].stamp, stamp) <= distance(rights_.shots[best].stamp, stamp)) best = i;
  return best;
}

bool Pairs::next(ShotPair& pair) noexcept {
  if (rights_.count == 0) return false;
  const Duration newest = rights_.shots[rights_.count - 1].stamp;
  std::size_t hopeless = 0;  // number of left frames for which no nearer right frame can come
  for (std::size_t i = lefts_.count; i-- > 0;) {
    const Shot left = lefts_.shots[i];
    const Shot right = rights_.shots[nearest(left.stamp)];
    const bool all_known = newest >= left.stamp;
    const Duration off = distance(left.stamp, right.stamp);
    if (off <= apart_ && (off <= half_ || all_known)) {
      unpaired_ += static_cast<std::int64_t>(i);
      lefts_.drop(i + 1);
      pair = {left, right};
      count(pair);
      return true;
    }
    if (all_known) hopeless = std::max(hopeless, i + 1);
  }
  unpaired_ += static_cast<std::int64_t>(hopeless);
  lefts_.drop(hopeless);
  return false;
}

void Pairs::count(const ShotPair& pair) noexcept {
  ++errors_.pairs;
  errors_.last = seconds(pair.right.stamp - pair.left.stamp);
  errors_.sum += std::abs(errors_.last);
  errors_.largest = std::max(errors_.largest, std::abs(errors_.last));
}

void Pairs::forget() noexcept { lefts_.count = rights_.count = 0; }

}  // namespace enc::v4l2
