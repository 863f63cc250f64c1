// A hand repeats indentations A, B and C of [VHMR 4.2] on the virtual ball through the whole haptic loop. The
// error of Table 2 is the recorded force less the reference curve at the recorded deflection.
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

// Deflection and force of a press or a release, in the order of time.
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
// Errors against the press curve of a response, or against its release curve.
[[nodiscard]] Errors errors_of(const Branch& branch, const Response& reference, bool press);

// One recording of a press and its release. Pressing ends when the deflection first comes within 0.05 mm of
// the limit (or at its maximum if it never does). Releasing begins when it leaves that range for the last
// time. At the limit itself force rises with no deflection: that is the device's wall and no error of the
// ball.
struct Recording {
  Branch press, release;
};
[[nodiscard]] Recording split(const Branch& contact, double limit);

struct IndentRun {
  Recording recorded;  // input force of the ball's model, over the machine's own position
  Recording sensor;    // force before the filter over that position: free of weight, inertia and zero
  Recording truth;     // true contact force over the true deflection
  Branch loop;         // `recorded` plus the part at the limit: for the plots
  Response reference;
  double limit = kUnset;           // m
  double greatest = 0.0;           // m, true deflection
  double force_at_limit = kUnset;  // N, true (sources/hand 3)
  double noise = kUnset;           // N rms: force before the filter less true force, about the mean
  double tremor = kUnset;          // N rms: part of the true force near 8 Hz
  double simulated = 0.0;          // s
  std::int32_t contacts = 0;
};
// `base`: devices and conditions; the function sets seed and watch.
[[nodiscard]] IndentRun indent_run(const models::Setup& setup, std::uint64_t seed,
                                   const trial::TrialOptions& base = {});

// Spread of the hand from run to run: each value is drawn anew. [sources/hand 2]
struct HandSpread {
  double time = 0.10;  // press and release time, log-normal: indentations differ by more (2 to 20 mm/s), one
                       // person repeating one press by less
  double depth = 0.05e-3;   // m, sd, of the intended depth; instrument held still: 49 um rms
  double offset = 0.25e-3;  // m, sd, of the place: drift of a lay hand, 0.15 mm rms an axis
  double tilt = 5.0;        // deg, sd, of the approach
  double speed =
      0.3;  // approach speed, log-normal about the plan: the scene plans the speed of an indentation
};
// The set-up of run `number`: draws the hand's plan from the seed and the given settings.
[[nodiscard]] models::Setup varied(models::Setup setup, std::uint64_t seed, const HandSpread& spread = {});

// The scene of an indentation: `own` settings, then the user's, so that the user's win.
[[nodiscard]] models::Setup indent_setup(const std::string& models, const Indentation& which,
                                         const Words& own, const Words& user);
// A hand without tremor and drift: the remaining error is the machine's.
[[nodiscard]] const Words& still_hand();
// Runs with seeds first, first + 1, ..., each with its own hand, on all cores.
[[nodiscard]] std::vector<IndentRun> indent_runs(const models::Setup& setup, std::uint64_t first,
                                                 std::size_t count, const HandSpread& spread = {});

}  // namespace enc::bench::indentation
