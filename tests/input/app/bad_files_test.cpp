// Wrong files and arguments: each ends with exit code 2 (3 for a device) and one line with the place and the
// expectation.
#include <algorithm>
#include <regex>
#include <string>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/input/app/program.h"
#include "tests/support/files.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

struct BadFile {
  const char* name;   // name of the test
  const char* file;   // edited file, under models/
  const char* from;   // replaces this text ...
  const char* to;     // ... by this text
  const char* at;     // the reported place is the beginning of this text, after the edit
  const char* words;  // words of the line
};
void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.name; }

constexpr const char* kBall = "scenes/tennis_ball.toml";
constexpr const char* kSim = "rigs/sim.toml";

class BadFiles : public Program, public ::testing::WithParamInterface<BadFile> {};

TEST_P(BadFiles, IsRefusedWithPlaceAndExpectation) {
  const BadFile& bad = GetParam();
  const std::string file = std::string("models/") + bad.file;
  edit(file, bad.from, bad.to);
  const std::string said = scene_refused(ball());
  EXPECT_THAT(said, StartsWith(path(file) + ":" + line_and_column(bytes_of(path(file)), bad.at) + ": "));
  EXPECT_THAT(said, HasSubstr(bad.words));
}

INSTANTIATE_TEST_SUITE_P(
    Bad, BadFiles,
    ::testing::Values(
        BadFile{"UnknownKey", kBall, "radius_mm = 33", "radus_mm = 33", "radus_mm",
                "did you mean 'radius_mm'?"},
        BadFile{"UnknownTable", kBall, "[tracker]", "[trackr]", "trackr]", "did you mean 'tracker'?"},
        BadFile{"UnknownKeyInRig", kSim, "filter_hz = 5 ", "filtre_hz = 5 ", "filtre_hz",
                "did you mean 'filter_hz'?"},
        BadFile{"UnknownKeyInBehaviours", "behaviours.toml", "stiffness_N_per_mm = 2\n",
                "stifness_N_per_mm = 2\n", "stifness", "did you mean 'stiffness_N_per_mm'?"},
        BadFile{"UnknownKeyInResponse", "responses/tennis_ball.toml", "limit_mm = 6", "limits_mm = 6",
                "limits_mm", "did you mean 'limit_mm'?"},
        BadFile{"MissingKey", kBall, "radius_mm = 33", "", "[[object]]", "has no 'radius_mm'; expected"},
        BadFile{"MissingKeyInRig", kSim, "[manipulator]\ndriver = \"sim\"", "[manipulator]", "[manipulator]",
                "has no 'driver'; expected"},
        BadFile{"MissingKeyInResponse", "responses/tennis_ball.toml", "limit_mm = 6", "", "#",
                "has no 'limit_mm'; expected"},
        BadFile{"WrongType", kBall, "radius_mm = 33", "radius_mm = \"33\"", "\"33\"",
                "is a text; expected a positive number"},
        BadFile{"WrongTypeInRig", kSim, "rate_hz = 1000 ", "rate_hz = [1] ", "[1]", "expected a number"},
        BadFile{"WrongUnit", kBall, "radius_mm = 33", "radius_cm = 3.3", "radius_cm",
                "expected the unit mm; did you mean 'radius_mm'?"},
        BadFile{"WrongUnitInRig", kSim, "speed_mm_s = 50 ", "speed_m_s = 0.05 ", "speed_m_s",
                "did you mean 'speed_mm_s'?"},
        BadFile{"NanMass", kBall, "mass_kg = 0.05", "mass_kg = nan", "nan", "expected a finite number"},
        BadFile{"InfiniteMass", kBall, "mass_kg = 0.05", "mass_kg = inf", "inf", "expected a finite number"},
        BadFile{"NegativeMass", kBall, "mass_kg = 0.05", "mass_kg = -0.05", "-0.05",
                "expected a number of at least 1e-06"},
        BadFile{"NegativeMassBehindTheSensor", kSim, "mass_kg = 0.91", "mass_kg = -0.91", "-0.91",
                "expected a"},
        BadFile{"NegativeStiffness", "behaviours.toml", "N_per_mm = 2\n", "N_per_mm = -2\n", "-2",
                "expected a positive number"},
        BadFile{"InfiniteStiffness", "behaviours.toml", "N_per_mm = 2\n", "N_per_mm = inf\n", "inf",
                "expected a finite number"},
        BadFile{"NanRate", kSim, "rate_hz = 1000 ", "rate_hz = nan ", "nan", "expected a finite number"},
        BadFile{"NegativeRate", kSim, "rate_hz = 1000 ", "rate_hz = -1000 ", "-1000",
                "expected a number from"},
        BadFile{"NegativeTrackerRate", kSim, "rate_hz = 120 ", "rate_hz = -120 ", "-120",
                "expected a number from 0.1 to 100000"},
        BadFile{"TimeStepAboveFiveMilliseconds", kSim, "timestep_us = 1000", "timestep_us = 5001", "5001",
                "at most 5000"},
        BadFile{"TimeStepThatDoesNotDivide", kSim, "timestep_us = 1000", "timestep_us = 700",
                "timestep_us = 700", "does not divide the haptic period"},
        BadFile{"NanCoefficient", "responses/tennis_ball.toml", "press_N_per_mm_k = [",
                "press_N_per_mm_k = [nan, 0, 0, 0] #", "[nan", "expected a finite number"},
        BadFile{"ObjectOutOfReach", kBall, "position_mm = [0, 0, -20]", "position_mm = [200, 0, -20]",
                "position_mm = [200", "outside the machine's reach"},
        BadFile{"PressOutOfReach", kBall, "polar_deg = 0 ", "polar_deg = 170 ", "polar_deg = 170",
                "presses where the machine does not reach"},
        BadFile{"UnknownBehaviour", kBall, "behaviour = \"tennis_ball\"", "behaviour = \"tenis_ball\"",
                "behaviour = \"tenis", "did you mean 'tennis_ball'?"},
        BadFile{"MissingResponseFile", "behaviours.toml", "response = \"tennis_ball\"",
                "response = \"tenis_ball\"", "response = \"tenis", "did you mean 'tennis_ball'?"},
        BadFile{"NotToml", kBall, "radius_mm = 33", "radius_mm 33", "33", "this is not TOML"},
        BadFile{"AnotherFormat", kBall, "format = 1", "format = 2", "2", "this program reads version 1"}),
    [](const auto& test) { return std::string(test.param.name); });

