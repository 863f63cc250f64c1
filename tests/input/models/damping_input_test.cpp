// What can be wrong in [admittance] of a rig: one line that says where, what, and what was expected.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"

namespace enc {
namespace {

using testing::AllOf;
using testing::HasSubstr;

std::string refused(const std::string& setting) {
  try {
    models::load(tests::source_dir() + "/models/scenes/plane.toml", "sim", {setting});
  } catch (const Error& e) {
    return e.what();
  }
  return "(accepted)";
}

TEST(DampingInput, SaysWhatIsWrong) {
  EXPECT_THAT(refused("rig.admittance.damping=much"),
              AllOf(HasSubstr("much"), HasSubstr("none"), HasSubstr("observed")));
  EXPECT_THAT(refused("rig.admittance.margin=0"), AllOf(HasSubstr("margin"), HasSubstr("expected")));
  EXPECT_THAT(refused("rig.admittance.calm_time_s=-1"), AllOf(HasSubstr("calm_time"), HasSubstr("expected")));
  EXPECT_THAT(refused("rig.admittance.least_swing_um=nan"), HasSubstr("least_swing"));
  EXPECT_THAT(refused("rig.admittance.slowest=1"), HasSubstr("slowest_hz"));  // without its unit
  EXPECT_THAT(refused("truth.force.oversampling=0"), AllOf(HasSubstr("oversampling"), HasSubstr("expected")));
  EXPECT_EQ(refused("rig.admittance.damping=observed"), "(accepted)");
}

}  // namespace
}  // namespace enc
