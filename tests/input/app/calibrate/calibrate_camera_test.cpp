// `encounter calibrate camera` as a person uses it: the camera's pose from pairs of points, and from an arm
// that is driven through its view; and mistakes in points and rigs, one line each.
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/input/app/calibrate/calibrate_files.h"

namespace enc::tests {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class CalibrateCamera : public CalibrateFiles {};

// Five places seen without noise by a camera that is turned by 90 deg about z and stands at (1, 2,
// 3) m.
const std::string kPointHeader = "camera_x_m,camera_y_m,camera_z_m,device_x_m,device_y_m,device_z_m\n";
const std::string kPoints =
    "0,0,0,1,2,3\n0.1,0,0,1,2.1,3\n0,0.1,0,0.9,2,3\n0,0,0.1,1,2,3.1\n0.1,0.1,0.1,0.9,2.1,3.1\n";

TEST_F(CalibrateCamera, TellsTheCamerasPoseOutOfPoints) {
  const Result r = run_program({"calibrate", "camera", write("p.csv", kPointHeader + kPoints)});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out,
              AllOf(HasSubstr("5 pairs, 1 frame of each"), HasSubstr("[frames.W_C]\n"),
                    HasSubstr("position_mm = [1000.0000, 2000.0000, 3000.0000]"),
                    HasSubstr("90.00000]  # turns"), HasSubstr("give rows of one place the same `pair`")));
  const Result json = run_program({"calibrate", "camera", path("p.csv"), "--json"});
  const auto told = nlohmann::json::parse(json.out);
  EXPECT_NEAR(told["position_mm"][1].get<double>(), 2000.0, 1e-6);
  EXPECT_NEAR(told["rotation_deg"][2].get<double>(), 90.0, 1e-6);
  EXPECT_LT(told["mean_error_mm"][0].get<double>(), 1e-9);
}

TEST_F(CalibrateCamera, RefusesBadPointsInOneLine) {
  const auto refused = [&](const std::string& rows) {
    return line({"calibrate", "camera", write("p.csv", rows)});
  };
  EXPECT_THAT(refused(kPointHeader + kPoints.substr(0, kPoints.find("0,0,0.1"))),
              HasSubstr("p.csv:4:1: there are 3 pairs of points; expected at least 4"));
  EXPECT_THAT(refused(kPointHeader + kPoints + "0,nan,0,1,2,3\n"),
              HasSubstr("p.csv:7:3: 'camera_y_m' is 'nan'"));
  EXPECT_THAT(refused(kPointHeader + kPoints + "0,0,0,1,2\n"),
              HasSubstr("p.csv:7:9: this row has 5 columns"));
  EXPECT_THAT(refused("camera_x,camera_y,camera_z,device_x,device_y,device_z\n" + kPoints),
              HasSubstr("p.csv:1:1: there is no column 'camera_x_m'"));
  EXPECT_THAT(refused(kPointHeader + "0,0,0,1,2,3\n0.1,0,0,1,2.1,3\n0.2,0,0,1,2.2,3\n0.4,0,0,1,2.4,3\n"),
              HasSubstr("p.csv:1:1: the camera's points lie on one line"));
  EXPECT_THAT(refused(kPointHeader + "0,0,0,1,2,3\n0,0,0,1,2,3\n0,0,0,1,2,3\n0,0,0,1,2,3\n"),
              HasSubstr("p.csv:1:1: the camera's points are all in one place"));
}