TEST_F(Program, TwoObjectsOfOneName) {
  const std::string second =
      "[[object]]\nname = \"ball\"\nshape = \"plane\"\nposition_mm = [0, 0, 0]\nbehaviour = "
      "\"wall\"\n\n[[tool]]";
  edit("models/scenes/tennis_ball.toml", "[[tool]]", second);
  const std::string text = bytes_of(ball());
  const auto at = text.find("[[object]]", text.find("[[object]]") + 1);
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '\n');
  EXPECT_THAT(scene_refused(ball()), AllOf(StartsWith(ball() + ":" + std::to_string(line) +
                                                      ":1: there are two [[object]] named 'ball'"),
                                           HasSubstr("expected different names")));
}

TEST_F(Program, EmptyScene) {
  write("models/scenes/empty.toml", "");
  EXPECT_THAT(scene_refused(path("models/scenes/empty.toml")),
              StartsWith(path("models/scenes/empty.toml") + ":1:1: the file has no 'format'; expected"));
  write("models/scenes/empty.toml", "format = 1\n");
  EXPECT_THAT(scene_refused(path("models/scenes/empty.toml")),
              StartsWith(path("models/scenes/empty.toml") +
                         ":1:1: the scene has no object; expected at least one [[object]]"));
}

// Slope of the press curve d - 0.9 d^2 is 1 - 1.8 d: it falls from 1 / 1.8 = 0.5556 mm to the limit of 6 mm.
// The program searches the curve in steps, hence the 0.01 mm.
TEST_F(Program, NonMonotonePolynomialIsRefusedWithItsInterval) {
  const std::string response = "models/responses/tennis_ball.toml";
  write(response,
        "format = 1\nsource = \"bad\"\nlimit_mm = 6\npress_N_per_mm_k = [1, -0.9, 0, 0]\n"
        "release_N_per_mm_k = [0.5, 0, 0, 0]\n");
  const std::string said = scene_refused(ball());
  EXPECT_THAT(said, HasSubstr("press curve falls"));
  std::smatch interval;
  ASSERT_TRUE(std::regex_search(said, interval, std::regex("from ([0-9.]+) to ([0-9.]+)"))) << said;
  EXPECT_NEAR(std::stod(interval[1]), 0.5556, 0.01);
  EXPECT_NEAR(std::stod(interval[2]), 6.0, 1e-9);
}

