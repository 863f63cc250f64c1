// The file of `encounter calibrate rig RIG`: a rig reads it, its numbers take the place of the rig file's,
// and one that is of another rig, or wrong, is refused in a line.
#include "models/setup/rig_calibration.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/replaced.h"
#include "tests/support/temporary_folder.h"

namespace enc::tests {
namespace {

using models::day_of;
using models::identity_of;
using models::parse_rig_calibration;
using models::rig_calibration_text;
using models::RigCalibration;
using test::replaced;
using testing::AllOf;
using testing::HasSubstr;

const std::string kShippedModels = tests::source_dir() + "/models/";

std::string read_text(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class RigCalibrationFile : public testing::Test {
 protected:
  RigCalibrationFile() {
    write("rig.toml", replaced(read_text(kShippedModels + "rigs/sim.toml"), "\n[loop]\n",
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
  // A record of it needs no other file, and has the same numbers.
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
  // What is set by hand stays so.
  const models::Setup set = loaded({"rig.force.mass_kg=0.5"});
  EXPECT_EQ(set.rig.force.mass, 0.5);
  EXPECT_EQ(set.rig.frames.W_C.position, measured().W_C->position);
}

// A real rig has no [truth]: its twin stands where the rig is thought to be.
TEST_F(RigCalibrationFile, WhatNothingSaysOfTheTruthIsAsBelieved) {
  const std::string sim = read_text(kShippedModels + "rigs/sim.toml");
  const std::string calibrated = read_text(path("rig.toml"));
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

  // Key by key: what is said stays, whoever says it.
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

  write("rig.toml", calibrated);  // of a simulated rig, whose truth is another
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
