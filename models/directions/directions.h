// The response of a round object, measured in several directions, for a press in another direction. VHMR
// measured three pushes of its ball (A, B, C of Fig 7) and none between them.
//
// Two angles describe a push: the position of its normal (location), and its direction against that normal
// (slant). A response is a mixture of the measured ones with weights >= 0 whose sum is 1. The chosen weights
// come nearest to the two angles; of several such sets, the most even one. Both laws of
// core/shape/response/response.h are linear in their coefficients. So no slope of a mixture is below the
// least of its parts, press stays above release, and no weight of a stop is negative. A mixture of monotone
// and passive responses is therefore monotone and passive too. Outside of the measured range the nearest edge
// counts, without extrapolation.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/spec/scene_spec.h"

namespace enc::models {

// models/directions/*.toml: a behaviour names such a file in place of a response. Scene preparation mixes for
// the press that [user] plans: the core sees where a tool touches, but not which press is intended.
//
//   format = 1
//   [[direction]]
//   name = "B"
//   response = "tennis_ball_B"     # models/responses/tennis_ball_B.toml, fitted to these pushes
//   location_deg = 13.45           # between the normal at the touched point and the vertical
//   slant_deg = 13.45              # between their axis and that normal
struct Direction {
  std::string name, response;
  double location = 0.0, slant = 0.0;  // rad
};
// Both throw Error with the place of the fault.
[[nodiscard]] std::vector<Direction> read_directions(const std::string& text, const std::string& path);
[[nodiscard]] std::vector<Direction> load_directions(const std::string& path);

struct PressWay {
  double location = 0.0, slant = 0.0;  // rad
};
// axis: out of the object, against the push. normal: outward, at the point where the push meets the surface.
// Both unit, in W. Pushes from above and from below are equal.
[[nodiscard]] PressWay way_of(const Vec3& axis, const Vec3& normal);
// The angles of the press that the scene's user plans; and whether that press is of a sphere with this
// behaviour.
[[nodiscard]] PressWay planned_way(const SceneSpec& scene);
[[nodiscard]] bool presses_sphere(const SceneSpec& scene, const std::string& behaviour);

// One weight for each direction.
[[nodiscard]] std::vector<double> weights(const std::vector<Direction>& directions, const PressWay& way);

// Throws Error, key "limit" or "stops", if the parts differ in their limit or in the radii of their stops.
[[nodiscard]] ResponseSpec mixed(const std::vector<ResponseSpec>& parts, const std::vector<double>& weights);

}  // namespace enc::models
