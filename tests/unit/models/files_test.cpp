// Files: Encounter never overwrites an existing file or an input, and two runs never write one file.
#include "models/files.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "core/base/error.h"
#include "models/directions/directions.h"
#include "models/schema/schema.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/refusal.h"

namespace enc::models {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using testing::AllOf, testing::HasSubstr, testing::StartsWith;

class Files : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return folder_.file(name); }
  static std::string refusal(const std::string& path, OverwritePolicy existing) {
    try {
      OutFile(path, existing).write("new");
      return {};
    } catch (const Error& e) {
      return e.what();
    }
  }
  test::TemporaryFolder folder_;
};

TEST_F(Files, StandBesideTheirPlaceUntilTheyAreWhole) {
  {
    OutFile file(path("a"), OverwritePolicy::keep);
    file.write("half");
    EXPECT_FALSE(fs::exists(path("a")));
    EXPECT_EQ(bytes_of(file.aside()), "half");
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
  write_file(path("a"), "whole", OverwritePolicy::keep);
  EXPECT_EQ(bytes_of(path("a")), "whole");
  EXPECT_FALSE(fs::exists(path("a.part")));
}

TEST_F(Files, WhatIsThereStaysUnlessItShallBeReplaced) {
  write_file(path("a"), "old", OverwritePolicy::keep);
  EXPECT_THAT(refusal(path("a"), OverwritePolicy::keep), HasSubstr("is there already; expected a new file"));
  EXPECT_EQ(bytes_of(path("a")), "old");
  write_file(path("a"), "new", OverwritePolicy::replace);
  EXPECT_EQ(bytes_of(path("a")), "new");
}

// Otherwise anybody with write access to the folder could choose the file to overwrite.
TEST_F(Files, ALinkIsNeverWrittenThrough) {
  write_file(path("theirs"), "theirs", OverwritePolicy::keep);
  for (const OverwritePolicy existing : {OverwritePolicy::keep, OverwritePolicy::replace})
    for (const char* target : {"theirs", "free"})
      for (const char* name : {"a", "a.part"}) {
        fs::create_symlink(path(target), path(name));
        EXPECT_THAT(refusal(path("a"), existing), HasSubstr("is a link"));
        EXPECT_TRUE(fs::is_symlink(path(name)));
        fs::remove(path(name));
        EXPECT_EQ(bytes_of(path("theirs")), "theirs");
        EXPECT_FALSE(fs::exists(path("free")) || fs::exists(path("a")) || fs::exists(path("a.part")));
      }
}

// The option --force removes what an earlier run left, but not a file that has a second name (a hard link).
TEST_F(Files, WhatAnotherNameHasTooIsNotWrittenOver) {
  write_file(path("theirs"), "theirs", OverwritePolicy::keep);
  fs::create_hard_link(path("theirs"), path("a.part"));
  write_file(path("a"), "mine", OverwritePolicy::replace);
  EXPECT_EQ(bytes_of(path("theirs")), "theirs");
  EXPECT_EQ(bytes_of(path("a")), "mine");
  ASSERT_EQ(mkfifo(path("b.part").c_str(), 0600), 0);
  EXPECT_THAT(refusal(path("b"), OverwritePolicy::replace), HasSubstr("b.part: is no file of yours"));
}

// A link that replaces the file during the write is moved away, not followed.
TEST_F(Files, NorIsALinkThatAppearsMeanwhile) {
  write_file(path("theirs"), "theirs", OverwritePolicy::keep);
  OutFile file(path("a"), OverwritePolicy::replace);
  file.write("mine");
  fs::create_symlink(path("theirs"), path("a"));
  file.keep();
  EXPECT_FALSE(fs::is_symlink(path("a")));
  EXPECT_EQ(bytes_of(path("a")), "mine");
  EXPECT_EQ(bytes_of(path("theirs")), "theirs");
}

// The same holds for a file that appears during the write; neither file is lost.
TEST_F(Files, WhatAppearsMeanwhileStays) {
  OutFile file(path("a"), OverwritePolicy::keep);
  file.write("mine");
  write_file(path("b"), "yours", OverwritePolicy::keep);
  fs::rename(path("b"), path("a"));
  EXPECT_THROW(file.keep(), Error);
  EXPECT_EQ(bytes_of(path("a")), "yours");
  EXPECT_EQ(bytes_of(path("a.part")), "mine");
}

TEST_F(Files, AnInputIsNeverAnOutput) {
  write_file(path("a"), "read", OverwritePolicy::keep);
  std::string why;
  EXPECT_EQ(read_file(path("a"), 100, why), "read");
  fs::create_symlink(path("a"), path("link"));
  fs::create_hard_link(path("a"), path("hard"));
  for (const char* name : {"a", "link", "hard"})
    EXPECT_THAT(refusal(path(name), OverwritePolicy::replace), HasSubstr("is read by this command")) << name;
  EXPECT_EQ(bytes_of(path("a")), "read");
}

TEST_F(Files, TwoDoNotWriteOne) {
  OutFile first(path("a"), OverwritePolicy::replace);
  first.write("first");
  EXPECT_THAT(refusal(path("a"), OverwritePolicy::replace), HasSubstr("another run is writing it"));
  first.keep();
  EXPECT_EQ(bytes_of(path("a")), "first");
  const OutFolder alone(path("out"));
  EXPECT_THROW(OutFolder(path("out")), Error);
}

TEST_F(Files, WhatARunLeftIsNotWrittenOver) {
  {
    OutFile file(path("a"), OverwritePolicy::keep);
    file.spare();
    file.write("half");
  }
  EXPECT_THAT(refusal(path("a"), OverwritePolicy::keep),
              HasSubstr("a.part: is left of a run that did not end"));
  EXPECT_EQ(bytes_of(path("a.part")), "half");
  write_file(path("a"), "x", OverwritePolicy::replace);
  EXPECT_EQ(bytes_of(path("a")), "x");
}

TEST_F(Files, DevicesStayDevices) {
  write_file("/dev/null", "gone", OverwritePolicy::keep);
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_THROW(write_file("/dev/full", "x", OverwritePolicy::keep), Error);
  EXPECT_THROW(write_file(folder_.path().string(), "x", OverwritePolicy::replace), Error);
  EXPECT_THROW(write_file(path("none/a"), "x", OverwritePolicy::replace), Error);
}

TEST_F(Files, WhatNeverEndsIsNotRead) {
  std::string why;
  EXPECT_EQ(read_file("/dev/zero", std::size_t{1} << 20U, why), "");
  EXPECT_EQ(why, "it is a device");
  why.clear();
  write_file(path("long"), std::string((std::size_t{1} << 20U) + 1, 'x'), OverwritePolicy::keep);
  EXPECT_EQ(read_file(path("long"), std::size_t{1} << 20U, why), "");
  EXPECT_EQ(why, "it is longer than 1 MiB");
}

// A default stands once, in the struct. A file overrides it, and a shipped rig gives the reason on that line.

const std::string kShipped = tests::source_dir() + "/models";

std::map<std::string, std::string> values_of(const Setup& setup) {
  std::map<std::string, std::string> values;
  for (const Parameter& p : parameters(setup)) values[p.name] = p.value;
  return values;
}

// The parts of `like`, with the numbers of the structs.
models::Setup in_code(const Setup& like) {
  models::Setup code;
  RigSpec& rig = code.rig;
  rig.manipulator.driver = like.rig.manipulator.driver;
  rig.arm.driver = like.rig.arm.driver;
  rig.arm.machine.kind = like.rig.arm.machine.kind;
  rig.force.driver = like.rig.force.driver;
  rig.tracker.driver = like.rig.tracker.driver;
  rig.camera.driver = like.rig.camera.driver;
  rig.display.driver = like.rig.display.driver;
  rig.gripper.driver = like.rig.gripper.driver;
  code.twin.arm.there = like.twin.arm.there;
  code.twin.arm.machine.kind = like.twin.arm.machine.kind;
  return code;
}

std::string write(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}

TEST(Defaults, AFileThatNamesNothingHasThoseOfTheStructs) {
  const test::TemporaryFolder folder;
  const std::string rig = write(folder.file("rig.toml"), R"(format = 1
[manipulator]
driver = "sim"
[arm]
driver = "sim"
[arm.machine]
[force]
driver = "sim"
[tracker]
driver = "sim"
[display]
driver = "sim"
[gripper]
driver = "sim"
[truth.arm]
[truth.arm.machine]
)");
  const models::Setup file = load_rig_setup(rig);
  EXPECT_GT(values_of(file).size(), 200U);
  EXPECT_EQ(values_of(file), values_of(in_code(file)));

  const std::string scene = write(folder.file("scene.toml"), R"(format = 1
[[object]]
name = "ball"
shape = "sphere"
radius_mm = 33
position_mm = [0, 0, -20]
behaviour = "tennis_ball"
[[tool]]
name = "stylus"
markers_mm = [[0, 0, 0], [52, 0, 0], [0, 41, 0]]
tip_mm = [0, 0, -120]
[manipulator]
[force]
[tracker]
[display]
[user]
)");
  const models::Setup loaded = load(scene, "");
  models::Setup code = loaded;
  code.scene = SceneSpec{};
  code.scene.behaviours = loaded.scene.behaviours;
  ObjectSpec& ball = code.scene.objects.emplace_back();
  ball.name = "ball";
  ball.radius = 0.033;
  ball.position = {0, 0, -0.02};
  ball.behaviour = "tennis_ball";
  ToolSpec& stylus = code.scene.tools.emplace_back();
  stylus.name = "stylus";
  stylus.markers = {{0, 0, 0}, {0.052, 0, 0}, {0, 0.041, 0}};
  stylus.tip = {0, 0, -0.12};
  code.scene.manipulator.emplace();
  code.scene.force.emplace();
  code.scene.tracker.emplace();
  code.scene.display.emplace();
  code.scene.user.emplace();
  round_to_text(code);
  EXPECT_EQ(values_of(loaded), values_of(code));
}

// "models/rigs/vishap.toml:14:1" -> its line.
std::string line_at(const std::string& place) {
  const auto column = place.rfind(':'), line = place.rfind(':', column - 1);
  std::ifstream in(place.substr(0, line));
  std::string text;
  for (int i = std::stoi(place.substr(line + 1)); i > 0; --i) std::getline(in, text);
  return text;
}

TEST(Defaults, ARigThatNamesAnotherValueSaysWhy) {
  int others = 0;
  for (const std::string& name : files_in(kShipped, "rigs")) {
    const models::Setup rig = load_rig_setup(kShipped + "/rigs/" + name + ".toml");
    const std::map<std::string, std::string> defaults = values_of(in_code(rig));
    for (const auto& [key, value] : values_of(rig)) {
      const auto place = rig.places.find(key);
      const auto is = defaults.find(key);
      const bool title = key == "rig.title";  // every rig has its own
      if (place == rig.places.end() || is == defaults.end() || is->second == value || title) continue;
      ++others;
      EXPECT_NE(line_at(place->second).find('#'), std::string::npos)
          << place->second << ": '" << key << "' is " << value << " and the struct has " << is->second
          << "; say why in a comment at this line, or leave the line out";
    }
  }
  EXPECT_GT(others, 40);
}

// An arm defaults to the one of [VisHap]: the struct has its gains.
TEST(Defaults, OfAnArmAreThoseOfVisHap) {
  const models::Setup rig = load_rig_setup(kShipped + "/rigs/vishap.toml");
  models::Setup code = in_code(rig);
  code.rig.arm.loop.emplace();  // only if a rig states it
  const std::map<std::string, std::string> defaults = values_of(code);
  for (const auto& [key, value] : values_of(rig)) {
    const bool rounded = key.starts_with("rig.arm.machine.") || key == "rig.arm.winding_share";
    if (!key.starts_with("rig.arm.") || rounded) continue;
    EXPECT_EQ(value, defaults.at(key)) << key;
  }
}

// The mixture of a ball's three measured directions for other directions: worked by hand; and every mistake
// in one line.

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

// Upwards into the lowest point of a ball and downwards into its highest point are one direction.
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
  return test::refusal([&] { (void)read_directions(text, "d.toml"); });
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

// The record holds the prepared response: replay does not mix again.
TEST(Directions, ResolvedSceneKeepsTheMixture) {
  const std::string text = resolved(any_ball({"user.offset_mm=4"}));
  EXPECT_EQ(resolved(parse_resolved(text, "resolved")), text);
}

TEST(Directions, WhoPressesNoSphereIsRefused) {
  const auto refused = [](const std::string& scene, const std::string& object) -> std::string {
    return test::refusal([&] {
      (void)load(kFolder + "/scenes/" + scene + ".toml", "sim",
                 {"object." + object + ".behaviour=tennis_ball_any"});
    });
  };
  for (const auto& [scene, object] : {std::pair{"plane", "wall"}, std::pair{"hare", "hare"}})
    EXPECT_THAT(refused(scene, object),
                AllOf(HasSubstr("behaviours.toml:"), HasSubstr("[user] that presses a sphere")));
}

}  // namespace
}  // namespace enc::models
