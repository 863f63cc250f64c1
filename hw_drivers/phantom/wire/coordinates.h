// The PHANToM's own coordinates and ours. HD: mm from the tip's place with all joints at 0, x to the right of
// a person in front of the device, y up, z towards that person. R: m, x towards the person, z up.
#pragma once

#include "core/base/frames.h"
#include "core/base/units.h"

namespace enc::phantom {

// A direction, velocity or force; the unit stays.
[[nodiscard]] inline Vec3 axes_to_ours(const Vec3& hd) { return {hd.z(), hd.x(), hd.y()}; }
[[nodiscard]] inline Vec3 axes_to_hd(const Vec3& ours) { return {ours.y(), ours.z(), ours.x()}; }

// A position. `origin`: of HD's coordinates, in R, m.
[[nodiscard]] inline Point<'R'> point_of(const Vec3& hd_mm, const Point<'R'>& origin) {
  return Point<'R'>(Vec3(origin.e() + kMillimetre * axes_to_ours(hd_mm)));
}
[[nodiscard]] inline Vec3 hd_point(const Point<'R'>& tip, const Point<'R'>& origin) {
  return axes_to_hd(Vec3(tip.e() - origin.e())) / kMillimetre;
}

}  // namespace enc::phantom
