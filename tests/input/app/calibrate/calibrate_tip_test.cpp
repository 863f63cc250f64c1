// `encounter calibrate tip POSES.csv` as a person uses it, and the earlier form `calibrate WHAT` of the
// commands.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <sstream>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "core/base/rotation.h"
#include "tests/input/app/calibrate/calibrate_files.h"
#include "tests/support/built.h"
#include "tests/support/files.h"

namespace enc::tests {
namespace {

using test::replaced;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

// ---- `encounter calibrate tip POSES.csv` as a person uses it: a person swings the tool about its tip; and
// mistakes in its log, one line each.

class CalibrateTip : public CalibrateFiles {};

const std::string kHead = "time_s,tool,tool_x_mm,tool_y_mm,tool_z_mm,tool_qx,tool_qy,tool_qz,tool_qw\n";
const Vec3 kTip(3, -2, -120), kDimple(100, -900, 600);  // in T and in C, mm

// 10 s at 50 Hz of a pen with its tip at [3, -2, -120] mm, turned by these angles in deg; the tip slips in
// mm.
std::string rows(
    const std::function<Vec3(double)>& angles,
    const std::function<double(double)>& slip = [](double) { return 0.0; }) {
  std::string text;
  for (int i = 0; i < 500; ++i) {
    const double t = 0.02 * i;
    const Quat q = rotation_xyz(M_PI / 180.0 * angles(t));
    const Vec3 p = kDimple - q * kTip + Vec3(slip(t), 0, 0.05 * std::sin(77.0 * i));
    text += fmt::format("{:.2f},pen,{:.4f},{:.4f},{:.4f},{:.7f},{:.7f},{:.7f},{:.7f}\n", t, p.x(), p.y(),
                        p.z(), q.x(), q.y(), q.z(), q.w());
  }
  return text;
}
Vec3 about_two_axes(double t) { return {30 * std::sin(3.0 * t), 30 * std::sin(2.0 * t + 1.0), 0}; }

TEST_F(CalibrateTip, TellsTheTip) {
  const std::string log = write("p.csv", kHead + rows(about_two_axes));
  const Result r = run_program({"calibrate", "tip", log});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("500 poses of pen in 10.0 s\n"), HasSubstr("\nx       "),
                           testing::ContainsRegex("z +-(120.00|119.99)[0-9]+ \\+- 0.0[0-9]+\n"),
                           testing::ContainsRegex("\\[\\[tool\\]\\]\ntip_mm = \\[[23]\\.[09]"),
                           HasSubstr("the centre of its sphere"), HasSubstr("deg rms; the first is ["),
                           HasSubstr("of errors that last up to some 0.3 s"),
                           HasSubstr("; by the rotations of neighbours\n"), testing::Not(HasSubstr("rested")),
                           testing::Not(HasSubstr("metres"))));
  const Result json = run_program({"calibrate", "tip", log, "--json"});
  const auto told = nlohmann::json::parse(json.out);
  for (std::size_t a = 0; a < 3; ++a) {
    EXPECT_NEAR(told["tip_mm"][a].get<double>(), kTip(static_cast<Eigen::Index>(a)), 0.01);
    EXPECT_NEAR(told["dimple_mm"][a].get<double>(), kDimple(static_cast<Eigen::Index>(a)), 0.02);
    EXPECT_LT(told["tip_half_mm"][a].get<double>(), 0.02);
    EXPECT_GT(told["swing_deg"][a].get<double>(), 15.0);
  }
  EXPECT_EQ(told["poses"], 500);
  EXPECT_EQ(told["outliers"], 0);
  EXPECT_EQ(told["tool"], "pen");
  EXPECT_EQ(told["method"], "neighbours");
  EXPECT_NEAR(told["turned_s"].get<double>(), 9.98, 1e-9);
  EXPECT_EQ(told["rested_s"], 0.0);
  EXPECT_FALSE(told.contains("note"));
  EXPECT_NEAR(told["residual_rms_mm"].get<double>(), 0.05 / std::sqrt(2.0), 0.002);
  EXPECT_NEAR(told["residual_max_mm"].get<double>(), 0.05, 0.01);
}

