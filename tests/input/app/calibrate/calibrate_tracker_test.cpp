// `encounter calibrate tracker` as a person uses it: from a run to its bias; and mistakes in logs, one line
// each.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
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
#include "tests/support/replaced.h"

namespace enc::tests {
namespace {

using test::replaced;
using testing::AllOf;
using testing::HasSubstr;

class CalibrateTracker : public CalibrateFiles {};

// 20 ms late, there and back along x at two speeds.
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
  // The bias that was set, within what the interval says (95 %, so twice its half is all but certain).
  const auto axes =
      nlohmann::json::parse(run_program({"calibrate", "tracker", path("r.csv"), "--json"}).out)["axes"];
  for (const auto& [axis, bias_mm] : {std::pair{"x", 0.2}, {"y", 0.0}, {"z", -0.1}}) {
    const double half_mm = axes[axis]["bias_half_mm"];
    EXPECT_NEAR(axes[axis]["bias_mm"].get<double>(), bias_mm, 2.0 * half_mm) << axis;
    EXPECT_LT(half_mm, 0.005) << axis;
  }
}

// The whole way, of the scene in which the machine carries a tool past the tracker: 3.5 ms of the tracker,
// half an exposure, 9.2 ms of the server, 0.5 ms of network, half a cycle; injected 5 ms more.
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
  const auto at = [&](int row) {  // where a row begins
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

// A person presses a ball: the tip follows the tool, and is no reference for it.
TEST_F(CalibrateTracker, AToolThatGoesItsOwnWayTellsNothing) {
  const std::string scene = tests::source_dir() + "/models/scenes/tennis_ball.toml";
  ASSERT_EQ(run_program({"run", scene, "--for-s", "40", "--record", path("p.encrec")}, kShipped).code, 0);
  ASSERT_EQ(run_program({"export", path("p.encrec"), "--csv", path("p.csv")}).code, 0);
  EXPECT_THAT(line({"calibrate", "tracker", path("p.csv")}), HasSubstr("of the tool's motion"));
}

// Rows of 1 kHz, a packet each 10 ms, 8 s; mm.
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

// A machine that stands still carries no tool that moves.
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

// The tool's places in another order: no age fits, whatever is found.
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
  for (std::size_t i = 0; i < left.size(); ++i)  // 377 is prime to 800: each packet once
    text += left[i] + right[i % 10 == 0 ? 10 * (i / 10 * 377 % 800) : i] + "\n";
  EXPECT_THAT(line({"calibrate", "tracker", write("s.csv", header + "\n" + text)}),
              HasSubstr("of the tool's motion"));
}

}  // namespace
}  // namespace enc::tests