TEST_F(CalibrateCamera, DrivesTheArmOfARigThroughTheCamerasView) {
  const std::vector<std::string> args{"calibrate",   "camera", "vishap", "--out",
                                      path("p.csv"), "--json", "--force"};
  const Result r = run_program(args, kShipped);
  ASSERT_EQ(r.code, 0) << r.err;
  const auto told = nlohmann::json::parse(r.out);
  EXPECT_EQ(told["pairs"], 8);
  EXPECT_EQ(told["frames"], 20.0);
  EXPECT_GT(told["time_s"].get<double>(), 8.0);
  for (int a = 0; a < 3; ++a) {
    EXPECT_LT(told["true_error_mm"][a].get<double>(), 0.5);
    EXPECT_EQ(told["true_error_mm"][a], told["camera_to_arm_error_mm"][a]);
  }
  EXPECT_EQ(run_program(args, kShipped).out, r.out);  // to the byte
  const Result of_file = run_program({"calibrate", "camera", path("p.csv"), "--json"}, kShipped);
  const auto read = nlohmann::json::parse(of_file.out);
  EXPECT_NEAR(read["position_mm"][0].get<double>(), told["position_mm"][0].get<double>(), 1e-3);
  const Result text = run_program({"calibrate", "camera", "vishap", "--pairs", "4", "--frames", "2", "--set",
                                   "truth.arm.misplaced_mm=[0,0,3]"},
                                  kShipped);
  ASSERT_EQ(text.code, 0) << text.err;
  EXPECT_THAT(text.out, AllOf(HasSubstr("mm in W, "), HasSubstr("mm between camera and arm"),
                              HasSubstr("the arm was driven to each place")));
}

TEST_F(CalibrateCamera, RefusesRigsInOneLine) {
  const auto refused = [](std::vector<std::string> more) {
    more.insert(more.begin(), {"calibrate", "camera"});
    return line(more);
  };
  EXPECT_THAT(
      refused({"vishap", "--set", "truth.arm.peak_torque_Nm=[0.001,0.001,0.001]"}),
      AllOf(HasSubstr("vishap.toml:15:1: the tip did not come to rest for place 1, at ["),
            HasSubstr("mm away; expected it within 10 mm"), HasSubstr("raise rig.arm.stiffness_N_per_m")));
  EXPECT_THAT(refused({"vishap", "--set", "truth.frames.W_C.rotation_deg=[0,0,0]"}),
              HasSubstr("0 places of the arm were seen and 8 are wanted"));
  EXPECT_THAT(refused({"vishap", "--set", "rig.arm.driver=usb"}), HasSubstr("expected driver \"sim\""));
  EXPECT_THAT(refused({"vishap", "--out", path("none/p.csv")}), HasSubstr("none/p.csv: cannot be written: "));
}

TEST_F(CalibrateCamera, OptionsAndInputsOfAnotherSubjectAreRefused) {
  const std::string points = write("p.csv", kPointHeader + kPoints);
  for (const std::vector<std::string>& option :
       std::vector<std::vector<std::string>>{{"--out", path("o.csv")},
                                             {"--set", "a=1"},
                                             {"--pairs", "8"},
                                             {"--frames", "2"},
                                             {"--through-images"},
                                             {"--force"}}) {
    std::vector<std::string> words{"calibrate", "camera", points};
    words.insert(words.end(), option.begin(), option.end());
    EXPECT_THAT(line(words), HasSubstr(option.front() + " is of a rig; '" + points + "' is none"));
  }
  for (const char* option : {"--rate-Hz=100", "--poses=12", "--armed", "--pivot", "--square-mm=25"})
    EXPECT_THAT(line({"calibrate", "camera", "vishap", option}),
                HasSubstr("not expected: " + std::string(option)));
  EXPECT_THAT(line({"calibrate", "camera", write("q.csv", "time_s,tool_x_mm,tool_qx\n0,0,0\n")}),
              AllOf(HasSubstr("q.csv:1:1: is a table of a tool's poses; expected pairs of points; run: "),
                    HasSubstr("encounter calibrate tip ")));
  EXPECT_THAT(line({"calibrate", "camera", "sim"}), AllOf(HasSubstr("sim: has no arm; expected a rig"),
                                                          HasSubstr("run: encounter calibrate rig sim\n")));
  for (const char* what : {"vishp", "./nowhere/vishp"})
    EXPECT_THAT(line({"calibrate", "camera", what}),
                AllOf(HasSubstr("vishp: is not there; expected pairs of points (CSV) or a rig"),
                      HasSubstr("vishap")));
}

}  // namespace
}  // namespace enc::tests