TEST_F(CalibrateTip, ASlipIsLeftOutAndCounted) {
  const auto slip = [](double t) { return t > 4.0 && t < 4.5 ? 8.0 : 0.0; };
  const Result r = run_program({"calibrate", "tip", write("s.csv", kHead + rows(about_two_axes, slip))});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, AllOf(HasSubstr("; 24 left out, farther than 6 standard deviations"),
                           testing::ContainsRegex("medians of 0.25 s wander by up to [78]\\.")));
}

// During the turn about the second axis, 17 % of the log, the tip is out of its dimple.
TEST_F(CalibrateTip, TheSwingOfWhatIsLeftIsChecked) {
  const auto out = [](double t) { return t > 8.29; };
  const std::string log = write("o.csv", kHead + rows(
                                                     [&](double t) {
                                                       const double angle = 30 * std::sin(3.0 * t);
                                                       return out(t) ? Vec3(0, angle, 0) : Vec3(angle, 0, 0);
                                                     },
                                                     [&](double t) { return out(t) ? 30.0 : 0.0; }));
  EXPECT_THAT(
      line({"calibrate", "tip", log}),
      AllOf(HasSubstr("o.csv:1:1: the tool turned about one axis alone, [1.00, "),
            testing::ContainsRegex("in T, without the 8[0-9] poses that lie apart and are left out: "),
            HasSubstr("by 0.0 deg rms"), HasSubstr("either side, with the tip in its dimple")));
}

TEST_F(CalibrateTip, SaysThatTheToolRested) {
  const auto late = [](double from) {
    return [from](double t) { return about_two_axes(std::max(0.0, t - from)); };
  };
  const std::string log = write("l.csv", kHead + rows(late(5.5)));
  const Result r = run_program({"calibrate", "tip", log});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out,
              testing::ContainsRegex(
                  "\nnote        the tool rested for 5.[56] s, most of the log: 4.[45] s tell the tip\n"));
  const auto told = nlohmann::json::parse(run_program({"calibrate", "tip", log, "--json"}).out);
  EXPECT_NEAR(told["rested_s"].get<double>(), 5.5, 0.1);
  EXPECT_EQ(told["outliers"], 0);
  EXPECT_THAT(
      line({"calibrate", "tip", write("r.csv", kHead + rows(late(7.0)))}),
      testing::ContainsRegex("r.csv:1:1: the tool rested for most of the log: it turned for (3|2.9)[0-9]* s "
                             "of 9.98 s; expected at least 4 s; swing it"));
}

// The program prints no terminal commands, and a name must be text.
TEST_F(CalibrateTip, AToolsNameIsTextAndNothingElse) {
  const auto named = [&](const std::string& name) {
    std::string text = kHead + rows(about_two_axes);
    for (std::size_t at = text.find(",pen,"); at != std::string::npos; at = text.find(",pen,", at + 1))
      text.replace(at + 1, 3, name);
    return write("n.csv", text);
  };
  const std::string red =
      "p\x1b[31mn\xC2\x9B"
      "2J";
  const Result r = run_program({"calibrate", "tip", named(red)});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, testing::StartsWith("500 poses of p\\x1b[31mn\\u009b2J in 10.0 s\n"));
  const Result json = run_program({"calibrate", "tip", named(red), "--json"});
  EXPECT_EQ(nlohmann::json::parse(json.out)["tool"], red);
  for (const char c : json.out) ASSERT_TRUE(c == '\n' || (c >= ' ' && c < 127)) << json.out;
  for (const std::string how : {"", "--json"}) {
    std::vector<std::string> words{"calibrate", "tip", named("p\xFCn")};
    if (!how.empty()) words.push_back(how);
    EXPECT_THAT(line(words), HasSubstr("n.csv:2:6: the tool's name is not UTF-8; expected UTF-8; save"));
  }
}

