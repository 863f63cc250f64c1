// What each channel of a record may be off by where the twin is right. None of them is fitted to a result:
// each is what noise, drift, steps and clocks of the devices leave, rounded up, and stands with its reason.
// What a certain record leaves is its interval; a bound that is smaller than that is no verdict.
#pragma once

#include "core/base/frames.h"

namespace enc::trial::bounds {

// Commands go out and poses come in once a cycle of 1 kHz: nobody sees less than that.
inline constexpr double kMachineTime = 1.0e-3;  // s
// The twin has no wire. Where the driver sends set-points in cycles of its own, one waits for up to a cycle,
// and the answer is asked for up to half a cycle later. Of each cycle:
inline constexpr double kMachineCycles = 1.5;
// Commands are rounded to 3 um, a move ends within some 0.5 um rms, and a wire's numbers to 0.1 um: 10 um on
// each axis holds all of them at their worst, and as much for a machine that was told to be elsewhere in
// between.
inline constexpr double kMachinePlace = 20e-6;  // m
// Where it moves or where it stands, whichever is more, beside its lag, which is a time: a set-point that is
// taken a cycle earlier or later than its neighbours is 50 um at 50 mm/s. Steps are 3 um, and a servo of 15
// Hz that is 5 % off is 7 um more or less behind while it speeds up with 0.41 m/s^2.
inline constexpr double kMachineRest = 50e-6;  // m rms
// A pose scatters by 0.02 mm; bias that turns with the direction, and the line between two round tips whose
// sideways place is known to a few tenths, add up to 0.1 mm in a single stop. Twice that.
inline constexpr double kRegistration = 0.2e-3;  // m
// Cameras at 120 Hz and a server at 100 Hz, each begun at any time, wait for each other by 1/600 s more or
// less, the same in all of a run: 0.83 ms to either side of the mean; a packet is noticed at the next cycle,
// 0.5 ms to either side. Together 1.33 ms.
inline constexpr double kToolLatency = 1.5e-3;  // s
// They are held against the machine's pose, which is asked for and answered: it may be a cycle older than its
// own stamp, and so may the clock be by which a wire's stamps are read.
inline constexpr double kToolStamps = 2.0e-3;  // s
// The zero walks by 0.002 N/sqrt(s), 0.01 N in the 20 s of a slow push, and steps are 0.025 N: of the 2 N
// with which half of a press is felt, some 1 %. As much for 10 um of place in 1 mm of depth.
inline constexpr double kStiffness = 0.02;  // share
// Force steps of 0.025 N are 0.02 mm on an object of 1 N/mm; where it begins to give way is known to several
// of them.
inline constexpr double kObjectPlace = 0.1e-3;  // m
// Likewise: force and pose of one cycle may be read a cycle apart, on either side of each.
inline constexpr double kForceTime = 2.0e-3;  // s
// What neither size nor place nor time explains, beside what the twin's own sensor leaves: 2 % of the 2 N
// that half of a press is felt with. Another law of the object is above it, and so is a sensor of 0.05 N rms.
inline constexpr double kForceRest = 0.04;  // N rms
// As kStiffness, with the machine's 3 um steps and its lag in place of the place.
inline constexpr double kRendered = 0.02;  // share

}  // namespace enc::trial::bounds
