// Every shipped scene, and a newcomer's first scene of their own.
#include <algorithm>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "models/setup/scene_file.h"
#include "models/setup/scene_names.h"
#include "tests/input/app/program.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// ---- Every shipped scene ends with exit code 0 for every simulated hand, or its file gives the reason.
// Scenes listed here once ended in a limit or a hold. In one the machine followed the tool to a tray, in
// another a bound ignored the drawn reach.

Result run_seed(const std::string& scene, int seed) {
  return run_program(
      {"run", source_dir() + "/models/scenes/" + scene + ".toml", "--seed", std::to_string(seed)});
}

// The expected exit code from the scene file: "# Expected: seed 20 ends with exit code 1." and the reason.
int expected_code(const std::string& scene, int seed) {
  std::ifstream in(source_dir() + "/models/scenes/" + scene + ".toml");
  const std::regex says("# Expected: seed ([0-9]+) ends with exit code ([0-9])\\..+");
  for (std::string line; std::getline(in, line);)
    if (std::smatch found; std::regex_search(line, found, says) && std::stoi(found[1]) == seed)
      return std::stoi(found[2]);
  return 0;
}

void expect_well(const std::string& scene, int seed) {
  const Result run = run_seed(scene, seed);
  EXPECT_EQ(run.code, expected_code(scene, seed)) << scene << ", seed " << seed << "\n" << run.out << run.err;
}

TEST(ShippedScenes, EndWellWhereTheyOnceDidNot) {
  for (const int seed : {1, 5, 11}) {
    const Result run = run_seed("training", seed);
    EXPECT_EQ(run.code, 0) << run.out;
    EXPECT_THAT(run.out,
                AllOf(Not(HasSubstr("\nhold ")), HasSubstr("limit 0.15 mm"), HasSubstr("limit not reached")));
  }
  for (const int seed : {9, 12}) expect_well("session", seed);
}

TEST(ShippedScenesLong, EndWellWithSeeds1To20) {
  for (const std::string& scene : models::scene_names(source_dir() + "/models"))
    for (int seed = 1; seed <= 20; ++seed) expect_well(scene, seed);
}

// ---- The first steps of a newcomer: the shipped scenes by name, a first scene of their own, and a behaviour
// of their own in it.

using Json = nlohmann::json;

// The scene from the guide, as a reader copies it.
std::string scene_of_guide() {
  const std::string page = test::bytes_of(source_dir() + "/docs/guide/scene.md");
  const std::string begin = "```toml\n";
  const std::size_t from = page.find(begin) + begin.size();
  return page.substr(from, page.find("```", from) - from);
}

using OwnScene = Program;

TEST_F(OwnScene, TheOneThatTheGuideShowsTouchesSomething) {
  const std::string scene = scene_of_guide();
  ASSERT_THAT(scene, HasSubstr("[[object]]"));
  write("first.toml", scene);
  const Result run = run_program({"run", path("first.toml"), "--json"});
  ASSERT_EQ(run.code, 0) << run.out << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_GE(json.at("contacts").get<int>(), 1);
  EXPECT_GT(json.at("presses").at(0).at("peak_force_N").get<double>(), 1.0);
  EXPECT_EQ(run_program({"check", path("first.toml")}).code, 0);
}

TEST_F(OwnScene, MayHaveABehaviourOfItsOwn) {
  const std::string own =
      "[[behaviour]]\nname = \"sponge\"\nstiffness_N_per_mm = 0.8\nlimit_mm = 5\n\n[[object]]";
  edit("models/scenes/plane.toml", "behaviour = \"wall\"", "behaviour = \"sponge\"");
  edit("models/scenes/plane.toml", "[[object]]", own);
  const models::Setup setup = models::load(plane(), "");
  ASSERT_EQ(setup.scene.behaviours.size(), 1U);
  EXPECT_DOUBLE_EQ(setup.scene.behaviours[0].stiffness, 800.0);
  EXPECT_DOUBLE_EQ(setup.scene.behaviours[0].curves.press[0], 800.0);
  EXPECT_EQ(run_program({"run", plane(), "--for-s", "0.1"}).code, 0);
  // The scene's numbers can be set by --set, and also stand alone with the scene.
  EXPECT_DOUBLE_EQ(
      models::load(plane(), "", {"behaviour.sponge.stiffness_N_per_mm=1"}).scene.behaviours[0].stiffness,
      1000.0);
  const Result alone = run_program({"check", plane(), "--resolved"});
  EXPECT_THAT(alone.out, HasSubstr("name = \"sponge\""));
  write("alone.toml", alone.out);
  const auto hash = [&](const std::string& scene) {
    return Json::parse(run_program({"run", scene, "--for-s", "0.1", "--json"}).out)
        .at("state_hash")
        .get<std::string>();
  };
  EXPECT_EQ(hash(path("alone.toml")), hash(plane()));
}

