// `encounter shadow` as a person uses it: a record beside its twin, what diverges in words, what is refused;
// and `calibrate` and `fit`, which read a record, too.
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/input/app/program.h"
#include "tests/support/bytes_of.h"
#include "tests/support/one_line.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class ShadowInput : public Program {
 protected:
  // A short run with this truth.
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

// Where it is too far off for a size it is said in words, and fails all the same.
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

// They have no --partial: the table of what is whole is export's.
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

// What export makes of it is what they read: the words are the same.
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
