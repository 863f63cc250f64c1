// The channels and their bounds. Each channel adds its results, or the reason why this record does not allow
// a judgement.
#pragma once

#include <string>
#include <vector>

#include "core/base/units.h"
#include "trial/identify/shadow/shadow.h"
#include "trial/identify/shadow/tape.h"

namespace enc::trial {

// Largest deviation of each channel of a record for a correct twin. These bounds are not fitted to a result:
// each follows from noise, drift, steps and clocks of the devices, rounded up, and has its reason here. The
// residual of a certain record is its interval; a bound smaller than that gives no verdict.
namespace bounds {

// Commands go out and poses come in once a cycle of 1 kHz: a smaller time is not visible.
inline constexpr double kMachineTime = 1.0e-3;  // s
// The twin has no protocol. If the driver sends set-points in its own cycles, one waits for up to a cycle.
// The answer is requested up to half a cycle later. Share of each cycle:
inline constexpr double kMachineCycles = 1.5;
// Commands are rounded to 3 um, a move ends within some 0.5 um rms, and the numbers of a protocol are rounded
// to 0.1 um: 10 um on each axis covers the worst case of all. The same amount covers a machine that was
// commanded elsewhere in between.
inline constexpr double kMachinePlace = 20e-6;  // m
// The larger of moving and standing error, beyond the lag, which is a time. A set-point taken a cycle earlier
// or later than its neighbours is 50 um at 50 mm/s. Steps are 3 um. A servo of 15 Hz that is 5 % off lags 7
// um more or less while it accelerates with 0.41 m/s^2.
inline constexpr double kMachineRest = 50e-6;  // m rms
// A pose scatters by 0.02 mm. Two more errors add up to 0.1 mm in a single stop: bias that rotates with the
// direction, and the line between two round tips with sideways positions known to a few tenths. The bound is
// twice that.
inline constexpr double kRegistration = 0.2e-3;  // m
// Cameras at 120 Hz and a server at 100 Hz, each with a random start, wait for each other by 1/600 s more or
// less. That is constant in a run: 0.83 ms to either side of the mean. A packet is noticed at the next cycle,
// 0.5 ms to either side. Together 1.33 ms.
inline constexpr double kToolLatency = 1.5e-3;  // s
// Stamps are compared with the machine's pose, which is queried: it may be a cycle older than its own stamp,
// and so may the clock that reads the stamps of a protocol.
inline constexpr double kToolStamps = 2.0e-3;  // s
// The zero drifts by 0.002 N/sqrt(s), 0.01 N in the 20 s of a slow push, and steps are 0.025 N. That is some
// 1 % of 2 N, the force of half of a press. Another 1 % is for 10 um of position in 1 mm of depth.
inline constexpr double kStiffness = 0.02;  // share
// Force steps of 0.025 N are 0.02 mm on an object of 1 N/mm; the point at which it begins to yield is known
// to several of them.
inline constexpr double kObjectPlace = 0.1e-3;  // m
// Force and pose of one cycle may be read a cycle apart, on either side of each.
inline constexpr double kForceTime = 2.0e-3;  // s
// Residual beyond stiffness, position and time, in addition to that of the twin's own sensor: 2 % of 2 N, the
// force of half of a press. Another law of the object is above it, and so is a sensor with 0.05 N rms.
inline constexpr double kForceRest = 0.04;  // N rms
// As kStiffness, with the machine's 3 um steps and its lag in place of the position.
inline constexpr double kRendered = 0.02;  // share
// Second differences of two seconds of poses, and of forces, give their noise within 10 %. A pressing hand
// and the machine's servo add to it what the twin's sensors do not have. Noise half as large again is beyond
// them.
inline constexpr double kNoise = 0.5;  // share
// The phase of the clocks decides about one pose at each end of a contact. Ten presses of half a second have
// ten poses in 500 more or less, and a wired network loses fewer.
inline constexpr double kLoss = 0.05;  // share
// The zero of a sensor at its start is normal. A correct twin exceeds this multiple of its rms in 0.02 % of
// the records, over three axes.
inline constexpr double kZeros = 4.0;
// The direction of a force near its threshold. The line between both tips turns by the registration,
// kRegistration along each axis across it, over its length. Friction holds a tool that touches beside the
// middle: its force may point anywhere between that line and the way on which the object yields.
inline constexpr double kTurned = 2.0 / kDegPerRad;  // rad, plus those two

}  // namespace bounds

void see_machine(const Tape& tape, Shadow& shadow);   // commands -> the machine's reported poses
void see_tool(const Tape& tape, Shadow& shadow);      // machine's poses -> tracked poses of the tool
void see_probed(const Tape& tape, Shadow& shadow);    // probe's positions -> measured forces
void see_rendered(const Tape& tape, Shadow& shadow);  // measured forces -> displacement of the tip
void see_sensor(const Tape& tape, Shadow& shadow);    // untouched force sensor of a rendered object

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

// The tool's tip in a packet, in W by the rig's calibration.
[[nodiscard]] inline Point<'W'> tip_of(const Scene& scene, const TrackedTool& tool) {
  return scene.X_WC * (tool.X_CT * scene.tools[static_cast<std::size_t>(tool.tool)].tip.centre);
}

}  // namespace enc::trial
