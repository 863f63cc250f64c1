// `bench --rig`: Table 1 and Fig 3 over real sockets, with fakes in place of the devices; and what it
// refuses.
#include "benchmarks/kit/over_rig.h"

#include <algorithm>
#include <csignal>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "benchmarks/stiffness/push_study.h"
#include "core/base/error.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/wires/free_ports.h"
#include "hw_drivers/wires/tight_times.h"
#include "tests/support/built.h"
#include "tests/support/bytes_of.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::bench {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

Words bench_words(Words words, const Words& set = {}) {
  words.insert(words.begin(), "bench");
  for (const std::string& one : set) words.insert(words.end(), {"--set", one});
  return words;
}

// In one line, before anything runs.
std::string refused_line(const Words& words) {
  const tests::Result r = tests::run_program(bench_words(words));
  EXPECT_EQ(r.code, 2) << r.err;
  EXPECT_EQ(r.out, "") << "something ran";
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  return r.err;
}

TEST(OverRig, WhatDoesNotFitIsSaidBeforeAnythingRuns) {
  EXPECT_THAT(refused_line({"dent", "tracking", "--rig", "fakes", "--armed"}),
              HasSubstr("--rig: dent measures in the twin alone; expected stiffness or tracking"));
  for (const char* flag : {"--armed", "--lockstep", "--fakes"})
    EXPECT_THAT(refused_line({"tracking", flag}),
                HasSubstr(std::string(flag) + ": it is of the devices of a rig; expected --rig, too"));
  EXPECT_THAT(refused_line({"tracking", "--rig", "fakes"}), HasSubstr("told nothing without --armed"));
  EXPECT_THAT(refused_line({"tracking", "--rig", "nowhere", "--armed"}), HasSubstr("nowhere"));
  EXPECT_THAT(refused_line({"tracking", "--rig", "sim", "--lockstep", "--armed"}),
              HasSubstr("the rig's machine is simulated"));
}

TEST(OverRig, FakesThatCannotBeginSayWhy) {
  const Words ports = enc::wires::free_ports();
  const std::string port = ports.front().substr(ports.front().find('=') + 1);
  const net::Socket taken = net::listen_tcp("127.0.0.1", static_cast<std::uint16_t>(std::stoi(port)));
  const tests::Result r = tests::run_program(
      bench_words({"tracking", "--rig", "fakes", "--armed", "--lockstep", "--fakes", "--quick"}, ports));
  EXPECT_EQ(r.code, 3) << r.err;
  EXPECT_THAT(r.err, AllOf(HasSubstr("encounter fake: "), HasSubstr("is taken")));
}

Json figure_of(const Json& report, const std::string& id) {
  for (const Json& benchmark : report["benchmarks"])
    for (const Json& figure : benchmark["figures"])
      if (figure["id"] == id) return figure;
  ADD_FAILURE() << "there is no figure " << id;
  return {};
}

// The number behind "twin without wires ".
double twin_of(const Json& figure) {
  const std::string note = figure["note"], before = "twin without wires ";
  const std::size_t at = note.find(before);
  EXPECT_NE(at, std::string::npos) << note;
  return at == std::string::npos ? kUnset : std::stod(note.substr(at + before.size()));
}

// All that they had is free again.
void expect_free(const Words& ports) {
  for (const std::string& one : ports) {
    const auto port = static_cast<std::uint16_t>(std::stoi(one.substr(one.find('=') + 1)));
    const bool datagrams =
        one.find("netft.port") != std::string::npos || one.find("igtl") != std::string::npos;
    EXPECT_NO_THROW((void)(datagrams ? net::bind_udp("127.0.0.1", port) : net::listen_tcp("127.0.0.1", port)))
        << one;
  }
}

// However many holds there are before there is anything to go by, and whenever the last of them began.
TEST(OverRig, ARunThatHeldIsSeenToHaveHeld) {
  const auto held = [](const std::function<bool(int)>& gone) {
    trial::TrialOptions options;
    options.seconds = 0.4;
    int tick = 0;
    options.disturb = [&](Inputs& in) {
      if (gone(tick++)) in.tip.health = Health::absent;
    };
    trial::Trial trial(models::load(tests::source_dir() + "/models/scenes/tennis_ball.toml", "", {}),
                       options);
    while (trial.tick()) {
    }
    return held_in(trial);
  };
  EXPECT_EQ(held([](int) { return false; }), "");
  EXPECT_EQ(held([](int tick) { return tick < 90 && tick % 2 == 1; }), "");
  EXPECT_THAT(held([](int tick) { return tick == 300; }), HasSubstr("held at 0.300 s: machine pose lost"));
  EXPECT_THAT(held([](int tick) { return (tick < 90 && tick % 2 == 1) || tick == 300; }),
              HasSubstr("was in hold at 0.300 s: machine pose lost"));
  EXPECT_THAT(held([](int tick) { return tick >= 50; }),
              HasSubstr("was in hold at 0.400 s: machine pose lost"));
}

