#include <array>
#include <utility>

#include "core/devices/mode.h"

namespace enc {

std::string_view mode_name(Mode mode) {
  static constexpr std::array<std::string_view, kModes> kNames{"away", "follow", "contact", "restore",
                                                               "hold", "probe",  "travel"};
  return kNames[static_cast<std::size_t>(mode)];
}

std::string why_text(std::uint32_t why) {
  static constexpr auto kTexts = std::to_array<std::pair<Reason, std::string_view>>(
      {{kToolInvalid, "tool pose invalid"},
       {kToolLost, "tool lost"},
       {kForceInvalid, "force invalid"},
       {kForceSaturated, "force sensor saturated"},
       {kForceLost, "force lost"},
       {kTipInvalid, "machine pose invalid"},
       {kTipLost, "machine pose lost"},
       {kDentWrong, "visual surface wrong"},
       {kDentOverdue, "visual surface overdue"},
       {kOutsideObject, "tip outside the object"},
       {kOutsideDent, "tip outside the visual surface"},
       {kClockLate, "clock late"},
       {kNotFinite, "target not finite"},
       {kToolNotHeld, "gripper holds no tool"},
       {kNotFollowing, "machine does not follow its commands"},
       {kTrackerFault, "tracker lost or at fault"},
       {kToolPredicted, "tool pose old"},
       {kUnreachable, "target out of reach"},
       {kLimited, "speed or acceleration limited"},
       {kAtLimit, "deflection limit"},
       {kByForce, "contact by force"},
       {kTaring, "force zero not known yet"},
       {kToolUnseen, "no tool in view"},
       {kHot, "motors warm: pushed less than it should"},
       {kOverload, "pressed harder than the machine carries"},
       {kSurfaceJump, "nearest point jumped"},
       {kPassive, "push held back to stay passive"}});
  std::string text;
  for (const auto& [bit, words] : kTexts) {
    if ((why & bit) == 0) continue;
    if (!text.empty()) text += ", ";
    text += words;
  }
  return text;
}

}  // namespace enc
