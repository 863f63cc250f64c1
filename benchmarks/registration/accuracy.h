// Accuracy of a registration over many seeds of camera noise, and over the number of pairs and of frames of
// each. The arm visits the places once, with the most of both. The camera sees them anew for each seed, and
// smaller numbers use the first ones.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "trial/identify/camera/registration_rig.h"

namespace enc::bench::registration {

// One number of pairs and of frames; vectors are over seeds. Errors along W's axes, m.
struct Accuracy {
  std::size_t pairs = 8, frames = 20;
  std::vector<Vec3> residual;        // mean residual |error| at the pairs
  std::vector<Vec3> held_out;        // mean |error| of the registration at the targets
  std::vector<Vec3> position;        // |error| of the camera's position
  std::vector<double> turn;          // rad
  std::vector<double> scale;         // camera's size over the device's
  std::vector<double> square;        // m^2, at each target, mean over seeds
  double seconds = kUnset;           // of experiment
  [[nodiscard]] double rms() const;  // over targets and seeds, m
  [[nodiscard]] double rms_at(std::size_t from, std::size_t to) const;  // of some targets
};

struct AccuracyStudy {
  std::vector<std::size_t> pairs, frames;  // every combination of them
  std::size_t seeds = 200;
  std::uint64_t first_seed = 1;
};
// Results in the order of pairs, then frames. visits: the first places, in their order, with as many frames
// as are studied.
[[nodiscard]] std::vector<Accuracy> run_accuracy(const trial::RegistrationRig& rig,
                                                 const trial::RegistrationPlaces& places,
                                                 const std::vector<trial::TipVisit>& visits,
                                                 const AccuracyStudy& study,
                                                 const std::function<void(double)>& progress = {});

// Largest errors over random transforms, without noise: position in m and rotation (of its matrix).
[[nodiscard]] double exact_error(std::size_t count, std::uint64_t seed, double off = 0.0);

}  // namespace enc::bench::registration
