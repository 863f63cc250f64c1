// Shadow mode: a record is fed to the twin, which says of each channel what it would have said, given what
// the record says of the others; and how far apart the two are, each with its 95 % interval. The same
// estimator looks at the record and at what the twin says, so that both have the same errors
// (docs/guide/shadow.md).
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/base/words.h"
#include "core/record/record.h"
#include "models/identify/block_error.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

enum class Channel : std::uint8_t { machine, tool, force, rendering, clock };
constexpr auto words(Channel) { return enum_words("machine", "tool", "force", "rendering", "clock"); }

// What may be apart: the record less the twin.
enum class Quantity : std::uint8_t {
  machine_time,   // s: the machine answers its commands so much later
  machine_place,  // m, an axis of W: it says that it is so much farther than it was told
  machine_rest,   // m rms: what neither explains
  registration,   // m, an axis of W, or away from the tip: the tool is seen so much farther
  tool_latency,   // s: what is seen of the tool comes so much later
  tool_stamps,    // s: its stamps are so much later than what they are of
  stiffness,      // share: the object that is pressed is so much stiffer
  object_place,   // m: that object stands so much nearer to what presses it
  force_time,     // s: what the sensor feels comes so much later
  force_rest,     // N rms: what these three leave over, more than the twin's leaves
  rendered        // share: the rendered object is so much stiffer
};
constexpr auto words(Quantity) {
  return enum_words("machine_time", "machine_place", "machine_rest", "registration", "tool_latency",
                    "tool_stamps", "stiffness", "object_place", "force_time", "force_rest",
                    "rendered_stiffness");
}

struct Divergence {
  Channel channel{};
  Quantity quantity{};
  std::string axis;       // "x"; "away" from the tip; empty: it has none
  models::Interval off;   // SI
  double bound = kUnset;  // SI, of bounds.h: what a twin that is right stays below
  // Farther off than the bound, and than chance.
  [[nodiscard]] bool diverges() const;
  // This record does not tell it to within its bound, so that nothing follows from it.
  [[nodiscard]] bool vague() const;
};

// A line about a channel: why it cannot be judged from this record, or what is only to be known.
struct Remark {
  Channel channel{};
  std::string text;
};

struct Shadow {
  std::vector<Divergence> found;
  std::vector<Remark> gross;  // diverges by more than has a size, and why
  std::vector<Remark> unjudged, facts;
  std::int64_t ticks = 0;
  double seconds = 0.0;
  [[nodiscard]] bool diverges() const;
};

// twin: the record's own set-up, or that with other numbers. Throws Error where the record has no tick, or is
// of another version.
[[nodiscard]] Shadow shadow(RecordReader& record, const std::string& path, const models::Setup& twin);

// The set-up of the record with what --set says put over it.
[[nodiscard]] models::Setup twin_of(const RecordReader& record, const std::string& path,
                                    const std::vector<std::string>& overrides);

}  // namespace enc::trial
