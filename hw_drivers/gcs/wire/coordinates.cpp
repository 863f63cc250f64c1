#include "hw_drivers/gcs/wire/coordinates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/units.h"

namespace enc::gcs {
namespace {

constexpr double unit(std::size_t axis) { return axis < 3 ? kMillimetre : kDegree; }

}  // namespace

Coordinates to_wire_units(const Coordinates& metres_and_radians) noexcept {
  Coordinates all{};
  for (std::size_t i = 0; i < kAxes; ++i) all[i] = metres_and_radians[i] / unit(i);
  return all;
}

Coordinates from_wire_units(const Coordinates& millimetres_and_degrees) noexcept {
  Coordinates all{};
  for (std::size_t i = 0; i < kAxes; ++i) all[i] = millimetres_and_degrees[i] * unit(i);
  return all;
}

double metres(double millimetres) noexcept { return millimetres * kMillimetre; }
double millimetres(double metres) noexcept { return metres / kMillimetre; }

Pose<'R', 'H'> pose_of(const Coordinates& at, const Stand& stand) noexcept {
  const Quat turn = Eigen::AngleAxisd(at[3], Vec3::UnitX()) * Eigen::AngleAxisd(at[4], Vec3::UnitY()) *
                    Eigen::AngleAxisd(at[5], Vec3::UnitZ());
  const Vec3 centre = stand.origin + stand.pivot;
  return {turn, Vec3(centre + Vec3(at[0], at[1], at[2]) + turn * (stand.tip - centre))};
}

bool coordinates_of(const Pose<'R', 'H'>& X_RH, const Stand& stand, Coordinates& at) noexcept {
  if (!X_RH.valid()) return false;
  const Mat3 turn = X_RH.q().normalized().toRotationMatrix();
  constexpr double kLeast = 1e-6;  // lower limit of cos V
  const double cosine = std::hypot(turn(0, 0), turn(0, 1));
  if (!(cosine > kLeast)) return false;
  const Vec3 centre = stand.origin + stand.pivot;
  const Vec3 shift = X_RH.p() - centre - turn * (stand.tip - centre);
  at = {shift.x(),
        shift.y(),
        shift.z(),
        std::atan2(-turn(1, 2), turn(2, 2)),
        std::atan2(turn(0, 2), cosine),
        std::atan2(-turn(0, 1), turn(0, 0))};
  return true;
}

double distance(const Coordinates& from, const Coordinates& to) noexcept {
  constexpr double kDegreeAsMetres = 1e-3 / (std::numbers::pi / 180.0);  // m/rad
  double sum = 0.0;
  for (std::size_t i = 0; i < kAxes; ++i) {
    const double way = (to[i] - from[i]) * (i < 3 ? 1.0 : kDegreeAsMetres);
    sum += way * way;
  }
  return std::sqrt(sum);
}

namespace {

constexpr double kFarthest = 1.0;  // m or rad: beyond the range of any machine of this kind

// The largest reachable coordinate on one axis, by bisection to a billionth of kFarthest.
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
