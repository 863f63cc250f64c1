// The test rig and `encounter shadow` as a person uses them: a run, its replay and export, a record beside
// its twin; and mistakes, one line each.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/record/record.h"
#include "tests/input/app/program.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// ---- The test rig as a person uses it: run, replay, export; and every mistake in one line.

using Words = std::vector<std::string>;

class RigProgram : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_ / name).string(); }

  // Expects `run` and `check` to refuse the settings in equal words; returns the line.
  [[nodiscard]] static std::string refused(Words set) {
    Words args{shipped_scene("rig_A")};
    for (std::string& text : set) {
      args.emplace_back("--set");
      args.push_back(std::move(text));
    }
    std::string said;
    for (const char* command : {"run", "check"}) {
      Words words{command};
      words.insert(words.end(), args.begin(), args.end());
      const Result r = run_program(words);
      EXPECT_EQ(r.code, 2) << r.err;
      EXPECT_EQ(r.out, "");
      EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
      EXPECT_TRUE(said.empty() || said == r.err) << said << r.err;
      said = r.err;
    }
    return said;
  }
  [[nodiscard]] static std::string line(const Words& args) {
    const Result r = run_program(args);
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    return r.err;
  }
  // The rig's scene with one text replaced.
  [[nodiscard]] std::string edited(const std::string& from, const std::string& to) const {
    std::string text = bytes_of(shipped_scene("rig_A"));
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    fs::create_directories(folder_ / "scenes");
    std::ofstream(folder_ / "scenes" / "rig.toml") << text.replace(at, from.size(), to);
    return path("scenes/rig.toml");
  }
  test::TemporaryFolder temporary_;
  const fs::path& folder_ = temporary_.path();
};

struct Row {
  std::string mode;
  std::vector<double> numbers;  // all other columns before the source; NaN for an empty cell
  std::string source;
  std::vector<std::string>
      markers;  // the tool, its markers, the stamps of tip and force, and the gap; no empty last cell
};
std::vector<Row> rows_of(const std::string& csv) {
  std::istringstream in(csv);
  std::vector<Row> rows;
  std::string text;
  std::getline(in, text);
  EXPECT_EQ(
      text,
      "time_s,mode,tip_x_mm,tip_y_mm,tip_z_mm,force_x_N,force_y_N,force_z_N,deflection_mm,force_N,repeat,"
      "tool_x_mm,tool_y_mm,tool_z_mm,tool_time_s,source,tool,markers_x_mm,markers_y_mm,markers_z_mm,"
      "markers_qx,markers_qy,markers_qz,markers_qw,tip_time_s,force_time_s,gap_mm");
  while (std::getline(in, text)) {
    Row row;
    std::istringstream cells(text);
    bool past = false;
    for (std::string cell; std::getline(cells, cell, ',');) {
      if (row.numbers.size() == 1 && row.mode.empty())
        row.mode = cell;
      else if (past)
        row.markers.push_back(cell);
      else if (row.numbers.size() == 14)
        row.source = cell, past = true;
      else
        row.numbers.push_back(cell.empty() ? kUnset : std::strtod(cell.c_str(), nullptr));
    }
    rows.push_back(row);
  }
  return rows;
}

