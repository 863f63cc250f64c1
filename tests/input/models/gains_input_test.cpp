// Gains of an arm's law that cannot be: one line, with the number that is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/built.h"
#include "trial/trial.h"

namespace enc {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

std::string said_gains(const std::string& set) {
  try {
    (void)trial::prepare_setup(models::load(tests::source_dir() + "/models/scenes/wall.toml", "", {set}));
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(GainsInput, UnderDampedIsRefusedWithTheRatio) {
  EXPECT_EQ(said_gains("rig.arm.damping_Ns_per_m=11.5"), "");
  EXPECT_THAT(said_gains("rig.arm.damping_Ns_per_m=5"),
              AllOf(HasSubstr("under-damped: ratio 0.4"), HasSubstr("expected 1 or more"),
                    HasSubstr("damping_Ns_per_m")));
  EXPECT_THAT(said_gains("rig.arm.stiffness_N_per_m=1200"), HasSubstr("under-damped: ratio 0.5"));
}

TEST(GainsInput, NegativeOrZeroIsRefused) {
  for (const char* key : {"stiffness_N_per_m", "damping_Ns_per_m", "filter_hz"})
    for (const char* value : {"-1", "0", "nan"})
      EXPECT_THAT(said_gains(std::string("rig.arm.") + key + "=" + value), HasSubstr(key)) << key << value;
}

}  // namespace
}  // namespace enc
