// The fake C-887 and the driver against PI's own client and server of GCS (PIPython), each in a program of
// its own.
#include <array>
#include <chrono>
#include <filesystem>
#include <thread>

#include <gtest/gtest.h>

#include "tests/conformance/foreign/piped_child.h"
#include "tests/conformance/gcs_bench.h"

namespace enc::test {
namespace {

const std::string kPipython = ENCOUNTER_SOURCE_DIR "/.deps/pipython";
const std::string kScripts = ENCOUNTER_SOURCE_DIR "/tests/conformance/foreign/";

Duration steady() { return std::chrono::steady_clock::now().time_since_epoch(); }

class GcsForeign : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kPipython)) GTEST_SKIP() << "no " << kPipython << ": ./check fetches it";
  }
  static std::vector<std::string> script(const std::string& name) {
    return {"/usr/bin/python3", "-B", kScripts + name, kPipython};
  }
};

// Connects, references, moves, waits on target, meets limits, stops in three ways, sends two commands in one
// segment and one byte at a time.
TEST_F(GcsForeign, PipythonDrivesTheFake) {
  FollowingMachine machine;
  gcs::Controller controller(machine, {.referenced = false});
  tests::PipedChild child(script("pipython_client.py"));
  std::array<char, 4096> bytes{};
  const Duration until = steady() + Duration(60'000'000'000);
  while (!child.closed() && steady() < until) {
    const std::size_t got = child.read(bytes, 1);
    controller.cycle(Time(steady()));
    child.write(controller.take({bytes.data(), got}));
  }
  EXPECT_TRUE(child.closed());
  EXPECT_EQ(child.end(), 0);
  EXPECT_TRUE(controller.at_rest());
}

class ChildLink final : public gcs::Link {
 public:
  explicit ChildLink(tests::PipedChild& child) : child_(child) {}
  std::size_t send(std::string_view bytes) noexcept override {
    child_.write(bytes);
    return bytes.size();
  }
  std::size_t receive(std::span<char> into) noexcept override { return child_.read(into, 0); }
  [[nodiscard]] bool closed() const noexcept override { return child_.closed(); }
  void wait(Duration most) noexcept override { std::this_thread::sleep_for(most); }
  [[nodiscard]] Duration now() const noexcept override { return steady(); }

 private:
  tests::PipedChild& child_;
};

TEST_F(GcsForeign, TheDriverSpeaksToPipythonsServer) {
  GcsBench bench;
  tests::PipedChild child(script("pipython_replies.py"));
  std::this_thread::sleep_for(std::chrono::seconds(1));  // until Python has begun
  {
    gcs::GcsManipulator driver(bench.offer(), bench.settings, std::make_unique<ChildLink>(child));
    EXPECT_EQ(driver.describe(), "C-887.53 117012345 at 127.0.0.1:50000, firmware 2.3.0.1, referenced");
    const auto there = Pose<'R', 'H'>::shift(0.0015, 0, bench.reach.machine.zero().p().z());
    for (int i = 0; i < 500; ++i) {
      driver.command(there);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const auto sample = driver.read(Time{});
    EXPECT_EQ(sample.health, Health::ok);
    EXPECT_LT((sample.value.X_RH.p() - there.p()).norm(), 1e-12);
  }
  EXPECT_EQ(child.end(), 0);
}

}  // namespace
}  // namespace enc::test
