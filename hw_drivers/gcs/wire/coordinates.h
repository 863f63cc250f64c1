// A pose in the hexapod controller's coordinates. X Y Z act along fixed axes. U V W act about axes that meet
// in the pivot and turn with the platform: U about x, V about the y that U turned, W about the z that both
// turned (manual of the H-820, page 13).
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

#include "core/base/frames.h"
#include "core/machine/hexapod.h"

namespace enc::gcs {

inline constexpr std::size_t kAxes = 6;
inline constexpr std::string_view kAxisNames = "XYZUVW";
inline constexpr std::string_view kPivotNames = "RST";

using Coordinates = std::array<double, kAxes>;  // X Y Z in m, U V W in rad

// The protocol has mm and degrees; these two functions are its only conversions.
[[nodiscard]] Coordinates to_wire_units(const Coordinates& metres_and_radians) noexcept;
[[nodiscard]] Coordinates from_wire_units(const Coordinates& millimetres_and_degrees) noexcept;
[[nodiscard]] double metres(double millimetres) noexcept;
[[nodiscard]] double millimetres(double metres) noexcept;

// Distance, m: a degree counts as a millimetre.
[[nodiscard]] double distance(const Coordinates& from, const Coordinates& to) noexcept;

// Position of the controller's axes in R; they are parallel to those of R.
struct Stand {
  Vec3 origin{0, 0, 0};  // origin of the coordinates: the pivot while R, S and T are 0; m
  Vec3 pivot{0, 0, 0};   // R S T: from the origin to the pivot, m
  Vec3 tip{0, 0, 0};     // H while all coordinates are 0, in R, m
};

// p_RH = centre + (X Y Z) + turn * (tip - centre), turn = Rx(U) Ry(V) Rz(W), centre = origin + pivot.
[[nodiscard]] Pose<'R', 'H'> pose_of(const Coordinates& at, const Stand& stand) noexcept;
// Returns false if V is +-90 degrees, where U and W are ambiguous, or if the input is not a pose.
[[nodiscard]] bool coordinates_of(const Pose<'R', 'H'>& X_RH, const Stand& stand, Coordinates& at) noexcept;

// Range of a machine on each of the controller's axes, from its zero, as TMN? and TMX? report it.
struct Travel {
  Coordinates low{}, high{};

  [[nodiscard]] Coordinates both_sides() const noexcept;  // the smaller of both directions on each axis
  // Limits `at` to the range; returns true if that changed it.
  bool clamp(Coordinates& at) const noexcept;
};
[[nodiscard]] Travel travel_of(const Reach& reach, const Stand& stand) noexcept;

}  // namespace enc::gcs