TEST_F(CalibrateTip, DoubtsMetresInColumnsOfMillimetres) {
  std::istringstream in(rows(about_two_axes));
  std::string text = kHead;
  for (std::string row; std::getline(in, row);) {
    std::vector<std::string> cells;
    std::istringstream parts(row);
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    for (std::size_t k = 2; k < 5; ++k) cells[k] = fmt::format("{:.7f}", 1e-3 * std::stod(cells[k]));
    text += fmt::format("{}\n", fmt::join(cells, ","));
  }
  const std::string log = write("m.csv", text);
  const Result r = run_program({"calibrate", "tip", log});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out,
              HasSubstr("\nnote        the tip is within 5 mm of the markers' origin, and all poses within "
                        "20 mm of the tracker's: if the log is in metres, multiply its places by 1000\n"));
  const auto told = nlohmann::json::parse(run_program({"calibrate", "tip", log, "--json"}).out);
  EXPECT_THAT(told["note"].get<std::string>(), HasSubstr("if the log is in metres"));
}

// Rewrites each row of the log: its time, place (mm) and rotation.
std::string reread(const std::function<void(double& time, Vec3& place, Quat& turn)>& change) {
  std::istringstream in(rows(about_two_axes));
  std::string text = kHead;
  for (std::string row; std::getline(in, row);) {
    std::vector<double> cells;
    std::istringstream parts(row);
    for (std::string cell; std::getline(parts, cell, ',');)
      cells.push_back(cell == "pen" ? 0.0 : std::stod(cell));
    Vec3 place(cells[2], cells[3], cells[4]);
    Quat turn(cells[8], cells[5], cells[6], cells[7]);
    change(cells[0], place, turn);
    text += fmt::format("{:.6g},pen,{:.4f},{:.4f},{:.4f},{:.7f},{:.7f},{:.7f},{:.7f}\n", cells[0], place.x(),
                        place.y(), place.z(), turn.x(), turn.y(), turn.z(), turn.w());
  }
  return text;
}

// Inverted poses, of the tracker in the tool, leave no residual: the tip and its dimple change places.
TEST_F(CalibrateTip, RefusesInvertedPoses) {
  const std::string log = write("i.csv", reread([](double&, Vec3& place, Quat& turn) {
                                  turn = turn.conjugate();
                                  place = -(turn * place);
                                }));
  EXPECT_THAT(
      line({"calibrate", "tip", log}),
      testing::ContainsRegex("i.csv:1:1: the tip is 1.09 m from the markers and the dimple 0.12 m from "
                             "the tracker; are these poses inverted. then the tip is "
                             "\\[3.0, -2.0, -120.0\\] mm; expected poses of the markers"));
}

// A tip can be farther from the markers than the dimple from the tracker: the command warns and does not
// refuse.
TEST_F(CalibrateTip, DoubtsALongToolNearItsTracker) {
  const std::string log = write("n.csv", reread([](double&, Vec3& place, Quat& turn) {
                                  place += turn * Vec3(0, 0, 280) - kDimple + Vec3(0, 0, 150);
                                }));
  const Result r = run_program({"calibrate", "tip", log});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out,
              HasSubstr("\nnote        the tip is 0.40 m from the markers and the dimple 0.15 m from the "
                        "tracker; are these poses inverted?"));
  const auto told = nlohmann::json::parse(run_program({"calibrate", "tip", log, "--json"}).out);
  EXPECT_THAT(told["note"].get<std::string>(), HasSubstr("are these poses inverted?"));
}

// The tracker moves and turns at 6 s.
TEST_F(CalibrateTip, TellsWhenTheFrameMoved) {
  const Quat turned = rotation_xyz(M_PI / 180.0 * Vec3(0, 0, 5));
  const std::string log = write("f.csv", reread([&](double& time, Vec3& place, Quat& turn) {
                                  if (time < 5.999) return;
                                  turn = turned * turn;
                                  place = turned * place + Vec3(3, 0, 0);
                                }));
  EXPECT_THAT(line({"calibrate", "tip", log}),
              AllOf(HasSubstr("f.csv:1:1: the tip did not stay"),
                    testing::ContainsRegex(
                        "; from 6\\.00 s on it stays within 0\\.0[0-9]+ mm rms again, 8[0-9]\\.[0-9] mm "
                        "from where it stayed before: the dimple, the tracker or its "
                        "reference was moved; keep one part")));
}

