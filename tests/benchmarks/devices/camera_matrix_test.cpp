// The safety matrix of a live stereo camera: each fault in each mode of an arm, in virtual time.
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/kit/parallel.h"
#include "core/devices/roles.h"
#include "models/setup/scene_file.h"
#include "tests/benchmarks/devices/camera_line.h"
#include "tests/benchmarks/devices/reaction.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc::bench::devices {
namespace {

using Fault = CameraLine::Fault;

struct CameraFault {
  const char* name;
  Fault fault;
  Limits limits;
  double hold_away;  // ms, at most, with no finger to follow
};

// A finger is lost lost_age_ms (300) after its last exposure, and the link silent_ms (500) after the last
// pair; the camera's thread looks each 50 ms.
constexpr Limits kStale{End::link_lost, 301, kNever, kToolLost | kTrackerFault};
const std::vector<CameraFault> kCameraFaults{
    {"unplugged", Fault::unplugged, {End::link_lost, 1, kNever, kTrackerFault}, 1},
    {"silent", Fault::silent, kStale, 551},
    {"all frames damaged", Fault::damaged, kStale, 551},
    {"half frames", Fault::half, kStale, 551},
    {"an error instead of each frame", Fault::error, kStale, 551},
    {"each fifth frame lost", Fault::lossy, {End::unharmed}, 0}};

constexpr Mode kCameraModes[] = {Mode::away, Mode::follow, Mode::contact, Mode::hold};

struct CameraCell {
  const CameraFault* fault = nullptr;
  Mode mode = Mode::away;
  std::uint64_t seed = 1;
  bool falsely = false;  // the core gets a false report
  Reaction of{};
  bool resumes = false;      // after the operator resumed it
  double worst_stamp = 0.0;  // s
};

class CameraRun {
 public:
  explicit CameraRun(CameraCell& cell) : cell_(cell) {
    options_.seed = cell.seed;
    options_.fit_out = [this](Rig& rig) { line_.fit_out(rig); };
    options_.disturb = [this](Inputs& in) {
      if (stopped_) in.arm.health = Health::fault;
      if (cell_.falsely) report_.give(faulty_, cell_.fault->limits.end, trial_->now().t, in.tool, in.missed);
    };
    trial_ = std::make_unique<trial::Trial>(
        models::load(tests::source_dir() + "/models/scenes/wall.toml", "vishap",
                     {"user.depth_mm=5", "user.press_s=0.5", "user.hold_s=1", "user.release_s=0.5",
                      "user.rest_s=1.5", "user.approach_mm_s=[100]"}),
        options_);
  }
  void react() {
    const Mode first = cell_.mode == Mode::hold ? Mode::follow : cell_.mode;
    while (trial_->tick() && trial_->outputs().mode != first) {
    }
    for (std::uint64_t i = std::mt19937_64(cell_.seed)() % 100 + 30; i > 0; --i) trial_->tick();
    stopped_ = cell_.mode == Mode::hold;
    for (int i = 0; stopped_ && i < 20; ++i) trial_->tick();
    cell_.of.in = trial_->outputs().mode;
    line_.suffer(cell_.fault->fault);
    faulty_ = true;
    for (int i = 1; i <= 700; ++i) watch(i);
    cell_.of.zero = 0.0;
    stopped_ = faulty_ = false;
    line_.suffer(Fault::none);
    for (int i = 0; i < 200; ++i) {
      trial_->tick();
      cell_.of.goes_on = cell_.of.goes_on || trial_->outputs().mode != Mode::hold;
    }
    cell_.of.linked = !trial_->gate().link_lost(RoleId::tracker);
    trial_->resume();
    for (int i = 0; i < 50; ++i) trial_->tick();
    cell_.resumes = trial_->outputs().mode != Mode::hold;
    cell_.of.said = line_.said();
    cell_.worst_stamp = line_.worst_stamp();
  }

 private:
  void watch(int tick) {
    trial_->tick();
    if (trial_->outputs().mode != Mode::hold || cell_.of.hold < kNever) return;
    cell_.of.hold = tick;
    cell_.of.why = trial_->outputs().why;
  }
  CameraCell& cell_;
  CameraLine line_;
  trial::TrialOptions options_;
  std::unique_ptr<trial::Trial> trial_;
  FalseReport<TrackedTool> report_;
  bool stopped_ = false, faulty_ = false;
};

TEST(CameraMatrix, EachFaultEndsAsStated) {
  std::vector<CameraCell> cells;
  for (const CameraFault& fault : kCameraFaults)
    for (const Mode mode : kCameraModes) cells.push_back({&fault, mode, 1 + cells.size()});
  in_parallel(cells.size(), [&](std::size_t i) { CameraRun(cells[i]).react(); });
  for (const CameraCell& cell : cells) {
    const std::string name = fmt::format("{}, in {}", cell.fault->name, mode_name(cell.mode));
    Limits limits = cell.fault->limits;
    if (cell.mode == Mode::away) limits.hold = cell.fault->hold_away;
    EXPECT_EQ(wrong_with(limits, cell.mode, cell.of), "") << name;
    EXPECT_TRUE(cell.resumes) << name;
    EXPECT_LE(cell.worst_stamp, 1e-3) << name;
    testing::Test::RecordProperty(name, fmt::format("hold {} ms", cell.of.hold));
  }
}

TEST(CameraMatrixLong, EachRowFailsForAFalseReport) {
  std::vector<CameraCell> cells;
  for (const CameraFault& fault : kCameraFaults) cells.push_back({&fault, Mode::contact, 1, true});
  in_parallel(cells.size(), [&](std::size_t i) { CameraRun(cells[i]).react(); });
  for (const CameraCell& cell : cells) {
    const std::string wrong = wrong_with(cell.fault->limits, cell.mode, cell.of);
    EXPECT_NE(wrong, "") << cell.fault->name;
    testing::Test::RecordProperty(cell.fault->name, wrong);
  }
}

}  // namespace
}  // namespace enc::bench::devices
