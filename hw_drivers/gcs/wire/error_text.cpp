#include "hw_drivers/gcs/wire/error_text.h"

#include <algorithm>
#include <array>

namespace enc::gcs {
namespace {

constexpr std::string_view kReport = "report this: the driver sends nothing of the kind";
constexpr std::string_view kCome = "come back within the limits";
constexpr std::string_view kLook =
    "look at the machine, then switch the controller off and on and reference it";
constexpr std::string_view kSystem = "disable the coordinate system (KEN ZERO)";

// Error numbers of GCS 2.
constexpr std::array kMeanings = std::to_array<ErrorMeaning>({
    {0, "none", ""},
    {1, "parameter syntax", kReport},
    {2, "unknown command", "see that the controller speaks GCS 2 and its firmware is as the rig file says"},
    {3, "command too long", kReport},
    {5, "not referenced, or a servo is off", "reference it (FRF) and switch the servos on (SVO)"},
    {7, "position out of limits", kCome},
    {8, "velocity out of limits", "lower driver.gcs.velocity_mm_s"},
    {9, "the pivot cannot be moved while U, V or W is not 0", "move them to 0 first"},
    {10, "stopped by command", "see who else told it to stop, then begin anew"},
    {15, "no such axis", "see that a hexapod is connected to this controller"},
    {17, "parameter out of range", kReport},
    {22, "an axis twice", kReport},
    {23, "illegal axis", "see that a hexapod is connected to this controller"},
    {24, "wrong number of parameters", kReport},
    {25, "no number where one is expected", kReport},
    {26, "a parameter is missing", kReport},
    {27, "soft limit out of range", "correct the soft limits of the controller"},
    {34, "not allowed for this stage", "see that the hexapod is the one the controller is set up for"},
    {45, "referencing failed", "see that nothing is in the way of the platform, then reference it again"},
    {50, "referencing is disabled", "enable it in the controller's parameters"},
    {53, "not allowed in motion", "wait until it stands"},
    {54, "unknown parameter", kReport},
    {60, "command level too low", "raise it (CCL)"},
    {63, "initialisation is running", "wait until it is done"},
    {73, "the wave generator is active", "stop it (WGO)"},
    {89, "not allowed in this mode of motion", "leave the mode in the program that set it"},
    {200, "no stage is connected", "switch off, connect the hexapod, switch on"},
    {214, "the position could not be calculated", kLook},
    {215, "the connection to the hexapod is broken", "switch off, look at its cable, switch on"},
    {216, "a limit switch was met", kLook},
    {217, "a strut stopped", kLook},
    {500, "the red knob was pressed", "release it when all is clear, then reference the machine"},
    {502, "a check of consistency failed", kLook},
    {503, "a collision was foreseen", "give the platform room, or correct the controller's collision bodies"},
    {504, "a strut does not follow", "take load off the platform, then switch the servos on (SVO)"},
    {508, "not permitted now", "wait until the controller is ready"},
    {509, "emergency stop", "release it when all is clear, then switch the servos on (SVO)"},
    {530, "the coordinate system does not exist", kSystem},
    {531, "the coordinate system has no parent", kSystem},
    {532, "the coordinate system is in use", kSystem},
    {533, "coordinate systems linked in a circle", kSystem},
    {536, "coordinate systems cannot be changed in motion", "wait until it stands"},
    {537, "a coordinate system of this type cannot be enabled", kSystem},
    {539, "a coordinate system linked to itself", kSystem},
    {540, "a coordinate system is incomplete", kSystem},
    {542, "coordinate systems of different chains", kSystem},
    {544, "the pivot cannot be moved in this coordinate system", kSystem},
    {545, "soft limits are not valid in this coordinate system", kSystem},
    {546, "the coordinate system is write protected", kSystem},
    {556, "no coordinate system is enabled", kSystem},
    {557, "invalid name of a coordinate system", kSystem},
    {1024, "error of motion: it did not follow",
     "take load off the platform, then switch the servos on (SVO)"},
});

}  // namespace

std::span<const ErrorMeaning> error_meanings() noexcept { return kMeanings; }

std::string error_words(int number) {
  const auto* const found =
      std::find_if(kMeanings.begin(), kMeanings.end(), [&](const auto& one) { return one.number == number; });
  std::string words = "error " + std::to_string(number);
  if (found == kMeanings.end()) return words + ": look it up in the controller's manual (GCS 2)";
  words.append(": ").append(found->what);
  if (!found->to_do.empty()) words.append("; ").append(found->to_do);
  return words;
}

}  // namespace enc::gcs
