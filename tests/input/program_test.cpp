// The program as a person calls it: every kind of bad input ends with exit code 2 (3 for a device), one line
// that says where and what was expected, and before anything has run. And what good input prints.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "core/record/record.h"
#include "tests/support/built.h"
#include "tests/support/bytes_of.h"
#include "tests/support/run_program.h"
#include "tests/support/temporary_folder.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::MatchesRegex;
using ::testing::Not;
using ::testing::StartsWith;
using Json = nlohmann::json;
using Words = std::vector<std::string>;

using test::bytes_of;

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  EXPECT_NE(at, std::string::npos) << "not in the file: " << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

// "12:3" of the first `what` in a text; columns count from 1.
std::string line_and_column(const std::string& text, const std::string& what) {
  const auto at = text.find(what);
  EXPECT_NE(at, std::string::npos) << "not in the file: " << what;
  if (at == std::string::npos) return "?";
  const auto head = text.substr(0, at);
  const auto line = 1 + std::count(head.begin(), head.end(), '\n');
  const auto column = at - (head.rfind('\n') == std::string::npos ? 0 : head.rfind('\n') + 1) + 1;
  return std::to_string(line) + ":" + std::to_string(column);
}

// A folder of our own with a copy of models/, so that a test may break what it likes.
class Program : public ::testing::Test {
 protected:
  Program() {
    fs::create_directory(folder_ / "models");
    const fs::path models = fs::path(ENCOUNTER_SOURCE_DIR) / "models";
    for (const char* part : {"scenes", "rigs", "mjcf", "responses"})
      fs::copy(models / part, folder_ / "models" / part, fs::copy_options::recursive);
    fs::copy(models / "behaviours.toml", folder_ / "models");
    unsetenv("ENCOUNTER_MODELS");
    unsetenv("ENCOUNTER_MODULES");
  }

  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }
  [[nodiscard]] std::string ball() const { return path("models/scenes/tennis_ball.toml"); }
  [[nodiscard]] std::string plane() const { return path("models/scenes/plane.toml"); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  void edit(const std::string& name, const std::string& from, const std::string& to) const {
    write(name, replaced(bytes_of(folder_ / name), from, to));
  }
  [[nodiscard]] Words files() const {
    Words names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) names.push_back(entry.path());
    std::sort(names.begin(), names.end());
    return names;
  }

  // Runs what must be refused; gives its one line. Nothing on stdout, no file made, none changed in number.
  [[nodiscard]] std::string refused(const Words& args, int code = 2) const {
    const Words before = files();
    const Result r = run_program(args);
    EXPECT_EQ(r.code, code) << r.err;
    EXPECT_EQ(r.out, "") << "something ran";
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << "one line: " << r.err;
    EXPECT_THAT(r.err, AllOf(StartsWith("encounter: "), EndsWith("\n")));
    EXPECT_EQ(files(), before) << "a file was left behind";
    return r.err.substr(std::min<std::size_t>(11, r.err.size()));
  }
  // `run` with a record and `check` say the same.
  [[nodiscard]] std::string scene_refused(const std::string& scene, const Words& more = {}) const {
    Words run{"run", scene, "--for-s", "0.1", "--record", path("never.encrec")};
    Words check{"check", scene};
    run.insert(run.end(), more.begin(), more.end());
    check.insert(check.end(), more.begin(), more.end());
    const std::string said = refused(run);
    EXPECT_EQ(refused(check), said);
    return said;
  }
  // A good record of half a second.
  [[nodiscard]] std::string recorded(const Words& more = {}) const {
    Words run{"run", plane(), "--for-s", "0.5", "--record", path("run.encrec")};
    run.insert(run.end(), more.begin(), more.end());
    const Result r = run_program(run);
    EXPECT_EQ(r.code, 0) << r.err;
    return path("run.encrec");
  }

  test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

// ---- files that are wrong
// ------------------------------------------------------------------------------------

struct BadFile {
  const char* name;   // of the test
  const char* file;   // edited, under models/
  const char* from;   // this ...
  const char* to;     // ... becomes this
  const char* at;     // the place told is where this begins, after the edit
  const char* words;  // what the line says
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
                "expected a positive number"},
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
// The curve is searched in steps, hence the 0.01 mm.
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

// The response file is at fault, not the scene that names a behaviour that names it.
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

