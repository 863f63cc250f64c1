// Files of a rig: its tables of admittance and of drivers, the day of its measurement, and its calibration.
#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/setup/calibration_files.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/error_of.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

using models::day_of;
using models::identity_of;
using models::parse_rig_calibration;
using models::rig_calibration_text;
using models::RigCalibration;
using test::replaced;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// ---- Mistakes in [admittance] of a rig: one line with the place, the mistake and the expectation.

std::string refused(const std::string& setting) {
  return test::error_of(
      [&] { models::load(tests::source_dir() + "/models/scenes/plane.toml", "sim", {setting}); });
}

TEST(DampingInput, SaysWhatIsWrong) {
  EXPECT_THAT(refused("rig.admittance.damping=much"),
              AllOf(HasSubstr("much"), HasSubstr("none"), HasSubstr("observed")));
  EXPECT_THAT(refused("rig.admittance.margin=0"), AllOf(HasSubstr("margin"), HasSubstr("expected")));
  EXPECT_THAT(refused("rig.admittance.calm_time_s=-1"), AllOf(HasSubstr("calm_time"), HasSubstr("expected")));
  EXPECT_THAT(refused("rig.admittance.least_swing_um=nan"), HasSubstr("least_swing"));
  EXPECT_THAT(refused("rig.admittance.slowest=1"), HasSubstr("slowest_hz"));  // lacks its unit
  EXPECT_THAT(refused("truth.force.oversampling=0"), AllOf(HasSubstr("oversampling"), HasSubstr("expected")));
  EXPECT_EQ(refused("rig.admittance.damping=observed"), "");
}

// ---- The table of a driver on the command line: refused with its place before anything moves, listed,
// described, recorded.

class DriverInput : public testing::Test {
 protected:
  DriverInput() {
    text_ = test::bytes_of(tests::source_dir() + "/models/rigs/sim.toml");
    for (const std::string role : {"[manipulator]\n", "[force]\n"}) {
      const std::size_t at = text_.find(role + "driver = \"sim\"");
      text_.replace(at, role.size() + 14, role + "driver = \"sample\"");
    }
    line_ = static_cast<int>(std::count(text_.begin(), text_.end(), '\n')) + 1;
  }
  Result program(const std::string& command, const std::string& table, std::vector<std::string> more = {},
                 const std::string& modules = module_folder()) {
    std::ofstream(rig()) << text_ << table;
    more.insert(more.begin(), {command, scene_, "--rig", rig()});
    return run_program(more, {{"ENCOUNTER_MODULES", modules}});
  }
  [[nodiscard]] std::string rig() const { return folder_.file("lab.toml"); }
  [[nodiscard]] std::string at(int line, int column) const {
    return "encounter: " + rig() + ":" + std::to_string(line_ + line) + ":" + std::to_string(column) + ": ";
  }
  test::TemporaryFolder folder_;
  std::string scene_ = tests::source_dir() + "/models/scenes/rig_A.toml", text_;
  int line_ = 0;
};

TEST_F(DriverInput, AWrongTableIsOneLineWithItsPlaceAndNothingMoves) {
  for (const char* command : {"run", "check", "params"}) {
    const Result unknown = program(command, "[driver.sample]\nprot = 4712\n");
    EXPECT_EQ(unknown.code, 2) << command;
    EXPECT_EQ(unknown.out, "");
    EXPECT_EQ(unknown.err,
              at(1, 1) + "unknown key 'prot'; expected a key of [driver.sample]; did you mean 'port'?\n");
    const Result kind = program(command, "[driver.sample]\naddress = 7\n");
    EXPECT_EQ(kind.code, 2) << command;
    EXPECT_THAT(kind.err, StartsWith(at(1, 1) + "'address' is a whole number; expected a text"));
    EXPECT_EQ(program(command, "[driver.sample]\nport = 0\n").code, 2) << command;
    EXPECT_THAT(program(command, "[driver.sample]\naddress = 2020-01-01\n").err,
                StartsWith(at(1, 1) + "'address' is a date or time; expected"));
    EXPECT_EQ(program(command, "[driver.smaple]\nport = 1\n").code, 2) << command;
  }
}

