// Parts of the benchmark `stability`: the certificate's predictions beside MuJoCo's results; and its maps:
// the outcome of a disturbance over stiffness and delay, in small multiples, with the bounds drawn in.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "benchmarks/kit/kit.h"
#include "benchmarks/stability/slide.h"
#include "core/control/safety/certificate/certificate.h"

namespace enc::bench::stability {

// The certificate's input for a device.
[[nodiscard]] certificate::SampledLoop loop_of(const Device& device);
[[nodiscard]] certificate::Steps steps_of(const Device& device);
// The device as the certificate is given it; a mutant has ten times its damping and friction.
[[nodiscard]] Device believed(const BenchContext& context, Device device);

// MuJoCo's outcome as a value of the certificate.
[[nodiscard]] certificate::Rest same_as(Outcome outcome);

// Predictions beside outcomes. A place counts as predicted only if both are known.
struct Agreement {
  double places = 0.0, rest = 0.0, same = 0.0;  // rest: yes or no; same: limit cycles as well
  void see(certificate::Rest told, certificate::Rest seen);
};

// The larger of two; NaN if one of them is.
[[nodiscard]] double worse(double a, double b);
void add_passivity(Bench& bench);  // energy output of a wall with the core's controller in its loop
void add_spare(Bench& bench);      // energy output of the hexapod in the twin
void add_regions(Bench& bench);    // regions with friction and counts: damping x delay, and a map

inline constexpr std::array kDelays{0.0, 0.2e-3, 0.5e-3, 1e-3, 2e-3, 5e-3, 10e-3, 20e-3, 50e-3};  // s
inline constexpr double kSoftest = 1e-2, kHardest = 1e6;                                          // N/m

// The operator models: no hand, a finger, and a pen's grip [sources/hand 1]; `firm` is a clenched grip.
struct Grip {
  const char* name;
  certificate::Hand hand;
};
inline const std::array<Grip, 3> kGrips{Grip{"nobody", {}}, Grip{"a fingertip", {6e-3, 2.0, 300.0}},
                                        Grip{"a firm grip", {0.15, 10.0, 2000.0}}};
[[nodiscard]] Device held_by(Device device, const Grip& grip);

// Words for certificate::Rest, in its order.
inline constexpr std::array kRestWords{"rests", "limit cycle", "runs away", "not known"};
[[nodiscard]] inline const char* words_of(certificate::Rest rest) {
  return kRestWords[static_cast<std::size_t>(rest)];
}

// Even logarithmic steps: decades; two in a quick run, quarters in a full one.
[[nodiscard]] std::vector<double> stiffnesses(const BenchContext& context);

// A plot of panels over the delays; values outside it become gaps.
class Map {
 public:
  Map(std::string id, std::string title, std::vector<std::string> panels, std::size_t columns);
  void cell(std::size_t panel, std::size_t delay, double stiffness, certificate::Rest rest);
  void line(const std::string& name, std::size_t panel, std::size_t delay, double stiffness);

  void add_to(Bench& bench, std::string caption);

 private:
  Series& series(const std::string& name, std::size_t panel, Mark mark);
  Plot plot_;
};

// Random places of some panels, drawn by the user's seed. `share`, 0 to 1, is for the stiffness.
struct Place {
  std::size_t panel, delay;
  double share;
};
[[nodiscard]] std::vector<Place> random_places(const BenchContext& context, std::size_t panels,
                                               std::size_t count, std::uint64_t stream);
// N/m: near the boundary, up to 30 times softer and stiffer, to expose a wrong boundary; within the map.
[[nodiscard]] double about(double boundary, double share);

void add_wall_maps(Bench& bench);       // stiffness x delay x period x grip, and x damping of both
void add_admittance_map(Bench& bench);  // map of a machine that measures force
void add_widths(Bench& bench);          // softest to stiffest, beside published devices

}  // namespace enc::bench::stability
