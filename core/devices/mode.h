// The mode of the machine and its reasons. Reasons are bits, because a tick can have several.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace enc {

// Each mode has a cause and ends with it. The last column is how long a mode may outlive its cause.
//
//   follow   a known tool is within the pause distance                                   at once
//   contact  the contact's own tool is within the leave gap; or a force is measured and
//            that tool is within 10 mm                                                   leave time
//            (before the first force, that tool may be within 10 mm for 0.5 s)
//            a force is measured and its own tool is seen clear of the object
//            (tare_clearance)                                                            0.5 s
//            a force is measured and that tool is out of view: the force varies, as a
//            hand's does; or it is steady and small, and the tool in view is clear       5 s
//            or it is steady and larger, or another tool is near the object              60 s
//            with a damper, the tip is deeper than the leave gap and no tool is within
//            10 mm                                                                       5 s
//   restore  the tip returns to the buffered point                                       2 s
//   hold     a reason to hold; for a machine that did not follow: the tool is still
//            there                                                                       at once
enum class Mode : std::uint8_t {
  // No tool, or beyond the pause distance: the tip waits in place [VHMR 3.3].
  away,
  // The tip tracks the surface point nearest to the tool, from just inside [VHMR 3.3].
  follow,
  // Tool and tip are engaged: the object's model places the tip by the measured force [VHMR 3.4].
  contact,
  restore,  // released: the tip returns to the buffered first-touch point [VHMR 3.4]
  hold,     // a fault: the tip stands still; `why` has the reasons
  // The procedures below keep a mode each: report, record and the column `mode` name what the machine does.
  // The machine itself presses and measures a real object, without rendering [VHMR 4.2].
  probe,
  // The machine carries a clamped tool past the tracker, without rendering [VHMR 4.1].
  travel
};
inline constexpr int kModes = 7;

enum Reason : std::uint32_t {
  // Reasons to hold.
  // Tracker sample not finite, not a rotation, absurdly far, of an unknown tool, or out of order.
  kToolInvalid = 1U << 0,
  kToolLost = 1U << 1,        // no tool pose for longer than the rig allows
  kForceInvalid = 1U << 2,    // force sample not finite or absurd
  kForceSaturated = 1U << 3,  // the sensor is at its range: its reading is a lower bound only
  kForceLost = 1U << 4,       // no force sample for longer than the rig allows
  kTipInvalid = 1U << 5,      // the machine's own pose is not finite or not reachable
  kTipLost = 1U << 6,         // no pose from the machine
  kDentWrong = 1U << 7,       // the visual surface names an unknown object or is impossible
  kDentOverdue = 1U << 8,     // the visual surface is too old
  kOutsideObject = 1U << 9,   // the tip is outside the undeformed object
  kOutsideDent = 1U << 10,    // the tip is outside the deformed surface by more than its age explains
  kClockLate = 1U << 11,      // cycles were missed
  kNotFinite = 1U << 12,      // the core's own target is not finite: a defect of the core
  kToolNotHeld = 1U << 13,    // the gripper has lost its tool or does not report
  kNotFollowing = 1U << 14,   // the machine is not at its commanded position
  kTrackerFault = 1U << 15,   // the tracker reports a fault, or its link is lost
  // Notices: the loop goes on.
  kToolPredicted = 1U << 16,  // tool pose older than usual
  kUnreachable = 1U << 17,    // target limited to the machine's reach
  kLimited = 1U << 18,        // target limited by speed or acceleration
  kAtLimit = 1U << 19,        // deflection limit reached
  kByForce = 1U << 20,        // this contact began by force, not by gap
  kTaring = 1U << 21,         // force zero not known yet
  kToolUnseen = 1U << 22,     // no tool in the tracker's view
  // The pressing force exceeds the payload: the tip stays at the deflection limit.
  kOverload = 1U << 24,
  kHot = 1U << 25,  // reduced force: the motors are warm
  // The surface point under the tool jumped: another part of the surface is as near.
  kSurfaceJump = 1U << 23,
  // The passivity controller reduced the force: the law would have given out more energy than was put in.
  kPassive = 1U << 26,
};
inline constexpr std::uint32_t kHoldReasons = 0xFFFFU;

[[nodiscard]] std::string_view mode_name(Mode mode);
// "tool lost, force saturated"; empty for 0.
[[nodiscard]] std::string why_text(std::uint32_t why);

}  // namespace enc
