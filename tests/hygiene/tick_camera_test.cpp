// Within the loop Mesa draws a picture and vision evaluates it in the tick that takes it. Both use heap and
// system calls, in that tick and in no other.
#include <gtest/gtest.h>

#include "app/modules/modules.h"
#include "tests/hygiene/tick_run.h"

namespace enc::test {
namespace {

class CameraTick : public Tick {};
class CameraTickLong : public CameraTick {};

void only_with_a_picture(const ChildTally& told) {
  EXPECT_GT(told.tally.dirty, 0);
  EXPECT_LE(static_cast<double>(told.tally.dirty), told.extra) << words(told.tally);
}
Case seen(const std::string& scene) {
  Case asked{.scene = scene};
  asked.options.drivers = app::load_module;
  return asked;
}
std::string short_name(const testing::TestParamInfo<std::string>& scene) {
  return scene.param.substr(scene.param.find('/') + 1);
}

TEST_P(CameraTick, AsksForNothingBetweenPictures) {
  Case asked = seen(GetParam());
  asked.most = 1000;
  const ChildTally told = counted_run(asked);
  ASSERT_EQ(told.error, "");
  ASSERT_EQ(told.tally.ticks, asked.most);
  only_with_a_picture(told);
  if (!told.tally.filtered) GTEST_SKIP() << kNoFilter;
}
INSTANTIATE_TEST_SUITE_P(Shipped, CameraTick, testing::ValuesIn(scenes(true)), short_name);

TEST_P(CameraTickLong, AsksForNothingBetweenPictures) { count_scene(seen(GetParam()), only_with_a_picture); }
INSTANTIATE_TEST_SUITE_P(Shipped, CameraTickLong, testing::ValuesIn(scenes(true)), short_name);

}  // namespace
}  // namespace enc::test
