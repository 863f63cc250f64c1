// The words of the enums that a file can name: they are the names of the values, all of them and no more.
#include "core/base/words.h"

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "models/schema/schema.h"

namespace enc {
namespace {

// As the compiler spells it: "plate" of PropKind::plate; "(enc::PropKind)3" has no name.
template <auto Value>
std::string_view spelled() {
  std::string_view text = __PRETTY_FUNCTION__;
  text = text.substr(text.find("Value = ") + 8);
  text = text.substr(0, text.find_first_of(";]"));
  if (text.front() == '(') return {};
  return text.substr(text.rfind(':') + 1);
}

template <class Enum>
class EnumWords : public ::testing::Test {};
using All = ::testing::Types<ShapeKind, Tangential, Reversal, TipShape, Interaction, PropKind, TremorForm,
                             UserKind, TravelWays, ManipulatorKind, Prediction, SegmentationMethod,
                             SquareReading, SeenTip, Damping, Tare, ArmKind, JointKind, GravityForm,
                             sim::HexapodForm, sim::TrackerClocks, sim::Packets, sim::ArmFriction,
                             sim::BallSet, sim::Scenery, sim::Tone, models::Confidence>;
TYPED_TEST_SUITE(EnumWords, All);

TYPED_TEST(EnumWords, AreTheNamesOfTheValues) {
  constexpr std::size_t kCount = kWords<TypeParam>.size();
  const auto one = [](std::string_view name, std::size_t i) {
    EXPECT_EQ(word_of(static_cast<TypeParam>(i)), name) << "value " << i;
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) { (one(spelled<static_cast<TypeParam>(I)>(), I), ...); }
  (std::make_index_sequence<kCount>{});
  EXPECT_EQ(spelled<static_cast<TypeParam>(kCount)>(), "") << "a value without a word";
}

}  // namespace
}  // namespace enc
