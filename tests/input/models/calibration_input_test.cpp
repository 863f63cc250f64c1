// The day on which a rig was measured.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"

namespace enc {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string said_date(const std::string& text) {
  try {
    (void)models::load(tests::source_dir() + "/models/scenes/plane.toml", "",
                       {"rig.calibration.date=" + text});
  } catch (const Error& e) {
    return e.what();
  }
  return {};
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

}  // namespace
}  // namespace enc