TEST_F(DriverInput, RunCheckAndDoctorSayWhatTheDriverSays) {
  const std::string table = "[driver.sample]\naddress = \"10.0.0.7\"\nport = 4712\n";
  const std::string says = "device      manipulator: sample 10.0.0.7:4712, answered";
  EXPECT_THAT(program("check", table).out,
              AllOf(HasSubstr(says), HasSubstr("device      force: sample 10.0.0.7")));
  EXPECT_THAT(program("run", table, {"--for-s", "0.05"}).out, HasSubstr(says));
  EXPECT_THAT(program("run", table, {"--for-s", "0.05", "--json"}).out,
              HasSubstr("\"manipulator\": \"sample 10.0.0.7:4712, answered"));
  EXPECT_THAT(program("check", table, {"--set", "rig.driver.sample.port=99"}).out,
              HasSubstr("sample 10.0.0.7:99"));
  EXPECT_THAT(program("check", table, {"--resolved", "--set", "rig.driver.sample.port=99"}).out,
              HasSubstr("[rig.driver.sample]\naddress = \"10.0.0.7\"\nport = 99\n"));
  const std::string alone = folder_.file("alone.toml");
  std::ofstream(alone) << program("check", table, {"--resolved"}).out;
  EXPECT_THAT(run_program({"check", alone}, {{"ENCOUNTER_MODULES", module_folder()}}).out, HasSubstr(says));
  EXPECT_THAT(run_program({"doctor"}).out,
              HasSubstr("driver sample: manipulator, force sensor; [driver.sample] address, port"));
  EXPECT_THAT(program("params", table).out,
              HasSubstr("rig.driver.sample.port,,4712,driver,chosen,TCP port of the controller\n"));
  EXPECT_THAT(run_program({"check", scene_}).out, Not(HasSubstr("device ")));
}

// Without the module the program still reads, lists and keeps the table; only a run needs the device.
TEST_F(DriverInput, WithoutItsModuleATableIsKept) {
  const std::string table = "[driver.sample]\nport = 4712\n";
  const Result check = program("check", table, {}, "/nowhere");
  EXPECT_EQ(check.code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("device      manipulator: NOT THERE: /nowhere/encounter_sample.so"));
  const Result resolved = program("check", table, {"--resolved"}, "/nowhere");
  EXPECT_THAT(resolved.out, HasSubstr("[rig.driver.sample]\nport = 4712\n"));
  EXPECT_THAT(program("params", table, {}, "/nowhere").out,
              HasSubstr("rig.driver.sample.port,,4712,driver,chosen,known to its driver alone\n"));
  EXPECT_EQ(program("run", table, {}, "/nowhere").code, 3);
}

TEST_F(DriverInput, ARecordKeepsItAndReplaysWithoutTheModule) {
  const std::string record = folder_.file("r.encrec");
  const Result run = program("run", "[driver.sample]\nport = 4712\n", {"--for-s", "0.1", "--record", record});
  EXPECT_NE(run.code, 2) << run.err;
  EXPECT_THAT(test::bytes_of(record),
              HasSubstr("[rig.driver.sample]\naddress = \"127.0.0.1\"\nport = 4712\n"));
  const Result replayed = run_program({"replay", record}, {{"ENCOUNTER_MODULES", "/nowhere"}});
  EXPECT_EQ(replayed.code, 0) << replayed.err;
}

// ---- The day of a rig's measurement.

std::string said_date(const std::string& text) {
  return test::error_of([&] {
    (void)models::load(tests::source_dir() + "/models/scenes/plane.toml", "",
                       {"rig.calibration.date=" + text});
  });
}

TEST(CalibrationInput, ADayOfTheCalendarIsTaken) {
  EXPECT_EQ(said_date("\"2026-11-27\""), "");
  EXPECT_EQ(said_date("\"2024-02-29\""), "");
  for (const char* text : {"2026-02-29", "2026-13-01", "2026-00-10", "2026-01-32", "26-11-27", "2026-11-7",
                           "27.11.2026", "0000-01-01", "-202-01-01", "2026-11-27 ", "yesterday"})
    EXPECT_THAT(said_date("\"" + std::string(text) + "\""),
                AllOf(HasSubstr("rig.calibration.date"), HasSubstr(text), HasSubstr("expected a day")))
        << text;
  EXPECT_NE(said_date("2026"), "") << "a number";
}

