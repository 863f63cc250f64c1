// The program as a person calls it: what good input prints.
#include "tests/input/app/program.h"

#include <algorithm>
#include <regex>
#include <sstream>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

TEST_F(Program, JsonSaysWhatIsInTheProcess) {
  const Result r = run_program({"run", plane(), "--for-s", "0.2", "--json"});
  ASSERT_EQ(r.code, 0) << r.err;
  const Json json = Json::parse(r.out);
  EXPECT_EQ(json.at("threads"), 1);
  EXPECT_EQ(json.at("ticks"), 201);  // tick 0 and 0.2 s of 1 kHz
  EXPECT_EQ(json.at("diverged_at_tick"), -1);
  const std::regex heavy("opencv|libGL|libEGL|glfw|X11|wayland", std::regex::icase);
  bool mujoco = false;
  for (const std::string library : json.at("libraries")) {
    EXPECT_FALSE(std::regex_search(library, heavy)) << library;
    mujoco = mujoco || library.starts_with("libmujoco");
  }
  EXPECT_TRUE(mujoco);
  // Two seconds without a press have no error of the force: null, never NaN.
  EXPECT_THAT(r.out, Not(HasSubstr("nan")));
  EXPECT_TRUE(json.at("rmse_press_N").is_null());
}

TEST_F(Program, JsonSaysWhatWasBuiltAndWhatWasLeftOut) {
  const auto names = [&](const Json& list) {
    Words all;
    for (const auto& item : list.items()) all.push_back(item.key());
    return all;
  };
  const auto parts = [&](const std::string& scene) {
    return Json::parse(run_program({"run", scene, "--for-s", "0.01", "--json"}).out);
  };
  const Json wall = parts(plane());  // names no [display]
  EXPECT_THAT(names(wall.at("built")),
              ::testing::UnorderedElementsAre("manipulator", "force", "tracker", "user"));
  EXPECT_THAT(names(wall.at("left_out")), Contains("display"));
  for (const Json& why : wall.at("left_out")) EXPECT_THAT(why.get<std::string>(), HasSubstr("does not name"));
  const Json tennis = parts(ball());
  EXPECT_THAT(names(tennis.at("built")), Contains("display"));
  EXPECT_THAT(names(tennis.at("left_out")), Not(Contains("display")));
}

