// The log of a tracker as a file: what is read, and what is refused with its place in one line.
#include "models/identify/tracker/tracker_log.h"

#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"

namespace enc::models {
namespace {

using testing::HasSubstr;

const std::string kHead = "time_s,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_mm\n";

// Rows from `first` to `last`, one each ms, and a packet each `every` rows, each a little different.
std::string rows(int first, int last, int every = 10, int step = 1) {
  std::string text;
  for (int n = first; n < last; n += step) {
    text += fmt::format("{:.3f},{:.3f},0,0,", n * 1e-3, n * 1e-3);
    text += n % every == 0 ? fmt::format("{:.3f},0.1,{:.6f}\n", n * 1e-3 - 0.02, n * 1e-6) : ",,\n";
  }
  return text;
}

TEST(TrackerLog, ReadsRowsAndPackets) {
  const TrackerLog log = parse_tracker_log("# a rig\n" + kHead + rows(0, 200), "l.csv");
  EXPECT_EQ(log.time.size(), 200U);
  ASSERT_EQ(log.packets.size(), 20U);
  EXPECT_NEAR(log.period, 1e-3, 1e-9);
  EXPECT_NEAR(log.packet_period, 10e-3, 1e-9);
  EXPECT_FALSE(log.repeated);
  EXPECT_NEAR(log.tip[100].x(), 0.1e-3, 1e-12);
  EXPECT_NEAR(log.packets[1].tool.x(), -0.01e-3, 1e-12);
  EXPECT_DOUBLE_EQ(log.packets[1].time, 0.010);
  EXPECT_TRUE(std::isnan(log.packets[1].stamp));
}

TEST(TrackerLog, ARepeatedValueIsNoNews) {
  std::string text = kHead;
  for (int n = 0; n < 300; ++n) text += fmt::format("{:.3f},0,0,0,{},0,0\n", n * 1e-3, n / 10);
  const TrackerLog log = parse_tracker_log(text, "l.csv");
  EXPECT_TRUE(log.repeated);
  ASSERT_EQ(log.packets.size(), 30U);
  EXPECT_DOUBLE_EQ(log.packets[1].time, 0.010);
}

TEST(TrackerLog, TakesStampsAndInterpolatesTheTip) {
  std::string text = "tool_time_s,other," + kHead;
  for (int n = 0; n < 300; ++n)
    text +=
        fmt::format("{},text,{:.3f},{},0,0,{}\n", n % 10 == 0 ? fmt::format("{:.4f}", n * 1e-3 - 0.012) : "",
                    n * 1e-3, n, n % 10 == 0 ? fmt::format("{},0,0", n) : ",,");
  const TrackerLog log = parse_tracker_log(text, "l.csv");
  EXPECT_NEAR(log.packets[3].stamp, 0.018, 1e-12);
  const TipPath path(log);
  EXPECT_NEAR(path.position(0.1005).x(), 100.5e-3, 1e-12);
  EXPECT_NEAR(path.velocity(0.1505).x(), 1.0, 1e-9);
  EXPECT_FALSE(path.knows(0.001));
  EXPECT_TRUE(path.knows(0.150));
}

// A loop on a busy computer loses a cycle now and then: the tip moves on in a straight line meanwhile.
TEST(TrackerLog, AFewLostRowsAreInterpolatedAndCounted) {
  const TrackerLog log = parse_tracker_log(kHead + rows(0, 100) + rows(101, 150) + rows(210, 300), "l.csv");
  EXPECT_EQ(log.time.size(), 239U);
  EXPECT_THAT(log.notes, testing::Contains(HasSubstr("61 rows are missing, at 2 places of up to 61 ms")));
  EXPECT_NEAR(log.period, 1e-3, 1e-9);
  const TipPath path(log);
  for (const double t : {0.0995, 0.1, 0.120, 0.149, 0.18, 0.2095, 0.25}) {
    EXPECT_TRUE(path.knows(t)) << t;
    EXPECT_NEAR(path.position(t).x(), t * 1e-3, 1e-12) << t;
  }
}

// The tip moves by 1 mm in each row; its stamps are 4 ms before the rows, and each stands in two of them.
TEST(TrackerLog, TheTipIsWhereItWasAtItsOwnStamp) {
  std::string text = "tip_time_s," + kHead;
  for (int n = 0; n < 300; ++n) {
    const int said = n / 2 * 2;
    const bool lost = n > 120 && n <= 270;  // nothing was heard of it: the last stands on
    text += fmt::format("{:.3f},{:.3f},{},0,0,{}\n", (lost ? 120 : said) * 1e-3 - 4e-3, n * 1e-3,
                        lost ? 120 : said, n % 10 == 0 ? fmt::format("{},0,0", n) : ",,");
  }
  const TipPath path(parse_tracker_log(text, "l.csv"));
  for (const double t : {0.050, 0.0605, 0.0811}) {
    EXPECT_TRUE(path.knows(t)) << t;
    EXPECT_NEAR(path.position(t).x(), t + 4e-3, 1e-9) << t;
    EXPECT_NEAR(path.velocity(t).x(), 1.0, 1e-9) << t;
  }
  EXPECT_FALSE(path.knows(0.2));
  EXPECT_TRUE(path.knows(0.285));
}

std::string refused_log(const std::string& csv, double rate = kUnset) {
  try {
    static_cast<void>(parse_tracker_log(csv, "l.csv", rate));
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}

TEST(TrackerLog, RefusesWithThePlaceInOneLine) {
  const std::string good = kHead + rows(0, 200);
  const std::string row = "0.200,0.2,0,0,0.1,0,0\n";
  std::string two_rates = kHead + rows(0, 5000, 10) + rows(5000, 12000, 40);
  struct Case {
    std::string csv;
    const char* begins;
    const char* says;
  };
  const std::vector<Case> cases{
      {"", "l.csv:1:1:", "there is no column 'time_s'"},
      {"time_s,tip_x_mm,tip_y_mm,tip_z_mm,tool_x_mm,tool_y_mm,tool_z_m\n",
       "l.csv:1:1:", "multiply 'tool_z_m' by 1000 and call it 'tool_z_mm'"},
      {good + "0.200,0.2,0,0,nan,0,0\n", "l.csv:202:15:", "'tool_x_mm' is 'nan'"},
      {good + "0.200,0.2,0,zero,,,\n", "l.csv:202:13:", "'tip_z_mm' is 'zero'"},
      {good + "0.200,,0,0,,,\n", "l.csv:202:7:", "'tip_x_mm' is ''"},
      {good + "0.200,0.2,0,0,1,,1\n", "l.csv:202:17:", "'tool_y_mm' is ''"},
      {good + "0.200,0.2,0,0,1e300,0,0\n", "l.csv:202:15:", "farther than 10 m"},
      {good + "0.200,1e999,0,0,,,\n", "l.csv:202:7:", "finite"},
      {good + "0.199,0.2,0,0,,,\n", "l.csv:202:1:", "repeats"},
      {good + "0.100,0.2,0,0,,,\n", "l.csv:202:1:", "does not come after 0.199"},
      {good + "0.200,0.2\n", "l.csv:202:7:", "2 columns; expected 7"},
      {good + rows(300, 400), "l.csv:202:1:", "rows are missing from 0.199 to 0.3 s"},
      {good + "0.2016,0.2,0,0,,,\n", "l.csv:202:1:", "rows are missing from 0.199 to 0.2016 s"},
      {"tip_time_s," + kHead + "5,0.000,0,0,0,,,\n", "l.csv:2:1:", "the tip's stamp 5 is 5 s from the row's"},
      {good + rows(200, 1000, 10, 2), "l.csv:", "expected one rate"},
      {kHead + rows(0, 9), "l.csv:10:1:", "there are 9 rows; expected at least 10"},
      {kHead + rows(0, 50), "l.csv:51:1:", "there are 5 packets"},
      {kHead + rows(0, 500) + rows(500, 2000, 1500) + rows(2000, 3000),
       "l.csv:", "no packet of the tool came"},
      {two_rates, "l.csv:", "packets a second"},
  };
  for (const Case& c : cases) {
    const std::string what = refused_log(c.csv);
    EXPECT_EQ(what.rfind(c.begins, 0), 0U) << what;
    EXPECT_THAT(what, HasSubstr(c.says));
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
  EXPECT_THAT(refused_log(good, 500.0), HasSubstr("the rows come at 1000 Hz; expected 500 Hz"));
  EXPECT_EQ(refused_log(good, 1000.0), "accepted");
}

}  // namespace
}  // namespace enc::models
