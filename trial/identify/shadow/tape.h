// The reader of a record for shadow mode, which plays it several times, and the parts of the twin that follow
// it. It reads tick by tick, so that a long record is never in memory as a whole, except for its machine's
// positions.
#pragma once

#include <functional>
#include <vector>

#include "core/control/scene/scene.h"
#include "core/record/record.h"
#include "models/setup/scene_file.h"
#include "sim/plants/tracker_plant.h"
#include "sim/world.h"

namespace enc::trial {

// Position of the machine at any time, interpolated between its reports by their stamps.
class TipTrace {
 public:
  void see(const Measurement<TipSample>& tip);  // call in the order of a record; ignores repeated reports
  [[nodiscard]] bool empty() const { return said_.empty(); }
  // True if the machine reported shortly before and after this time.
  [[nodiscard]] bool knows(Time t) const;
  // Outside of the known range, the first or last position holds. The trace must not be empty.
  [[nodiscard]] TipSample at(Time t) const;

 private:
  [[nodiscard]] std::size_t after(Time t) const;  // first later report
  std::vector<Measurement<TipSample>> said_;
};

// One row of a record, and the machine's health in it.
using SeeTick = std::function<void(const RecordedTick&)>;

struct Tape {
  RecordReader& record;
  const models::Setup& twin;
  const Scene& scene;  // the twin's
  TipTrace tip{};
  std::int64_t first = 0, last = -1;  // index of a tick
  Time begin{};
  bool sent = false;        // the machine received some command
  bool pressed = false;     // a finger or tool pressed a rendered object
  std::int64_t missed = 0;  // cycles

  Tape(RecordReader& from, const models::Setup& setup, const Scene& prepared);
  void play(const SeeTick& see) const;
  [[nodiscard]] double seconds() const { return static_cast<double>(last - first) * scene.dt; }
};

// True if the machine's report is reliable.
[[nodiscard]] bool is_well(const Measurement<TipSample>& tip);
// True if this tick's command was sent to the machine.
[[nodiscard]] bool was_sent(const RecordedTick& frame);
// True for a pose that came with this tick, of a tool of the scene. `newest`: stamp of the last one; it is
// updated.
[[nodiscard]] bool is_news(const Measurement<TrackedTool>& tool, const Scene& scene, Time& newest);

// The twin's machine under the commands of a record.
class ToldMachine {
 public:
  explicit ToldMachine(const Tape& tape);
  // Advances to the tick of this frame, before its command. A machine that begins anew takes its reported
  // pose.
  void advance(const RecordedTick& frame);
  void command(const Pose<'R', 'H'>& X_RH) { plant_.command(X_RH); }
  [[nodiscard]] bool known() const { return known_; }
  [[nodiscard]] TipSample said() const;

 private:
  void begin(const TipSample& at);
  sim::HexapodPlant plant_;
  int steps_;
  double timestep_;
  std::int64_t tick_ = 0;
  bool known_ = false;
};

// The twin's world with its machine at the record's poses, plus `shift` (in R, m).
using SeeWorld = std::function<void(Time t, const sim::World& world, const TipSample& led)>;
void lead_world(const Tape& tape, const models::Setup& twin, const Vec3& shift, const SeeWorld& see);

// Packets of the twin's trackers, one for each seed, for a true pose given tick by tick.
struct SeenPacket {
  // Times of the tick in which it came, and of its stamp.
  Time t{}, stamp{};
  TrackedTool tool;
};
class TwinTrackers {
 public:
  explicit TwinTrackers(const Tape& tape);
  void advance(Time t, std::int32_t tool, const Pose<'W', 'T'>& X_WT);
  [[nodiscard]] const std::vector<std::vector<SeenPacket>>& packets() const { return packets_; }

 private:
  const Scene& scene_;
  std::vector<sim::TrackerPlant> plants_;
  std::vector<Time> newest_;
  std::vector<std::vector<SeenPacket>> packets_;
};
[[nodiscard]] std::vector<SeenPacket> recorded_packets(const Tape& tape);

inline double in_seconds(Time t) { return seconds(t.time_since_epoch()); }

}  // namespace enc::trial
