// Parts of the benchmark `gravity`: the poses of the arm and the force that compensation leaves at its tip.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "core/machine/arm.h"
#include "models/setup/scene_file.h"

namespace enc::bench::gravity {

inline constexpr double kPlate = 0.020;  // kg, a prop

// A machine and its prop: the masses that gravity acts on.
struct LoadedArm {
  Arm arm;
  double payload = 0.0;  // kg
};
enum class Compensation : std::uint8_t { none, published, exact };

// The arm of the scene, as assumed by the core and as simulated.
struct GravityRig {
  LoadedArm believed, real;
  PerJoint encoder_step{};  // rad
  models::Setup setup;
};

void add_cost(BenchResult& result, const std::string& id, double value, const char* unit,
              const std::string& note, double low = kUnset, double high = kUnset);
void add_figure(BenchResult& result, const std::string& id, double paper, double twin, const char* unit,
                const std::string& note, double low = kUnset, double high = kUnset);
void add_twin(const GravityRig& rig, const BenchContext& context, BenchResult& result);

}  // namespace enc::bench::gravity
