// The user of a scene: a person with a tool or a bare finger, or a pusher that pushes the machine. Parts of
// the scene file (scene_spec.h); SI.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/base/frames.h"
#include "core/base/words.h"

namespace enc {

// The way in which a person reaches for a surface and presses it. Each pair is the minimum and maximum of a
// uniform distribution, drawn anew for each press.
struct ReachRanges {
  std::vector<double> tilt{0.0, 0.35};            // rad, reach against the surface normal
  std::vector<double> reach{0.060, 0.090};        // m, distance of the reach's start from the touched point
  std::vector<double> peak_speed{0.2, 0.5};       // m/s, of the first, ballistic part
  std::vector<double> touch_speed{0.02, 0.1};     // m/s, intended at the surface
  std::vector<double> depth{0.003, 0.0065};       // m, intended deflection
  std::vector<double> press_speed{0.002, 0.020};  // m/s, mean, down to the depth and back up
  std::vector<double> hold{0.2, 1.0}, rest{0.5, 2.0};  // s; rest: over the next point, before each reach
};

// Random radial presses of a ball, with one change of the tool [VHMR 4.4].
struct SessionSpec : ReachRanges {
  double duration = 120.0;  // s; a press that would not end in time is not started
  double polar_most = 0.8;  // rad from +z of W: points are uniform up to here, if they can be pressed
  std::string other_tool;   // used after the change; empty: no change
  std::vector<double> change{0.4, 0.6};  // share of the duration after which the next pause is the change
  // Resting place of the first tool's tip, in W, m; the other tool lies beside it (session_plan.h).
  Vec3 tray{-0.150, 0.0, 0.060};
  static constexpr double kTrayBeside = 0.080;  // m along y of W, from the first tool's place to the other's
};

// Reaches of a bare finger from far away to random points of a scene's objects, equally often for each object
// [VisHap 2.2]. Planes, buttons, spheres.
struct ReachesSpec : ReachRanges {
  ReachesSpec()
      : ReachRanges{{0.0, 0.7},     {0.16, 0.20},   {0.3, 0.8}, {0.05, 0.2},
                    {0.002, 0.005}, {0.010, 0.040}, {0.0, 0.1}, {0.6, 1.0}} {}
  std::int64_t count = 20;  // reaches
  // m; plane: points are uniform over this around the named point.
  double spread = 0.030;
  double polar_most = 0.8;  // rad; sphere: directions are uniform up to here from +z of W
};

// Tremor of a held tool: one sine for each axis, or several between 8 and 12 Hz that wax and wane.
enum class TremorForm : std::uint8_t { sine, band };
constexpr auto words(TremorForm) { return enum_words("sine", "band"); }
enum class UserKind : std::uint8_t { press_release, session, reaches };
constexpr auto words(UserKind) { return enum_words("press_release", "session", "reaches"); }

// The user who holds the tool. A simulated rig plays this; a real rig shows it to the person.
struct UserSpec {
  UserKind kind = UserKind::press_release;
  std::string object, tool;      // object to press and tool to hold; empty: the first
  double azimuth = 0.0;          // point on the object: angle from +x towards +y of W, rad
  double polar = 0.0;            // point on the object: angle from +z of W, rad; 0 presses from above
  double offset = 0.0;           // m, sideways of the axis (indentation B)
  double depth = 0.006;          // intended deflection, m
  std::vector<double> depths{};  // m, alternative to `depth`: press k takes entry k; the last one stays
  double push = kUnset;          // N, alternative to `depth`: push with this force, whatever the depth
  double press_time = 6.0, hold_time = 0.5, release_time = 6.0, rest_time = 1.0;  // s
  std::vector<double> approach{0.02};  // m/s, tool's speed at the touch; one press for each entry
  double approach_from = 0.060;        // m, distance of the start from the touched point
  double approach_tilt = 0.5;          // rad, approach against the surface normal
  // Motion during the hold, which lasts as long: there and back along x of the surface's frame, m; peak
  // speed, m/s.
  double slide = 0.0, slide_speed = 0.030;
  std::int64_t repeats = 1;  // repeats of the whole list
  TremorForm tremor = TremorForm::sine;
  std::optional<SessionSpec> session;  // alternative to the presses above
  std::optional<ReachesSpec> reaches;  // alternative to the presses above
};

// A pusher outside of the machine pushes the haptic-tip into a rendered object [VHMR 2, Fig 3]. It pushes
// along the outward normal of the surface point nearest to W's origin. The scene has no hand-held tool.
struct PusherSpec {
  std::string object;    // rendered object to push; empty: the first
  double depth = 0.015;  // m, intended deflection, unless the force limits it
  double force = 30.0;   // N, the push ends at this force of the object
  double ramp_time = 2.0, hold_time = 8.0, rest_time = 1.0;  // s; rest: clear of the tip, before each push
  std::int64_t repeats = 1;
};

}  // namespace enc