TEST_F(CalibrateTip, TellsThatPlacesAreOfOtherRows) {
  for (const int late : {2, -3}) {
    std::vector<Vec3> places;
    (void)reread([&](double&, Vec3& place, Quat&) { places.push_back(place); });
    int row = 0;
    const std::string log = write("s.csv", reread([&](double&, Vec3& place, Quat&) {
                                    const int of =
                                        std::clamp(row++ - late, 0, static_cast<int>(places.size()) - 1);
                                    place = places[static_cast<std::size_t>(of)];
                                  }));
    EXPECT_THAT(line({"calibrate", "tip", log}),
                AllOf(HasSubstr("the tip did not stay"),
                      HasSubstr(fmt::format("; with each place taken from {} rows {} it stays within 0.0",
                                            std::abs(late), late > 0 ? "later" : "earlier"))));
  }
}

TEST_F(CalibrateTip, ATimeInAnotherUnitIsAskedFor) {
  const auto in_unit = [&](double factor) {
    return line(
        {"calibrate", "tip", write("u.csv", reread([&](double& time, Vec3&, Quat&) { time *= factor; }))});
  };
  EXPECT_THAT(in_unit(1e3), HasSubstr("u.csv:1:1: rows are 20 s apart: milliseconds?"));
  EXPECT_THAT(in_unit(1e6), HasSubstr("rows are 2e+04 s apart: microseconds?"));
  EXPECT_THAT(in_unit(1e4), HasSubstr("rows are 200 s apart: milliseconds?"));
  EXPECT_THAT(in_unit(50), HasSubstr("rows are 1 s apart: frame numbers?"));
}

// A misread quaternion leaves a residual; the message names the convention that fits.
TEST_F(CalibrateTip, TellsWhichQuaternionWouldFit) {
  const auto written = [&](const std::function<Quat(const Quat&)>& as) {
    return line(
        {"calibrate", "tip", write("q.csv", reread([&](double&, Vec3&, Quat& turn) { turn = as(turn); }))});
  };
  EXPECT_THAT(written([](const Quat& q) { return q.conjugate(); }),
              AllOf(HasSubstr("the tip did not stay"),
                    HasSubstr("; with qx, qy, qz negated, so the rotation is inverted it stays within 0.0")));
  EXPECT_THAT(
      written([](const Quat& q) { return Quat(q.z(), q.w(), q.x(), q.y()); }),
      AllOf(HasSubstr("q.csv:1:1: "), HasSubstr("; with qw first, in the column qx it stays within 0.0")));
}

TEST_F(CalibrateTip, RefusesMotionThatDoesNotTellTheTip) {
  const auto refused = [&](const std::string& text) {
    return line({"calibrate", "tip", write("m.csv", kHead + text)});
  };
  const std::string good = rows(about_two_axes);
  EXPECT_THAT(refused(rows([](double) { return Vec3(10, 20, 30); })),
              AllOf(HasSubstr("m.csv:1:1: the tool hardly turned: no direction of it by more than"),
                    HasSubstr("expected at least 5 deg of each; swing it about its tip")));
  EXPECT_THAT(refused(rows([](double t) { return Vec3(0, 0, 60 * std::sin(t)); })),
              AllOf(HasSubstr("m.csv:1:1: the tool turned about one axis alone, [0.00, 0.00, 1.00] in T"),
                    HasSubstr("by 0.0 deg rms, so the tip's place along it is not known"),
                    HasSubstr("swing the tool about a second axis")));
  EXPECT_THAT(refused(rows(about_two_axes, [](double t) { return 3.0 * t; })),
              AllOf(HasSubstr("m.csv:1:1: the tip did not stay: it wandered by up to 1"),
                    HasSubstr("expected at most 2 mm rms and 20 %; hold the tip in its dimple")));
  EXPECT_THAT(refused(rows(about_two_axes, [](double t) { return t < 4.0 ? 30.0 : 0.0; })),
              AllOf(HasSubstr("it wandered by up to 30 mm"), HasSubstr("40 % more lie apart")));
  EXPECT_THAT(refused(good.substr(0, good.find("0.58,pen"))),
              HasSubstr("m.csv:1:1: there are 29 poses of the tool; expected at least 30; record longer"));
  EXPECT_THAT(refused(good.substr(0, good.find("2.00,pen"))),
              HasSubstr("m.csv:1:1: the poses of the tool are of 1.98 s; expected at least 4 s"));
  EXPECT_THAT(refused(good.substr(0, good.find("3.92,pen"))),
              HasSubstr("tool are of 3.9 s; expected at least 4 s"));
  EXPECT_EQ(
      run_program({"calibrate", "tip", write("e.csv", kHead + good.substr(0, good.find("4.12,pen")))}).code,
      0);
  EXPECT_THAT(
      refused(good.substr(0, good.find("1.00,pen")) + good.substr(good.find("9.00,pen"))),
      HasSubstr("m.csv:1:1: the poses of the tool are of 1.96 s, without the gaps in them, which are 8.02 s; "
                "expected at least 4 s of poses; record longer, with the markers in view"));
}