TEST_F(RigProgram, RunsReplaysAndExports) {
  const Result ran =
      run_program({"run", shipped_scene("rig_A"), "--set", "probe.repeats=2", "--record", path("a.encrec")});
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_THAT(ran.out,
              AllOf(HasSubstr("probe (10 mm radius, 2 pushes of 6 mm)"), HasSubstr("\npushes      2 of 2"),
                    HasSubstr("\nrepeats     within "), testing::Not(HasSubstr("miss "))));
  EXPECT_THAT(run_program({"replay", path("a.encrec")}).out, HasSubstr("equal to the bit"));
  ASSERT_EQ(run_program({"export", path("a.encrec"), "--csv", path("a.csv")}).code, 0);
  const std::string csv = bytes_of(path("a.csv"));
  EXPECT_EQ(run_program({"export", path("a.encrec")}).out, csv);  // the default is standard output

  RecordReader record(path("a.encrec"));
  const std::vector<Row> rows = rows_of(csv);
  ASSERT_EQ(static_cast<std::int64_t>(rows.size()), record.ticks());
  double peak = 0.0;
  int pushed[3] = {0, 0, 0};
  for (const Row& row : rows) {
    RecordedTick tick;
    ASSERT_TRUE(record.next(tick));
    ASSERT_EQ(row.numbers.size(), 14U);
    ASSERT_EQ(row.markers.size(), 11U);
    ASSERT_EQ(std::stod(row.markers[8]), seconds(tick.in.tip.t.time_since_epoch()));
    ASSERT_EQ(std::stod(row.markers[9]), seconds(tick.in.wrench.t.time_since_epoch()));
    ASSERT_EQ(row.mode, "probe");
    ASSERT_EQ(row.source,
              row.numbers[9] > 0 ? "SIMULATED and not measured: ball 'nominal' pressed 6 mm at 4 mm/s" : "");
    ASSERT_EQ(row.numbers[0], seconds(tick.tick.t.time_since_epoch()));
    ASSERT_EQ(row.numbers[7], 1e3 * tick.out.deflection);  // to the bit
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_TRUE(row.numbers[4 + i] == tick.out.force_unfiltered.xyz[i] ||
                  (std::isnan(row.numbers[4 + i]) && std::isnan(tick.out.force_unfiltered.xyz[i])));
    }
    const int repeat = static_cast<int>(row.numbers[9]);
    ASSERT_EQ(repeat, tick.out.deflection > 0.0 ? tick.out.contacts : 0);
    ++pushed[repeat];
    if (repeat > 0) {
      ASSERT_NEAR(row.numbers[8], -row.numbers[6], 1e-12);  // the axis is straight down
      peak = std::max(peak, row.numbers[8]);
    }
  }
  EXPECT_NEAR(peak, 12.0, 0.2);
  EXPECT_NEAR(pushed[1], 3000, 60);  // twice 6 mm at 4 mm/s
  EXPECT_NEAR(pushed[2], 3000, 60);
}

// The columns of an ordinary scene hold the response of the rendered object, contact after contact.
TEST_F(RigProgram, ExportsAnOrdinaryPress) {
  ASSERT_EQ(run_program({"run", shipped_scene("plane"), "--record", path("p.encrec")}).code, 0);
  RecordReader record(path("p.encrec"));
  double deepest = 0.0;
  for (const Row& row : rows_of(run_program({"export", path("p.encrec")}).out)) {
    RecordedTick tick;
    ASSERT_TRUE(record.next(tick));
    ASSERT_EQ(static_cast<int>(row.numbers[9]), tick.out.mode == Mode::contact ? tick.out.contacts : 0);
    if (row.numbers[9] > 0) {
      ASSERT_EQ(row.numbers[8], -tick.out.force.xyz[2]);
      deepest = std::max(deepest, row.numbers[7]);
    }
  }
  EXPECT_NEAR(deepest, 3.0, 0.3);
}

TEST_F(RigProgram, ExportSaysWhatIsWrong) {
  ASSERT_EQ(run_program({"run", shipped_scene("rig_A"), "--for-s", "0.5", "--record", path("a.encrec")}).code,
            0);
  const std::string before = bytes_of(path("a.encrec"));
  EXPECT_THAT(line({"export", path("a.encrec"), "--csv", path("a.encrec")}),
              HasSubstr("is read by this command"));
  EXPECT_EQ(bytes_of(path("a.encrec")), before);
  EXPECT_THAT(line({"export", path("a.encrec"), "--csv", path("none/a.csv")}),
              HasSubstr("cannot be written"));
  EXPECT_THAT(line({"export", path("a.encrec"), "--csv", "/dev/full"}),
              HasSubstr("cannot be written: No space"));
  EXPECT_THAT(line({"export", path("no.encrec")}), HasSubstr("cannot read the record"));
  std::ofstream(path("cut.encrec")) << before.substr(0, before.size() - 100);
  EXPECT_THAT(line({"export", path("cut.encrec")}), HasSubstr("cut off"));
  EXPECT_EQ(run_program({"export", path("cut.encrec"), "--partial"}).code, 0);
}

