// `encounter calibrate rig`, `calibrate camera` and `calibrate tracker` as a person uses them: results,
// output, and mistakes, one line each.
#include <cmath>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/input/app/calibrate/calibrate_files.h"
#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::tests {
namespace {

using test::replaced;
using ::testing::AllOf;
using ::testing::HasSubstr;

// ---- `encounter calibrate rig` as a person uses it: its output, the file that it writes and the rig reads;
// and mistakes, one line each.

class CalibrateRig : public CalibrateFiles {
 protected:
};

TEST_F(CalibrateRig, WritesWhatTheRigReads) {
  const std::string out = path("measured.toml");
  const Result r = run_program({"calibrate", "rig", "sim", "--poses", "12", "--out", out, "--set",
                                "truth.frames.W_C.position_mm=[3, -896, 600]", "--set",
                                "truth.tracker.bias_mm=[0, 0, 0]", "--set", "truth.hexapod.mass_kg=1.11"},
                               kShipped);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("12 poses in "), HasSubstr("force       mass_kg = 1.1"),
                           HasSubstr("the rig believes 0.91"), HasSubstr("tracker     position_mm = ["),
                           HasSubstr("mm from what the rig believes"), HasSubstr("tool        tip_mm = ["),
                           HasSubstr("intervals   99 % for each number")));
  const std::string file = test::bytes_of(out);
  EXPECT_THAT(file, AllOf(HasSubstr("# 12 poses in "), HasSubstr("\n[of]\nmanipulator = \"sim\"\n"),
                          HasSubstr("[frames.W_C]"), HasSubstr("[frames.H_F]"), HasSubstr("mass_kg = 1.1")));
  // The command does not overwrite the file.
  EXPECT_THAT(line({"calibrate", "rig", "sim", "--poses", "12", "--out", out}), HasSubstr("--force"));
  // The rig that names the file uses its numbers, and reports them.
  write("rig.toml", replaced(test::bytes_of(tests::source_dir() + "/models/rigs/sim.toml"), "\n[loop]\n",
                             "\n[calibration]\nfile = \"measured.toml\"\n\n[loop]\n"));
  const std::string scene = tests::source_dir() + "/models/scenes/tracking.toml";
  const Result params = run_program({"params", scene, "--rig", path("rig.toml")}, kShipped);
  ASSERT_EQ(params.code, 0) << params.err;
  EXPECT_THAT(params.out, testing::ContainsRegex("rig.force.mass_kg,kg,1.1[^\n]*measured.toml"));
}

TEST_F(CalibrateRig, TellsTheSameInJson) {
  const Result r =
      run_program({"calibrate", "rig", "sim", "--poses", "12", "--json", "--seed", "3"}, kShipped);
  ASSERT_EQ(r.code, 0) << r.err;
  const auto told = nlohmann::json::parse(r.out);
  EXPECT_EQ(told["poses"], 12);
  EXPECT_NEAR(told["force"]["mass_kg"].get<double>(), 0.91, 3 * told["force"]["mass_half_kg"].get<double>());
  // The twin's tracker has a constant error, which goes into its position.
  EXPECT_NEAR(told["tracker"]["position_mm"][1].get<double>(), -900.0, 1.0);
  EXPECT_LT(told["tracker"]["origin_half_mm"][2].get<double>(), 0.05);
  EXPECT_NEAR(told["tracker"]["tip_mm"][2].get<double>(), -120.0, 0.2);
  EXPECT_EQ(run_program({"calibrate", "rig", "sim", "--poses", "12", "--json", "--seed", "3"}, kShipped).out,
            r.out)
      << "the same seed tells the same";
}

