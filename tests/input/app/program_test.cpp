// The program as a person calls it: the output for good input, the files of `export`, and the libraries that
// the program loads.
#include "tests/input/app/program.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

using Json = nlohmann::json;

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
  // Two seconds without a press have no force error: null, never NaN.
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
  const Json wall = parts(plane());  // has no [display]
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
  EXPECT_EQ(r.err, "");  // no progress display in a pipe
  EXPECT_LE(std::count(r.out.begin(), r.out.end(), '\n'), 25);
  EXPECT_THAT(r.out, AllOf(HasSubstr("\nbuilt "), HasSubstr("\nleft out "), HasSubstr("\nmodes "),
                           HasSubstr("\nforce "), HasSubstr("\napproach "), HasSubstr("miss"),
                           HasSubstr("bound"), HasSubstr("\nenergy "), HasSubstr("\ntick "),
                           HasSubstr("\ntime "), HasSubstr("\nstate hash ")));
}

// The tool never comes back into view: the run ends in hold.
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
  // --set shows in both: the wall at 11 mm is 11 mm up.
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
    // Six fields: five commas outside quotes.
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

// --set accepts the value of every row: it changes nothing.
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

// Removes the measurements of a wall clock.
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
  // The locale is made here, because few machines have it; where that fails the C locale stands in.
  fs::create_directories(path("locale"));
  const bool made = run({"localedef", "-i", "de_DE", "-f", "UTF-8", path("locale/de_DE.UTF-8")}).code == 0;
  const Environment german{{"LC_ALL", made ? "de_DE.UTF-8" : "C"}, {"LOCPATH", path("locale")}};
  const Environment plain{{"LC_ALL", "C"}};
  if (made) {
    EXPECT_EQ(run({"bash", "-c", "printf '%.1f' 1,5"}, german).out, "1,5");  // the locale works
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

// ---- `export`: a record as a table or as MCAP, a scene as MuJoCo's own programs open it; and one line for
// every other input.

using Words = std::vector<std::string>;

const std::string kRoot = tests::source_dir();
const std::string kWall = kRoot + "/models/scenes/wall.toml", kRecord = kRoot + "/tests/data/press.encrec";

std::string line(const Words& args) {
  const Result r = run_program(args);
  EXPECT_EQ(r.code, 2) << r.out << r.err;
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  return r.err;
}

TEST(Export, AWorldHasTheRigAndTheNumbersThatItIsGiven) {
  const test::TemporaryFolder folder;
  const auto world = [&](const char* name, const Words& more) {
    Words args{"export", kWall, folder.file(name)};
    args.insert(args.end(), more.begin(), more.end());
    const Result r = run_program(args);
    EXPECT_EQ(r.code, 0) << r.err;
    return test::bytes_of(folder.file(name));
  };
  const std::string as_shipped = world("a.xml", {});
  EXPECT_THAT(as_shipped, AllOf(HasSubstr("<mujoco"), Not(HasSubstr("timestep=\"0.0005\""))));
  EXPECT_THAT(world("b.xml", {"--set", "truth.arm.timestep_us=500"}), HasSubstr("timestep=\"0.0005\""));
  EXPECT_NE(world("c.xml", {"--rig", "stage"}), as_shipped);
  EXPECT_THAT(line({"export", kWall, folder.file("d.xml"), "--set", "truth.arm.timestep_us=501"}),
              HasSubstr("does not divide the haptic period"));
  EXPECT_THAT(line({"export", kWall, folder.file("d.xml"), "--rig", "none"}), HasSubstr("none"));
  EXPECT_FALSE(std::filesystem::exists(folder.file("d.xml")));
}

// The energy balance of the run, to the last digit; for a record without one, the reason.
TEST(Export, TheLedgerOfARecordIsThatOfItsRun) {
  const test::TemporaryFolder folder;
  const std::string record = folder.file("keypad.encrec"), keypad = kRoot + "/models/scenes/keypad.toml";
  const Result ran = run_program({"run", keypad, "--for-s", "6", "--json", "--record", record});
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto json = nlohmann::json::parse(ran.out).at("ledger");
  ASSERT_EQ(json.size(), 1U);
  const Result ledger = run_program({"export", record, "--ledger"});
  ASSERT_EQ(ledger.code, 0) << ledger.err;
  EXPECT_EQ(std::count(ledger.out.begin(), ledger.out.end(), '\n'), 2);
  EXPECT_THAT(ledger.out, StartsWith("contact,object,rendered,began_s,ended_s,hand_mJ,"));
  const std::string row = ledger.out.substr(ledger.out.find('\n') + 1);
  EXPECT_THAT(row, StartsWith("1,"));
  EXPECT_EQ(std::stod(row.substr(row.find_last_of(',') + 1)), json.at(0).at("closure_percent").get<double>());
  const Result again = run_program({"replay", record});
  EXPECT_EQ(again.code, 0);
  EXPECT_THAT(again.out, HasSubstr("\nenergy ledger of 1 contact, as the run had it: export --ledger\n"));
  EXPECT_THAT(line({"export", kRecord, "--ledger"}), HasSubstr("press.encrec: has no energy ledger"));
}

TEST(Export, WhatIsOfTheOtherIsRefused) {
  const test::TemporaryFolder folder;
  const std::string xml = folder.file("w.xml"), csv = folder.file("t.csv");
  EXPECT_THAT(line({"export", kWall, xml, "--csv", csv}), HasSubstr("--csv: only of a record"));
  EXPECT_THAT(line({"export", kWall, xml, "--csv", "-"}), HasSubstr("--csv: only of a record"));
  EXPECT_THAT(line({"export", kWall, xml, "--partial"}), HasSubstr("--partial: only of a record"));
  EXPECT_THAT(line({"export", kWall, xml, "--ledger"}), HasSubstr("--ledger: only of a record"));
  EXPECT_THAT(line({"export", kWall, "-"}), HasSubstr("expected a file"));
  EXPECT_THAT(line({"export", kWall, ""}), HasSubstr("xml"));
  EXPECT_THAT(line({"export", kRecord, xml}), HasSubstr("press.encrec: is a record"));
  EXPECT_THAT(line({"export", kWall}), HasSubstr("wall.toml: is a scene"));
  EXPECT_THAT(line({"export", kWall, "--csv", csv}), HasSubstr("wall.toml: is a scene"));
  EXPECT_THAT(line({"export", kRecord, "--rig", "sim"}), HasSubstr("--rig: only of a scene"));
  EXPECT_THAT(line({"export", kRecord, "--set", "a=1"}), HasSubstr("--set: only of a scene"));
  EXPECT_THAT(line({"export", kWall, kWall, "--force"}), HasSubstr("is read by this command"));
  EXPECT_TRUE(std::filesystem::is_empty(std::filesystem::path(xml).parent_path()));
}

// MCAP needs a file of its own beside table, energy balance and world. Its readers look for its end, so a
// pipe is no use.
TEST(Export, McapIsAFileOfItsOwn) {
  const test::TemporaryFolder folder;
  const std::string mcap = folder.file("r.mcap"), csv = folder.file("t.csv");
  EXPECT_THAT(line({"export", kRecord, "--mcap", ""}), AllOf(HasSubstr("--mcap"), HasSubstr("empty")));
  EXPECT_THAT(line({"export", kRecord, "--mcap"}), HasSubstr("--mcap"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--csv", csv}), HasSubstr("--csv: only of a table"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--csv", "-"}), HasSubstr("--csv: only of a table"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--ledger"}), HasSubstr("--ledger: only of a table"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--rig", "sim"}), HasSubstr("--rig: only of a scene"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", mcap, "--truth"}), HasSubstr("--truth: only of a table"));
  EXPECT_THAT(line({"export", kRecord, "--ros2"}), HasSubstr("--ros2 requires --mcap"));
  EXPECT_THAT(line({"export", kRecord, "--uncompressed"}), HasSubstr("--uncompressed requires --mcap"));
  EXPECT_THAT(line({"export", kWall, folder.file("w.xml"), "--mcap", mcap}),
              HasSubstr("--mcap: only of a record"));
  EXPECT_THAT(line({"export", kWall, "--mcap", mcap}), HasSubstr("wall.toml: is a scene"));
  EXPECT_THAT(line({"export", kRecord, "--mcap", folder.file("none/r.mcap")}),
              HasSubstr("cannot be written"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// Like every file of the program, MCAP never replaces an existing file or its input.
TEST(Export, McapReplacesNothingUnasked) {
  const test::TemporaryFolder folder;
  const std::string mcap = folder.file("r.mcap");
  const std::string record = folder.file("r.encrec");
  std::filesystem::copy_file(kRecord, record);
  ASSERT_EQ(run_program({"export", record, "--mcap", mcap}).code, 0);
  const std::string first = test::bytes_of(mcap);
  EXPECT_THAT(line({"export", record, "--mcap", mcap}), HasSubstr("is there already"));
  EXPECT_EQ(run_program({"export", record, "--mcap", mcap, "--force"}).code, 0);
  EXPECT_EQ(test::bytes_of(mcap), first);  // the same record gives the same bytes
  EXPECT_THAT(line({"export", record, "--mcap", record, "--force"}), HasSubstr("is read by this command"));
  const Result full = run({"bash", "-c",
                           "ulimit -f 100; exec '" + program_file() + "' export '" + record + "' --mcap '" +
                               folder.file("full.mcap") + "'"});
  EXPECT_EQ(full.code, 2);
  EXPECT_THAT(full.err, HasSubstr("cannot be written"));
  EXPECT_EQ(test::bytes_of(record), test::bytes_of(kRecord));
  std::filesystem::remove(mcap);
  std::filesystem::remove(record);
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// A run that writes MCAP itself writes what an export of its record writes.
TEST(Export, ARunWritesTheMcapOfItsRecord) {
  const test::TemporaryFolder folder;
  const std::string record = folder.file("r.encrec"), direct = folder.file("direct.mcap"),
                    mcap = folder.file("r.mcap");
  ASSERT_EQ(
      run_program({"run", kWall, "--for-s", "1.2", "--record", record, "--mcap", direct}, kShipped).code, 0);
  ASSERT_EQ(run_program({"export", record, "--mcap", mcap}).code, 0);
  EXPECT_TRUE(test::bytes_of(direct) == test::bytes_of(mcap));
  EXPECT_THAT(line({"run", kWall, "--for-s", "0.1", "--mcap", direct}), HasSubstr("is there already"));
}

// `run --live` refuses what it cannot listen at, before anything is made.
TEST(Live, RefusesItsAddressInALine) {
  // For an address of IPv6 the library would listen at all addresses.
  for (const char* where : {"x", "65536", "-1", ":80", "127.0.0.1:", "127.0.0.1:8765x", "1e3", "::1:0",
                            "lo:0", "fe80::1:0", "[::1]:0", "127.1:0", "127.0.0.1 :0"})
    EXPECT_THAT(line({"run", kWall, "--live", where}),
                HasSubstr("expected a port from 0 to 65535, or ADDRESS:PORT with an IPv4 address"));
  const test::TemporaryFolder folder;
  EXPECT_THAT(line({"run", kWall, "--live", "192.0.2.1:0", "--record", folder.file("r.encrec"), "--mcap",
                    folder.file("r.mcap")}),
              HasSubstr("192.0.2.1:0: cannot listen there"));
  EXPECT_THAT(line({"run", kWall, "--record", folder.file("r"), "--mcap", folder.file("r")}),
              HasSubstr("another run is writing it"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// "-" is standard output where an option says so, and never the name of a file.
TEST(Output, ADashIsNoFile) {
  const test::TemporaryFolder folder;
  const std::string spec = folder.file("s.toml"), images = folder.file("images");
  const std::vector<std::vector<std::string>> commands{{"run", kWall, "--record"},
                                                       {"run", kWall, "--mcap"},
                                                       {"run", kWall, "--frames"},
                                                       {"serve", kWall, "--record"},
                                                       {"view", kWall, "--record"},
                                                       {"view", kWall, "--shot"},
                                                       {"view", kWall, "--video"},
                                                       {"tour", "--out"},
                                                       {"sweep", spec, "--out"},
                                                       {"export", kRecord, "--mcap"},
                                                       {"bench", "ball", "--out"},
                                                       {"fit", "loop.csv", "--out"},
                                                       {"mesh", "ball", "--out"},
                                                       {"questionnaire", "--store"},
                                                       {"questionnaire", "--out"},
                                                       {"calibrate", "rig", "sim", "--out"},
                                                       {"calibrate", "stereo", images, "--picture"}};
  for (std::vector<std::string> words : commands) {
    words.emplace_back("-");
    EXPECT_THAT(line(words), HasSubstr(words[words.size() - 2] + ": '-' is no name of a file")) << words[0];
  }
  EXPECT_THAT(line({"export", kWall, "-"}), HasSubstr("a world is not written to standard output"));
  EXPECT_FALSE(std::filesystem::exists("-"));
  EXPECT_FALSE(std::filesystem::exists("-.part"));
}

// `plot` draws each record, and refuses in one line.
TEST(Plot, DrawsARecord) {
  const test::TemporaryFolder folder;
  const std::string svg = folder.file("p.svg");
  const Result drawn = run_program({"plot", kRecord, svg});
  ASSERT_EQ(drawn.code, 0) << drawn.err;
  EXPECT_EQ(drawn.out + drawn.err, "");
  const std::string picture = test::bytes_of(svg);
  EXPECT_THAT(picture,
              AllOf(StartsWith("<svg "), HasSubstr(">force, N</text>"), HasSubstr(">deflection, mm</text>"),
                    HasSubstr(">gap, mm</text>"), HasSubstr(">contact</text>"), HasSubstr("</svg>\n")));
  EXPECT_THAT(picture, Not(HasSubstr("nan")));
  EXPECT_EQ(run_program({"plot", kRecord, "-"}).out, picture);
  EXPECT_THAT(line({"plot", kRecord, svg}), HasSubstr("is there already"));
  EXPECT_THAT(line({"plot", kRecord, kRecord, "--force"}), HasSubstr("is read by this command"));
  EXPECT_THAT(line({"plot", kWall, folder.file("w.svg")}), HasSubstr("not a record"));
  EXPECT_EQ(run_program({"plot", kRecord}).code, 2);
}

// A record with fewer ticks than pixels, whose tip is still far: each curve is one line.
TEST(Plot, AShortRecordHasWholeLines) {
  const test::TemporaryFolder folder;
  const std::string record = folder.file("r.encrec");
  ASSERT_EQ(run_program({"run", kWall, "--for-s", "0.1", "--record", record}, kShipped).code, 0);
  const std::string picture = run_program({"plot", record, "-"}).out;
  EXPECT_THAT(picture, Not(HasSubstr("nan")));
  const std::size_t begin = picture.rfind("<path", picture.find("clip-path='url(#c2)'"));
  const std::string gap = picture.substr(begin, picture.find("clip-path", begin) - begin);
  EXPECT_EQ(std::count(gap.begin(), gap.end(), 'M'), 1) << gap;
  EXPECT_GE(std::count(gap.begin(), gap.end(), 'L'), 30) << gap;
}

// The program reports missing parts where people look: in the terminal, as for a table, and in the file.
TEST(Export, McapSaysWhatOfItsRecordIsMissing) {
  const test::TemporaryFolder folder;
  const std::string mcap = folder.file("r.mcap"), cut = folder.file("cut.encrec");
  std::string bytes = test::bytes_of(kRecord);
  const auto write = [&] { std::ofstream(cut, std::ios::binary) << bytes; };
  const auto both = [&](int code) {
    const Result table = run_program({"export", cut, "--partial"});
    const Result file = run_program({"export", cut, "--partial", "--mcap", mcap, "--force"});
    EXPECT_EQ(table.code, code) << table.err;
    EXPECT_EQ(file.code, code) << file.err;
    EXPECT_EQ(file.out, "");
    std::string said = table.err;
    said.replace(said.rfind("table"), 5, "file");
    EXPECT_EQ(file.err, said);
    const std::string in_file = said.substr(said.find(cut) + cut.size() + 2);
    EXPECT_THAT(test::bytes_of(mcap), HasSubstr(in_file.substr(0, in_file.size() - 1)));
    return said;
  };
  bytes.resize(bytes.size() * 3 / 4);
  write();
  EXPECT_THAT(line({"export", cut, "--mcap", mcap}), HasSubstr("--partial"));
  EXPECT_FALSE(std::filesystem::exists(mcap));
  EXPECT_THAT(both(0), HasSubstr("is not sealed"));
  bytes = test::bytes_of(kRecord);
  bytes[bytes.size() * 3 / 4] = static_cast<char>(bytes[bytes.size() * 3 / 4] ^ 1);
  write();
  EXPECT_THAT(both(1), HasSubstr("checksum"));
}

// ---- The parts and libraries of the program: a scene loads whatever it names, and nothing that only others
// need.

using Json = nlohmann::json;

// enc::bench as the compiler writes it into the names of functions.
TEST(Footprint, TheProgramHoldsNoBenchmark) {
  const std::string program = test::bytes_of(program_file());
  ASSERT_GT(program.size(), 100'000U);
  EXPECT_NE(program.find("3enc5trial"), std::string::npos);  // so the search does find names
  EXPECT_EQ(program.find("3enc5bench"), std::string::npos);
  EXPECT_EQ(program.find("fit_ball"), std::string::npos);
}

TEST(Footprint, APlaneMapsNoModuleAndHasOneThread) {
  const Result result =
      run_program({"run", tests::source_dir() + "/models/scenes/plane.toml", "--for-s", "0.1", "--json"});
  ASSERT_EQ(result.code, 0) << result.err;
  const Json json = Json::parse(result.out);
  EXPECT_EQ(json["threads"], 1);
  EXPECT_GT(json["mujoco_elements"], 0);
  const auto libraries = json["libraries"].get<std::vector<std::string>>();
  EXPECT_THAT(libraries, Contains(HasSubstr("libmujoco")));
  for (const char* other : {"encounter_", "libGL", "libEGL", "opencv", "embree", "orocos", "png"})
    EXPECT_THAT(libraries, Each(Not(HasSubstr(other))));
#if !defined(__SANITIZE_ADDRESS__)
  EXPECT_LT(json["peak_memory_MiB"], 20.0);
#endif
}

TEST(Footprint, VersionIsOneLine) {
  const Result result = run_program({"--version"});
  EXPECT_EQ(result.code, 0);
  EXPECT_THAT(result.out,
              testing::MatchesRegex("Encounter [0-9]+\\.[0-9]+\\.[0-9]+, commit [-0-9a-z]+ of [-0-9a-z]+\n"));
}

// ---- The test runner itself.

TEST(RunProgram, reports_output_code_and_time) {
  const tests::Result r =
      tests::run({"sh", "-c", "echo out; echo $GREETING >&2; exit 3"}, {{"GREETING", "hello"}});
  EXPECT_EQ(r.code, 3);
  EXPECT_EQ(r.out, "out\n");
  EXPECT_EQ(r.err, "hello\n");
  EXPECT_GT(r.seconds, 0.0);
}

TEST(RunProgram, takes_much_output_and_kills_what_does_not_end) {
  EXPECT_EQ(tests::run({"sh", "-c", "head -c 1000000 /dev/zero; head -c 1000000 /dev/zero >&2"}).out.size(),
            1000000U);
  const tests::Result slow = tests::run({"sleep", "10"}, {}, 0.2);
  EXPECT_EQ(slow.code, 137);
  EXPECT_LT(slow.seconds, 5.0);
  EXPECT_EQ(tests::run({"/nonexistent/program"}).code, 127);
}

}  // namespace
}  // namespace enc::tests
