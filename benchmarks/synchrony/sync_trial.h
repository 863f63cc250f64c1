// The experiment of [VHMR 4.3, Fig 13] in the twin: scene `synchrony` through the whole loop. In each haptic
// cycle the deflection that the display has drawn and sent back is compared with the haptic-tip's own
// deflection, and with that of the true tool.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "models/setup/scene_file.h"

namespace enc::bench::synchrony {

// Lag of one signal behind another, by cross-correlation.

// The delay of `later` behind `earlier`, s, with the highest correlation (each without its mean); negative if
// `later` comes first. Both are sampled every `period` s. The search spans `most` s either way, with a
// parabola through the three highest between samples. NaN for too little signal, or if the highest is at the
// end of the search.
[[nodiscard]] double lag_of(std::span<const double> earlier, std::span<const double> later, double period,
                            double most);

// A cycle, m. A deflection is 0 without contact.
struct SyncSample {
  double t = 0.0;       // s
  double haptic = 0.0;  // hexapod's position against the buffered first touch, inwards along the normal there
  double visual = 0.0;  // depth of the drawn dent, as the core has received it by now
  double truth = 0.0;   // depth of the true tool tip below the undeformed surface
  double force = 0.0;   // true force of the tool on the haptic-tip, N
  bool contact = false;  // the core's mode: this sample counts
  bool news = false;     // a new packet of the display has arrived
};

struct SyncErrors {
  double mae = 0.0, rmse = 0.0, bias = 0.0;  // m; the bias is the mean, with its sign
};

struct SyncRun {
  std::vector<SyncSample> samples;
  std::array<double, 3> over{};  // m: deepest true haptic-tip less the limit, of each press
  std::int32_t contacts = 0;
  bool held = false;       // the machine was held by a fault
  double simulated = 0.0;  // s

  // Visual less haptic, visual less truth. During contact alone; at each cycle, or at each new packet.
  [[nodiscard]] SyncErrors against_haptic(bool at_packets = false) const;
  [[nodiscard]] SyncErrors against_truth() const;
  // The errors over all cycles from the first to the last contact, rests included.
  [[nodiscard]] SyncErrors with_rests() const;
  [[nodiscard]] double lag() const;         // s, visual behind haptic
  [[nodiscard]] double truth_lag() const;   // s, visual behind truth
  [[nodiscard]] double peak_speed() const;  // m/s, speed of the haptic-tip inwards, over 20 ms
  // Largest approach of the two tips' centres over the sum of their radii, m: the give of the contact.
  double given = 0.0;
};

[[nodiscard]] SyncRun run_sync(const models::Setup& setup, std::uint64_t seed);

}  // namespace enc::bench::synchrony
