// A rig that `encounter calibrate rig RIG` has measured is right. Twins whose tracker, force sensor and
// weight are not where and what the rig believes are calibrated, seed by seed; each number is in the interval
// that the calibration states. Then the tool travels as in [VHMR 4.1] with what was found: Table 1.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/tracking/table1.h"
#include "core/base/rotation.h"
#include "models/identify/rig/turn.h"
#include "sim/truth/random.h"
#include "tests/support/built.h"
#include "trial/identify/rig/machine_calibration.h"

namespace enc::bench::tracking {
namespace {

constexpr double kPlace = 5e-3, kTurn = 2.0 * M_PI / 180.0, kMass = 0.2;  // what is wrong: m, rad, kg
const std::string kModels = tests::source_dir() + "/models";

Vec3 some_way(sim::Stream& random, double length) { return length * random.normal3().normalized(); }

// A rig that believes other numbers than are so. The twin draws the sensor's zero, 0.5 N rms.
struct Spoilt {
  models::Setup setup;
  Pose<'W', 'C'> X_WC;
  Quat R_HF;
  double mass = kUnset;
};
Spoilt spoilt(std::uint64_t seed) {
  sim::Stream random(seed, "calibration");
  Spoilt truth{models::load(kModels + "/scenes/clamped_tool.toml", ""), {}, {}, kUnset};
  sim::TwinSpec& twin = truth.setup.twin;
  const auto turned = [&](const PoseSpec& believed) {
    return Quat(models::turn_by(some_way(random, kTurn)) * rotation_xyz(believed.rotation));
  };
  const PoseSpec& camera = truth.setup.rig.frames.W_C;
  truth.X_WC = {turned(camera), Vec3(camera.position + some_way(random, kPlace))};
  twin.frames.W_C = {truth.X_WC.p(), angles_xyz(Quat(truth.X_WC.q()))};
  truth.R_HF = turned(truth.setup.rig.frames.H_F);
  twin.frames.H_F.rotation = angles_xyz(truth.R_HF);
  truth.mass = truth.setup.rig.force.mass + (random.uniform() < 0.5 ? -kMass : kMass);
  twin.hexapod.mass = truth.mass;
  // The shipped twin sees turns exactly; markers that are 50 mm apart and off by 0.09 mm do not.
  twin.tracker.turn_noise = 0.1 * M_PI / 180.0;
  // The paper's bias is what its own calibration left over (sources/tracking 2).
  twin.tracker.bias = Vec3::Zero();
  return truth;
}

constexpr std::array kNumbers{"place of the tracker",     "turn of the tracker", "turn of the force sensor",
                              "zero of the force sensor", "tip of the tool",     "mass"};
struct Calibrated {
  std::array<std::array<bool, 3>, kNumbers.size()> held{};  // by its interval, each axis
  PoseSpec W_C;                                             // found
  sim::FramesTruth frames;                                  // true
};
Calibrated calibrated(std::uint64_t seed) {
  const Spoilt truth = spoilt(seed);
  trial::TrialOptions options;
  options.seed = seed;
  trial::CarriedTool tool(truth.setup, options);
  const trial::MachineCalibration made = trial::calibrate_machine(tool);
  const models::HandEyeFit& eye = *made.hand_eye;
  const models::WeightFit& weight = *made.weight;
  Calibrated result;
  const auto compare = [&](std::size_t number, const Vec3& error, const Vec3& half) {
    for (Eigen::Index a = 0; a < 3; ++a)
      result.held[number][static_cast<std::size_t>(a)] = std::abs(error(a)) <= half(a);
  };
  compare(0, truth.X_WC.p() - eye.X_WC.p(), eye.place_half);
  compare(1, models::turn_of(truth.X_WC.q() * eye.X_WC.q().conjugate()), eye.turn_half);
  compare(2, models::turn_of(weight.R_HF.conjugate() * truth.R_HF), weight.turn_half);
  compare(3, tool.trial().world().force->zero().e() - weight.zero.value, weight.zero.half);
  const ToolSpec& clamped = truth.setup.scene.tools[static_cast<std::size_t>(made.clamped_tool)];
  compare(4, clamped.tip - eye.tip.value, eye.tip.half);
  compare(5, Vec3::Constant(truth.mass + made.tool_mass - weight.mass.value),
          Vec3::Constant(weight.mass.half));
  result.W_C = {eye.X_WC.p(), angles_xyz(Quat(eye.X_WC.q()))};
  result.frames = truth.setup.twin.frames;
  return result;
}

// At 20 and at 40 mm/s.
struct Travels {
  TravelErrors slow, fast;
  void add(const Travels& other) {
    slow.add(other.slow);
    fast.add(other.fast);
  }
};
TravelErrors travel(models::Setup setup, double speed, std::uint64_t seed) {
  setup.scene.travel->speed = speed;
  setup.scene.travel->dwell = 1.0;
  return run_travel(setup, seed, false);
}
Travels travels(const models::Setup& setup, std::uint64_t seed) {
  return {travel(setup, 0.020, seed), travel(setup, 0.040, seed)};
}

// The tool travels with what a calibration found; with nothing else wrong, and beside a twin that never was
// wrong.
struct Carried {
  double at_rest = kUnset;  // m, mean error where the calibration alone leaves one
  Travels found, right;
};
Carried carried(const Calibrated& with, std::uint64_t seed) {
  const models::Setup right =
      models::load(kModels + "/scenes/tracking.toml", "", {"travel.ways=\"one_way\""});
  models::Setup setup = right;
  setup.twin.frames = with.frames;
  setup.rig.frames.W_C = with.W_C;
  models::Setup unbiased = setup;
  unbiased.twin.tracker.bias = Vec3::Zero();
  return {resting_column(travel(unbiased, 0.040, seed))[3].mae, travels(setup, seed), travels(right, seed)};
}

// How many of the seeds' intervals hold a number, along one axis.
std::size_t held(const std::vector<Calibrated>& all, std::size_t number, std::size_t axis) {
  return static_cast<std::size_t>(
      std::count_if(all.begin(), all.end(), [&](const Calibrated& one) { return one.held[number][axis]; }));
}

// A 99 % interval holds in at least 95 % of the seeds: of few seeds over the three axes together, of many
// along each axis.
void expect_held(const std::vector<Calibrated>& all, bool each_axis) {
  for (std::size_t number = 0; number < kNumbers.size(); ++number) {
    std::size_t sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      sum += held(all, number, axis);
      if (each_axis) {
        EXPECT_GE(100 * held(all, number, axis), 95 * all.size()) << kNumbers[number] << ", axis " << axis;
      }
    }
    EXPECT_GE(100 * sum, 95 * 3 * all.size()) << kNumbers[number];
  }
}

void expect_calibrated(std::size_t seeds, std::size_t travelling) {
  std::vector<Calibrated> all(seeds);
  std::vector<Carried> after(travelling);
  in_parallel(seeds, [&](std::size_t i) {
    all[i] = calibrated(1 + i);
    if (i < travelling) after[i] = carried(all[i], 1 + i);
  });
  expect_held(all, seeds >= 100);
  const Table1 paper = table1_of(Reference::load(kModels, "table1.csv"));
  std::vector<double> at_rest;
  Travels found, right;
  for (const Carried& one : after) {
    at_rest.push_back(one.at_rest);
    found.add(one.found);
    right.add(one.right);
  }
  EXPECT_LE(median(at_rest), paper[0][3].mae) << "the paper's own calibration left that";
  const Table1 table = table_of(found.slow, found.fast), twin = table_of(right.slow, right.fast);
  for (std::size_t s = 0; s < table.size(); ++s)
    for (std::size_t a = 0; a < table[s].size(); ++a) {
      const double like_paper = a < 3 ? 0.13 : 0.06;  // as `bench tracking` asks
      SCOPED_TRACE(testing::Message() << kTableAxes[a] << " at " << kTableSpeeds[s] << " mm/s");
      EXPECT_NEAR(table[s][a].rmse / twin[s][a].rmse, 1.0, 0.05) << "of a twin that never was wrong";
      EXPECT_NEAR(table[s][a].rmse / paper[s][a].rmse, 1.0, like_paper);
    }
}

TEST(Calibration, FindsWhatIsWrongAndTable1IsThatOfARightRig) { expect_calibrated(20, 12); }
TEST(CalibrationLong, FindsWhatIsWrongAndTable1IsThatOfARightRig) { expect_calibrated(100, 12); }

}  // namespace
}  // namespace enc::bench::tracking
