// The channels, each of which adds what it found, or why it cannot be judged from this record.
#pragma once

#include <string>
#include <vector>

#include "sim/plants/tracker_plant.h"
#include "sim/world.h"
#include "trial/identify/shadow/shadow.h"
#include "trial/identify/shadow/tape.h"

namespace enc::trial {

void see_machine(const Tape& tape, Shadow& shadow);   // what it was told -> where it says it was
void see_tool(const Tape& tape, Shadow& shadow);      // where the machine was -> where the tool was seen
void see_probed(const Tape& tape, Shadow& shadow);    // where a probe was -> what the sensor felt
void see_rendered(const Tape& tape, Shadow& shadow);  // what the sensor felt -> how far the tip gave way

// ---- what they share -------------------------------------------------------------------------------------

// How many twins of a sensor are asked: as many seeds, which have noise, drift and phases of their own. What
// they scatter by is what another run of the same rig differs by.
inline constexpr std::size_t kTwins = 32;
[[nodiscard]] inline std::uint64_t twin_seed(std::size_t i) { return 0x5ead0 + i; }
// Mean of what they say, with the interval in which one more of them would lie. Unset values are left out.
[[nodiscard]] models::Interval of_twins(const std::vector<double>& values);
// What the record says less that: its own interval counts where it has one.
[[nodiscard]] models::Interval beside_twins(const models::Interval& recorded,
                                            const std::vector<double>& values);

void add(Shadow& shadow, Channel channel, Quantity quantity, const models::Interval& off, double bound,
         const std::string& axis = {});
// So far off that no size is found for it.
void diverges_grossly(Shadow& shadow, Channel channel, std::string how);
void cannot_judge(Shadow& shadow, Channel channel, std::string why);

// The twin's machine as a record tells it what to do.
class ToldMachine {
 public:
  explicit ToldMachine(const Tape& tape);
  // To the tick of this frame, before it is told anything; a machine that begins anew is where it says it is.
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

// The twin's world with its machine where the record's was, `shift` further (in R, m).
using SeeWorld = std::function<void(Time t, const sim::World& world, const TipSample& led)>;
void lead_world(const Tape& tape, const models::Setup& twin, const Vec3& shift, const SeeWorld& see);

// Packets of the twin's tracker, of each seed, for a true pose that is told tick by tick.
struct SeenPacket {
  Time t{}, stamp{};  // of the tick in which it came
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

// The tool's tip of a packet, in W as the rig believes.
[[nodiscard]] inline Point<'W'> tip_of(const Scene& scene, const TrackedTool& tool) {
  return scene.X_WC * (tool.X_CT * scene.tools[static_cast<std::size_t>(tool.tool)].tip.centre);
}

// s by which packets are older than their stamps say when they come: mean, and what blocks of time say.
[[nodiscard]] models::Interval mean_age(const std::vector<SeenPacket>& packets);
// A tool that the machine carries, and one that presses its tip.
void see_carried(const Tape& tape, const std::vector<SeenPacket>& recorded, Shadow& shadow);
void see_pressing(const Tape& tape, const std::vector<SeenPacket>& recorded, Shadow& shadow);
// Of what is neither: how old packets are by their stamps; and how many come.
void see_ages(const Tape& tape, const std::vector<SeenPacket>& recorded,
              const std::vector<std::vector<SeenPacket>>& twins, bool judge, Shadow& shadow);

}  // namespace enc::trial