TEST_F(Program, UnknownDriverModuleIsADevice) {
  for (const char* role : {"manipulator", "force", "tracker", "display"}) {
    const std::string table = std::string("[") + role + "]\ndriver = ";
    write("models/rigs/lab.toml",
          replaced(bytes_of(path("models/rigs/sim.toml")), table + "\"sim\"", table + "\"no_such\""));
    EXPECT_THAT(
        refused({"run", ball(), "--rig", "lab", "--for-s", "0.1", "--record", path("never.encrec")}, 3),
        AllOf(HasSubstr("there is no module 'no_such'"), HasSubstr("modules there: ")))
        << role;
  }
}

// ---- words that are wrong
// ------------------------------------------------------------------------------------

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

// NaN is how "not given" is said inside; given by a person it is bad input all the same.
TEST_F(Program, LengthThatIsNaN) {
  EXPECT_THAT(refused({"run", plane(), "--for-s=nan", "--record", path("never.encrec")}),
              HasSubstr("--for-s: expected a positive number"));
}

TEST_F(Program, SeedThatIsNoWholeNumber) {
  for (const char* seed : {"x", "1.5", ""})
    EXPECT_THAT(refused({"run", ball(), "--for-s=0.1", std::string("--seed=") + seed}), HasSubstr("--seed"))
        << seed;
}