TEST_F(CalibrateRig, RefusesInALineWhatCannotBe) {
  EXPECT_THAT(line({"calibrate", "rig", "fakes"}), AllOf(HasSubstr("fakes.toml:"), HasSubstr("--armed")));
  // The command connects to no device, and no device would detect an obstacle.
  EXPECT_THAT(line({"calibrate", "rig", "fakes", "--armed", "--set", "rig.force.driver=sim"}),
              AllOf(HasSubstr("--set rig.force.driver=sim: "), HasSubstr("needs a force sensor"),
                    HasSubstr("here it is 'sim'")));
  const std::string tracked = tests::source_dir() + "/models/scenes/tracking.toml";
  EXPECT_THAT(
      line({"calibrate", "rig", "fakes", "--armed", "--scene", tracked, "--set", "rig.force.driver=none"}),
      HasSubstr("here it is 'none'"));
  write("bare.toml", replaced(test::bytes_of(tests::source_dir() + "/models/scenes/clamped_tool.toml"),
                              "[force]\n[tracker]\n", ""));
  EXPECT_THAT(line({"calibrate", "rig", "sim", "--scene", path("bare.toml"), "--set", "rig.force.driver=none",
                    "--set", "rig.tracker.driver=none"}),
              HasSubstr("neither a force sensor nor a tracker"));
  for (const char* option :
       {"--pairs=8", "--frames=2", "--through-images", "--rate-Hz=100", "--square-mm=25"})
    EXPECT_THAT(line({"calibrate", "rig", "sim", option}), HasSubstr("not expected: " + std::string(option)));
  EXPECT_THAT(line({"calibrate", "rig", "vishap"}),
              AllOf(HasSubstr("vishap: has an arm; expected a rig with a hexapod"),
                    HasSubstr("run: encounter calibrate camera vishap\n")));
  EXPECT_THAT(line({"calibrate", "rig", write("log.csv", "time_s\n")}),
              HasSubstr("log.csv: is no rig; expected a name in models/rigs or a TOML file"));
  EXPECT_THAT(line({"calibrate", "rig", "sim", "--scene", tests::source_dir() + "/models/scenes/plane.toml"}),
              HasSubstr("no tool is clamped"));
  EXPECT_NE(run_program({"calibrate", "rig", "sim", "--poses", "3"}, kShipped).code, 0);
  EXPECT_THAT(line({"calibrate", "rig", "sim", "--poses", "12", "--set", "truth.tracker.loss=1"}),
              HasSubstr("the tool was seen in 0 stands"));
}

// ---- `encounter calibrate camera` as a person uses it. The camera's pose comes from pairs of points, and
// from an arm that moves through its view. Mistakes in points and rigs, one line each.

class CalibrateCamera : public CalibrateFiles {};

// Five places without noise, from a camera that is turned by 90 deg about z and stands at (1, 2, 3) m.
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

// ---- `encounter calibrate tracker` as a person uses it: from a run to its bias; and mistakes in logs, one
// line each.

class CalibrateTracker : public CalibrateFiles {};

// A log that is 20 ms late, there and back along x at two speeds.
std::string log_text() {
  const auto tip = [](double t) {
    const double phase = std::fmod(t, 4.0), speed = t < 4.0 ? 20.0 : 40.0;
    const double moved = phase < 1.0 ? 0.0 : phase < 2.0 ? phase - 1.0 : phase < 3.0 ? 1.0 : 4.0 - phase;
    return t < 0.0 ? 0.0 : speed * moved;
  };
  std::string text = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_mm\n";
  for (int n = 0; n < 8000; ++n) {
    const double t = n * 1e-3;
    text += fmt::format("{:.3f},{:.4f},0,0,", t, tip(t));
    text +=
        n % 10 == 0 ? fmt::format("{:.4f},{:.4f},0.1\n", tip(t - 0.020) + 0.3, 0.002 * (n / 10 % 3)) : ",,\n";
  }
  return text;
}