TEST_F(RigProgram, MistakesInAProbe) {
  EXPECT_THAT(
      refused({"probe.radius_mm=9"}),
      AllOf(HasSubstr("--set probe.radius_mm=9: 'radius_mm' is 9; expected 10"), HasSubstr("write it like")));
  EXPECT_THAT(refused({"probe.depth_mm=8.1"}),
              HasSubstr("expected at most 8, where the law of the simulated ball ends"));
  EXPECT_THAT(refused({"probe.depth_mm=0"}), HasSubstr("expected a positive number"));
  EXPECT_THAT(refused({"probe.polar_deg=0"}), HasSubstr("expected a number from 90 to 180"));
  EXPECT_THAT(refused({"probe.offset_mm=44"}), HasSubstr("the probe goes past the object"));
  EXPECT_THAT(refused({"probe.speed_mm_s=51"}), HasSubstr("cannot push that fast"));
  EXPECT_THAT(refused({"probe.object=bal"}), HasSubstr("did you mean 'ball'?"));
  EXPECT_THAT(refused({"object.ball.position_mm=[0,0,70]"}), HasSubstr("outside the machine's reach"));
  // The surface at this distance has a resolution of half a nanometre; the search once tried to reach 1e-12
  // m.
  EXPECT_THAT(refused({"object.ball.position_mm=[0,0,2147483648]"}),
              HasSubstr("outside the machine's reach"));
  EXPECT_THAT(refused({"object.ball.position_mm=[0,0,44]"}), HasSubstr("in the way of the probe"));
  EXPECT_THAT(refused({"object.ball.limit_mm=6"}), HasSubstr("is real and has a 'limit_mm'"));
  EXPECT_THAT(refused({"truth.ball.set=dead"}), HasSubstr("'set' is 'dead'; expected"));
  EXPECT_THAT(refused({"truth.ball.uneven=0.06"}), HasSubstr("expected a number from -0.05 to 0.05"));
}

TEST_F(RigProgram, MistakesInATravel) {
  const auto said = [&](const std::string& set) {
    const Result r = run_program({"run", shipped_scene("tracking"), "--set", set});
    EXPECT_EQ(r.code, 2) << set;
    EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
    return r.err;
  };
  EXPECT_THAT(said("travel.speed_mm_s=51"),
              HasSubstr("the machine cannot travel that fast; lower speed_mm_s"));
  EXPECT_THAT(said("travel.speed_mm_s=0"), HasSubstr("expected a positive number"));
  EXPECT_THAT(said("travel.stops_mm=[0, 60]"), HasSubstr("out of the machine's reach"));
  EXPECT_THAT(said("travel.stops_mm=[0, 20, 10]"), HasSubstr("stops must grow"));
  EXPECT_THAT(said("travel.stops_mm=[0]"), HasSubstr("at least two stops"));
  EXPECT_THAT(said("travel.start_mm=[0, 0, 0]"), HasSubstr("move start_mm"));
  EXPECT_THAT(said("travel.axes=\"xw\""), HasSubstr("expected axes out of x, y and z"));
  EXPECT_THAT(said("travel.ways=\"back\""), HasSubstr("'ways' is 'back'; expected"));
  EXPECT_THAT(said("travel.dwell_s=nan"), HasSubstr("dwell_s"));
  EXPECT_THAT(said("travel.repeats=0"), HasSubstr("expected"));
  EXPECT_THAT(said("travel.spead_mm_s=20"), HasSubstr("speed_mm_s"));
  EXPECT_THAT(said("truth.tracker.process_ms=700"), HasSubstr("at most 60 packets"));
  EXPECT_THAT(said("truth.tracker.clocks=\"tied\""), HasSubstr("'clocks' is 'tied'; expected"));
}

TEST_F(RigProgram, ScenesThatAreNoRig) {
  const auto said = [&](const std::string& from, const std::string& to) {
    const Result r = run_program({"run", edited(from, to)}, kShipped);
    EXPECT_EQ(r.code, 2);
    EXPECT_THAT(r.err, StartsWith("encounter: " + path("scenes/rig.toml") + ":"));
    return r.err;
  };
  EXPECT_THAT(said("[force]\n", ""), HasSubstr("has no [force]; add it"));
  EXPECT_THAT(said("[force]\n", "[force]\n[tracker]\n"), HasSubstr("remove [tracker]"));
  EXPECT_THAT(said("[force]\n", "[force]\n[display]\n"), HasSubstr("remove [display]"));
  EXPECT_THAT(said("shape = \"sphere\"\nradius_mm = 33 ", "shape = \"plane\" "),
              HasSubstr("expected a sphere"));
  // A real object without a probe, or beside the one that is pressed.
  const std::string second =
      "[[object]]\nname = \"cup\"\nshape = \"sphere\"\nradius_mm = 20\n"
      "position_mm = [0, 60, 20]\n\n[manipulator]\n";
  EXPECT_THAT(said("[manipulator]\n", second), HasSubstr("object 'cup' has no 'behaviour'; expected one"));
}

// ---- `encounter shadow` as a person uses it: a record beside its twin, divergence in words, refusals. Also
// `calibrate` and `fit`, which read a record, too.

