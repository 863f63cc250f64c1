// Who touches in a scene: a person with a tool or a bare finger, or something that pushes the machine. Parts
// of the scene file (scene_spec.h); SI.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

// How a person reaches for a surface and presses it. A pair is the least and the most of what is drawn evenly
// between them, anew for each press.
struct ReachRanges {
  std::vector<double> tilt{0.0, 0.35};                 // rad, of a reach from the surface normal
  std::vector<double> reach{0.060, 0.090};             // m, distance of its start from the touched point
  std::vector<double> peak_speed{0.2, 0.5};            // m/s, of its first, ballistic part
  std::vector<double> touch_speed{0.02, 0.1};          // m/s, wanted where the surface is
  std::vector<double> depth{0.003, 0.0065};            // m, wanted deflection
  std::vector<double> press_speed{0.002, 0.020};       // m/s, mean, down to the depth and back up
  std::vector<double> hold{0.2, 1.0}, rest{0.5, 2.0};  // s; rest: over the next place, before each reach
};

// Random radial presses of a ball, with one change of the tool [VHMR 4.4].
struct SessionSpec : ReachRanges {
  double duration = 120.0;  // s; a press that would not end in time is not begun
  double polar_most = 0.8;  // rad from +z of W: places are even up to here, if they can be pressed
  std::string other_tool;   // taken at the change; empty: there is none
  std::vector<double> change{0.4, 0.6};  // of the duration: after which the next pause is the change
  // In W, m: where the first tool's tip lies while it is not held; the other's is beside it (session_plan.h).
  Vec3 tray{-0.150, 0.0, 0.060};
  static constexpr double kTrayBeside = 0.080;  // m along y of W, from the first tool's place to the other's
};

// Reaches of a bare finger from far away to random places of the objects of a scene, each object as often
// [VisHap 2.2]. Planes, buttons, spheres.
struct ReachesSpec : ReachRanges {
  ReachesSpec()
      : ReachRanges{{0.0, 0.7},     {0.16, 0.20},   {0.3, 0.8}, {0.05, 0.2},
                    {0.002, 0.005}, {0.010, 0.040}, {0.0, 0.1}, {0.6, 1.0}} {}
  std::int64_t count = 20;  // reaches
  double spread = 0.030;    // m: of a plane, places are even over this around the point of it that is named
  double polar_most = 0.8;  // rad: of a sphere, over the directions up to here from +z of W
};

// How a held tool trembles: one sine for each axis, or several between 8 and 12 Hz that wax and wane.
enum class TremorForm : std::uint8_t { sine, band };
constexpr auto words(TremorForm) { return enum_words("sine", "band"); }
enum class UserKind : std::uint8_t { press_release, session, reaches };
constexpr auto words(UserKind) { return enum_words("press_release", "session", "reaches"); }

// Who holds the tool. A simulated rig plays this; a real rig shows it to the person.
struct UserSpec {
  UserKind kind = UserKind::press_release;
  std::string object, tool;      // pressed, held; empty: the first
  double azimuth = 0.0;          // where on the object, from +x towards +y of W, rad
  double polar = 0.0;            // and from +z of W, rad: 0 presses from above
  double offset = 0.0;           // sideways of the axis, m (indentation B)
  double depth = 0.006;          // wanted deflection, m
  std::vector<double> depths{};  // m, instead: of the k-th press; the last one stays
  double push = kUnset;          // instead: push with this force, N, whatever the depth
  double press_time = 6.0, hold_time = 0.5, release_time = 6.0, rest_time = 1.0;  // s
  std::vector<double> approach{0.02};  // speed of the tool when it touches, m/s; one press for each entry
  double approach_from = 0.060;        // m, distance of the start from the touched point
  double approach_tilt = 0.5;          // rad, of the approach from the surface normal
  // While it holds, which takes as long: there and back along x of the surface's frame, m; fastest, m/s.
  double slide = 0.0, slide_speed = 0.030;
  std::int64_t repeats = 1;  // of the whole list
  TremorForm tremor = TremorForm::sine;
  std::optional<SessionSpec> session;  // instead of the presses above
  std::optional<ReachesSpec> reaches;  // likewise
};

// Something outside of the machine pushes the haptic-tip into an object that the core renders [VHMR 2, Fig
// 3]: along the outward normal of the surface point that is nearest to W's origin. Nobody holds a tool.
struct PusherSpec {
  std::string object;                                        // rendered and pushed into; empty: the first
  double depth = 0.015;                                      // wanted deflection, m, unless
  double force = 30.0;                                       // the object pushes back with this, N, before
  double ramp_time = 2.0, hold_time = 8.0, rest_time = 1.0;  // s; rest: clear of the tip, before each push
  std::int64_t repeats = 1;
};

}  // namespace enc
