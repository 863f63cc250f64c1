// The fake Net F/T against a foreign client (pynetft), in a program of its own.
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "hw_drivers/netft/fake/server.h"
#include "hw_drivers/netft/wire/record.h"
#include "tests/conformance/foreign/piped_child.h"
#include "tests/support/built.h"

namespace enc::test {
namespace {

const std::string kPynetft = tests::source_dir() + "/.deps/pynetft";
const std::string kPynetftScript = tests::source_dir() + "/tests/conformance/foreign/pynetft_client.py";

// As in pynetft_client.py. No two axes are alike, so that their order, their signs and their bytes count.
struct PressedTwoWays final : ForceSensor {
  Stamped<Wrench> read(Time now) noexcept override {
    const Wrench one{Vec<'F'>(1.234567, -23.456789, -123.456789), Vec<'F'>(0.345678, -4.567891, 9.876543)};
    const Wrench other{Vec<'F'>(-7.654321, 31.415926, -60.5), Vec<'F'>(-1.25, 2.718281, -8.000001)};
    return {second ? other : one, now, health};
  }
  std::atomic<bool> second = false;
  std::atomic<Health> health = Health::ok;
};

// More counts for a newton metre than for a newton, so that they cannot be mistaken for each other.
netft::Configuration gamma_of_two_scales() {
  netft::Configuration of = netft::gamma();
  of.per_newton_metre = 2e6;
  return of;
}

// A box with a clock of its own, a millisecond to a record: its numbers do not depend on this machine's load.
class PacedBox {
 public:
  ~PacedBox() { end(); }
  PacedBox() = default;
  PacedBox(const PacedBox&) = delete;
  PacedBox& operator=(const PacedBox&) = delete;
  void end() {
    end_ = true;
    if (thread_.joinable()) thread_.join();
  }
  void turn() {
    server.box().fail(status);
    server.serve(now_);
    now_ += Duration(1'000'000);
    server.publish(now_);
  }

  PressedTwoWays sensor;
  std::atomic<std::uint32_t> status = 0;
  netft::Server server{sensor, gamma_of_two_scales(), "127.0.0.1", netft::Ports{}};

 private:
  Time now_{};
  std::atomic<bool> end_ = false;
  std::thread thread_{[this] {
    while (!end_) {
      turn();
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }};
};

// Its scales over HTTP, one record, a stream and its numbers, a bias, another over it, which stays where
// another client comes; then a warning, which ends nothing, and a saturated sensor, which does.
TEST(NetftForeign, PynetftDrivesTheFake) {
  if (!std::filesystem::exists(kPynetft)) GTEST_SKIP() << "no " << kPynetft << ": ./check fetches it";
  PacedBox there;
  tests::PipedChild child({"/usr/bin/python3", "-B", kPynetftScript, kPynetft,
                           std::to_string(there.server.port()), std::to_string(there.server.http_port())});
  const auto said = [&] {  // a line, in whatever pieces
    std::string line;
    std::array<char, 64> bytes{};
    while (!line.ends_with('\n')) {
      const std::size_t got = child.read(bytes, 30'000);
      if (got == 0) break;
      line.append(bytes.data(), got);
    }
    return line;
  };
  ASSERT_EQ(said(), "biased\n");
  there.sensor.second = true;
  ASSERT_EQ(said(), "biased again\n");
  there.sensor.second = false;
  ASSERT_EQ(said(), "started again\n");
  there.status = netft::kError | netft::kMonitor;
  ASSERT_EQ(said(), "warned\n");
  there.sensor.health = Health::saturated;
  EXPECT_EQ(child.end(), 0);
  there.end();
  there.turn();  // what came last
  EXPECT_FALSE(there.server.box().streams()) << "its stop is not heard";
}

}  // namespace
}  // namespace enc::test
