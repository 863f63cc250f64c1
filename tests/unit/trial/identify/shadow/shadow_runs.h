// Records of short runs of shipped scenes, with another truth than the twin's, and the findings of shadow
// mode.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trial/identify/shadow/shadow.h"

namespace enc::test {

// A run with much information in a short time.
struct ShadowedScene {
  std::string name;
  std::vector<std::string> set;  // settings of record and twin
};
// A real object is pressed; a tool is carried; a tool presses a rendered object.
[[nodiscard]] const ShadowedScene& probing();
[[nodiscard]] const ShadowedScene& carrying();
[[nodiscard]] const ShadowedScene& pressing();

// The record has `altered` on top of the scene, and the twin has `twin` on top of the record's settings.
[[nodiscard]] trial::Shadow shadowed(const ShadowedScene& scene, std::uint64_t seed,
                                     const std::vector<std::string>& altered = {},
                                     const std::vector<std::string>& twin = {});

// The record has the scene's own truth and altered frames: `alter` gets each frame and the share of the
// record before it.
using AlterFrame = std::function<void(RecordedTick& frame, double share)>;
[[nodiscard]] trial::Shadow shadowed_frames(const ShadowedScene& scene, std::uint64_t seed,
                                            const AlterFrame& alter,
                                            const std::vector<std::string>& twin = {});
// A record of one set-up beside another.
[[nodiscard]] trial::Shadow shadowed_beside(const models::Setup& recorded, std::uint64_t seed,
                                            const models::Setup& twin);

// A shipped scene, with its settings and the given ones.
[[nodiscard]] models::Setup set_up(const ShadowedScene& scene, const std::string& rig = "sim",
                                   const std::vector<std::string>& more = {});

// "tool registration x": all divergences, in order; then "tool gross" for those without a size.
[[nodiscard]] std::vector<std::string> named(const trial::Shadow& shadow);
// Null if the shadow has no such divergence.
[[nodiscard]] const trial::Divergence* found(const trial::Shadow& shadow, trial::Quantity quantity,
                                             const std::string& axis = {});

}  // namespace enc::test
