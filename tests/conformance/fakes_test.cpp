// The laboratory in two programs: `encounter fake` on one side of real sockets, `encounter run` on the other.
#include "app/laboratory/fakes.h"

#include <csignal>
#include <cstdlib>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "app/modules/modules.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/net/steady.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

using testing::HasSubstr;
using tests::Result;
using tests::run_program;

const std::string kBall = ENCOUNTER_SOURCE_DIR "/models/scenes/tennis_ball.toml";

// Ports that nobody has just now.
std::vector<std::string> free_ports() {
  std::vector<std::string> set;
  const net::Socket machine = net::listen_tcp("127.0.0.1", 0), page = net::listen_tcp("127.0.0.1", 0),
                    commands = net::listen_tcp("127.0.0.1", 0);
  const net::Socket records = net::bind_udp("127.0.0.1", 0), tools = net::bind_udp("127.0.0.1", 0);
  for (const auto& [key, port] : {std::pair{"gcs.port", machine.port()},
                                  {"netft.http_port", page.port()},
                                  {"netft.command_port", commands.port()},
                                  {"netft.port", records.port()},
                                  {"igtl.port", tools.port()}})
    set.push_back("rig.driver." + std::string(key) + "=" + std::to_string(port));
  return set;
}

// The fakes in this process, where their machine can be seen.
struct Laboratory {
  explicit Laboratory(bool lockstep) {
    setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
    fakes = std::make_unique<app::Fakes>(models::load(kBall, "fakes", ports),
                                         app::FakesOptions{app::load_module, 1, lockstep});
    serve();
  }
  ~Laboratory() { pause(); }
  void serve() {
    end = false;
    thread = std::thread([this] {
      while (!end) fakes->turn();
    });
  }
  void pause() {
    end = true;
    if (thread.joinable()) thread.join();
  }
  [[nodiscard]] std::vector<std::string> words(std::vector<std::string> more) const {
    std::vector<std::string> all{"run", kBall, "--rig", "fakes"};
    for (const std::string& set : ports) all.insert(all.end(), {"--set", set});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  std::vector<std::string> ports = free_ports();
  std::unique_ptr<app::Fakes> fakes;
  std::atomic<bool> end = false;
  std::thread thread;
};

nlohmann::json json_of(const Result& result) {
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  return nlohmann::json::parse(result.out, nullptr, false);
}

// One press, whose deepest is at 13 s.
TEST(Fakes, InLockstepARunThroughSocketsIsTheSameEachTimeAndPressesAsWithout) {
  const Laboratory there(true);
  const std::vector<std::string> words = there.words({"--armed", "--lockstep", "--for-s", "14", "--json"});
  const nlohmann::json first = json_of(run_program(words, {}, 400)),
                       again = json_of(run_program(words, {}, 400));
  EXPECT_EQ(first["state_hash"], again["state_hash"]);
  const nlohmann::json pure = json_of(run_program({"run", kBall, "--for-s", "14", "--json"}));
  EXPECT_EQ(first["contacts"], 1);
  EXPECT_EQ(pure["contacts"], 1);
  ASSERT_TRUE(first["felt_peak_N"].is_number()) << first.dump();
  EXPECT_FALSE(first.contains("presses") && !first["presses"].empty()) << "a truth that nobody knows";
  const double peak = pure["presses"][0]["peak_force_N"];
  EXPECT_NEAR(first["felt_peak_N"].get<double>(), peak, 0.2);
  for (const auto& [mode, time] : pure["modes_s"].items())
    EXPECT_NEAR(first["modes_s"].value(mode, 0.0), time.get<double>(), 0.1) << mode;
  EXPECT_EQ(there.fakes->begun(), 2);
}

TEST(Fakes, WhatDoesNotFitIsSaid) {
  {
    const Laboratory there(true);
    EXPECT_THAT(run_program(there.words({"--armed", "--for-s", "1"})).err,
                HasSubstr("its time goes on with each set-point; add --lockstep"));
    EXPECT_THAT(run_program(there.words({"--lockstep"})).err,
                HasSubstr("without --armed none is sent; add it"));
  }
  const Laboratory there(false);
  EXPECT_THAT(run_program(there.words({"--armed", "--lockstep"})).err,
              HasSubstr("its time goes on by itself; leave out --lockstep"));
  EXPECT_THAT(run_program({"run", kBall, "--armed", "--lockstep"}).err,
              HasSubstr("the rig's machine is simulated"));
  EXPECT_THAT(run_program({"fake", "sim"}).err, HasSubstr("every device that the scene names is simulated"));
  const Result taken = run_program({"fake", "fakes", "--set", there.ports[0]});
  EXPECT_EQ(taken.code, 3);
  EXPECT_THAT(taken.err, HasSubstr("is taken"));
}

// Dry: all is read and computed, and the machine is told nothing.
TEST(Fakes, WithoutArmedTheMachineHearsNoSetPoint) {
  Laboratory there(false);
  const nlohmann::json dry = json_of(run_program(there.words({"--for-s", "2", "--json"})));
  EXPECT_GT(dry["withheld_commands"].get<int>(), 1000);
  there.pause();
  EXPECT_EQ(there.fakes->world().machine->state().pose.p(),
            there.fakes->world().machine->machine().zero().p());
}

// However it is killed, the machine comes to rest: its points run dry.
void kill_at_random_moments(int times) {
  Laboratory there(false);
  std::mt19937_64 random(20261126);
  double longest = 0.0;
  for (int i = 0; i < times; ++i) {
    const int signal = i % 2 == 0 ? SIGKILL : SIGTERM;
    std::vector<std::string> words{tests::program_file()};
    for (const std::string& word : there.words({"--armed"})) words.push_back(word);
    static_cast<void>(fflush(nullptr));  // the child has none of it
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      std::vector<char*> arguments;
      for (std::string& word : words) arguments.push_back(word.data());
      arguments.push_back(nullptr);
      static_cast<void>(freopen("/dev/null", "w", stdout));
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200 + random() % 1800));
    kill(child, signal);
    const Duration killed = net::steady_now();
    int status = 0;
    waitpid(child, &status, 0);
    constexpr double kSpeed = 1e-4;  // m/s
    bool still = false;
    while (!still && net::steady_now() - killed < Duration(5'000'000'000)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
      there.pause();
      still = there.fakes->world().machine->state().velocity.norm() < kSpeed;
      there.serve();
    }
    EXPECT_TRUE(still) << i;
    longest = std::max(longest, seconds(net::steady_now() - killed));
  }
  testing::Test::RecordProperty("longest_s", std::to_string(longest));
}
TEST(Fakes, AKilledRunLeavesTheMachineAtRest) { kill_at_random_moments(6); }
TEST(FakesLong, AKilledRunLeavesTheMachineAtRest) { kill_at_random_moments(100); }

