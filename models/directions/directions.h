// A round object that was measured in several directions, pressed in another one. VHMR measured three pushes
// of its ball (A, B, C of Fig 7) and nothing between them.
//
// A push is two angles: where its normal is (location) and how it goes against that (slant). A response is
// mixed of the measured ones with weights >= 0 whose sum is 1: those that come nearest to the two angles, and
// of them the most even ones. Both laws of core/shape/response/response.h are linear in their coefficients;
// no slope of a mixture is below the least of its parts, press stays above release, no weight of a stop is
// negative. So what is mixed of responses that are monotone and passive is that, too. Outside of what was
// measured the nearest edge counts: nothing is extrapolated.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/spec/scene_spec.h"

namespace enc::models {

// models/directions/*.toml: a behaviour names it in place of a response. Scene preparation mixes for the
// press that [user] plans: the core sees where a tool touches, but not what the press is meant to be.
//
//   format = 1
//   [[direction]]
//   name = "B"
//   response = "tennis_ball_B"     # models/responses/tennis_ball_B.toml, fitted to these pushes
//   location_deg = 13.45           # between the normal where they met the object, and the vertical
//   slant_deg = 13.45              # between their axis and that normal
struct Direction {
  std::string name, response;
  double location = 0.0, slant = 0.0;  // rad
};
// Throw Error with the place of what is wrong.
[[nodiscard]] std::vector<Direction> read_directions(const std::string& text, const std::string& path);
[[nodiscard]] std::vector<Direction> load_directions(const std::string& path);

struct PressWay {
  double location = 0.0, slant = 0.0;  // rad
};
// axis: out of the object, against the push. normal: outward, where the push meets the surface. Both unit, in
// W. From above or from below is the same.
[[nodiscard]] PressWay way_of(const Vec3& axis, const Vec3& normal);
// Of the press that the scene's user plans; and whether that is of a sphere with this behaviour.
[[nodiscard]] PressWay planned_way(const SceneSpec& scene);
[[nodiscard]] bool presses_sphere(const SceneSpec& scene, const std::string& behaviour);

// One for each direction.
[[nodiscard]] std::vector<double> weights(const std::vector<Direction>& directions, const PressWay& way);

// Throws Error, key "limit" or "stops", where the parts differ in their limit or in the radii of their stops.
[[nodiscard]] ResponseSpec mixed(const std::vector<ResponseSpec>& parts, const std::vector<double>& weights);

}  // namespace enc::models
