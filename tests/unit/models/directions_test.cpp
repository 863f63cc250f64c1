// What a ball measured in three directions answers in others: worked by hand; and every mistake in one line.
#include "models/directions/directions.h"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"

namespace enc::models {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

const std::vector<Direction> kThree{{"A", "a", 0.0, 0.0}, {"B", "b", 0.2, 0.2}, {"C", "c", 0.1, 0.0}};

void expect_weights(const PressWay& way, const std::vector<double>& wanted) {
  const std::vector<double> got = weights(kThree, way);
  ASSERT_EQ(got.size(), wanted.size());
  double sum = 0.0;
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_NEAR(got[i], wanted[i], 2e-3) << i << " at " << way.location << ", " << way.slant;
    EXPECT_GE(got[i], 0.0);
    sum += got[i];
  }
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST(Directions, WhereItWasMeasuredThereIsThatResponse) {
  expect_weights({0.0, 0.0}, {1, 0, 0});
  expect_weights({0.2, 0.2}, {0, 1, 0});
  expect_weights({0.1, 0.0}, {0, 0, 1});
}

TEST(Directions, BetweenThemWeightsAreBarycentric) {
  expect_weights({0.05, 0.0}, {0.5, 0, 0.5});
  expect_weights({0.1, 0.1}, {0.5, 0.5, 0});
  expect_weights({0.1, 0.2 / 3.0}, {1 / 3.0, 1 / 3.0, 1 / 3.0});
}

// (0, 0.2) is nearest to the middle of A and B; far beyond C, C is nearest or the edge from C to B.
TEST(Directions, BeyondThemTheNearestEdgeCounts) {
  expect_weights({0.0, 0.2}, {0.5, 0.5, 0});
  expect_weights({0.1, -0.3}, {0, 0, 1});
}

TEST(Directions, OneDirectionIsAlwaysIt) {
  EXPECT_EQ(weights({{"only", "x", 0.3, 0.0}}, {0.0, 0.1}), std::vector<double>{1.0});
}

// Upwards into the lowest point of a ball and downwards into its highest are the same way.
TEST(Directions, WayOfAPushIsTwoAngles) {
  const auto at = [](double angle, double sign) { return Vec3(std::sin(angle), 0, sign * std::cos(angle)); };
  for (const double sign : {1.0, -1.0}) {
    const PressWay way = way_of(at(0.0, sign), at(0.2, sign));
    EXPECT_NEAR(way.location, 0.2, 1e-12);
    EXPECT_NEAR(way.slant, 0.2, 1e-12);
    EXPECT_NEAR(way_of(at(0.1, sign), at(0.1, sign)).slant, 0.0, 1e-7);
  }
}

TEST(Directions, CoefficientsAreMixed) {
  const ResponseSpec a{{1, 2, 3, 4}, {0, 1, 2, 3}, 6e-3, StopsSpec{{1, 2}, {1e-3}, {100}}};
  const ResponseSpec b{{5, 6, 7, 8}, {4, 5, 6, 7}, 6e-3, StopsSpec{{3}, {1e-3}, {500}}};
  const ResponseSpec m = mixed({a, b}, {0.25, 0.75});
  EXPECT_EQ(m.press, (std::array<double, 4>{4, 5, 6, 7}));
  EXPECT_EQ(m.release, (std::array<double, 4>{3, 4, 5, 6}));
  EXPECT_EQ(m.stops->curve, (std::vector<double>{2.5, 0.5}));
  EXPECT_EQ(m.stops->weights, std::vector<double>{400});
  EXPECT_EQ(mixed({a}, {1.0}).press, a.press);
}

TEST(Directions, PartsOfOtherKindsAreRefused) {
  const ResponseSpec a{{1, 2, 3, 4}, {0, 1, 2, 3}, 6e-3, StopsSpec{{1, 2}, {1e-3}, {100}}};
  ResponseSpec b = a;
  b.limit = 5e-3;
  EXPECT_THROW(static_cast<void>(mixed({a, b}, {0.5, 0.5})), Error);
  b = a;
  b.stops->radii = {2e-3};
  EXPECT_THROW(static_cast<void>(mixed({a, b}, {0.5, 0.5})), Error);
  b.stops.reset();  // then there is no law of stops at all
  EXPECT_FALSE(mixed({a, b}, {0.5, 0.5}).stops.has_value());
}

// ---- the file ---------------------------------------------------------------------------------------------

std::string said(const std::string& text) {
  try {
    static_cast<void>(read_directions(text, "d.toml"));
  } catch (const Error& e) {
    return e.what();
  }
  return "accepted";
}
const std::string kOne =
    "format = 1\n[[direction]]\nname = \"A\"\nresponse = \"tennis_ball\"\nlocation_deg = 90\nslant_deg = 0\n";

TEST(Directions, FileIsRead) {
  const std::vector<Direction> all = read_directions(kOne, "d.toml");
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].response, "tennis_ball");
  EXPECT_NEAR(all[0].location, M_PI / 2, 1e-12);
}