// The line names the response file, not the scene or its behaviour.
TEST_F(Program, NonMonotonePolynomialIsToldWithThePlaceInTheResponseFile) {
  const std::string response = "models/responses/tennis_ball.toml";
  write(response,
        "format = 1\nsource = \"bad\"\nlimit_mm = 6\npress_N_per_mm_k = [1, -0.9, 0, 0]\n"
        "release_N_per_mm_k = [0.5, 0, 0, 0]\n");
  EXPECT_THAT(scene_refused(ball()), HasSubstr(path(response) + ":4:"));
}

TEST_F(Program, MissingResponseFileOnDisk) {
  fs::remove(path("models/responses/tennis_ball.toml"));
  const std::string behaviours = path("models/behaviours.toml");
  EXPECT_THAT(
      scene_refused(ball()),
      AllOf(StartsWith(behaviours + ":" + line_and_column(bytes_of(behaviours), "response = ") + ": "),
            HasSubstr("there is no response file"), HasSubstr("expected a file in")));
}

TEST_F(Program, UnreadableScene) {
  EXPECT_THAT(scene_refused(path("models/scenes/tenis_ball.toml")),
              AllOf(StartsWith(path("models/scenes/tenis_ball.toml") + ":1:1: cannot read this scene: "),
                    HasSubstr("did you mean '" + ball() + "'?")));
  EXPECT_THAT(scene_refused(path("models/scenes")), HasSubstr("it is a folder; expected a TOML file"));
  write("models/scenes/bytes.toml", std::string("\x89PNG\0\xff\n", 7));
  EXPECT_THAT(scene_refused(path("models/scenes/bytes.toml")),
              StartsWith(path("models/scenes/bytes.toml") + ":1:"));
}

TEST_F(Program, UnknownRig) {
  EXPECT_THAT(scene_refused(ball(), {"--rig", "sym"}),
              AllOf(StartsWith(path("models/rigs/sym.toml") + ":1:1: cannot read this rig: "),
                    HasSubstr("did you mean 'sim'?")));
}

TEST_F(Program, ModelsComeFromTheEnvironmentToo) {
  fs::rename(path("models"), path("elsewhere"));
  fs::create_directories(path("lonely"));
  fs::copy_file(path("elsewhere/scenes/plane.toml"), path("lonely/plane.toml"));
  edit("elsewhere/behaviours.toml", "N_per_mm = 2\n", "N_per_mm = -2\n");
  const Result r =
      run_program({"check", path("lonely/plane.toml")}, {{"ENCOUNTER_MODELS", path("elsewhere")}});
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, StartsWith("encounter: " + path("elsewhere/behaviours.toml") + ":"));
}

// A scene in a shared folder runs with the program's own files, not with files that somebody put there.
TEST_F(Program, WhatLiesBesideOrAboveASceneIsNotTaken) {
  fs::create_directories(path("shared/scenes"));
  fs::copy_file(ball(), path("shared/scenes/ball.toml"));
  for (const char* folder : {"rigs", "responses", "mjcf", "meshes"})
    fs::create_directories(path(std::string("shared/") + folder));
  for (const char* theirs :
       {"behaviours.toml", "rigs/sim.toml", "responses/tennis_ball.toml", "mjcf/hexapod.xml"})
    write(std::string("shared/") + theirs, "theirs");
  const Result r =
      run_program({"run", path("shared/scenes/ball.toml"), "--for-s", "0.1"}, {{"ENCOUNTER_MODELS", ""}});
  EXPECT_EQ(r.code, 0) << r.err;
}

