#include "hw_drivers/gcs/wire/travel.h"

#include <algorithm>

namespace enc::gcs {
namespace {

constexpr double kFarthest = 1.0;  // m or rad: no machine of this kind gets there

// The farthest coordinate on one axis, to a billionth of kFarthest.
double farthest(const Reach& reach, const Stand& stand, std::size_t axis, double side) noexcept {
  double low = 0.0, high = kFarthest;
  for (int i = 0; i < 30; ++i) {
    Coordinates at{};
    at[axis] = side * 0.5 * (low + high);
    (reach.contains(pose_of(at, stand)) ? low : high) = 0.5 * (low + high);
  }
  return side * low;
}

}  // namespace

Coordinates Travel::both_sides() const noexcept {
  Coordinates all{};
  for (std::size_t i = 0; i < kAxes; ++i) all[i] = std::min(-low[i], high[i]);
  return all;
}

bool Travel::clamp(Coordinates& at) const noexcept {
  const Coordinates before = at;
  for (std::size_t i = 0; i < kAxes; ++i) at[i] = std::min(std::max(at[i], low[i]), high[i]);
  return at != before;
}

Travel travel_of(const Reach& reach, const Stand& stand) noexcept {
  Travel travel;
  for (std::size_t axis = 0; axis < kAxes; ++axis) {
    travel.low[axis] = farthest(reach, stand, axis, -1.0);
    travel.high[axis] = farthest(reach, stand, axis, 1.0);
  }
  return travel;
}

}  // namespace enc::gcs