TEST_F(CalibrateTracker, TellsBiasAndLatency) {
  const Result r = run_program({"calibrate", "tracker", write("l.csv", log_text())});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("800 packets at 100 Hz"), HasSubstr("\nx            20.0"),
                           HasSubstr("0.3000 +- 0.000"), HasSubstr("y did not move"),
                           HasSubstr("rig.frames.W_C.position_mm: take away [0.3000")));
  const Result json = run_program({"calibrate", "tracker", path("l.csv"), "--json"});
  EXPECT_THAT(json.out, AllOf(testing::ContainsRegex("\"latency_ms\": (20.0|19.99)"),
                              HasSubstr("\"latency_half_ms\": "), HasSubstr("\"one_way\": false"),
                              HasSubstr("\"stamp_late_ms\": null")));
}

TEST_F(CalibrateTracker, ReadsWhatExportWrites) {
  const std::string scene = tests::source_dir() + "/models/scenes/clamped_tool.toml";
  ASSERT_EQ(run_program({"run", scene, "--for-s", "3", "--record", path("r.encrec"), "--set",
                         "truth.tracker.bias_mm=[0.2,0,-0.1]"},
                        kShipped)
                .code,
            0);
  ASSERT_EQ(run_program({"export", path("r.encrec"), "--csv", path("r.csv")}).code, 0);
  const Result r = run_program({"calibrate", "tracker", path("r.csv")});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("3001 rows at 1000 Hz"), HasSubstr("x did not move"),
                           HasSubstr("nothing moved to compare them with")));
  // The injected bias, within the interval (95 %, so twice its half is nearly certain).
  const auto axes =
      nlohmann::json::parse(run_program({"calibrate", "tracker", path("r.csv"), "--json"}).out)["axes"];
  for (const auto& [axis, bias_mm] : {std::pair{"x", 0.2}, {"y", 0.0}, {"z", -0.1}}) {
    const double half_mm = axes[axis]["bias_half_mm"];
    EXPECT_NEAR(axes[axis]["bias_mm"].get<double>(), bias_mm, 2.0 * half_mm) << axis;
    EXPECT_LT(half_mm, 0.005) << axis;
  }
}

// The whole delay of the scene in which the machine carries a tool past the tracker: 3.5 ms of the tracker,
// half an exposure, 9.2 ms of the server, 0.5 ms of network, half a cycle; plus 5 ms injected.
TEST_F(CalibrateTracker, FindsTheLatencyOfTheTrackingScene) {
  const std::string scene = tests::source_dir() + "/models/scenes/tracking.toml";
  ASSERT_EQ(run_program({"run", scene, "--record", path("t.encrec"), "--set", "travel.dwell_s=0.5", "--set",
                         "travel.ways=both_ways", "--set", "truth.tracker.latency_ms=8.5"},
                        kShipped)
                .code,
            0);
  ASSERT_EQ(run_program({"export", path("t.encrec"), "--csv", path("t.csv")}).code, 0);
  const Result r = run_program({"calibrate", "tracker", path("t.csv"), "--json"});
  ASSERT_EQ(r.code, 0) << r.err;
  const nlohmann::json found = nlohmann::json::parse(r.out);
  EXPECT_NEAR(found["latency_ms"].get<double>(), 22.9, 1.0) << r.out;
}