TEST_F(Program, AProgramWithoutItsModelsTakesNoneFromWhereItIsStarted) {
  fs::create_directories(path("a/b/c"));
  fs::copy_file(program_file(), path("a/b/c/encounter"));
  const Result r = run(
      {"bash", "-c", "cd \"$1\" && a/b/c/encounter check models/scenes/plane.toml", "bash", folder_.string()},
      {{"ENCOUNTER_MODELS", ""}});
  EXPECT_EQ(r.code, 2) << r.out;
  EXPECT_THAT(r.err, AllOf(HasSubstr("a/b/c/models/rigs/sim.toml:1:1: cannot read this rig: "),
                           HasSubstr("set ENCOUNTER_MODELS to the folder that has it")));
}

TEST_F(Program, ARigFileThatASceneNamesIsFoundFromTheScene) {
  fs::create_directories(path("mine/rigs"));
  write("mine/plane.toml", replaced(bytes_of(plane()), "title", "made_for = \"rigs/own.toml\"\ntitle"));
  const Words check{"check", path("mine/plane.toml")};
  EXPECT_THAT(refused(check), StartsWith(path("mine/rigs/own.toml") + ":1:1: cannot read this rig: "));
  fs::copy_file(path("models/rigs/sim.toml"), path("mine/rigs/own.toml"));
  EXPECT_EQ(run_program(check).code, 0);
}

// Otherwise a scene could print the lines of a report.
TEST_F(Program, ATitleOrNameIsPrintableOnOneLine) {
  const std::string text = bytes_of(plane());
  for (const char* letters :
       {"\\nstate hash  122d7c00183e94e0", "\\u001b[2J", "\\u009b2J", "\\u202e", "\\t", "\\r"})
    for (const char* key : {"title = \"", "name = \"wall"}) {
      write("models/scenes/theirs.toml", replaced(text, key, key + std::string(letters)));
      const std::string said = scene_refused(path("models/scenes/theirs.toml"));
      EXPECT_THAT(said, StartsWith(path("models/scenes/theirs.toml") + ":")) << letters;
      EXPECT_THAT(said, HasSubstr("which cannot be printed as it is; expected printable text on one line"));
      EXPECT_EQ(said.find_first_of("\033\r\t"), std::string::npos);
    }
  EXPECT_THAT(refused({"run", plane(), "--set", "scene.tit\033[2Jle=x"}), HasSubstr("\\x1b[2J"));
}

// Anybody may choose the name of a file in a shared folder.
TEST_F(Program, ANameOfAFileForgesNoLine) {
  const std::string scene = path("a\nstate hash  122d7c00183e94e0.toml");
  fs::copy_file(plane(), scene);
  const Result r = run_program({"run", scene, "--for-s", "0.1"});
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, HasSubstr("a\\nstate hash  122d7c00183e94e0.toml, rig "));
}

// A missing driver, for each role that the scene names, in a rig file or by --set. `run` and `check` report
// it in equal words.
TEST_F(Program, ADriverThatIsNotThereIsNamedWithThoseThatAre) {
  for (const char* role : {"manipulator", "force", "tracker", "display"}) {
    const std::string table = std::string("[") + role + "]\ndriver = ";
    const std::string text =
        replaced(bytes_of(path("models/rigs/sim.toml")), table + "\"sim\"", table + "\"no_such\"");
    write("models/rigs/lab.toml", text);
    EXPECT_THAT(
        scene_refused(ball(), {"--rig", "lab"}),
        AllOf(StartsWith(path("models/rigs/lab.toml") + ":" + line_and_column(text, "driver = \"no_such\"") +
                         ": there is no driver 'no_such'; expected one of 'sim', 'forcedimension', 'gcs', "),
              HasSubstr("correct the name, or build it")))
        << role;
  }
  EXPECT_THAT(
      scene_refused(ball(), {"--set", "rig.manipulator.driver=gsc"}),
      AllOf(StartsWith("--set rig.manipulator.driver=gsc: there is no driver 'gsc'; expected one of "),
            HasSubstr("'netft', 'phantom', 'sample', 'v4l2'; did you mean 'gcs'?")));
  for (const char* command : {"fake", "devices", "params"}) {
    const bool rig = std::string(command) != "params";
    EXPECT_THAT(refused({command, rig ? "sim" : ball(), "--set", "rig.force.driver=vision"}),
                StartsWith("--set rig.force.driver=vision: there is no driver 'vision'"))
        << command;
  }
  EXPECT_EQ(run_program({"check", shipped_scene("rig_A"), "--set", "rig.display.driver=gsc"}).code, 0)
      << "the scene has no display";
}