TEST_F(Program, TextStaysWithinTwentyFiveLines) {
  const Result r = run_program({"run", ball(), "--for-s", "8"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.err, "");  // no progress in a pipe
  EXPECT_LE(std::count(r.out.begin(), r.out.end(), '\n'), 25);
  EXPECT_THAT(r.out, AllOf(HasSubstr("\nbuilt "), HasSubstr("\nleft out "), HasSubstr("\nmodes "),
                           HasSubstr("\nforce "), HasSubstr("\napproach "), HasSubstr("miss"),
                           HasSubstr("bound"), HasSubstr("\nenergy "), HasSubstr("\ntick "),
                           HasSubstr("\ntime "), HasSubstr("\nstate hash ")));
}

// A tool that is never seen again: the run ends in hold.
TEST_F(Program, ARunThatEndsInHoldSaysSo) {
  const Result r =
      run_program({"run", plane(), "--for-s", "1.5", "--json", "--set", "truth.tracker.blackout_at_s=1",
                   "--set", "truth.tracker.blackout_for_s=100"});
  EXPECT_EQ(r.code, 4);
  const Json holds = Json::parse(r.out).at("holds");
  ASSERT_EQ(holds.size(), 1U);
  EXPECT_EQ(holds[0].at("why"), "tool lost");
}

TEST_F(Program, AClampedToolIsHeldAndSeen) {
  const std::string scene = tests::source_dir() + "/models/scenes/clamped_tool.toml";
  const Result r = run_program({"run", scene, "--for-s", "1", "--json"});
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_TRUE(Json::parse(r.out).at("built").contains("gripper"));
  EXPECT_EQ(run_program({"run", scene, "--for-s", "1", "--set", "truth.gripper.width_mm=0"}).code, 4);
}

TEST_F(Program, OneKeySwitchesTheHexapodsForm) {
  const auto run = [&](const Words& more) {
    Words args{"run", ball(), "--for-s", "0.3", "--set", "truth.hexapod.form=structural"};
    args.insert(args.end(), more.begin(), more.end());
    return run_program(args);
  };
  EXPECT_EQ(run({}).code, 0);
  const Result long_step = run({"--set", "truth.structure.timestep_us=300"});
  EXPECT_EQ(long_step.code, 2);
  EXPECT_THAT(long_step.err, HasSubstr("does not divide the haptic period"));
  const Result stiff = run({"--set", "truth.structure.leg_stiffness_N_per_um=100"});
  EXPECT_EQ(stiff.code, 2);
  EXPECT_THAT(stiff.err, HasSubstr("expected a time step of at most"));
}

TEST_F(Program, TheHashIsOfSceneAndSeedAlone) {
  const auto hash = [&](const Words& more) {
    Words args{"run", plane(), "--for-s", "0.3", "--json"};
    args.insert(args.end(), more.begin(), more.end());
    const Result r = run_program(args);
    EXPECT_EQ(r.code, 0) << r.err;
    return Json::parse(r.out).at("state_hash").get<std::string>();
  };
  const std::string first = hash({});
  EXPECT_EQ(hash({}), first);
  EXPECT_EQ(hash({"--pace", "10"}), first);
  EXPECT_EQ(hash({"--pace", "wall"}), first);
  EXPECT_EQ(hash({"--record", path("run.encrec")}), first);
  EXPECT_NE(hash({"--seed", "2"}), first);
}

TEST_F(Program, PaceIsKept) {
  const Result r = run_program({"run", plane(), "--for-s", "0.5", "--pace", "2"});
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_GT(r.seconds, 0.24);  // 0.5 s at twice the wall's speed
}

TEST_F(Program, CheckPrintsTheFramesAndTheResolvedScene) {
  const Result r = run_program({"check", plane()});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.err, "");
  for (const char* edge : {"X_WR", "X_RH", "X_HF", "X_WC", "X_CT", "X_WO", "X_WN"})
    EXPECT_THAT(r.out, HasSubstr(std::string("\n  ") + edge + "  "));
  EXPECT_THAT(r.out, HasSubstr("left out    camera, display"));
  EXPECT_THAT(run_program({"check", plane(), "--resolved"}).out,
              AllOf(HasSubstr("format = 1\n"), HasSubstr("[rig.loop]\nrate_hz = 1000\n"),
                    HasSubstr("[truth.tracker]\n"), HasSubstr("press_N_per_mm_k = [2, 0, 0, 0]")));
  // --set shows in both: the wall 11 mm up is at 11 mm.
  const std::string up = "object.wall.position_mm=[0,0,11]";
  EXPECT_THAT(run_program({"check", plane(), "--set", up}).out,
              HasSubstr("[0.000, 0.000, 11.000] mm  object"));
  EXPECT_THAT(run_program({"check", plane(), "--set", up, "--resolved"}).out,
              HasSubstr("position_mm = [0, 0, 11]"));
}

TEST_F(Program, ParametersHaveAHeaderAndOneRowEach) {
  const Result r = run_program({"params", ball()});
  ASSERT_EQ(r.code, 0) << r.err;
  std::istringstream lines(r.out);
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  EXPECT_EQ(line, "name,unit,value,source,confidence,meaning");
  Words names;
  while (std::getline(lines, line)) {
    // Six fields: five commas outside of quotes.
    bool quoted = false;
    int commas = 0;
    for (const char c : line) {
      if (c == '"') quoted = !quoted;
      commas += c == ',' && !quoted ? 1 : 0;
    }
    EXPECT_FALSE(quoted) << line;
    EXPECT_EQ(commas, 5) << line;
    names.push_back(line.substr(0, line.find(',')));
  }
  Words unique = names;
  std::sort(unique.begin(), unique.end());
  EXPECT_EQ(std::unique(unique.begin(), unique.end()), unique.end());
  EXPECT_THAT(names, AllOf(Contains("object.ball.radius_mm"), Contains("rig.loop.rate_hz"),
                           Contains("truth.tracker.blackout_at_s")));
  const Json json = Json::parse(run_program({"params", ball(), "--json"}).out);
  ASSERT_EQ(json.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) EXPECT_EQ(json[i].at("name"), names[i]);
}