TEST_F(CalibrateTracker, RefusesBadLogsInOneLine) {
  const std::string good = log_text();
  const std::string head = good.substr(0, good.find('\n') + 1);
  const auto at = [&](int row) {  // the beginning of a row
    std::size_t place = 0;
    for (int i = 0; i <= row; ++i) place = good.find('\n', place) + 1;
    return place;
  };
  EXPECT_THAT(line({"calibrate", "tracker", write("empty.csv", "")}),
              HasSubstr("empty.csv:1:1: there is no column"));
  EXPECT_THAT(line({"calibrate", "tracker", path("none.csv")}),
              HasSubstr("none.csv:1:1: cannot read this log"));
  EXPECT_THAT(line({"calibrate", "tracker", temporary_.path().string()}),
              HasSubstr(":1:1: cannot read this log"));
  EXPECT_THAT(line({"calibrate", "tracker", write("nan.csv", good + "8.000,nan,0,0,,,\n")}),
              HasSubstr("nan.csv:8002:7: 'tip_x_mm' is 'nan'"));
  EXPECT_THAT(line({"calibrate", "tracker", write("back.csv", good + "1.000,0,0,0,,,\n")}),
              HasSubstr("back.csv:8002:1: the time 1.000 s does not come after 7.999 s"));
  EXPECT_THAT(
      line({"calibrate", "tracker", write("gap.csv", good.substr(0, at(3000)) + good.substr(at(3100)))}),
      HasSubstr("gap.csv:3002:1: rows are missing from 2.999 to 3.1 s"));
  EXPECT_THAT(line({"calibrate", "tracker", write("short.csv", good.substr(0, at(5)))}),
              HasSubstr("there are 5 rows"));
  std::string milliseconds = head;
  for (int n = 0; n < 100; ++n) milliseconds += fmt::format("{},0,0,0,0,0,0\n", n);
  EXPECT_THAT(line({"calibrate", "tracker", write("ms.csv", milliseconds)}),
              HasSubstr("ms.csv:3:1: rows are 1 s apart: milliseconds?"));
  for (const char* stamp : {"tool_time_s", "tip_time_s"}) {
    std::string text = replaced(head, "tool_z_mm", std::string("tool_z_mm,") + stamp);
    for (int n = 0; n < 100; ++n) text += fmt::format("{:.3f},0,0,0,{},0,0,{}\n", 0.01 * n, n, 10 * n);
    EXPECT_THAT(line({"calibrate", "tracker", write("stamp.csv", text)}),
                HasSubstr(fmt::format("is {} in milliseconds?", stamp)));
  }
  EXPECT_THAT(line({"calibrate", "tracker", write("few.csv", good.substr(0, at(50)))}),
              HasSubstr("there are 5 packets"));
  EXPECT_THAT(line({"calibrate", "tracker", write("l.csv", good), "--rate-Hz", "500"}),
              HasSubstr("expected 500 Hz"));
  EXPECT_THAT(line({"calibrate", "tracker", path("l.csv"), "--rate-Hz", "-1"}), HasSubstr("--rate-Hz"));
}

// A person presses a ball: the tip follows the tool, so it is no reference for the tool.
TEST_F(CalibrateTracker, AToolThatGoesItsOwnWayTellsNothing) {
  const std::string scene = tests::source_dir() + "/models/scenes/tennis_ball.toml";
  ASSERT_EQ(run_program({"run", scene, "--for-s", "40", "--record", path("p.encrec")}, kShipped).code, 0);
  ASSERT_EQ(run_program({"export", path("p.encrec"), "--csv", path("p.csv")}).code, 0);
  EXPECT_THAT(line({"calibrate", "tracker", path("p.csv")}), HasSubstr("of the tool's motion"));
}

// Rows at 1 kHz, a packet every 10 ms, 8 s; mm.
template <class Tip, class Tool>
std::string made_log(Tip tip, Tool tool) {
  std::string text = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_mm\n";
  for (int n = 0; n < 8000; ++n) {
    const double t = n * 1e-3;
    text += fmt::format("{:.3f},{:.4f},0,0,", t, tip(t));
    text += n % 10 == 0 ? tool(t, 0.01 * (n / 10 % 3 - 1)) + "\n" : ",,\n";
  }
  return text;
}
double swing(double t) { return std::fmod(t, 4.0) < 2.0 ? 0.0 : 20.0 * std::sin(M_PI * t); }

