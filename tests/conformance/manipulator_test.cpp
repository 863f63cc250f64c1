// Every Manipulator: the simulated hexapod, the driver to copy and those of devices. A new
// driver is one more entry of the table at the end.
#include <chrono>
#include <random>
#include <thread>

#include <gtest/gtest.h>

#include "app/modules/modules.h"
#include "tests/conformance/bench_world.h"
#include "tests/conformance/gcs_port.h"
#include "tests/support/built.h"
#include "tests/support/devices/default_offer.h"

namespace enc::test {
namespace {

// A device with what keeps it alive, and its clock.
struct Machine {
  virtual ~Machine() = default;
  virtual Manipulator& device() = 0;
  virtual void next() { now += Duration(1'000'000); }           // one cycle passes
  [[nodiscard]] virtual Duration oldest() const { return {}; }  // what it says, behind its cycle
  Time now{-Duration(1'000'000)};
};

struct SimMachine final : Machine {
  explicit SimMachine(const std::vector<std::string>& set = {}) : twin(set) {}
  Twin twin;
  Manipulator& device() override { return *twin.rig.manipulator; }
  void next() override { now = twin.rig.clock->next().t; }
};

struct SampleMachine final : Machine {
  Reach reach{0.05, 0.41, Hexapod{HexapodGeometry{}}};
  DefaultOffer offer;
  std::unique_ptr<Manipulator> made = app::load_module("sample").driver->manipulator(offer.with(reach));
  Manipulator& device() override { return *made; }
};

// The driver of the C-887 and its fake over loopback, on the wall clock, which both live in: half a
// millisecond of it is enough for what a cycle is asked for here.
struct GcsMachine final : Machine {
  GcsPort there;
  std::unique_ptr<Manipulator> made = app::load_module("gcs").driver->manipulator(there.offer());
  Manipulator& device() override { return *made; }
  [[nodiscard]] Duration oldest() const override { return Duration(45'000'000); }
  void next() override {
    std::this_thread::sleep_for(std::chrono::microseconds(500));
    Machine::next();
  }
};

struct Entry {
  const char* name;
  std::unique_ptr<Machine> (*make)();
};

class ManipulatorTest : public testing::TestWithParam<Entry> {
 protected:
  void SetUp() override {
    setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
    machine_ = GetParam().make();
  }
  Stamped<TipSample> after(const Pose<'R', 'H'>& command, int cycles) {
    Stamped<TipSample> last;
    for (int i = 0; i < cycles; ++i) {
      machine_->next();
      last = machine_->device().read(machine_->now);
      machine_->device().command(command);
    }
    return last;
  }
  [[nodiscard]] Pose<'R', 'H'> zero() { return machine_->device().reach().machine.zero(); }
  [[nodiscard]] Pose<'R', 'H'> at(double x, double y, double z) {
    const Vec3 p = zero().p() + Vec3(x, y, z);
    return Pose<'R', 'H'>::shift(p.x(), p.y(), p.z());
  }
  std::unique_ptr<Machine> machine_;
};

TEST_P(ManipulatorTest, TimeNeverGoesBackAndAdvances) {
  Time before = Time{} - machine_->oldest();
  for (int i = 0; i < 50; ++i) {
    machine_->next();
    const auto s = machine_->device().read(machine_->now);
    EXPECT_GE(s.t, before);
    before = s.t;
  }
  EXPECT_LE(before, Time(Duration(49'000'000)));
  EXPECT_GE(before, Time(Duration(49'000'000)) - machine_->oldest());
}

TEST_P(ManipulatorTest, SaysAPoseThatIsOneAndWithinItsReach) {
  machine_->next();
  const auto s = machine_->device().read(machine_->now);
  EXPECT_EQ(s.health, Health::ok);
  EXPECT_TRUE(s.value.X_RH.valid());
  EXPECT_TRUE(machine_->device().reach().contains(s.value.X_RH));
  EXPECT_TRUE(s.value.velocity.finite());
  EXPECT_TRUE(s.value.acceleration.finite());
}

TEST_P(ManipulatorTest, GoesWhereItIsTold) {
  const Pose<'R', 'H'> there = at(0.004, -0.003, 0.002);
  const auto s = after(there, 1500);
  EXPECT_EQ(s.health, Health::ok);
  EXPECT_LT((s.value.X_RH.p() - there.p()).norm(), 3e-6);  // its step
}

TEST_P(ManipulatorTest, OutOfReachIsClampedAndSaid) {
  const auto s = after(at(0, 0, 0.5), 3000);
  EXPECT_EQ(s.health, Health::out_of_range);
  EXPECT_LT(s.value.X_RH.p().z() - zero().p().z(), 0.05);
  EXPECT_GT(s.value.X_RH.p().z() - zero().p().z(),
            0.015);  // it went as far as it can: the stroke is +/-24 mm
  // Steps of 3 um, rounded, may end 1.5 um beyond the limit.
  const Pose<'R', 'H'> inside(Quat(s.value.X_RH.q()), Vec3(s.value.X_RH.p() - Vec3(0, 0, 3e-6)));
  EXPECT_TRUE(machine_->device().reach().contains(inside));
  EXPECT_EQ(after(zero(), 3000).health, Health::ok);  // and recovers
}

TEST_P(ManipulatorTest, NotANumberIsRefusedAndSaid) {
  const Pose<'R', 'H'> there = at(0.002, 0, 0);
  after(there, 1000);
  Pose<'R', 'H'> bad = there;
  bad.xyz[1] = kUnset;
  auto s = after(bad, 200);
  EXPECT_EQ(s.health, Health::fault);
  EXPECT_LT((s.value.X_RH.p() - there.p()).norm(), 3e-6);  // stands where it was
  s = after(Pose<'R', 'H'>(Quat(2, 0, 0, 0), Vec3(there.p())), 2);
  EXPECT_EQ(s.health, Health::fault);  // no rotation either
  EXPECT_EQ(after(there, 2).health, Health::ok);
}

// However fast it was: it stands where it stopped, a second stop changes nothing, and a command starts anew.
TEST_P(ManipulatorTest, StopsStaysAndStartsAnew) {
  const Vec3 there = after(at(0.01, 0, 0), 60).value.X_RH.p();  // on its way
  machine_->device().stop();
  const auto rest = [&](int cycles) -> Vec3 {
    for (int i = 0; i < cycles; ++i) machine_->next();
    return machine_->device().read(machine_->now).value.X_RH.p();
  };
  const Vec3 stood = rest(1500);
  EXPECT_LT((stood - there).norm(), 0.003);  // what braking takes
  machine_->device().stop();
  EXPECT_LT((rest(300) - stood).norm(), 3e-6);
  EXPECT_LT((after(at(0.001, 0, 0), 1500).value.X_RH.p() - at(0.001, 0, 0).p()).norm(), 3e-6);
}

TEST_P(ManipulatorTest, ReadNeitherWaitsNorMovesAnything) {
  after(at(0.01, 0, 0), 30);
  const auto first = machine_->device().read(machine_->now);
  for (int i = 0; i < 1000; ++i) {
    const auto once = machine_->device().read(machine_->now), again = machine_->device().read(machine_->now);
    // A device that moves on the wall clock may have told of its next place in between.
    EXPECT_TRUE(again.t > once.t || again.value.X_RH.xyz == once.value.X_RH.xyz);
  }
  EXPECT_GE(machine_->device().read(machine_->now).t, first.t);
}

INSTANTIATE_TEST_SUITE_P(
    All, ManipulatorTest,
    testing::Values(
        Entry{"sim", []() -> std::unique_ptr<Machine> { return std::make_unique<SimMachine>(); }},
        Entry{"sim_structural",
              []() -> std::unique_ptr<Machine> {
                return std::make_unique<SimMachine>(
                    std::vector<std::string>{"truth.hexapod.form=structural"});
              }},
        Entry{"sample", []() -> std::unique_ptr<Machine> { return std::make_unique<SampleMachine>(); }},
        Entry{"gcs", []() -> std::unique_ptr<Machine> { return std::make_unique<GcsMachine>(); }}),
    [](const auto& entry) { return std::string(entry.param.name); });

// The plant alone: limits of the moving part, which a driver's machine keeps by itself.
TEST(SimulatedMachine, KeepsSpeedAndAccelerationUnderWildCommands) {
  Twin twin;
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> far(-0.03, 0.03);
  const Reach reach = twin.rig.manipulator->reach();
  const Vec3 zero = reach.machine.zero().p();
  Vec3 before = zero;
  Vec3 velocity = Vec3::Zero();
  double fastest = 0.0;
  double hardest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    twin.rig.clock->next();
    const Vec3 p = twin.rig.manipulator->read({}).value.X_RH.p();
    const Vec3 v = (p - before) / 1e-3;
    fastest = std::max(fastest, v.norm());
    hardest = std::max(hardest, (v - velocity).norm() / 1e-3);
    before = p;
    velocity = v;
    if (i % 37 == 0)
      twin.rig.manipulator->command(
          Pose<'R', 'H'>(Quat::Identity(), Vec3(zero + Vec3(far(random), far(random), far(random)))));
  }
  EXPECT_LE(fastest, reach.speed * (1 + 1e-6));
  EXPECT_LE(hardest, reach.acceleration * (1 + 1e-6));
  EXPECT_GT(hardest, 0.9 * reach.acceleration);  // the test does push it to its limit
}

}  // namespace
}  // namespace enc::test