// In lockstep only rounding on the wires is between the two: Table 1 comes out as in the twin, and a
// stiffness to two steps of the machine (3 um) out of the 3 mm that 30 N press 10 N/mm in.
TEST(OverRig, OverFakesInLockstepTheFiguresAreThoseOfTheTwin) {
  const test::TemporaryFolder folder;
  const Words ports = enc::wires::free_ports();
  const tests::Result r =
      tests::run_program(bench_words({"tracking", "stiffness", "--rig", "fakes", "--armed", "--lockstep",
                                      "--fakes", "--quick", "--out", folder.file("out")},
                                     enc::wires::tight_times(ports)),
                         {}, 300);
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_THAT(r.out, AllOf(ContainsRegex("stiffness.rig.load.10.percent +absent"),
                           HasSubstr("Measured over rig"), HasSubstr("in lockstep")));
  const Json json = Json::parse(test::bytes_of(folder.path() / "out/results.json"));
  EXPECT_THAT(json["command"].get<std::string>(), HasSubstr("--rig fakes --armed --lockstep --fakes"));
  for (const char* id :
       {"tracking.rig.rmse.x.0", "tracking.rig.mae.x.0", "tracking.rig.rmse.x.40", "tracking.rig.mae.x.40"}) {
    const Json figure = figure_of(json, id);
    ASSERT_TRUE(figure["twin"].is_number()) << id;
    EXPECT_TRUE(figure["paper"].is_number() && figure["low"].is_number() && figure["high"].is_number()) << id;
    EXPECT_EQ(figure["ok"], true) << id;
    EXPECT_NEAR(figure["twin"].get<double>(), twin_of(figure), 0.001) << id;  // mm
  }
  const Json error = figure_of(json, "stiffness.rig.error.10.percent");
  ASSERT_TRUE(error["twin"].is_number());
  EXPECT_EQ(error["high"], 2.0);
  EXPECT_NEAR(error["twin"].get<double>(), twin_of(error), 0.2);
  for (const char* id : {"stiffness.rig.load.10.percent", "stiffness.rig.peak_to_peak.10.mm"}) {
    const Json figure = figure_of(json, id);
    EXPECT_TRUE(figure["twin"].is_null()) << id;
    EXPECT_EQ(figure["ok"], true) << id;
  }
  expect_free(ports);
}

// Of a shell: waits until the fakes listen, without a connection.
std::string until_there(const Words& ports) {
  for (const std::string& one : ports)
    if (const std::size_t at = one.find("gcs.port="); at != std::string::npos)
      return fmt::format("until grep -q ':{:04X} 00000000:0000 0A' /proc/net/tcp; do sleep 0.05; done; ",
                         std::stoi(one.substr(at + 9)));
  return "exit 99; ";
}

// The run lets go of its machine and ends the fakes before it ends itself.
TEST(OverRig, ASignalEndsTheFakesToo) {
  const test::TemporaryFolder folder;
  const Words ports = enc::wires::free_ports();
  const Words words = bench_words(
      {"tracking", "--rig", "fakes", "--armed", "--lockstep", "--fakes", "--repeats", "50"}, ports);
  Words all{"bash", "-c", "set -m; \"$@\" & " + until_there(ports) + "kill -TERM $!; wait $!", "bash",
            tests::program_file()};
  all.insert(all.end(), words.begin(), words.end());
  const tests::Result r = tests::run(all);
  EXPECT_EQ(r.code, 128 + SIGTERM) << r.err;
  EXPECT_THAT(r.err, HasSubstr("interrupted; 0 of 1 benchmarks complete, missing: tracking"));
  expect_free(ports);
}

// Killed, it ends nothing itself: the system does.
TEST(OverRig, FakesDoNotOutliveAKilledBench) {
  const Words ports = enc::wires::free_ports();
  const Words words = bench_words(
      {"tracking", "--rig", "fakes", "--armed", "--lockstep", "--fakes", "--repeats", "50"}, ports);
  Words all{"bash", "-c", "set -m; \"$@\" & " + until_there(ports) + "kill -KILL $!; wait $!; sleep 1",
            "bash", tests::program_file()};
  all.insert(all.end(), words.begin(), words.end());
  EXPECT_EQ(tests::run(all).code, 0);
  expect_free(ports);
}

TEST(Companion, IsThereWhenItSaysSoAndGoneAfterwards) {
  const test::TemporaryFolder folder;
  const std::string file = folder.file("ended");
  {
    const Companion one(
        {"/bin/sh", "-c", "trap 'echo x >\"$0\"; exit 0' TERM; echo ready; while :; do sleep 0.05; done",
         file},
        "ready", 20.0);
    EXPECT_FALSE(std::ifstream(file).good());
  }
  EXPECT_TRUE(std::ifstream(file).good()) << "was not ended by SIGTERM";
}

TEST(Companion, SaysWhyItIsNotThere) {
  const auto said = [](const char* script, double longest) -> std::string {
    try {
      const Companion none({"/bin/sh", "-c", script}, "ready", longest);
    } catch (const Error& e) {
      return fmt::format("{} {}", static_cast<int>(e.kind()), e.what());
    }
    return "it is there";
  };
  EXPECT_EQ(said("echo 'encounter: no\nmore' >&2; exit 3", 20.0), "3 sh -c: no");
  EXPECT_EQ(said("exit 2", 20.0), "2 sh -c: it ended before it had begun");
  EXPECT_EQ(said("exec sleep 60", 0.2), "3 sh -c: was silent for 0.2 s");
}

TEST(PushTimes, AreThoseOfTheScene) {
  PusherSpec pusher;
  pusher.rest_time = 1.0;
  pusher.ramp_time = 2.0;
  using stiffness::part_at;
  using stiffness::PushPart;
  EXPECT_EQ(part_at(pusher, 0.999), PushPart::rest);
  EXPECT_EQ(part_at(pusher, 1.0), PushPart::ramp);
  EXPECT_EQ(part_at(pusher, 2.999), PushPart::ramp);
  EXPECT_EQ(part_at(pusher, 3.0), PushPart::hold);
}

}  // namespace
}  // namespace enc::bench