TEST(Fakes, DevicesSaysWhatAnswersAndHowOften) {
  const Laboratory there(false);
  std::vector<std::string> words{"devices", "fakes"};
  for (const std::string& set : there.ports) words.insert(words.end(), {"--set", set});
  const Result result = run_program(words);
  EXPECT_EQ(result.code, 0) << result.err;
  for (const char* part : {"manipulator  C-887", "force        Net F/T at 127.0.0.1",
                           "tracker      tool data of", " samples a second, "})
    EXPECT_THAT(result.out, HasSubstr(part));
  const Result none = run_program({"devices", "fakes", "--set", "rig.driver.gcs.port=1"});
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.out, HasSubstr("manipulator  NOT THERE: 127.0.0.1:1: nobody listens there"));
}

// The rig of the fakes is the simulated one, but for its drivers.
TEST(Fakes, TheirRigIsTheSimulatedOne) {
  const auto text = [](models::Setup setup) {
    for (std::string* driver :
         {&setup.rig.manipulator.driver, &setup.rig.force.driver, &setup.rig.tracker.driver})
      *driver = "sim";
    setup.rig.drivers.clear();
    setup.rig.title.clear();
    return models::resolved(setup);
  };
  EXPECT_EQ(text(models::load(kBall, "fakes")), text(models::load(kBall, "sim")));
}

}  // namespace
}  // namespace enc::test
