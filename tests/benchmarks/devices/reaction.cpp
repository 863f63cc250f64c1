#include "tests/benchmarks/devices/reaction.h"

#include <fmt/format.h>

namespace enc::bench::devices {

std::string wrong_with(const Limits& limits, Mode mode, const Reaction& of) {
  std::string wrong;
  const auto say = [&](bool bad, const std::string& what) {
    if (bad) wrong += (wrong.empty() ? "" : "; ") + what;
  };
  say(of.in != mode, fmt::format("it was in {}", mode_name(of.in)));
  const bool lost = limits.end == End::link_lost;
  say(of.linked == lost, lost ? "the link came back" : "the link is lost");
  say(!(of.zero <= limits.zero), fmt::format("force until {} ms, at most {}", of.zero, limits.zero));
  say(of.goes_on == lost, lost ? "it goes on by itself" : "it does not go on: " + why_text(of.why));
  if (mode != Mode::hold) {
    if (limits.end == End::unharmed) {
      say(of.hold < kNever, fmt::format("held after {} ms: {}", of.hold, why_text(of.why)));
    } else {
      say(!(of.hold <= limits.hold), fmt::format("held after {} ms, at most {}", of.hold, limits.hold));
      say((of.why & limits.why) == 0, "held for another reason: " + why_text(of.why));
    }
  }
  return wrong.empty() ? wrong : wrong + (of.said.empty() ? "" : " (" + of.said + ")");
}

}  // namespace enc::bench::devices
