// The fake C-887 and the driver against PI's own client and server of GCS (PIPython), each in a program of
// its own.
#include <array>
#include <chrono>
#include <filesystem>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "hw_drivers/gcs/drive/net_link.h"
#include "tests/conformance/foreign/piped_child.h"
#include "tests/conformance/gcs_bench.h"
#include "tests/conformance/gcs_port.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

const std::string kPipython = tests::source_dir() + "/.deps/pipython";
const std::string kScripts = tests::source_dir() + "/tests/conformance/foreign/";

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
  const GcsPort there({.referenced = false});
  std::vector<std::string> words = script("pipython_client.py");
  words.push_back(std::to_string(there.server.port()));
  const tests::Result result = tests::run(words);
  EXPECT_EQ(result.code, 0) << result.out << result.err;
}

TEST_F(GcsForeign, TheDriverSpeaksToPipythonsServer) {
  tests::PipedChild child(script("pipython_replies.py"));
  std::array<char, 64> line{};
  const std::string port(line.data(), child.read(line, 20'000));
  ASSERT_NE(port, "");
  GcsPort other;
  other.table.port = std::stoi(port);
  {
    const auto driver = gcs::connected(other.offer());
    EXPECT_THAT(driver->describe(), testing::EndsWith(", firmware 2.3.0.1, referenced"));
    const auto there = Pose<'R', 'H'>::shift(0.0015, 0, driver->reach().machine.zero().p().z());
    for (int i = 0; i < 500; ++i) {
      tell(*driver, there);
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const auto sample = driver->read(Time{});
    EXPECT_EQ(sample.health, Health::ok);
    EXPECT_LT((sample.value.X_RH.p() - there.p()).norm(), 1e-12);
  }
  EXPECT_EQ(child.end(), 0);
}

}  // namespace
}  // namespace enc::test
