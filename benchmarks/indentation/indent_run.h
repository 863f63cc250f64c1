// Indentations A, B and C of [VHMR 4.2], replicated by a hand on the virtual ball through the whole haptic
// loop, and the error of Table 2: recorded force less the reference curve at the recorded deflection.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/shape/response/response.h"
#include "models/setup/scene_file.h"
#include "trial/trial.h"

namespace enc::bench::indentation {

using Words = std::vector<std::string>;

// One column pair of Table 2, as settings of the scene `indentation`.
struct Indentation {
  const char* name;
  Words set;
};
[[nodiscard]] const std::array<Indentation, 3>& indentations();

// Deflection and force of one way, in the order of time.
struct Branch {
  std::vector<double> deflection, force;  // m, N
  [[nodiscard]] std::size_t size() const { return force.size(); }
  void add(double d, double f) {
    deflection.push_back(d);
    force.push_back(f);
  }
};
struct Errors {
  double rmse = kUnset, mae = kUnset, mean = kUnset;  // N: root of the mean of e^2, mean of |e|, mean of e
};
// Against the press curve of a response, or against its release curve.
[[nodiscard]] Errors errors_of(const Branch& branch, const Response& reference, bool press);

// One recording of a press and its release. Pressing ends when the deflection first comes within 0.05 mm of
// the limit (or, where it does not, at its greatest); releasing begins when it leaves that for the last time.
// At the limit itself force rises with no deflection: that is the device's wall and no error of the ball.
struct Recording {
  Branch press, release;
};
[[nodiscard]] Recording split(const Branch& contact, double limit);

struct IndentRun {
  Recording recorded;  // the force that the ball's model is given, over the machine's own position
  Recording sensor;    // the same position, and the force before the filter: free of weight, inertia and zero
  Recording truth;     // true contact force over the true deflection
  Branch loop;         // as `recorded`, with what lies at the limit: for the plots
  Response reference;
  double limit = kUnset;           // m
  double greatest = 0.0;           // m, true deflection
  double force_at_limit = kUnset;  // N, true (sources/hand 3)
  double simulated = 0.0;          // s
  std::int32_t contacts = 0;
};
// `base`: with what devices and under which conditions; seed and watch are set here.
[[nodiscard]] IndentRun indent_run(const models::Setup& setup, std::uint64_t seed,
                                   const trial::TrialOptions& base = {});

// How a hand differs from one run to the next: each of these is drawn anew. [sources/hand 2]
struct HandSpread {
  double time = 0.10;       // of the press and the release time, log-normal: indentations differ by more
                            // (2 to 20 mm/s), one person repeating one press by less
  double depth = 0.05e-3;   // m, sd, of the wanted depth; instrument held still: 49 um rms
  double offset = 0.25e-3;  // m, sd, of the place: drift of a lay hand, 0.15 mm rms an axis
  double tilt = 5.0;        // deg, sd, of the approach
  double speed =
      0.3;  // of the approach, log-normal about the plan: the scene plans the speed of an indentation
};
// The set-up of run `number`: the hand's plan is drawn from the seed and what is set.
[[nodiscard]] models::Setup varied(models::Setup setup, std::uint64_t seed, const HandSpread& spread = {});

// The scene of an indentation: `own` settings, then the user's, so that the user's win.
[[nodiscard]] models::Setup indent_setup(const std::string& models, const Indentation& which,
                                         const Words& own, const Words& user);
// A hand that neither trembles nor drifts: what is left is the machine's.
[[nodiscard]] const Words& still_hand();
// Runs with seeds first, first + 1, ..., each with a hand of its own, on all cores.
[[nodiscard]] std::vector<IndentRun> indent_runs(const models::Setup& setup, std::uint64_t first,
                                                 std::size_t count);

}  // namespace enc::bench::indentation
