// Parts of the benchmark `gravity`: where the arm is asked, what compensation leaves at its tip.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "benchmarks/kit/bench.h"
#include "core/machine/arm.h"
#include "models/setup/scene_file.h"

namespace enc::bench::gravity {

// The 13 x 18 x 25 cm of [VisHap 1] in front of the arm: where in x and z most of it is within the limits,
// and the joints at its grid points. Which side lies along which axis no source says; here x is the shortest,
// y (sideways) the longest.
struct ArmBox {
  static constexpr std::array<double, 3> kSize{0.13, 0.25, 0.18};  // m
  Vec3 centre{0, 0, 0};                                            // in R, m
  double share = 0.0;                                              // of its points within the limits
  std::vector<PerJoint> poses;
  std::vector<Vec3> points;  // of these poses, in R
};
[[nodiscard]] double share_in_reach(const Arm& arm, const Vec3& centre, int points_per_side);
[[nodiscard]] ArmBox place_box(const Arm& arm, int points_per_side);

// What hangs where: a machine and its prop.
struct Laden {
  Arm arm;
  double payload = 0.0;  // kg
};
enum class Compensation : std::uint8_t { none, published, exact };

// Force with which the tip pushes (or must be held) at a pose when the device answers the force that the core
// computes [eq. 4, 5]: J_real^-T (J_believed^T F_gc - gravity_real). Joints are read in the encoders' steps.
// N.
[[nodiscard]] Vec3 residual(const Laden& believed, Compensation form, const Laden& real,
                            const PerJoint& encoder_step, const PerJoint& q);

struct Spread {
  std::vector<double> force;  // N, at each pose
  double median = kUnset, most = kUnset;
};
[[nodiscard]] Spread residuals(const Laden& believed, Compensation form, const Laden& real,
                               const PerJoint& encoder_step, const ArmBox& box);

struct GravityCase {
  std::string name;
  Spread spread;
};

// The arm of the scene, as it is believed and as it is.
struct GravityRig {
  Laden believed, real;
  PerJoint encoder_step{};  // rad
  models::Setup setup;
};
[[nodiscard]] GravityRig gravity_rig(const BenchContext& context);

void add_cost(BenchResult& result, const std::string& id, double value, const char* unit,
              const std::string& note, double low = kUnset, double high = kUnset);
void add_figure(BenchResult& result, const std::string& id, double paper, double twin, const char* unit,
                const std::string& note, double low = kUnset, double high = kUnset);

void add_statics(const GravityRig& rig, const BenchContext& context, BenchResult& result);
void add_catalogue(const GravityRig& rig, BenchResult& result);
void add_twin(const GravityRig& rig, const BenchContext& context, BenchResult& result);
void add_race(const GravityRig& rig, const BenchContext& context, BenchResult& result);

}  // namespace enc::bench::gravity