// ---- The file of `encounter calibrate rig RIG`: its numbers replace those of the rig file. One line refuses
// a wrong file, or one from another rig.

const std::string kShippedModels = tests::source_dir() + "/models/";

class RigCalibrationFile : public testing::Test {
 protected:
  RigCalibrationFile() {
    write("rig.toml", replaced(test::bytes_of(kShippedModels + "rigs/sim.toml"), "\n[loop]\n",
                               "\n[calibration]\nfile = \"measured.toml\"\n\n[loop]\n"));
    write("measured.toml", rig_calibration_text(measured()));
  }
  static RigCalibration measured() {
    return {models::load_rig(kShippedModels + "rigs/sim.toml").title,
            "2026-11-28",
            identity_of(models::load_rig(kShippedModels + "rigs/sim.toml")),
            PoseSpec{{0.0031234, -0.8961, 0.6}, {0.01, -0.02, 0.03}},
            Vec3(0.011, 0.0, -0.02),
            1.1099};
  }
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }
  void change(const std::string& from, const std::string& to) const {
    write("measured.toml", replaced(rig_calibration_text(measured()), from, to));
  }
  [[nodiscard]] models::Setup loaded(const std::vector<std::string>& set = {}) const {
    return models::load(kShippedModels + "scenes/tracking.toml", path("rig.toml"), set);
  }
  [[nodiscard]] std::string refusal(const std::vector<std::string>& set = {}) const {
    try {
      (void)loaded(set);
    } catch (const Error& e) {
      EXPECT_EQ(e.kind(), ErrorKind::input);
      const std::string line = e.what();
      EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 0) << line;
      return line;
    }
    return "taken";
  }
  test::TemporaryFolder folder_;
};

TEST_F(RigCalibrationFile, ReadsWhatItWrites) {
  const std::string text = rig_calibration_text(measured());
  const RigCalibration read = parse_rig_calibration(text, "here");
  EXPECT_EQ(rig_calibration_text(read), text);
  EXPECT_EQ(read.W_C->position, measured().W_C->position);
  EXPECT_NEAR(read.H_F->x(), 0.011, 1e-7);
  EXPECT_EQ(*read.mass, 1.1099);
  RigCalibration part = measured();
  part.W_C.reset();
  part.mass.reset();
  const RigCalibration less = parse_rig_calibration(rig_calibration_text(part), "here");
  EXPECT_FALSE(less.W_C);
  EXPECT_FALSE(less.mass);
  EXPECT_TRUE(less.H_F);
}

TEST_F(RigCalibrationFile, ItsNumbersTakeThePlaceOfTheRigs) {
  const models::Setup setup = loaded();
  EXPECT_EQ(setup.rig.frames.W_C.position, measured().W_C->position);
  EXPECT_NEAR(setup.rig.frames.W_C.rotation.z(), 0.03, 1e-7);
  EXPECT_NEAR(setup.rig.frames.H_F.rotation.x(), 0.011, 1e-7);
  EXPECT_EQ(setup.rig.frames.H_F.position, Vec3(0, 0, -0.127)) << "the file does not say it";
  EXPECT_EQ(setup.rig.force.mass, 1.1099);
  EXPECT_EQ(setup.rig.calibration.date, "2026-11-28");
  // A record of this rig needs no other file, and has equal numbers.
  const models::Setup again = models::parse_resolved(models::resolved(setup), "record");
  EXPECT_EQ(again.rig.frames.W_C.position, measured().W_C->position);
  EXPECT_EQ(again.rig.calibration.file, "");
  EXPECT_EQ(again.rig.calibration.date, "2026-11-28");
  const auto source = [&](const models::Setup& of, const std::string& name) {
    const std::vector<models::Parameter> all = models::parameters(of);
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const models::Parameter& p) { return p.name == name; });
    return found == all.end() ? std::string() : found->source;
  };
  EXPECT_THAT(source(setup, "rig.force.mass_kg"), HasSubstr("measured.toml"));
  EXPECT_THAT(source(setup, "rig.force.filter_hz"), Not(HasSubstr("measured.toml")));
  // Numbers set by --set take precedence.
  const models::Setup set = loaded({"rig.force.mass_kg=0.5"});
  EXPECT_EQ(set.rig.force.mass, 0.5);
  EXPECT_EQ(set.rig.frames.W_C.position, measured().W_C->position);
}

