// Meaning and remedy of the numbers that ERR? returns.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace enc::gcs {

inline constexpr int kNoError = 0, kSyntax = 1, kUnknownCommand = 2, kTooLong = 3, kNotReady = 5,
                     kOutOfLimits = 7, kVelocityOutOfLimits = 8, kPivotWhileTurned = 9, kStopped = 10,
                     kNoSuchAxis = 15, kOutOfRange = 17, kAxisTwice = 22, kWrongCount = 24, kNoNumber = 25,
                     kMissing = 26, kNotInMotion = 53, kUnknownParameter = 54;

struct ErrorMeaning {
  int number;
  std::string_view what, to_do;
};
[[nodiscard]] std::span<const ErrorMeaning> error_meanings() noexcept;  // sorted by number

// "error 5: not referenced, or a servo is off; reference it and switch the servos on".
[[nodiscard]] std::string error_words(int number);

}  // namespace enc::gcs
