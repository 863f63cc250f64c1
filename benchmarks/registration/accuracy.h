// How good a registration is, over many seeds of camera noise and over the number of pairs and of frames of
// each: the places are visited once, with the most of both, the camera sees them anew for each seed, and
// fewer are taken from their beginning.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "benchmarks/registration/guided.h"

namespace enc::bench {

// What a registration works on: the arm as believed and as it is, and the camera where it really is.
struct RegistrationRig {
  ArmMachine believed;
  sim::ArmTruth arm;
  double least_dexterity = 0.15;
  Pose<'W', 'C'> X_WC;
  sim::CameraTruth camera;
};

// The places of the tip that a rig offers, and which of them are used and judged.
struct RegistrationPlaces {
  std::vector<Point<'W'>> visited;  // well spread, the most that are used
  std::vector<Point<'W'>> targets;  // all over the volume in view
  std::vector<double> distance;     // of each target from the middle of the volume, m
};
[[nodiscard]] RegistrationPlaces places_of(const RegistrationRig& rig, std::size_t most_pairs);

// One number of pairs and of frames; vectors are over seeds. Errors along W's axes, m.
struct Accuracy {
  std::size_t pairs = 8, frames = 20;
  std::vector<Vec3> residual;        // mean |error| left over at the pairs
  std::vector<Vec3> held_out;        // mean |error| of the registration itself at the targets
  std::vector<Vec3> position;        // |error| of the camera's own place
  std::vector<double> turn;          // rad
  std::vector<double> scale;         // camera's size over the device's
  std::vector<double> square;        // at each target, mean over seeds, m^2
  double seconds = kUnset;           // of experiment
  [[nodiscard]] double rms() const;  // over targets and seeds, m
  [[nodiscard]] double rms_at(std::size_t from, std::size_t to) const;  // of some targets
};

struct AccuracyStudy {
  std::vector<std::size_t> pairs, frames;  // every combination of them
  std::size_t seeds = 200;
  std::uint64_t first_seed = 1;
};
// In the order of pairs, then frames. visits: of the first places, in their order, with as many frames as are
// studied.
[[nodiscard]] std::vector<Accuracy> run_accuracy(const RegistrationRig& rig, const RegistrationPlaces& places,
                                                 const std::vector<TipVisit>& visits,
                                                 const AccuracyStudy& study,
                                                 const std::function<void(double)>& progress = {});

// Largest of random transforms' errors, without noise: position in m and rotation (of its matrix).
[[nodiscard]] double exact_error(std::size_t count, std::uint64_t seed);

}  // namespace enc::bench
