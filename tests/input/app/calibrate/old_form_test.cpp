// `calibrate WHAT`, as it was before each subject had its command: one line that names the new command, with
// the same arguments; and words that are no subject.
#include <filesystem>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/input/app/calibrate/calibrate_files.h"
#include "tests/support/built.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using Words = std::vector<std::string>;

class CalibrateOldForm : public CalibrateFiles {
 protected:
  // The command that the refusal names.
  static std::string named(Words words) {
    words.insert(words.begin(), "calibrate");
    const std::string text = line(words);
    EXPECT_THAT(text,
                HasSubstr("calibrate: the subject is missing; expected tracker, tip, camera, rig, stereo or "
                          "skin; run: "));
    const std::size_t at = text.find("run: encounter calibrate ");
    return at == std::string::npos ? text : text.substr(at + 25, text.size() - at - 26);
  }
};

TEST_F(CalibrateOldForm, ATableIsLookedInto) {
  const std::string log = write("l.csv", "# made\n\ntime_s,tip_x_mm,tool_x_mm,markers_x_mm\n");
  EXPECT_EQ(named({log}), "tracker " + log);
  EXPECT_EQ(named({log, "--json"}), "tracker " + log + " --json");
  EXPECT_EQ(named({"--rate-Hz", "500", log}), "tracker " + log + " --rate-Hz 500");
  EXPECT_EQ(named({log, "--pivot"}), "tip " + log);
  const std::string poses = write("q.csv", "time_s,tool_x_mm,tool_qx\n");
  EXPECT_EQ(named({"--json", poses}), "tip " + poses + " --json");
  const std::string points = write("p.csv", "camera_x_m,camera_y_m,camera_z_m\n");
  EXPECT_EQ(named({points, "--seed=2"}), "camera " + points + " --seed=2");
  const std::string spaced = write("my log.csv", "time_s,tip_x_mm\n");
  EXPECT_EQ(named({spaced}), "tracker '" + spaced + "'");
}

TEST_F(CalibrateOldForm, ARecordIsATrackersLog) {
  const std::string record = path("r.encrec");
  ASSERT_EQ(run_program({"run", shipped_scene("plane"), "--for-s", "0.1", "--record", record}, kShipped).code,
            0);
  EXPECT_EQ(named({record}), "tracker " + record);
  EXPECT_EQ(named({record, "--pivot"}), "tip " + record);
}

TEST_F(CalibrateOldForm, ARigIsAskedForItsArm) {
  EXPECT_EQ(named({"vishap"}), "camera vishap");
  EXPECT_EQ(named({"vishap", "--through-images", "--set", "truth.camera.exposure=4", "--out", "p.csv"}),
            "camera vishap --through-images --set truth.camera.exposure=4 --out p.csv");
  EXPECT_EQ(named({"sim", "--poses", "12", "--out", "m.toml", "--set", "truth.force.turned_deg=[1, 1, 0]"}),
            "rig sim --poses 12 --out m.toml --set 'truth.force.turned_deg=[1, 1, 0]'");
  EXPECT_EQ(named({"--armed", "fakes"}), "rig fakes --armed");
  const std::string rig = source_dir() + "/models/rigs/vishap.toml";
  EXPECT_EQ(named({rig}), "camera " + rig);
}

TEST_F(CalibrateOldForm, AFolderIsAStereoHeadOrHands) {
  const std::string folder = path("images");
  std::filesystem::create_directory(folder);
  EXPECT_EQ(named({folder, "--square-mm", "25", "--out", "h.toml"}),
            "stereo " + folder + " --square-mm 25 --out h.toml");
  EXPECT_EQ(named({folder, "--skin", "masks", "--json"}), "skin " + folder + " --masks masks --json");
  EXPECT_EQ(named({"--skin=masks", folder}), "skin " + folder + " --masks=masks");
}

// Its ending and its options tell what it was.
TEST_F(CalibrateOldForm, WhatIsNotThereIsNamed) {
  EXPECT_EQ(named({path("none.csv")}), "tracker " + path("none.csv"));
  EXPECT_EQ(named({path("none.toml")}), "rig " + path("none.toml"));
  EXPECT_EQ(named({"none", "--square-mm", "25"}), "stereo none --square-mm 25");
  EXPECT_EQ(named({"none", "--pairs", "8"}), "camera none --pairs 8");
  EXPECT_EQ(named({"none", "--poses", "12"}), "rig none --poses 12");
}

TEST_F(CalibrateOldForm, OptionsStandBehindTheSubject) {
  EXPECT_EQ(named({"--json", "tracker", "l.csv"}), "tracker --json l.csv");
}

TEST_F(CalibrateOldForm, WordsThatAreNoSubjectAreRefused) {
  EXPECT_THAT(line({"calibrate", "trakcer", "l.csv"}),
              AllOf(HasSubstr("calibrate: 'trakcer' is no subject; expected tracker, tip, camera"),
                    EndsWith("did you mean 'tracker'?\n")));
  EXPECT_THAT(line({"calibrate"}), AllOf(HasSubstr("calibrate: there is no subject; expected tracker"),
                                         EndsWith("see encounter calibrate --help\n")));
  EXPECT_THAT(line({"calibrate", "--json"}), HasSubstr("there is no subject"));
}

TEST_F(CalibrateOldForm, EachSubjectHasAHelpWithAnExample) {
  const Result all = run_program({"calibrate", "--help"});
  EXPECT_EQ(all.code, 0);
  for (const char* subject : {"tracker", "tip", "camera", "rig", "stereo", "skin"}) {
    EXPECT_THAT(all.out, HasSubstr(std::string("\n  ") + subject + " "));
    const Result one = run_program({"calibrate", subject, "--help"});
    EXPECT_EQ(one.code, 0);
    EXPECT_THAT(one.out, HasSubstr(std::string("\nExample: encounter calibrate ") + subject + " "));
    EXPECT_THAT(line({"calibrate", subject}), HasSubstr("is required"));
  }
}

}  // namespace
}  // namespace enc::tests