// A real rig has no [truth]: its twin takes the places that the rig states.
TEST_F(RigCalibrationFile, WhatNothingSaysOfTheTruthIsAsBelieved) {
  const std::string sim = test::bytes_of(kShippedModels + "rigs/sim.toml");
  const std::string calibrated = test::bytes_of(path("rig.toml"));
  const auto without_truth = [](const std::string& rig) { return rig.substr(0, rig.find("\n[truth.") + 1); };
  const std::string real =
      replaced(replaced(without_truth(sim), "position_mm = [0, -900, 600]", "position_mm = [10, -890, 605]"),
               "stroke_mm = 23.6", "stroke_mm = 23.5");
  write("rig.toml", real);
  const models::Setup plain = loaded();
  EXPECT_LT((plain.twin.frames.W_C.position - Vec3(0.010, -0.890, 0.605)).norm(), 1e-12);
  EXPECT_EQ(plain.twin.hexapod.geometry.stroke, plain.rig.manipulator.geometry.stroke);
  EXPECT_NEAR(plain.twin.hexapod.geometry.stroke, 0.0235, 1e-12);
  EXPECT_LT(
      (models::load_rig_setup(path("rig.toml")).twin.frames.W_C.position - Vec3(0.010, -0.890, 0.605)).norm(),
      1e-12);

  const models::Setup set =
      loaded({"rig.frames.W_C.position_mm=[5,-900,600]", "rig.frames.H_F.rotation_deg=[1,2,3]"});
  EXPECT_LT((set.twin.frames.W_C.position - Vec3(0.005, -0.900, 0.600)).norm(), 1e-12);
  EXPECT_EQ(set.twin.frames.H_F.rotation, set.rig.frames.H_F.rotation);
  EXPECT_GT(set.twin.frames.H_F.rotation.norm(), 0.01);

  // Key by key: a stated number stays, wherever it is stated.
  write("rig.toml", real + "[truth.frames.W_C]\nposition_mm = [1, -900, 600]\n");
  const models::Setup part =
      loaded({"rig.frames.W_C.rotation_deg=[1,2,3]", "truth.hexapod.geometry.stroke_mm=23"});
  EXPECT_LT((part.twin.frames.W_C.position - Vec3(0.001, -0.900, 0.600)).norm(), 1e-12);
  EXPECT_EQ(part.twin.frames.W_C.rotation, part.rig.frames.W_C.rotation);
  EXPECT_GT(part.twin.frames.W_C.rotation.norm(), 0.01);
  EXPECT_NEAR(part.twin.hexapod.geometry.stroke, 0.023, 1e-12);

  write("rig.toml", without_truth(calibrated));
  const models::Setup measured_once = loaded();
  EXPECT_EQ(measured_once.twin.frames.W_C.position, measured().W_C->position);
  EXPECT_EQ(measured_once.twin.frames.W_C.rotation, measured_once.rig.frames.W_C.rotation);
  EXPECT_NEAR(measured_once.twin.frames.H_F.rotation.x(), 0.011, 1e-7);
  EXPECT_EQ(measured_once.twin.hexapod.mass, 1.1099);
  EXPECT_LT((measured_once.twin.frames.H_F.position - Vec3(0, 0, -0.127)).norm(), 1e-12);

  write("rig.toml", calibrated);  // a simulated rig, whose ground truth differs
  EXPECT_LT((loaded().twin.frames.W_C.position - Vec3(0.0, -0.900, 0.600)).norm(), 1e-12);
  EXPECT_LT((loaded().twin.frames.H_F.rotation - Vec3(0, 0, 0)).norm(), 1e-12);
}