TEST_F(CalibrateTip, RefusesBadRowsInOneLine) {
  const std::string good = kHead + rows(about_two_axes);
  const auto refused = [&](const std::string& row) {
    return line({"calibrate", "tip", write("r.csv", good + row)});
  };
  EXPECT_THAT(refused("10,pen,nan,0,0,0,0,0,1\n"),
              HasSubstr("r.csv:502:8: 'tool_x_mm' is 'nan'; expected a finite number"));
  EXPECT_THAT(refused("10,pen,0,0,0,0,inf,0,1\n"), HasSubstr("r.csv:502:16: 'tool_qy' is 'inf'"));
  EXPECT_THAT(refused("10,pen,0,0,0,0,0,0,\n"), HasSubstr("r.csv:502:20: 'tool_qw' is ''"));
  EXPECT_THAT(refused("10,pen,0,0,0,0,0,0.1,1\n"),
              HasSubstr("r.csv:502:14: the quaternion 0, 0, 0.1, 1 has the length 1.005; expected 1"));
  EXPECT_THAT(refused("10,pen,0,0,0,0,0,0,0\n"), HasSubstr("has the length 0; expected 1"));
  EXPECT_THAT(refused("1,pen,0,0,0,0,0,0,1\n"),
              HasSubstr("r.csv:502:1: the time 1 s does not come after 9.98 s; expected increasing times"));
  EXPECT_THAT(refused("9.98,pen,0,0,0,0,0,0,1\n"), HasSubstr("the time 9.98 s repeats 9.98 s"));
  EXPECT_THAT(
      refused("10,stylus,0,0,0,0,0,0,1\n"),
      HasSubstr("r.csv:502:4: this row is of the tool 'stylus' and those before are of 'pen'; expected "
                "one tool in a log"));
  EXPECT_THAT(refused("10,pen,20000,0,0,0,0,0,1\n"), HasSubstr("r.csv:502:8: 20000 mm is farther than 10 m"));
  EXPECT_THAT(refused("10,pen,0,0,0,0,0,1\n"), HasSubstr("this row has 8 columns; expected 9"));
  EXPECT_THAT(line({"calibrate", "tip", write("h.csv", replaced(good, "tool_qw", "tool_w"))}),
              HasSubstr("h.csv:1:1: there is no column 'tool_qw'"));
}

