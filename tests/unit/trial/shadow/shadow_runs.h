// Records of short runs of shipped scenes, with another truth than the twin's, and what shadow mode says of
// them.
#pragma once

#include <string>
#include <vector>

#include "trial/shadow/shadow.h"

namespace enc::test {

// A run that tells much in a short time.
struct ShadowedScene {
  std::string name;
  std::vector<std::string> set;  // of record and twin
};
// A real object is pressed; a tool is carried; a tool presses a rendered object.
[[nodiscard]] const ShadowedScene& probing();
[[nodiscard]] const ShadowedScene& carrying();
[[nodiscard]] const ShadowedScene& pressing();

// The record has `altered` besides what the scene has, and the twin has `twin` over that of the record.
[[nodiscard]] trial::Shadow shadowed(const ShadowedScene& scene, std::uint64_t seed,
                                     const std::vector<std::string>& altered = {},
                                     const std::vector<std::string>& twin = {});

// "tool registration x": of all that diverge, in order.
[[nodiscard]] std::vector<std::string> named(const trial::Shadow& shadow);
// Null where it is not in there.
[[nodiscard]] const trial::Divergence* found(const trial::Shadow& shadow, trial::Quantity quantity,
                                             const std::string& axis = {});

}  // namespace enc::test
