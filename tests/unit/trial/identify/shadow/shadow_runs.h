// Records of short runs of shipped scenes, with another truth than the twin's, and what shadow mode finds.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "trial/identify/shadow/shadow.h"

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

// The same of a record with the scene's own truth, whose frames are altered: each, and its share of the
// record that is before it.
using AlterFrame = std::function<void(RecordedTick& frame, double share)>;
[[nodiscard]] trial::Shadow shadowed_frames(const ShadowedScene& scene, std::uint64_t seed,
                                            const AlterFrame& alter,
                                            const std::vector<std::string>& twin = {});
// A record of one set-up beside another.
[[nodiscard]] trial::Shadow shadowed_beside(const models::Setup& recorded, std::uint64_t seed,
                                            const models::Setup& twin);

// A shipped scene, with what is set of it and besides.
[[nodiscard]] models::Setup set_up(const ShadowedScene& scene, const std::string& rig = "sim",
                                   const std::vector<std::string>& more = {});

// "tool registration x": of all that diverge, in order; "tool gross" of what has no size, behind them.
[[nodiscard]] std::vector<std::string> named(const trial::Shadow& shadow);
// Null where it is not in there.
[[nodiscard]] const trial::Divergence* found(const trial::Shadow& shadow, trial::Quantity quantity,
                                             const std::string& axis = {});

}  // namespace enc::test