TEST_F(CalibrateTip, OptionsAndTablesOfAnotherSubjectAreRefused) {
  const std::string log = write("p.csv", kHead + rows(about_two_axes));
  for (const char* option : {"--out=o.csv", "--seed=1", "--rate-Hz=50", "--pairs=8", "--pivot"})
    EXPECT_THAT(line({"calibrate", "tip", log, option}), HasSubstr("not expected: " + std::string(option)));
  const std::string points = write("c.csv", "camera_x_m,camera_y_m,camera_z_m\n0,0,0\n");
  EXPECT_THAT(line({"calibrate", "tip", points}),
              AllOf(HasSubstr("c.csv:1:1: is a table of pairs of points; expected poses of a tool"),
                    HasSubstr("run: encounter calibrate camera " + points)));
  EXPECT_THAT(run_program({"calibrate", "tip", "--help"}).out,
              AllOf(HasSubstr("tool_qx"), HasSubstr("Example: encounter calibrate tip ")));
}

// The command for trackers takes a table that also has the machine's tip as its log.
TEST_F(CalibrateTip, ATableWithTipAndMarkersIsAskedForItsPoses) {
  const std::string head = replaced(kHead, "tool_x_mm,tool_y_mm,tool_z_mm,tool_qx,tool_qy,tool_qz,tool_qw",
                                    "markers_x_mm,markers_y_mm,markers_z_mm,markers_qx,markers_qy,markers_qz,"
                                    "markers_qw,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_mm");
  std::string text = rows(about_two_axes);
  for (std::size_t at = text.find('\n'); at != std::string::npos; at = text.find('\n', at + 13))
    text.insert(at, ",1,2,3,4,5,6");
  const std::string log = write("b.csv", head + text);
  const Result r = run_program({"calibrate", "tip", log});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_THAT(r.out, HasSubstr("500 poses of pen"));
  EXPECT_THAT(line({"calibrate", "tracker", log}), HasSubstr("b.csv:"));
}

// Content of a record of the laboratory: C is turned in W, and the tip is at [0, 0, -120] mm in T. An upright
// tool has the mean of its markers, [8.75, 2.75, 3] mm in T, above its tip.
TEST_F(CalibrateTip, ReadsWhatExportWrites) {
  const Quat turn = rotation_xyz(M_PI / 180.0 * Vec3(20, -30, 50));  // C in W, unlike its inverse
  const std::string set = "frames.W_C.rotation_deg=[20, -30, 50]";
  ASSERT_EQ(run_program(
                {"run", shipped_scene("clamped_tool"), "--for-s", "5", "--record", path("r.encrec"), "--set",
                 "rig." + set, "--set", "truth." + set, "--set", "truth.tracker.marker_noise_mm=0"},
                kShipped)
                .code,
            0);
  ASSERT_EQ(run_program({"export", path("r.encrec"), "--csv", path("r.csv")}).code, 0);
  const Quat upright = turn.conjugate() * rotation_z_to(Vec3(8.75, 2.75, 123)).conjugate();  // T in C
  std::ifstream in(path("r.csv"));
  int seen = 0;
  for (std::string row; std::getline(in, row);) {
    std::vector<std::string> cells;
    std::istringstream parts(row + ",");
    for (std::string cell; std::getline(parts, cell, ',');) cells.push_back(cell);
    ASSERT_EQ(cells.size(), 27U) << row;
    ASSERT_EQ(cells[16].empty(), cells[11].empty()) << row;
    if (cells[16] != "stylus") continue;
    ++seen;
    const auto number = [&](std::size_t k) { return std::stod(cells[k]); };
    const Vec3 tip_W(number(11), number(12), number(13)), p(number(17), number(18), number(19));
    const Quat q(number(23), number(20), number(21), number(22));
    // q and -q are one rotation.
    ASSERT_LT(std::min((q.coeffs() - upright.coeffs()).norm(), (q.coeffs() + upright.coeffs()).norm()), 1e-9)
        << row;
    ASSERT_LT((Vec3(0, -900, 600) + turn * (p + q * Vec3(0, 0, -120)) - tip_W).norm(), 1e-9) << row;
  }
  EXPECT_NEAR(seen, 500, 20);
  EXPECT_THAT(line({"calibrate", "tip", path("r.csv")}), HasSubstr("r.csv:1:1: the tool hardly turned"));
}

// ---- `calibrate WHAT`, the form before each subject had its command: one line names the new command with
// equal arguments. Also words that are no subject.

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

// The name's ending and the options show what the file was.
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