TEST_F(Program, SeedThatIsNegativeOrTooLarge) {
  for (const char* seed : {"-1", "99999999999999999999999"})
    EXPECT_THAT(refused({"run", ball(), "--for-s=0.1", std::string("--seed=") + seed}), HasSubstr("--seed"))
        << seed;
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

// ---- records
// -------------------------------------------------------------------------------------------------

TEST_F(Program, UnwritableRecordFolder) {
  write("file", "");
  for (const std::string& record : {path("file/run.encrec"), path("nowhere/run.encrec"), path("models")})
    EXPECT_THAT(refused({"run", ball(), "--for-s", "0.1", "--record", record}),
                AllOf(StartsWith(record + ": cannot be written: "), HasSubstr("; choose a file")));
  EXPECT_THAT(refused({"run", ball(), "--for-s", "0.1", "--record", "/dev/full"}),
              HasSubstr("No space left on device"));
}

// 200 KiB hold the header and three chunks of 64 KiB; each has about a hundred ticks.
TEST_F(Program, FullDiskWhileRecordingEndsTheRunAndLeavesWhatWasWritten) {
  const std::string record = path("full.encrec");
  const Result r = run({"bash", "-c",
                        "ulimit -f 200; exec '" + program_file() + "' run '" + plane() +
                            "' --for-s 3 --record '" + record + "'"});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  EXPECT_THAT(r.err, AllOf(StartsWith("encounter: cannot write the record"), HasSubstr("File too large")));
  EXPECT_THAT(r.out, AllOf(HasSubstr("\nmodes "), HasSubstr("\nstate hash ")));  // the report of what did run
  EXPECT_FALSE(fs::exists(record));                                              // it is not whole
  const std::string aside = record + ".part";
  EXPECT_THAT(r.err, AllOf(HasSubstr(aside), HasSubstr("replay --partial")));
  EXPECT_LE(fs::file_size(aside), 200U * 1024U);
  EXPECT_EQ(run_program({"replay", aside}).code, 2);
  const Result part = run_program({"replay", aside, "--partial"});
  EXPECT_EQ(part.code, 0) << part.err;
  std::smatch ticks;
  ASSERT_TRUE(std::regex_search(part.out, ticks, std::regex("^([0-9]+) ticks run again, equal to the bit")));
  EXPECT_GE(std::stoi(ticks[1]), 200);
  EXPECT_LT(std::stoi(ticks[1]), 500);
  EXPECT_THAT(part.out, HasSubstr("not sealed"));
}

// The first 2 KiB do not even hold the header: nothing runs, so nothing may be left.
TEST_F(Program, DiskTooFullForTheHeaderLeavesNoFile) {
  const std::string record = path("full.encrec");
  const Result r = run({"bash", "-c",
                        "ulimit -f 1; exec '" + program_file() + "' run '" + plane() +
                            "' --for-s 3 --record '" + record + "'"});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(r.out, "");
  EXPECT_THAT(r.err, HasSubstr("cannot write the record"));
  EXPECT_FALSE(fs::exists(record) || fs::exists(record + ".part"));
}

TEST_F(Program, TruncatedRecord) {
  const std::string whole = bytes_of(recorded());
  write("cut.encrec", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(refused({"replay", path("cut.encrec")}),
              MatchesRegex(".*cut\\.encrec: byte [0-9]+: the record is cut off here.*--partial.*\n"));
  const Result part = run_program({"replay", path("cut.encrec"), "--partial"});
  EXPECT_EQ(part.code, 0) << part.err;
  EXPECT_THAT(part.out, HasSubstr("equal to the bit"));
  write("cut.encrec", whole.substr(0, 100));  // in its header
  EXPECT_THAT(refused({"replay", path("cut.encrec")}), HasSubstr("cut off in its header"));
  EXPECT_THAT(refused({"replay", path("cut.encrec"), "--partial"}), HasSubstr("cut off in its header"));
}

TEST_F(Program, RecordThatIsNone) {
  EXPECT_THAT(refused({"replay", path("nothing.encrec")}), HasSubstr("cannot read the record"));
  EXPECT_THAT(refused({"replay", ball()}), HasSubstr("byte 0: this is not a record of Encounter"));
  EXPECT_THAT(refused({"replay", path("models")}), HasSubstr("record"));
  write("none.encrec", "");
  EXPECT_THAT(refused({"replay", path("none.encrec")}), HasSubstr("byte 0: "));
}

TEST_F(Program, RecordOfAnotherLayout) {
  { RecordWriter other(path("other.encrec"), {{"version", "9.8.7"}}, layout_hash() ^ 1U); }
  EXPECT_THAT(refused({"replay", path("other.encrec")}),
              AllOf(HasSubstr("record of another layout"), HasSubstr("of Encounter 9.8.7"),
                    HasSubstr("use the version of Encounter that wrote it")));
}

TEST_F(Program, RecordWithoutAScene) {
  {
    RecordWriter bare(path("bare.encrec"), {});
    bare.close();
  }
  EXPECT_THAT(refused({"replay", path("bare.encrec")}), HasSubstr("holds no scene"));
}

TEST_F(Program, ChecksumFailure) {
  std::string bytes = bytes_of(recorded());
  bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
  write("bad.encrec", bytes);
  EXPECT_THAT(refused({"replay", path("bad.encrec")}), HasSubstr("checksum failure"));
}

// One input changed by one part in 10^12 and sealed again: the file is sound, the answer is no.
TEST_F(Program, AlteredAndResealedRecordDiffers) {
  RecordReader reader(recorded());
  {
    RecordWriter changed(path("changed.encrec"), reader.texts());
    RecordedTick frame;
    while (reader.next(frame)) {
      if (frame.tick.index == 400) frame.in.wrench.value.force.xyz[2] *= 1.0 + 1e-12;
      changed.write(frame.tick, frame.in, frame.out, frame.hash);
    }
    changed.close();
  }
  const Result r = run_program({"replay", path("changed.encrec")});
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(r.err, "");
  EXPECT_THAT(r.out, StartsWith("differs from tick 400 on: "));
}

TEST_F(Program, ReplayIsEqualAndNamesTheHashOfTheRun) {
  const Result run =
      run_program({"run", ball(), "--for-s", "0.5", "--json", "--seed", "5", "--record", path("run.encrec")});
  ASSERT_EQ(run.code, 0) << run.err;
  fs::remove_all(path("models"));  // the record needs nothing else
  const Result replay = run_program({"replay", path("run.encrec")});
  EXPECT_EQ(replay.code, 0) << replay.err;
  EXPECT_EQ(replay.out, "501 ticks run again, equal to the bit; state hash " +
                            Json::parse(run.out).at("state_hash").get<std::string>() + "\n");
}

// ---- good input
// ----------------------------------------------------------------------------------------------

TEST_F(Program, EverySubcommandHasHelp) {
  for (const char* command : {"run", "check", "replay", "view", "params", "bench", "fit", "doctor"}) {
    const Result r = run_program({command, "--help"});
    EXPECT_EQ(r.code, 0) << command;
    EXPECT_EQ(r.err, "") << command;
    EXPECT_THAT(r.out, HasSubstr("Usage:")) << command;
  }
  EXPECT_EQ(run_program({"--help"}).code, 0);
  EXPECT_THAT(run_program({"--version"}).out, MatchesRegex("encounter [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

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
  const std::string scene = ENCOUNTER_SOURCE_DIR "/models/scenes/clamped_tool.toml";
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
  EXPECT_THAT(r.out, HasSubstr("left out    display"));
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
  EXPECT_EQ(r.out, before);
}

// ---- fit
// ----------------------------------------------------------------------------------------------------

// One press to 6 mm at 4 mm/s: 2 N/mm in, 1.5 N/mm out.
std::string loop_text() {
  std::string text = "time_s,deflection_mm,force_N,repeat\n";
  for (int i = 1; i <= 3000; ++i) {
    const int steps = i <= 1500 ? i : 3000 - i;  // of 4 um
    const auto fixed = [](int micro) {
      const std::string digits = std::to_string(micro);
      return "0." + std::string(6 - std::min<std::size_t>(6, digits.size()), '0') + digits;
    };
    const auto decimal = [&](int micro) {
      return std::to_string(micro / 1000000) + fixed(micro % 1000000).substr(1);
    };
    text += decimal(i * 1000) + "," + decimal(steps * 4000) + "," +
            decimal(steps * (i <= 1500 ? 8000 : 6000)) + ",1\n";
  }
  return text;
}

TEST_F(Program, FitWritesAResponseThatAScenePlays) {
  write("loop.csv", loop_text());
  const Result fit = run_program({"fit", path("loop.csv"), "--out", path("models/responses/mine.toml")});
  ASSERT_EQ(fit.code, 0) << fit.err;
  EXPECT_THAT(fit.out, AllOf(HasSubstr("1 presses"), HasSubstr("without constraints"), HasSubstr("95 %"),
                             HasSubstr("condition"), HasSubstr("no weight")));
  EXPECT_THAT(bytes_of(path("models/responses/mine.toml")),
              AllOf(HasSubstr("Of unknown origin."), Not(HasSubstr(path("")))));
  edit("models/behaviours.toml", "response = \"tennis_ball\"", "response = \"mine\"");
  for (const char* reversal : {"energy_stop", "prandtl_ishlinskii"}) {
    const Result check = run_program(
        {"check", ball(), "--resolved", "--set", std::string("behaviour.tennis_ball.reversal=") + reversal});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_THAT(check.out, HasSubstr(reversal));
  }
}

TEST_F(Program, FitRefusesBadLoopsInOneLine) {
  const std::string good = loop_text();
  write("loop.csv", good);
  write("text.csv", replaced(good, "0.024000", "much"));
  write("column.csv", replaced(good, "force_N", "force"));
  write("short.csv", good.substr(0, good.size() / 4).substr(0, good.rfind('\n', good.size() / 4) + 1));
  write("empty.csv", "");
  const std::vector<std::pair<Words, std::string>> cases{
      {{"fit", path("text.csv")}, path("text.csv") + ":4:"},
      {{"fit", path("column.csv")}, path("column.csv") + ":1:1: there is no column 'force_N'"},
      {{"fit", path("short.csv")}, "the deepest deflection is"},
      {{"fit", path("empty.csv")}, path("empty.csv") + ":1:1:"},
      {{"fit", path("none.csv")}, "cannot read this loop"},
      {{"fit", path("models")}, "cannot read this loop"},
      {{"fit", path("loop.csv"), "--limit-mm", "7"}, "--limit-mm 6"},
      {{"fit", path("loop.csv"), "--limit-mm", "-1"}, "--limit-mm"},
      {{"fit", path("loop.csv"), "--ceiling-N-per-mm", "0.1"}, "--ceiling-N-per-mm"},
      {{"fit", path("loop.csv"), "--rig", "simm"}, "did you mean 'sim'"},
      {{"fit", path("loop.csv"), "--out", path("none/f.toml")}, "cannot be written"}};
  for (const auto& [args, says] : cases) {
    const Result r = run_program(args);
    EXPECT_EQ(r.code, 2) << args[1];
    EXPECT_THAT(r.err, HasSubstr(says));
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  }
}

TEST_F(Program, StopsThatAFileDoesNotHaveAreMissed) {
  const std::string file = bytes_of(path("models/responses/tennis_ball.toml"));
  write("models/responses/tennis_ball.toml", file.substr(0, file.find("\n[")) + "\n");
  const Result r =
      run_program({"check", ball(), "--set", "behaviour.tennis_ball.reversal=prandtl_ishlinskii"});
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, AllOf(HasSubstr("no [stops]"), HasSubstr("encounter fit"), HasSubstr("tennis_ball")));
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
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
      "^(tick|time) |\"(p50|p99|p99_9|max|wall_s|times_real_time|started_cpu_ms|peak_memory_MiB)\":");
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
