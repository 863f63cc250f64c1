// The world subsystem's files: scenes of an arm, the interaction database, and what is wrong with them in one
// line.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/support/built.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/variable.h"
#include "trial/trial.h"

namespace enc::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const fs::path kModels = fs::path(tests::source_dir()) / "models";

models::Setup setup_of(const std::string& scene, const std::vector<std::string>& set = {},
                       const std::string& rig = "vishap") {
  return models::load((kModels / "scenes" / (scene + ".toml")).string(), rig, set);
}

// What is wrong; empty if the scene can be made ready.
std::string said_objects(const std::string& scene, const std::vector<std::string>& set) {
  try {
    (void)trial::prepare_setup(setup_of(scene, set));
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

TEST(ObjectsInput, TheShippedScenesAreReadyAndHaveTheirProps) {
  for (const char* scene : {"keypad", "room", "hit_ball", "tiles", "drum"}) {
    EXPECT_EQ(said_objects(scene, {}), "") << scene;
    EXPECT_THAT(setup_of(scene).notes, IsEmpty()) << scene;
  }
  EXPECT_EQ(trial::prepare_setup(setup_of("keypad")).objects.size(), 12U);
  EXPECT_EQ(std::get<Push>(trial::prepare_setup(setup_of("tiles")).task).movers.size(), 2U);
}

TEST(ObjectsInput, NumbersOutOfRange) {
  for (const char* set :
       {"object.key_1.width_mm=0", "object.key_1.height_mm=-15", "object.key_1.thickness_mm=0",
        "follow.hysteresis_mm=-1", "object.key_1.width_mm=nan"})
    EXPECT_THAT(said_objects("keypad", {set}), HasSubstr("; expected a ")) << set;
  for (const char* set :
       {"behaviour.hit_ball.interaction.mass_kg=-0.1", "behaviour.hit_ball.interaction.mass_kg=0",
        "behaviour.hit_ball.interaction.restitution=0", "behaviour.hit_ball.interaction.restitution=1.1",
        "behaviour.hit_ball.interaction.travel_mm=0", "behaviour.hit_ball.stiffness_N_per_mm=-1"})
    EXPECT_THAT(said_objects("hit_ball", {set}), HasSubstr("; expected a ")) << set;
  EXPECT_THAT(said_objects("tiles", {"behaviour.tile.interaction.friction_N=-1"}),
              HasSubstr("; expected a "));
  EXPECT_THAT(said_objects("tiles", {"behaviour.tile.interaction.way=[0,0,-0.5]"}),
              HasSubstr("expected length 1"));
}

TEST(ObjectsInput, AnEntryThatTheDatabaseDoesNotHaveIsOneLineWithItsPlace) {
  const std::string what = said_objects("keypad", {"object.key_3.behaviour=\"key_buton\""});
  EXPECT_THAT(what, AllOf(HasSubstr("there is no behaviour 'key_buton'"), HasSubstr("behaviours.toml"),
                          HasSubstr("did you mean 'key_button'?")));
  EXPECT_EQ(std::count(what.begin(), what.end(), '\n'), 0);
}

TEST(ObjectsInput, ANormalOfAnotherLengthIsMendedAndTold) {
  const models::Setup setup = setup_of("keypad", {"object.key_2.normal=[0,0,2]"});
  EXPECT_EQ(setup.scene.objects[1].normal, Vec3(0, 0, 1));
  EXPECT_THAT(setup.notes, ElementsAre(AllOf(HasSubstr("'normal' has length 2"), HasSubstr("[0, 0, 1]"))));
  EXPECT_THAT(said_objects("keypad", {"object.key_2.normal=[0,0,0]"}), HasSubstr("no direction"));
}

TEST(ObjectsInput, AWrongPropIsWarnedOf) {
  const models::Setup setup = setup_of("room", {"prop.kind=\"plate\""});
  EXPECT_THAT(setup.notes, ElementsAre(AllOf(HasSubstr("room.toml"),
                                             HasSubstr("warning: object 'key' shall feel like a key and the "
                                                       "arm carries a plate"))));
}

TEST(ObjectsInput, MoreObjectsThanCanMove) {
  models::Setup setup = setup_of("hit_ball");
  const ObjectSpec ball = setup.scene.objects[0];
  for (std::size_t i = 0; i < kMostMoving; ++i) {
    setup.scene.objects.push_back(ball);
    setup.scene.objects.back().name = "ball_" + std::to_string(i);
  }
  try {
    (void)prepare(setup.scene, setup.rig);
    FAIL();
  } catch (const Error& e) {
    EXPECT_THAT(e.what(), HasSubstr("at most 16"));
    EXPECT_EQ(e.key(), "object.ball_15.behaviour");
  }
}

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// Editing one entry changes the objects that name it, and no other.
TEST(ObjectsInput, EachEntryIsItsObjectsAlone) {
  const TemporaryFolder folder;
  fs::copy(kModels, folder.path(), fs::copy_options::recursive);
  const Variable models("ENCOUNTER_MODELS", folder.path().string());
  const fs::path file = fs::path(folder.path()) / "behaviours.toml";
  const auto room = [&] {
    return trial::prepare_setup(
        models::load((fs::path(folder.path()) / "scenes" / "room.toml").string(), "vishap", {}));
  };
  const Scene before = room();
  std::string text = text_of(file);
  const std::string old = "stiffness_N_per_mm = 0.6";
  const auto at = text.find(old, text.find("name = \"passive_key\""));
  ASSERT_NE(at, std::string::npos);
  std::ofstream(file) << text.replace(at, old.size(), "stiffness_N_per_mm = 0.4");
  const Scene after = room();
  EXPECT_EQ(before.objects[0].stiffness, 600.0);
  EXPECT_EQ(after.objects[0].stiffness, 400.0);
  for (std::size_t i = 1; i < before.objects.size(); ++i) {
    EXPECT_EQ(before.objects[i].stiffness, after.objects[i].stiffness);
    EXPECT_EQ(before.objects[i].interaction.kind, after.objects[i].interaction.kind);
    EXPECT_EQ(before.objects[i].X_WO.xyz, after.objects[i].X_WO.xyz);
  }
}

// A machine that only its file describes [L18].
TEST(ObjectsInput, AStageOfTwoSlidesRunsTheWall) {
  trial::TrialOptions options;
  trial::Trial trial(
      setup_of("wall", {"user.approach_mm_s=[50]", "user.press_s=1", "user.release_s=1"}, "stage"), options);
  double peak = 0.0;
  while (trial.tick()) peak = std::max(peak, trial.world().truth().contact_force.norm());
  EXPECT_EQ(trial.scene().impedance()->arm.joints(), 2U);
  EXPECT_GE(trial.result().contacts, 1);
  EXPECT_GT(peak, 1.0);
  EXPECT_TRUE(trial.result().holds.empty());
}

}  // namespace
}  // namespace enc::test