// What every row says, --set takes back: the same value changes nothing.
TEST_F(Program, EveryParameterCanBeSetToWhatItIs) {
  const Json list = Json::parse(run_program({"params", plane(), "--json"}).out);
  const auto below_the_first_line = [](const std::string& text) { return text.substr(text.find('\n')); };
  const std::string before = run_program({"check", plane(), "--resolved"}).out;
  Words args{"check", plane(), "--resolved"};
  for (const Json& p : list) {
    const std::string value = p.at("value");
    if (value == "unset" || value.empty()) continue;
    args.insert(args.end(), {"--set", p.at("name").get<std::string>() + "=" + value});
  }
  ASSERT_GT(args.size(), 100U);
  const Result r = run_program(args);
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(below_the_first_line(r.out), below_the_first_line(before));
}

// A weak machine carries 13 N, of which 8.92 N stand behind the sensor.
TEST_F(Program, AnObjectIsNotPressedHarderThanTheMachineCarries) {
  const Words weak{"--set", "rig.manipulator.payload_N=13"};
  for (Words args : {Words{"check", ball()}, Words{"run", ball(), "--set", "user.approach_mm_s=[20]"}}) {
    args.insert(args.end(), weak.begin(), weak.end());
    const Result r = run_program(args);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(r.out, AllOf(HasSubstr("limited     object 'ball': the machine carries at most 4.1 N"),
                             HasSubstr("instead of 6 mm")));
  }
  const Result none = run_program({"check", ball(), "--set", "rig.manipulator.payload_N=5"});
  EXPECT_EQ(none.code, 2);
  EXPECT_THAT(none.err, HasSubstr("does not even carry"));
}

// Without what a wall clock measured.
std::string timeless(const std::string& text) {
  std::istringstream lines(text);
  std::string kept;
  const std::regex timed(
      "^(tick|time|costs) |^  process "
      "|\"(p50|p99|p99_9|max|wall_s|times_real_time|started_cpu_ms|peak_memory_MiB)\":");
  for (std::string line; std::getline(lines, line);)
    if (!std::regex_search(line, timed)) kept += line + "\n";
  return kept;
}

TEST_F(Program, ACommaForThePointChangesNothing) {
  // Made here, because few machines have it; where it cannot be made the C locale stands in.
  fs::create_directories(path("locale"));
  const bool made = run({"localedef", "-i", "de_DE", "-f", "UTF-8", path("locale/de_DE.UTF-8")}).code == 0;
  const Environment german{{"LC_ALL", made ? "de_DE.UTF-8" : "C"}, {"LOCPATH", path("locale")}};
  const Environment plain{{"LC_ALL", "C"}};
  if (made) {
    EXPECT_EQ(run({"bash", "-c", "printf '%.1f' 1,5"}, german).out, "1,5");  // it is what it should be
  }
  const Words set{"--set", "object.wall.position_mm=[0,0,10.5]"};
  write("loop.csv", loop_text());
  for (Words args :
       {Words{"check", plane()}, Words{"params", plane()}, Words{"run", plane(), "--for-s", "0.5"},
        Words{"run", plane(), "--for-s", "0.5", "--json"}, Words{"fit", path("loop.csv")}}) {
    if (args[0] != "fit") args.insert(args.end(), set.begin(), set.end());
    const Result there = run_program(args, german);
    const Result here = run_program(args, plain);
    EXPECT_EQ(there.code, 0) << there.err;
    EXPECT_EQ(timeless(there.out), timeless(here.out)) << args[0];
    EXPECT_THAT(timeless(here.out), Not(IsEmpty()));
  }
}

}  // namespace
}  // namespace enc::tests