// One name means one behaviour, in every scene.
TEST_F(OwnScene, NamesItsBehaviourAsNoOtherIsNamed) {
  edit("models/scenes/plane.toml", "[[object]]",
       "[[behaviour]]\nname = \"wall\"\nstiffness_N_per_mm = 0.8\nlimit_mm = 5\n\n[[object]]");
  EXPECT_THAT(
      scene_refused(plane()),
      AllOf(StartsWith(plane() + ":" + line_and_column(test::bytes_of(plane()), "name = \"wall\"\nstiff") +
                       ": behaviour 'wall' has the name of an entry of"),
            HasSubstr("behaviours.toml:"), HasSubstr("rename it")));
}

TEST_F(OwnScene, ABehaviourWithAMistakeIsNamedWithItsPlace) {
  edit("models/scenes/plane.toml", "behaviour = \"wall\"", "behaviour = \"spunge\"");
  edit("models/scenes/plane.toml", "[[object]]",
       "[[behaviour]]\nname = \"sponge\"\nstiffness_N_per_mm = 0.8\nlimit_mm = 5\n\n[[object]]");
  EXPECT_THAT(scene_refused(plane()),
              AllOf(HasSubstr("there is no behaviour 'spunge'"),
                    HasSubstr("or a [[behaviour]] of this scene"), HasSubstr("did you mean 'sponge'?")));
  edit("models/scenes/plane.toml", "spunge", "sponge");
  edit("models/scenes/plane.toml", "stiffness_N_per_mm = 0.8", "stiffness_N_per_mm = -0.8");
  EXPECT_THAT(scene_refused(plane()),
              StartsWith(plane() + ":" + line_and_column(test::bytes_of(plane()), "-0.8") + ": "));
}

// A scene names no file outside models/, and reading a list of scenes waits for no device.
TEST_F(OwnScene, NamesNoFileByItsPath) {
  edit("models/scenes/plane.toml", "behaviour = \"wall\"", "behaviour = \"sponge\"");
  edit("models/scenes/plane.toml", "[[object]]",
       "[[behaviour]]\nname = \"sponge\"\nresponse = \"../rigs/sim\"\nlimit_mm = 5\n\n[[object]]");
  EXPECT_THAT(scene_refused(plane()),
              AllOf(HasSubstr("'response' is '../rigs/sim'"), HasSubstr("without a path")));
  ASSERT_EQ(mkfifo(path("models/scenes/pipe.toml").c_str(), 0600), 0);
  EXPECT_THAT(run_program({"scenes"}).out, Not(HasSubstr("pipe")));
}

TEST_F(OwnScene, ScenesAreListedWithTheirTitles) {
  const Result listed = run_program({"scenes"});
  ASSERT_EQ(listed.code, 0) << listed.err;
  const std::vector<models::ListedScene> all = models::listed_scenes(path("models"));
  EXPECT_GE(all.size(), 28U);
  for (const models::ListedScene& scene : all) {
    EXPECT_EQ(scene.mistake, "") << scene.name;
    EXPECT_FALSE(scene.title.empty()) << scene.name;
    EXPECT_THAT(listed.out, HasSubstr(scene.name + " ")) << "and its title";
    EXPECT_THAT(listed.out, HasSubstr(scene.title));
  }
  EXPECT_EQ(std::count(listed.out.begin(), listed.out.end(), '\n'), static_cast<std::ptrdiff_t>(all.size()));
  EXPECT_THAT(listed.out, AllOf(HasSubstr("tennis_ball"), HasSubstr("camera/wall")));
  edit("models/scenes/plane.toml", "title", "titel");
  const Result broken = run_program({"scenes"});
  EXPECT_EQ(broken.code, 0);
  EXPECT_THAT(broken.out, HasSubstr("CANNOT BE READ: " + plane() + ":"));
}

TEST_F(OwnScene, AShippedSceneIsFoundByItsName) {
  for (const char* name : {"plane", "tennis_ball", "rig_A"}) {
    const Result by_name = run_program({"run", name, "--for-s", "0.05"});
    EXPECT_EQ(by_name.code, 0) << by_name.err;
    EXPECT_THAT(by_name.out, HasSubstr("models/scenes/" + std::string(name) + ".toml"));
  }
  EXPECT_EQ(run_program({"check", "camera/wall"}).code, 0);
  // A local file of that name takes precedence.
  EXPECT_EQ(models::scene_file_of(plane()), plane());
  EXPECT_EQ(models::scene_file_of("plane"), plane());
  EXPECT_EQ(models::scene_file_of("plane.toml"), "plane.toml");
}

TEST_F(OwnScene, AfterAMistakeAllNamesAreOffered) {
  EXPECT_THAT(refused({"run", "tenis_ball"}), AllOf(HasSubstr("tenis_ball:1:1: cannot read this scene"),
                                                    HasSubstr("did you mean 'tennis_ball'?")));
  const std::string all = refused({"run", "xxxxxxxxxx"});
  for (const std::string& name : models::scene_names(path("models")))
    EXPECT_THAT(all, HasSubstr("'" + name + "'"));
  EXPECT_THAT(all, Not(HasSubstr("...")));
  const std::string paths = refused({"run", "xxxxxxxxxx.toml"});
  EXPECT_THAT(paths, AllOf(HasSubstr(plane()), HasSubstr(path("models/scenes/camera/wall.toml")),
                           Not(HasSubstr("..."))));
}

}  // namespace
}  // namespace enc::tests
