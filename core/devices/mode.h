// What the machine is doing, and why. Reasons are bits, so that a tick can have several.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace enc {

// Each mode has a cause, and is over when that is:
//
//   follow   a tool that is known is within the pause distance                                   at once
//   contact  the contact's own tool is within the leave gap; or force is felt and that tool is    leave time
//            within 10 mm. Before force was first felt: that tool is within 10 mm, for 0.5 s
//            force is felt and its own tool is seen clear of the object (tare_clearance)          0.5 s
//            force is felt and that tool is out of view: the force varies, as a hand's does;
//            or it is steady and small, and the tool in view is clear                             5 s
//            or it is steady and larger, or another tool is near the object                       60 s
//            behind a damper, the tip is deeper than the leave gap and no tool is 10 mm away      5 s
//   restore  the tip is on its way to the buffered point                                         2 s
//   hold     a reason to hold; of a machine that did not follow: the tool is still there         at once
//
// (the last column: how long a mode may outlive its cause).
enum class Mode : std::uint8_t {
  away,     // no tool, or farther than the pause distance: the tip waits where it is [VHMR 3.3]
  follow,   // the tip tracks the surface point nearest to the tool, from just inside [VHMR 3.3]
  contact,  // tool and tip are engaged: the tip is where the object's model puts it under the measured force
            // [VHMR 3.4]
  restore,  // released: the tip returns to the buffered first-touch point [VHMR 3.4]
  hold,     // something is wrong: the tip stands still; `why` says what
  probe,    // the machine itself presses a real object and measures it: nothing is rendered [VHMR 4.2]
  travel    // it carries a clamped tool past the tracker: nothing is rendered [VHMR 4.1]
};
inline constexpr int kModes = 7;

enum Why : std::uint32_t {
  // Reasons to hold.
  kToolInvalid =
      1U << 0,  // tracker sample not finite, not a rotation, absurdly far, unknown tool, or out of order
  kToolLost = 1U << 1,        // no tool pose for longer than the rig allows
  kForceInvalid = 1U << 2,    // force sample not finite or absurd
  kForceSaturated = 1U << 3,  // the sensor is at its range: its reading is a lower bound only
  kForceLost = 1U << 4,       // no force sample for longer than the rig allows
  kTipInvalid = 1U << 5,      // the machine's own pose is not finite or not reachable
  kTipLost = 1U << 6,         // no pose from the machine
  kDentWrong = 1U << 7,       // the visual surface names an unknown object or cannot be
  kDentOverdue = 1U << 8,     // the visual surface is too old
  kOutsideObject = 1U << 9,   // the tip is outside the undeformed object
  kOutsideDent = 1U << 10,    // the tip is outside the deformed surface by more than its age excuses
  kClockLate = 1U << 11,      // cycles were missed
  kNotFinite = 1U << 12,      // the core's own target is not finite: a defect, caught
  kToolNotHeld = 1U << 13,    // the gripper has lost its tool, or says nothing
  kNotFollowing = 1U << 14,   // the machine is not where its commands have sent it
  kTrackerFault = 1U << 15,   // the tracker says that it is at fault, or its link is lost
  // Notices: the loop goes on.
  kToolPredicted = 1U << 16,  // tool pose older than usual
  kUnreachable = 1U << 17,    // target clamped to what the machine reaches
  kLimited = 1U << 18,        // target clamped to speed or acceleration
  kAtLimit = 1U << 19,        // deflection limit reached
  kByForce = 1U << 20,        // this contact was found by force, not by gap
  kTaring = 1U << 21,         // force zero not known yet
  kToolUnseen = 1U << 22,     // no tool in the tracker's view
  kOverload = 1U << 24,       // pressed harder than the machine carries: it stands at the deflection limit
  kHot = 1U << 25,            // pushed less than it should: the motors are warm
  kSurfaceJump = 1U << 23,    // the surface point under the tool jumped: it is as near to another part
  kPassive = 1U << 26,        // pushed less than the law asked: more would have come out than was put in
};
inline constexpr std::uint32_t kHoldReasons = 0xFFFFU;

[[nodiscard]] std::string_view mode_name(Mode mode);
// "tool lost, force saturated"; empty for 0.
[[nodiscard]] std::string why_text(std::uint32_t why);

}  // namespace enc
