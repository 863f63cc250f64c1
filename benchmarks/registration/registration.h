// Parts of the benchmark `registration`.
#pragma once

#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "benchmarks/registration/accuracy.h"
#include "models/setup/scene_file.h"

namespace enc::bench::registration {

inline constexpr const char* kAxisNames = "xyz";

// Of the list in which pairs and frames are each of the given ones.
[[nodiscard]] const Accuracy& accuracy_of(const std::vector<Accuracy>& all, std::size_t pairs,
                                          std::size_t frames);

// One number for each seed: the axis on which mean |error| is largest.
[[nodiscard]] std::vector<double> worst_axis(const std::vector<Vec3>& errors);

// CPU time of averaging and registering, s: least of several, on one core.
struct RegistrationCost {
  std::size_t pairs = 0, frames = 0;
  double cpu = kUnset;
};

void add_registration_plots(const std::vector<Accuracy>& all, const std::vector<RegistrationCost>& costs,
                            const trial::RegistrationPlaces& places, double paper, BenchResult& result);

}  // namespace enc::bench::registration