// A machine at standstill carries no tool that moves.
TEST_F(CalibrateTracker, AToolThatMovesAlongAStillTipTellsNothing) {
  const auto step = [](double t, double noise) {
    return fmt::format("23,{:.4f},{:.4f}", (t > 4.0 ? 5.0 : 0.0) + noise, noise);
  };
  EXPECT_THAT(line({"calibrate", "tracker", write("s.csv", made_log([](double) { return 0.0; }, step))}),
              HasSubstr("the tip stood still and the tool moved"));
  const auto carried = [](double t, double noise) {
    return fmt::format("{:.4f},{:.4f},{:.4f}", swing(t - 0.03) + noise, (t > 4.0 ? 5.0 : 0.0) + noise, noise);
  };
  const Result r = run_program({"calibrate", "tracker", write("x.csv", made_log(swing, carried))}, kShipped);
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("y of the tip stood still and y of the tool moved by 5.0 mm"),
                           testing::Not(HasSubstr("z of the tip stood still"))));
  EXPECT_THAT(r.out, testing::Not(testing::ContainsRegex("take away .*, [25]\\.")));
}

TEST_F(CalibrateTracker, AScaleThatIsWrongAndATimeThatCannotBeAreSaid) {
  const auto tool = [](double scale, double late) {
    return [=](double t, double noise) {
      return fmt::format("{:.4f},{:.4f},{:.4f}", scale * swing(t - late) + noise, noise, noise);
    };
  };
  const auto told = [&](double scale, double late, int code) {
    const Result r =
        run_program({"calibrate", "tracker", write("k.csv", made_log(swing, tool(scale, late)))}, kShipped);
    EXPECT_EQ(r.code, code) << r.err;
    return r.out;
  };
  const std::string large = told(1.3, 0.03, 1), early = told(1.0, -0.09, 1), good = told(1.0, 0.03, 0);
  EXPECT_THAT(large, AllOf(HasSubstr("times as far as x of the tip"), testing::Not(HasSubstr("\nset "))));
  EXPECT_THAT(early, AllOf(HasSubstr("where the tip was not yet"), testing::Not(HasSubstr("usual_age_ms"))));
  EXPECT_THAT(good, AllOf(HasSubstr("usual_age_ms: above 3"), testing::Not(HasSubstr("as far as"))));
}

TEST_F(CalibrateTracker, OptionsAndTablesOfAnotherSubjectAreRefused) {
  const std::string log = write("log.csv", log_text());
  for (const char* option :
       {"--out=o.csv", "--pairs=8", "--seed=1", "--scene=x", "--square-mm=25", "--pivot"})
    EXPECT_THAT(line({"calibrate", "tracker", log, option}),
                HasSubstr("not expected: " + std::string(option)));
  const std::string points = write("p.csv", "camera_x_m,camera_y_m,camera_z_m\n0,0,0\n");
  EXPECT_THAT(line({"calibrate", "tracker", points}),
              AllOf(HasSubstr("p.csv:1:1: is a table of pairs of points; expected a tracker's log; run: "),
                    HasSubstr("encounter calibrate camera " + points)));
  const std::string poses = write("q.csv", "time_s,tool_x_mm,tool_qx\n0,0,0\n");
  EXPECT_THAT(line({"calibrate", "tracker", poses}),
              AllOf(HasSubstr("q.csv:1:1: is a table of a tool's poses"),
                    HasSubstr("run: encounter calibrate tip " + poses)));
}

// Shuffled places of the tool: no age fits, whatever the search returns.
TEST_F(CalibrateTracker, ShuffledRowsTellNothing) {
  std::istringstream rows(log_text());
  std::string header, text;
  std::getline(rows, header);
  std::vector<std::string> left, right;
  for (std::string row; std::getline(rows, row);) {
    const std::size_t cut = row.find(",0,0,") + 5;
    left.push_back(row.substr(0, cut));
    right.push_back(row.substr(cut));
  }
  for (std::size_t i = 0; i < left.size(); ++i)  // 377 is coprime to 800: each packet once
    text += left[i] + right[i % 10 == 0 ? 10 * (i / 10 * 377 % 800) : i] + "\n";
  EXPECT_THAT(line({"calibrate", "tracker", write("s.csv", header + "\n" + text)}),
              HasSubstr("of the tool's motion"));
}

}  // namespace
}  // namespace enc::tests