TEST_F(RigCalibrationFile, OfAnotherRigIsRefused) {
  change("manipulator = \"sim\"", "manipulator = \"gcs 192.168.0.10\"");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("rig.toml:"), HasSubstr("of another rig"),
                               HasSubstr("its manipulator was 'gcs 192.168.0.10' and is 'sim'")));
  change("title = \"", "title = \"Another ");
  EXPECT_THAT(refusal(), HasSubstr("its title was 'Another "));
  change("height_mm = 154.5", "height_mm = 154.6");
  EXPECT_THAT(refusal(), HasSubstr("rig.manipulator.geometry.height_mm was 154.6 and is 154.5"));
  change("base_half_angle_deg = 22.6", "base_half_angle_deg = 22.7");
  EXPECT_THAT(refusal(), HasSubstr("base_half_angle_deg was 22.7 and is 22.6"));
  write("measured.toml", rig_calibration_text(measured()));
  EXPECT_EQ(refusal(), "taken");
  EXPECT_THAT(refusal({"rig.manipulator.geometry.stroke_mm=20"}), HasSubstr("stroke_mm was 23.6 and is 20"));
}

TEST_F(RigCalibrationFile, WhatIsWrongWithItIsSaidWithItsPlace) {
  change("date = \"2026-11-28\"", "date = \"yesterday\"");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("measured.toml:"), HasSubstr("expected a day")));
  change("mass_kg = 1.1099", "mass_kg = -1");
  EXPECT_THAT(refusal(), AllOf(HasSubstr("measured.toml:"), HasSubstr("mass_kg")));
  change("mass_kg", "mass_g");
  EXPECT_THAT(refusal(), HasSubstr("measured.toml:"));
  change("[of.geometry]", "[geometry]");
  EXPECT_THAT(refusal(), HasSubstr("measured.toml:"));
  write("measured.toml", "format = 1\ndate = \"2026-11-28\"\n");
  EXPECT_THAT(refusal(), HasSubstr("does not say which rig it is of"));
  std::filesystem::remove(path("measured.toml"));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("rig.toml:"), HasSubstr("cannot read the calibration")));
  write("measured.toml", rig_calibration_text(measured()));
  EXPECT_THAT(refusal({"rig.calibration.date=\"2026-11-27\""}), HasSubstr("expected one of the two"));
  EXPECT_THAT(refusal({"rig.calibration.valid_days=0"}), HasSubstr("valid_days"));
}

TEST_F(RigCalibrationFile, OfAPartOfTheRigIsRefused) {
  RigCalibration part = measured();
  part.W_C.reset();
  write("measured.toml", rig_calibration_text(part));
  EXPECT_THAT(refusal(), AllOf(HasSubstr("rig.toml:"), HasSubstr("does not say where the tracker is")));
  part = measured();
  part.mass.reset();
  write("measured.toml", rig_calibration_text(part));
  EXPECT_THAT(refusal(), HasSubstr("does not say how the force sensor is turned and what it carries"));
}

TEST(Days, LastAsLongAsTheRigSays) {
  const std::chrono::sys_days day = *day_of("2026-11-28");
  const auto doubt = [&](int days_later, const std::string& date = "2026-11-28") {
    return models::doubt_of(CalibrationRig{"", date, 30}, day + std::chrono::days(days_later));
  };
  EXPECT_EQ(doubt(0), "");
  EXPECT_EQ(doubt(30), "");
  EXPECT_THAT(doubt(31), AllOf(HasSubstr("31 days ago"), HasSubstr("expected 30 at most")));
  EXPECT_EQ(doubt(-1), "") << "measured east of here";
  EXPECT_THAT(doubt(-2), AllOf(HasSubstr("2 days from now"), HasSubstr("clock of this PC")));
  EXPECT_THAT(doubt(0, ""), HasSubstr("no day of calibration"));
}

TEST(Days, AreThoseOfTheCalendar) {
  EXPECT_TRUE(day_of("2024-02-29"));
  EXPECT_FALSE(day_of("2026-02-29"));
  EXPECT_FALSE(day_of(""));
  EXPECT_EQ((*day_of("2026-03-01") - *day_of("2026-02-28")).count(), 1);
}

}  // namespace
}  // namespace enc::tests