// The driver's table is right and the role misspells its name: the line gives both places.
TEST_F(Program, ADriverThatIsMistypedBesideItsTableIsNamedToo) {
  const std::string text =
      replaced(bytes_of(path("models/rigs/fakes.toml")), "driver = \"gcs\"", "driver = \"gsc\"");
  write("models/rigs/lab.toml", text);
  const std::string lab = path("models/rigs/lab.toml") + ":";
  EXPECT_EQ(scene_refused(ball(), {"--rig", "lab"}),
            lab + line_and_column(text, "[driver.gcs]") +
                ": no role of this rig has the driver 'gcs'; expected one that a role names; did you mean "
                "'gsc', as " +
                lab + line_and_column(text, "driver = \"gsc\"") + " says?\n");
}

TEST_F(Program, ADriverThatDoesNotFillItsRoleIsNamedWithThoseThatDo) {
  const std::string text = replaced(bytes_of(path("models/rigs/sim.toml")), "[force]\ndriver = \"sim\"",
                                    "[force]\ndriver = \"gcs\"");
  write("models/rigs/lab.toml", text);
  EXPECT_EQ(
      scene_refused(ball(), {"--rig", "lab"}),
      path("models/rigs/lab.toml") + ":" + line_and_column(text, "driver = \"gcs\"") +
          ": driver 'gcs' is for no force sensor; expected one of 'sim', 'netft', 'sample'; name one of "
          "them\n");
  EXPECT_THAT(scene_refused(ball(), {"--set", "rig.tracker.driver=netft"}),
              StartsWith("--set rig.tracker.driver=netft: driver 'netft' is for no tracker; expected one of "
                         "'sim', 'igtl'; name"));
}

// No server listens at port 1. The line names which of three devices fails, and its place in the rig file.
TEST_F(Program, ADeviceThatDoesNotAnswerIsNamedByItsRoleAndItsPlace) {
  const std::string text = bytes_of(path("models/rigs/fakes.toml"));
  for (const auto& [role, driver, key] :
       {std::tuple{"manipulator", "gcs", "port"}, {"force", "netft", "http_port"}}) {
    Words words{"run",     ball(), "--rig", "fakes",
                "--for-s", "0.1",  "--set", std::string("rig.driver.") + driver + "." + key + "=1"};
    if (std::string(role) != "manipulator")
      words.insert(words.end(), {"--set", "rig.manipulator.driver=sim"});
    EXPECT_THAT(refused(words, 3),
                StartsWith(path("models/rigs/fakes.toml") + ":" +
                           line_and_column(text, std::string("driver = \"") + driver + "\"") + ": " + role +
                           ": 127.0.0.1:1: nobody listens there; see that the device is on"));
  }
}

// ---- Wrong arguments: one line refuses each before anything runs; and the help.

TEST_F(Program, SetThatCannotBe) {
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radus_mm=30"}),
              AllOf(StartsWith("--set object.ball.radus_mm=30: unknown parameter"),
                    HasSubstr("did you mean 'object.ball.radius_mm'?")));
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radius_cm=3"}), HasSubstr("radius_mm"));
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radius_mm=wide"}), HasSubstr("expected a"));
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radius_mm=nan"}), HasSubstr("expected a finite"));
  EXPECT_THAT(scene_refused(ball(), {"--set", "object.ball.radius_mm"}), HasSubstr("expected name=value"));
  EXPECT_THAT(scene_refused(ball(), {"--set", "user.polar_deg=170"}),
              StartsWith("--set user.polar_deg=170: the user presses where the machine does not reach"));
}