class ShadowInput : public Program {
 protected:
  // Records a short run with this ground truth.
  [[nodiscard]] std::string run_of(const std::string& scene, const Words& more) const {
    Words words{"run", path("models/scenes/" + scene + ".toml"), "--record", path("r.encrec"), "--force"};
    words.insert(words.end(), more.begin(), more.end());
    EXPECT_EQ(run_program(words).code, 0);
    return path("r.encrec");
  }
};

const Words kQuickProbe{"--set", "probe.repeats=1", "--set", "probe.dwell_s=0.5", "--set", "probe.rest_s=1"};
const Words kQuickTravel{"--set", "travel.dwell_s=0.5",       "--set", "travel.ways=both_ways",
                         "--set", "travel.stops_mm=[0,10,40]"};

TEST_F(ShadowInput, AnUnalteredRecordAgrees) {
  const Result r = run_program({"shadow", run_of("rig_identify", kQuickProbe)});
  EXPECT_EQ(r.code, 0) << r.out << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("verdict     no channel diverges"), HasSubstr("force       stiffness"),
                           HasSubstr("2 %"), Not(HasSubstr("DIVERGES"))));
}

TEST_F(ShadowInput, AnAlteredOneIsNamedInALine) {
  const std::string record = run_of("rig_identify", kQuickProbe);
  const Result r =
      run_program({"shadow", record, "--set", "truth.ball.rubber_modulus_MPa=2.476", "--set",
                   "truth.ball.pressure_kPa=9.524", "--set", "truth.ball.felt_modulus_MPa=0.19048"});
  EXPECT_EQ(r.code, 1) << r.err;
  EXPECT_THAT(r.out, testing::ContainsRegex("diverges    force: stiffness: the object is (5.0|4.9)[0-9] \\+- "
                                            "0.[0-9]+ % stiffer than the twin's\n"));
  EXPECT_THAT(r.out, Not(HasSubstr("verdict")));
  const Result json = run_program({"shadow", record, "--json", "--set", "truth.hexapod.delay_cycles=1"});
  EXPECT_EQ(json.code, 1);
  const nlohmann::json found = nlohmann::json::parse(json.out);
  EXPECT_TRUE(found.at("diverges"));
  for (const nlohmann::json& one : found.at("channels")) {
    const bool late = one.at("quantity") == "machine_time";
    EXPECT_EQ(one.at("verdict") == "diverges", late) << one.dump();
    if (!late) continue;
    EXPECT_NEAR(one.at("off_ms").get<double>(), 3.0, 0.01);
    EXPECT_EQ(one.at("bound_ms"), 1.0);
    EXPECT_THAT(one.at("words").get<std::string>(), HasSubstr("answers 3.00 +- 0.00 ms later"));
  }
}

TEST_F(ShadowInput, ACameraThatWasMovedIsRegistration) {
  const std::string record = run_of("tracking", kQuickTravel);
  const Result r = run_program({"shadow", record, "--set", "truth.frames.W_C.position_mm=[0,-900,601]"});
  EXPECT_EQ(r.code, 1) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("diverges    tool: registration: the tool is seen "),
                           HasSubstr("farther than by the twin's tracker, towards +z\n")));
}

// The object is too far off for a number: the report says so in words, and fails.
TEST_F(ShadowInput, AnObjectThatStandsFarOffDiverges) {
  const std::string record = run_of("rig_identify", kQuickProbe);
  const Words beside{"shadow", record, "--set", "truth.ball.misplaced_mm=[0,0,5]"};
  const Result r = run_program(beside);
  EXPECT_EQ(r.code, 1) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("diverges    force: the "), Not(HasSubstr("verdict"))));
  Words json = beside;
  json.emplace_back("--json");
  const nlohmann::json found = nlohmann::json::parse(run_program(json).out);
  EXPECT_TRUE(found.at("diverges"));
  EXPECT_EQ(found.at("gross").at(0).at("channel"), "force");
}

