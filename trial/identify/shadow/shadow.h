// Shadow mode: the twin runs on a record and predicts each channel from the others. The result is the
// difference of record and prediction, with 95 % intervals. One estimator evaluates both the record and the
// prediction, so that both have equal errors (docs/guide/shadow.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/words.h"
#include "core/record/record.h"
#include "models/identify/block_fit.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

enum class Channel : std::uint8_t { machine, tool, force, rendering, clock };
constexpr auto words(Channel) { return enum_words("machine", "tool", "force", "rendering", "clock"); }

// Kinds of difference: record minus twin.
enum class Quantity : std::uint8_t {
  machine_time,   // s: delay of the machine's answer to its commands
  machine_place,  // m, an axis of W: reported beyond commanded position
  machine_rest,   // m rms: unexplained by these two
  registration,   // m, an axis of W, or away from the tip: offset of the tracked tool
  tool_latency,   // s: delay of the tracked tool
  tool_stamps,    // s: delay of its stamps after their true time
  stiffness,      // share: extra stiffness of the pressed object
  object_place,   // m: the object is this much nearer to the pressing tip
  force_time,     // s: delay of the measured force
  force_rest,     // N rms: unexplained by these three, beyond the twin's residual
  rendered,       // share: extra stiffness of the rendered object
  tool_noise,     // share: extra noise of the poses of a pressing tool
  tool_loss,      // share: missing poses of a pressing tool
  force_noise,    // share: extra noise of the force while no tool touches
  force_zero,     // N, an axis of F: force while no tool touches, without the weight
  force_turned    // rad: angle between the force of a press and the line between both tips
};
constexpr auto words(Quantity) {
  return enum_words("machine_time", "machine_place", "machine_rest", "registration", "tool_latency",
                    "tool_stamps", "stiffness", "object_place", "force_time", "force_rest",
                    "rendered_stiffness", "tool_noise", "tool_loss", "force_noise", "force_zero",
                    "force_turned");
}

struct Divergence {
  Channel channel{};
  Quantity quantity{};
  std::string axis;       // "x"; "away" from the tip; empty: no axis
  models::Interval off;   // SI
  double bound = kUnset;  // SI, from channels.h: a correct twin stays below it
  // True if beyond the bound, and beyond chance.
  [[nodiscard]] bool diverges() const;
  // True if this record does not determine it to within its bound, so that no conclusion is possible.
  [[nodiscard]] bool vague() const;
};

// A line about a channel: why this record does not allow a judgement, or additional information.
struct Remark {
  Channel channel{};
  std::string text;
};

struct Shadow {
  std::vector<Divergence> found;
  std::vector<Remark> gross;  // divergences too gross for a size, and the reasons
  std::vector<Remark> unjudged, facts;
  std::int64_t ticks = 0;
  double seconds = 0.0;
  [[nodiscard]] bool diverges() const;
};

// `twin`: the record's own set-up, or that with other numbers. Throws Error if the record has no tick, or
// another version.
[[nodiscard]] Shadow shadow(RecordReader& record, const std::string& path, const models::Setup& twin);

// The set-up of the record with the values of --set.
[[nodiscard]] models::Setup twin_of(const RecordReader& record, const std::string& path,
                                    const std::vector<std::string>& overrides);

}  // namespace enc::trial