TEST_F(Program, PaceThatIsRubbish) {
  for (const char* pace : {"rubbish", "10x", "0", "-1", "nan", "inf", "1e999", "free ", "1,5"})
    EXPECT_THAT(refused({"run", ball(), "--for-s", "0.1", "--record", path("never.encrec"),
                         std::string("--pace=") + pace}),
                HasSubstr("expected free, wall, or a positive number"))
        << "pace '" << pace << "'";
  EXPECT_THAT(refused({"run", ball(), "--for-s", "0.1", "--pace="}), HasSubstr("--pace"));
}

TEST_F(Program, LengthThatIsNotPositive) {
  for (const char* length : {"-1", "0", "-0.0", "-inf", "inf", "1e300"})
    EXPECT_THAT(refused({"run", ball(), std::string("--for-s=") + length, "--record", path("never.encrec")}),
                HasSubstr("--for-s: expected a positive number"))
        << length;
  EXPECT_THAT(refused({"run", ball(), "--for-s=soon"}), HasSubstr("--for-s"));
}

// Inside the program NaN means "not given"; from a person it is bad input.
TEST_F(Program, LengthThatIsNaN) {
  EXPECT_THAT(refused({"run", plane(), "--for-s=nan", "--record", path("never.encrec")}),
              HasSubstr("--for-s: expected a positive number"));
}

TEST_F(Program, SeedThatIsNoWholeNumber) {
  for (const char* seed : {"x", "1.5", ""})
    EXPECT_THAT(refused({"run", ball(), "--for-s=0.1", std::string("--seed=") + seed}), HasSubstr("--seed"))
        << seed;
}

// Every command with a seed refuses it.
TEST_F(Program, SeedThatIsNegativeOrTooLarge) {
  for (const char* seed : {"-1", "99999999999999999999999"})
    for (const Words& words :
         {Words{"run", ball(), "--for-s=0.1"}, Words{"fake", "fakes"}, Words{"bench"},
          Words{"calibrate", "camera", "vishap"}, Words{"calibrate", "rig", "sim"}, Words{"view", ball()}}) {
      Words all = words;
      all.push_back(std::string("--seed=") + seed);
      const bool two = words.front() == "calibrate";
      EXPECT_EQ(refused(all),
                "--seed: expected a whole number from 0 to 18446744073709551615; see encounter " +
                    words.front() + (two ? " " + words[1] : "") + " --help\n");
    }
}

TEST_F(Program, OptionsThatDoNotExist) {
  EXPECT_THAT(refused({"run", ball(), "--recrd", path("never.encrec")}), HasSubstr("--recrd"));
  EXPECT_THAT(refused({"check", ball(), "--pace", "free"}), HasSubstr("--pace"));
  EXPECT_THAT(refused({"run", ball(), "superfluous"}), HasSubstr("superfluous"));
  EXPECT_THAT(refused({"run"}), HasSubstr("scene"));
  EXPECT_THAT(refused({"replay"}), HasSubstr("record"));
  EXPECT_THAT(refused({}), HasSubstr("see encounter --help"));
}

TEST_F(Program, SubcommandThatDoesNotExistIsNamedWithTheNearest) {
  EXPECT_THAT(refused({"rn", ball()}), AllOf(HasSubstr("'rn'"), HasSubstr("'run'")));
}

TEST_F(Program, EverySubcommandHasHelp) {
  for (const char* command :
       {"run", "check", "replay", "view", "params", "bench", "fit", "doctor", "fake", "devices"}) {
    const Result r = run_program({command, "--help"});
    EXPECT_EQ(r.code, 0) << command;
    EXPECT_EQ(r.err, "") << command;
    EXPECT_THAT(r.out, HasSubstr("Usage:")) << command;
  }
  EXPECT_EQ(run_program({"--help"}).code, 0);
  EXPECT_THAT(run_program({"--version"}).out,
              MatchesRegex("Encounter [0-9]+\\.[0-9]+\\.[0-9]+, commit .+ of .+\n"));
}

}  // namespace
}  // namespace enc::tests
