// The channels. Each adds its results, or the reason why this record does not allow a judgement.
#pragma once

#include <string>
#include <vector>

#include "sim/plants/tracker_plant.h"
#include "sim/world.h"
#include "trial/identify/shadow/shadow.h"
#include "trial/identify/shadow/tape.h"

namespace enc::trial {

void see_machine(const Tape& tape, Shadow& shadow);   // commands -> the machine's reported poses
void see_tool(const Tape& tape, Shadow& shadow);      // machine's poses -> tracked poses of the tool
void see_probed(const Tape& tape, Shadow& shadow);    // probe's positions -> measured forces
void see_rendered(const Tape& tape, Shadow& shadow);  // measured forces -> displacement of the tip

// ---- shared by the channels
// ---------------------------------------------------------------------------------

// Number of simulated twins of a sensor, with different seeds for noise, drift and phases. Their scatter is
// the difference to expect from another run of this rig.
inline constexpr std::size_t kTwins = 32;
[[nodiscard]] inline std::uint64_t twin_seed(std::size_t i) { return 0x5ead0 + i; }
// Mean of their values, with the interval in which one more of them would lie. Unset values are left out.
[[nodiscard]] models::Interval of_twins(const std::vector<double>& values);
// The record's value minus that mean, including the record's own interval if it has one.
[[nodiscard]] models::Interval beside_twins(const models::Interval& recorded,
                                            const std::vector<double>& values);

void add(Shadow& shadow, Channel channel, Quantity quantity, const models::Interval& off, double bound,
         const std::string& axis = {});
// A divergence so gross that it has no size.
void diverges_grossly(Shadow& shadow, Channel channel, std::string how);
void cannot_judge(Shadow& shadow, Channel channel, std::string why);

// The twin's machine under the commands of a record.
class ToldMachine {
 public:
  explicit ToldMachine(const Tape& tape);
  // Advances to the tick of this frame, before its command; a machine that begins anew takes its reported
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

// The tool's tip in a packet, in W by the rig's calibration.
[[nodiscard]] inline Point<'W'> tip_of(const Scene& scene, const TrackedTool& tool) {
  return scene.X_WC * (tool.X_CT * scene.tools[static_cast<std::size_t>(tool.tool)].tip.centre);
}

// Age of packets beyond that of their stamps at arrival, s: mean, and interval from blocks of time.
[[nodiscard]] models::Interval mean_age(const std::vector<SeenPacket>& packets);
// A tool carried by the machine, and a tool that presses its tip.
void see_carried(const Tape& tape, const std::vector<SeenPacket>& recorded, Shadow& shadow);
void see_pressing(const Tape& tape, const std::vector<SeenPacket>& recorded, Shadow& shadow);
// Properties independent of both: age of packets by their stamps, and number of packets.
void see_ages(const Tape& tape, const std::vector<SeenPacket>& recorded,
              const std::vector<std::vector<SeenPacket>>& twins, bool judge, Shadow& shadow);

}  // namespace enc::trial