TEST(Directions, MistakesInTheFileAreOneLine) {
  EXPECT_THAT(said("format = 1\n"), AllOf(StartsWith("d.toml:1:1:"), HasSubstr("no direction")));
  EXPECT_THAT(said(kOne + "slent_deg = 1\n"), AllOf(StartsWith("d.toml:7:1:"), HasSubstr("slent_deg")));
  const std::string negative = kOne.substr(0, kOne.find("slant_deg")) + "slant_deg = -1\n";
  EXPECT_THAT(said(negative), AllOf(StartsWith("d.toml:6:"), HasSubstr("slant_deg")));
  EXPECT_THAT(said(kOne.substr(0, kOne.find("slant_deg"))), HasSubstr("slant_deg"));
  EXPECT_THAT(said("format = 2\n" + kOne.substr(kOne.find('\n') + 1)), StartsWith("d.toml:1:"));
  EXPECT_THAT(said("format = "), StartsWith("d.toml:1:"));
  for (const std::string& text : {std::string("format = 1\n"), kOne + "slent_deg = 1\n", negative}) {
    const std::string line = said(text);
    EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 0) << line;
  }
}

// ---- in a scene -------------------------------------------------------------------------------------------

const std::string kFolder = tests::source_dir() + "/models";

Setup any_ball(std::vector<std::string> set) {
  set.insert(set.begin(), "object.ball.behaviour=tennis_ball_any");
  return load(kFolder + "/scenes/indentation.toml", "sim", set);
}

TEST(Directions, SceneIsPreparedForThePlannedPress) {
  const ResponseSpec a = load_response(kFolder + "/responses/tennis_ball.toml");
  const ResponseSpec b = load_response(kFolder + "/responses/tennis_ball_B.toml");
  const auto force = [](const ResponseSpec& r) { return Response(r, 0.0).press(6e-3); };
  EXPECT_NEAR(force(any_ball({}).scene.behaviours.front().curves), force(a), 2e-3);
  EXPECT_NEAR(force(any_ball({"user.offset_mm=10"}).scene.behaviours.front().curves), force(b), 2e-3);
  const double between = force(any_ball({"user.offset_mm=4"}).scene.behaviours.front().curves);
  EXPECT_GT(between, force(a) + 0.05);
  EXPECT_LT(between, force(b) - 0.05);
}

// What is prepared stands in the record: nothing is mixed again.
TEST(Directions, ResolvedSceneKeepsTheMixture) {
  const std::string text = resolved(any_ball({"user.offset_mm=4"}));
  EXPECT_EQ(resolved(parse_resolved(text, "resolved")), text);
}

TEST(Directions, WhoPressesNoSphereIsRefused) {
  const auto refused = [](const std::string& scene, const std::string& object) -> std::string {
    try {
      static_cast<void>(load(kFolder + "/scenes/" + scene + ".toml", "sim",
                             {"object." + object + ".behaviour=tennis_ball_any"}));
    } catch (const Error& e) {
      return e.what();
    }
    return "accepted";
  };
  for (const auto& [scene, object] : {std::pair{"plane", "wall"}, std::pair{"hare", "hare"}})
    EXPECT_THAT(refused(scene, object),
                AllOf(HasSubstr("behaviours.toml:"), HasSubstr("[user] that presses a sphere")));
}

}  // namespace
}  // namespace enc::models