TEST_F(ShadowInput, SaysWhatOfARecordIsMissing) {
  const std::string record = run_of("plane", {"--for-s", "1"});
  std::string bytes = test::bytes_of(record);
  bytes.resize(bytes.size() * 3 / 4);
  write("cut.encrec", bytes);
  const Result cut = run_program({"shadow", path("cut.encrec"), "--partial"});
  EXPECT_EQ(cut.code, 0) << cut.out;
  EXPECT_THAT(cut.err, AllOf(HasSubstr("cut.encrec: is not sealed"), HasSubstr("are in the comparison\n")));
  bytes = test::bytes_of(record);
  bytes[bytes.size() * 3 / 4] = static_cast<char>(bytes[bytes.size() * 3 / 4] ^ 1);
  write("damaged.encrec", bytes);
  const Result damaged = run_program({"shadow", path("damaged.encrec"), "--partial", "--json"});
  EXPECT_EQ(damaged.code, 1) << damaged.out;
  EXPECT_THAT(damaged.err, HasSubstr("checksum"));
  const nlohmann::json json = nlohmann::json::parse(damaged.out);
  EXPECT_FALSE(json.at("diverges"));
  EXPECT_THAT(json.at("lack").get<std::string>(),
              AllOf(HasSubstr("checksum"), HasSubstr("in the comparison")));
}

// These commands have no --partial: export makes the table of the complete part.
TEST_F(ShadowInput, CalibrateAndFitSayHowACutRecordIsRead) {
  const std::string bytes = test::bytes_of(run_of("plane", {"--for-s", "0.5"}));
  write("cut.encrec", bytes.substr(0, bytes.size() / 2));
  for (Words words : {Words{"calibrate", "tracker"}, Words{"calibrate", "tip"}, Words{"calibrate", "camera"},
                      Words{"fit"}}) {
    words.push_back(path("cut.encrec"));
    EXPECT_THAT(one_line(run_program(words)), AllOf(HasSubstr("cut.encrec: byte "),
                                                    HasSubstr("encounter export RECORD --partial --csv FILE"),
                                                    Not(HasSubstr("give --partial"))));
  }
}

TEST_F(ShadowInput, RefusesInOneLine) {
  const std::string record = run_of("plane", {"--for-s", "0.5"});
  EXPECT_THAT(one_line(run_program({"shadow", path("none.encrec")})), HasSubstr("none.encrec"));
  write("text.csv", "time_s\n1\n");
  EXPECT_THAT(one_line(run_program({"shadow", path("text.csv")})), HasSubstr("text.csv:1:1: is no record"));
  EXPECT_THAT(one_line(run_program({"shadow", plane()})), HasSubstr("run that scene with --record"));
  EXPECT_THAT(one_line(run_program({"shadow", record, "--set", "truth.hexapod.delay=4"})),
              HasSubstr("delay_cycles"));
  EXPECT_THAT(one_line(run_program({"shadow", record, "--set", "truth.hexapod.delay_cycles=99"})),
              HasSubstr("--set truth.hexapod.delay_cycles=99: "));
  EXPECT_THAT(one_line(run_program({"shadow", record, "--set", "truth.hexapod.servo_hz=-1"})),
              HasSubstr("expected"));
  const std::string bytes = test::bytes_of(record);
  write("cut.encrec", bytes.substr(0, bytes.size() / 2));
  EXPECT_THAT(one_line(run_program({"shadow", path("cut.encrec")})), HasSubstr("cut.encrec"));
  EXPECT_EQ(run_program({"shadow", path("cut.encrec"), "--partial"}).code, 0);
  const Result arm =
      run_program({"run", path("models/scenes/wall.toml"), "--for-s", "0.2", "--record", path("arm.encrec")});
  ASSERT_NE(arm.code, 2) << arm.err;
  EXPECT_THAT(
      one_line(run_program({"shadow", path("arm.encrec")})),
      AllOf(HasSubstr("arm.encrec: "), HasSubstr("without [manipulator]"), HasSubstr("record a run")));
}

// The commands read a record as its exported table: the output is equal.
TEST_F(ShadowInput, CalibrateAndFitReadARecordAsItsTable) {
  const std::string carried = run_of("tracking", kQuickTravel);
  ASSERT_EQ(run_program({"export", carried, "--csv", path("l.csv")}).code, 0);
  const Result table = run_program({"calibrate", "tracker", path("l.csv")});
  const Result direct = run_program({"calibrate", "tracker", carried});
  ASSERT_EQ(direct.code, 0) << direct.err;
  EXPECT_EQ(direct.out, table.out);
  const std::string pushed = run_of("rig_identify", kQuickProbe);
  ASSERT_EQ(run_program({"export", pushed, "--csv", path("p.csv")}).code, 0);
  const Result ball = run_program({"fit", pushed, "--ball", "--json"});
  ASSERT_EQ(ball.code, 0) << ball.err;
  EXPECT_EQ(ball.out, run_program({"fit", path("p.csv"), "--ball", "--json"}).out);
}

}  // namespace
}  // namespace enc::tests
