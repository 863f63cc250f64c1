// The safety matrix of both arms: each fault in each mode, in virtual time, with the driver's own thread and
// the vendor's fake library. docs/reference/safety.md has its table.
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/devices/mode.h"
#include "hw_drivers/forcedimension/wire/dhd.h"
#include "hw_drivers/phantom/wire/hd.h"
#include "models/setup/scene_file.h"
#include "sim/plants/arm_plant.h"
#include "tests/benchmarks/devices/arm_line.h"
#include "tests/benchmarks/devices/reaction.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc::bench::devices {
namespace {

namespace dhd = forcedimension::dhd;
namespace hd = phantom::hd;
using Kind = Trouble::Kind;

constexpr Mode kArmModes[] = {Mode::away, Mode::follow, Mode::contact, Mode::hold};
constexpr int kInjured = 100, kCalm = 700;  // ticks of the fault, and after it

struct ArmFault {
  const char* name;
  void (*inject)(ArmLine& at, int tick);  // called before each tick of the fault, from 0 on
  void (*cure)(ArmLine& at);
  Limits limits;
  bool stands = false;   // the loop stands during the fault
  bool process = false;  // the driver's threads, too: only the device's own watchdog can end the force
};

template <int error>
void fails(ArmLine& at, int tick) {
  if (tick == 0) at.server().suffer({Kind::error_code, static_cast<double>(error)});
}
void mends(ArmLine& at) { at.server().heal(Kind::error_code); }
template <Kind kind>
void spoils(ArmLine& at, int tick) {
  if (tick == 0) at.server().suffer({kind, 1.0});
  at.library(LibraryState::hears_noise);
}
template <Kind kind>
void clears(ArmLine& at) {
  at.server().heal(kind);
  at.library(LibraryState::calls);
}
void calls_again(ArmLine& at) { at.library(LibraryState::calls); }
void nothing(ArmLine&) {}
void hangs_if(ArmLine& at, bool hangs) { at.library(hangs ? LibraryState::hangs : LibraryState::calls); }

constexpr std::uint32_t kTip = kTipInvalid | kTipLost;
constexpr Limits kUnharmed{End::unharmed};
constexpr Limits kLost{End::link_lost, 5, 5, kTip}, kLostAtOnce{End::link_lost, 2, 2, kTip};
constexpr Limits kPasses{End::holds, 2, 2, kTip};  // an error is in the reading of the next call

const std::vector<ArmFault> kOfBoth{
    {"makes no more calls", [](ArmLine& at, int) { hangs_if(at, true); }, calls_again, kLost},
    {"makes no call for 6 ms", [](ArmLine& at, int tick) { hangs_if(at, tick < 6); }, calls_again, kLost},
    {"each tenth call is 2 ms late", [](ArmLine& at, int tick) { hangs_if(at, tick % 10 > 7); }, calls_again,
     kUnharmed},
    {"throws",
     [](ArmLine& at, int tick) {
       if (tick == 0) at.server().flag(arm::kThrows, true);
     },
     [](ArmLine& at) { at.server().flag(arm::kThrows, false); }, kLostAtOnce},
    {"all noise", spoils<Kind::garbage>, clears<Kind::garbage>, kLost},
    {"half messages", spoils<Kind::half_message>, clears<Kind::half_message>, kLost},
    {"dead man's switch opens",
     [](ArmLine& at, int tick) {
       if (tick == 0) at.server().press(false);
     },
     [](ArmLine& at) { at.server().press(true); }, kPasses},
    // Times of the hold count from the return of the loop, those of the force from its end.
    {"program: its loop stands for 400 ms",
     [](ArmLine& at, int tick) {
       if (tick == 0) at.stand(Duration(400'000'000), false);
     },
     nothing,
     {End::holds, 1, 5, kClockLate},
     true},
    {"program: stopped for 2 s (SIGSTOP)",
     [](ArmLine& at, int tick) {
       if (tick == 0) at.stand(Duration(2'000'000'000), true);
     },
     nothing,
     {End::link_lost, 1, 6, kClockLate | kTip},
     true,
     true}};

const std::vector<ArmFault> kOfPhantom{
    {"warm motors (0x200)", fails<hd::kWarmMotors>, mends, kPasses},
    {"too much force (0x201)", fails<hd::kMaxForce>, mends, kPasses},
    {"motors at 97 % of their heat",
     [](ArmLine& at, int tick) {
       if (tick == 0) at.server().warm(0.97);
     },
     [](ArmLine& at) { at.server().warm(0.5); }, kPasses},
    {"faulty (0x300)", fails<hd::kDeviceFault>, mends, kLostAtOnce},
    {"no communication (0x302)", fails<hd::kCommError>, mends, kLostAtOnce}};

const std::vector<ArmFault> kOfForceDimension{
    {"no communication (2)", fails<dhd::kCommunication>, mends, kLostAtOnce},
    {"no answer in time (7)", fails<dhd::kTimeout>, mends, kLostAtOnce}};

models::Setup pressed_wall(double watchdog_ms) {
  return models::load(
      tests::source_dir() + "/models/scenes/wall.toml", "vishap",
      {"user.depth_mm=5", "user.press_s=0.5", "user.hold_s=0.5", "user.release_s=0.5", "user.rest_s=1",
       "user.approach_mm_s=[200]", fmt::format("truth.arm.watchdog_ms={}", watchdog_ms)});
}

// The PHANToM's own watchdog of 5 ms would end a force that is kept, so it is 200 ms there.
// What makes a cell wrong: a false report of the device to the core, or a device that keeps its force.
enum class Flaw : std::uint8_t { none, false_report, keeps_force };

struct ArmRun {
  ArmRun(Vendor vendor, const ArmFault& one, std::uint64_t seed, Flaw flaw = Flaw::none)
      : fault(one),
        setup(pressed_wall(one.process && vendor == Vendor::phantom && flaw != Flaw::keeps_force ? 5.0
                                                                                                 : 200.0)),
        line(vendor, setup.rig, one.process ? 0.005 : 0.031, flaw == Flaw::keeps_force),
        random(seed) {
    options.seed = seed;
    options.fit_out = [this](Rig& rig) { line.fit_out(rig); };
    options.disturb = [this, flaw](Inputs& in) {
      if (blinded) in.tool.health = Health::fault;
      if (flaw == Flaw::false_report)
        report.give(counts, fault.limits.end, trial->now().t, in.arm, in.missed);
    };
    trial = std::make_unique<trial::Trial>(setup, options);
    line.exerts = [this] { return trial->world().arm->state().torque != PerJoint{}; };
  }

  void tick() {
    trial->tick();
    const bool holds = trial->outputs().mode == Mode::hold;
    if (counts) ++ticks;
    if (counts && holds && of.hold == kNever) {
      of.hold = ticks;
      of.why = trial->outputs().why;
    }
    // The motors' torque is that since the tick before.
    if (counts && line.exerts()) of.zero = kNever;
    if (counts && !line.exerts() && of.zero == kNever) of.zero = ticks - 1;
    goes_on = goes_on || !holds;
  }
  // Brings the run into the mode, and its arm behind the driver.
  void enter(Mode mode) {
    const Mode first = mode == Mode::hold ? Mode::follow : mode;
    while (trial->tick() && trial->outputs().mode != first) {
    }
    line.connect();
    for (std::uint64_t i = 60 + random() % 40; i > 0; --i) tick();
    blinded = mode == Mode::hold;
    for (int i = 0; blinded && i < 20; ++i) tick();
    of.in = trial->outputs().mode;
  }
  Reaction react(Mode mode) {
    enter(mode);
    counts = true;
    for (int i = 0; i < (fault.stands ? 1 : kInjured); ++i) {
      fault.inject(line, i);
      tick();
    }
    if (fault.stands) of.zero = line.force_in_stand();
    counts = blinded = goes_on = false;
    fault.cure(line);
    for (int i = 0; i < (fault.limits.end == End::holds ? kCalm : 50); ++i) tick();
    of.goes_on = goes_on;
    of.linked = trial->rig().arm->linked();
    of.said = line.said();
    if (fault.limits.end == End::link_lost && line.exerts()) of.zero = kNever;
    return of;
  }

  const ArmFault& fault;
  models::Setup setup;
  ArmLine line;
  std::mt19937_64 random;
  trial::TrialOptions options;
  std::unique_ptr<trial::Trial> trial;
  Reaction of;
  FalseReport<ArmSample> report;
  int ticks = 0;
  bool counts = false, blinded = false, goes_on = false;
};

// The fake library is one for the whole process, so the cells follow one after the other.
void expect_cells(Vendor vendor, const std::vector<ArmFault>& own) {
  std::uint64_t seed = 0;
  for (const std::vector<ArmFault>* all : {&kOfBoth, &own})
    for (const ArmFault& fault : *all)
      for (const Mode mode : kArmModes) {
        const Reaction of = ArmRun(vendor, fault, ++seed).react(mode);
        const std::string name = fmt::format("{}, in {}", fault.name, mode_name(mode));
        EXPECT_EQ(wrong_with(fault.limits, mode, of), "") << name;
        testing::Test::RecordProperty(name, fmt::format("hold {} ms, force {} ms", of.hold, of.zero));
      }
}

void expect_red(Vendor vendor, const std::vector<ArmFault>& own) {
  std::uint64_t seed = 0;
  for (const std::vector<ArmFault>* all : {&kOfBoth, &own})
    for (const ArmFault& fault : *all) {
      const std::string wrong =
          wrong_with(fault.limits, Mode::contact,
                     ArmRun(vendor, fault, ++seed, Flaw::false_report).react(Mode::contact));
      EXPECT_NE(wrong, "") << fault.name;
      testing::Test::RecordProperty(fault.name, wrong);
    }
}

void expect_force(Vendor vendor, const std::vector<ArmFault>& own) {
  std::uint64_t seed = 0;
  for (const std::vector<ArmFault>* all : {&kOfBoth, &own})
    for (const ArmFault& fault : *all) {
      if (fault.limits.zero == kNever) continue;
      Reaction of = ArmRun(vendor, fault, ++seed, Flaw::keeps_force).react(Mode::contact);
      EXPECT_GT(of.zero, fault.limits.zero) << fault.name;
      EXPECT_NE(wrong_with(fault.limits, Mode::contact, of), "") << fault.name;
      testing::Test::RecordProperty(fault.name, fmt::format("force {} ms", of.zero));
    }
}

TEST(ArmMatrix, EachFaultOfAPhantomEndsAsStated) { expect_cells(Vendor::phantom, kOfPhantom); }

TEST(ArmMatrix, EachFaultOfAForceDimensionEndsAsStated) {
  expect_cells(Vendor::forcedimension, kOfForceDimension);
}

TEST(ArmMatrixLong, EachRowFailsForAFalseReport) {
  expect_red(Vendor::phantom, kOfPhantom);
  expect_red(Vendor::forcedimension, kOfForceDimension);
}

TEST(ArmMatrixLong, EachLimitOfForceFailsForADeviceThatKeepsIt) {
  expect_force(Vendor::phantom, kOfPhantom);
  expect_force(Vendor::forcedimension, kOfForceDimension);
}

}  // namespace
}  // namespace enc::bench::devices
