// What shadow mode reads of a record, again and again: tick by tick, so that a long record is never in memory
// as a whole, but for where its machine was.
#pragma once

#include <functional>
#include <vector>

#include "core/control/scene/scene.h"
#include "core/record/record.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

// Where the machine was at any time, between what it said with its own stamps.
class TipTrace {
 public:
  void see(const Stamped<TipSample>& tip);  // in the order of a record; what is said twice is no news
  [[nodiscard]] bool empty() const { return said_.empty(); }
  // It was heard of on both sides, and not long before or after.
  [[nodiscard]] bool knows(Time t) const;
  // Beyond what is known it stands where it was first or last seen. Not for an empty trace.
  [[nodiscard]] TipSample at(Time t) const;

 private:
  [[nodiscard]] std::size_t after(Time t) const;  // first that was said later
  std::vector<Stamped<TipSample>> said_;
};

// One row of a record, and the machine's health in it.
using SeeTick = std::function<void(const RecordedTick&)>;

struct Tape {
  RecordReader& record;
  const models::Setup& twin;
  const Scene& scene;  // of the twin
  TipTrace tip{};
  std::int64_t first = 0, last = -1;  // index of a tick
  Time begin{};
  bool sent = false;        // some command went to the machine
  bool pressed = false;     // by a rendered object's finger or tool
  std::int64_t missed = 0;  // cycles

  Tape(RecordReader& from, const models::Setup& setup, const Scene& prepared);
  void play(const SeeTick& see) const;
  [[nodiscard]] double seconds() const { return static_cast<double>(last - first) * scene.dt; }
};

// What the machine says can be believed.
[[nodiscard]] bool is_well(const Stamped<TipSample>& tip);
// Its command of this tick went to it.
[[nodiscard]] bool was_sent(const RecordedTick& frame);
// A pose that came with this tick, of a tool of the scene. `newest`: stamp of the last one; is moved on.
[[nodiscard]] bool is_news(const Stamped<TrackedTool>& tool, const Scene& scene, Time& newest);

inline double in_seconds(Time t) { return seconds(t.time_since_epoch()); }

}  // namespace enc::trial
