// A file of only the built values runs with the same bits; the program does not read the values that it
// leaves out.
#include <fstream>
#include <set>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "core/record/fields.h"
#include "models/schema/schema.h"
#include "models/schema/toml_writer.h"
#include "models/setup/scene_file.h"
#include "sim/truth/truth.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "trial/trial.h"

namespace enc::models {
namespace {

using testing::HasSubstr, testing::Not;
const std::string kModels = tests::source_dir() + "/models";

// Calls `found` with every value's full name.
class Walk final : public Visitor {
 public:
  using TargetCallback = std::function<void(const std::string& name, const Target& target)>;
  explicit Walk(TargetCallback found) : found_(std::move(found)) {}

  void value(const Key& key, const Target& target) override {
    found_(paths_.back() + "." + std::string(key.name), target);
  }
  bool open(std::string_view table, bool present) override {
    if (present) paths_.push_back(paths_.back() + "." + std::string(table));
    return present;
  }
  std::size_t open_list(std::string_view, std::size_t size) override { return size; }
  void open_entry(std::string_view list, std::size_t, std::string_view name) override {
    paths_.push_back(paths_.back() + "." + std::string(list) + "." + std::string(name));
  }
  void close() override { paths_.pop_back(); }
  void drivers(std::string_view, std::vector<DriverTable>&) override {}  // texts: the program's test looks

 private:
  TargetCallback found_;
  std::vector<std::string> paths_{""};
};

// Another number for each value that the text of built_scene() leaves out.
int spoil_left_out(Setup& setup) {
  std::set<std::string> kept;
  Walk keep([&](const std::string& name, const Target&) { kept.insert(name); });
  walk_built(keep, setup);
  int spoiled = 0;
  const auto other = [](double x) { return 1.3 * x + 1e-3; };
  Walk spoil([&](const std::string& name, const Target& target) {
    if (kept.contains(name)) return;
    if (auto* const* number = std::get_if<double*>(&target)) **number = other(**number);
    if (auto* const* vector = std::get_if<Vec3*>(&target))
      for (double& x : **vector) x = other(x);
    ++spoiled;
  });
  describe_all(spoil, setup.scene, setup.rig, setup.twin);
  return spoiled;
}

struct SceneDigest {
  std::uint64_t hash;
  Vec3 tip;  // true
  bool operator==(const SceneDigest&) const = default;
};
SceneDigest told_by(const Setup& setup) {
  trial::TrialOptions options{.seconds = 5.0};
  trial::Trial trial(setup, options);
  const std::uint64_t hash = trial.run().hash;
  return {hash, trial.truth().tip.e()};
}

// Every tick's commands and truth, but not the values for a display alone.
std::uint64_t outcome_of(const Setup& setup, bool draw_all, RecordWriter* record) {
  StateHash outcome;
  trial::TrialOptions options{.seconds = 5.0, .draw_all = draw_all};
  options.watch = [&](const trial::Glance& glance) {
    Outputs out = glance.out;
    out.view = {};
    sim::Truth truth = glance.truth;
    fields(outcome, out);
    fields(outcome, truth);
  };
  trial::Trial trial(setup, options);
  trial.record_to(record);
  trial.run();
  return outcome.value;
}

std::vector<std::string> scenes() { return files_in(kModels, "scenes"); }
models::Setup shipped(const std::string& scene) { return load(kModels + "/scenes/" + scene + ".toml", ""); }

class BuiltScene : public testing::TestWithParam<std::string> {};

TEST_P(BuiltScene, AsAFileGivesTheSameBits) {
  const test::TemporaryFolder folder;
  const models::Setup scene = shipped(GetParam());
  const std::string path = folder.file("alone.toml"), text = built_scene(scene);
  std::ofstream(path) << text;
  const models::Setup alone = load(path, "");
  EXPECT_EQ(built_scene(alone), text);
  EXPECT_EQ(told_by(alone), told_by(scene));
}

TEST_P(BuiltScene, LeavesOutWhatNothingReads) {
  const models::Setup scene = shipped(GetParam());
  models::Setup spoiled = scene;
  EXPECT_GT(spoil_left_out(spoiled), 20);
  EXPECT_EQ(told_by(spoiled), told_by(scene));
}

// The file has every table of rig and truth, the display if the scene may have one, drawn bodies, and a
// record. The forces equal those of the scene with only its built values.
TEST_P(BuiltScene, WithEverythingOnGivesTheSameBits) {
  const test::TemporaryFolder folder;
  models::Setup scene = shipped(GetParam());
  const std::string minimal = folder.file("minimal.toml"), everything = folder.file("everything.toml");
  const bool shows = scene.scene.manipulator && scene.scene.user && !scene.scene.travel;
  if (shows) scene.scene.display.reset();
  std::ofstream(minimal) << built_scene(scene);
  if (shows) scene.scene.display.emplace();
  std::ofstream(everything) << write_toml(
      [&](Visitor& visitor) { describe_all(visitor, scene.scene, scene.rig, scene.twin); });
  const models::Setup most = load(everything, "");
  RecordWriter record(folder.file("everything.encrec"), record_texts(most),
                      layout_hash(trial::Trial(most, {}).scene()));
  EXPECT_EQ(outcome_of(most, true, &record), outcome_of(load(minimal, ""), false, nullptr));
}

INSTANTIATE_TEST_SUITE_P(Shipped, BuiltScene, testing::ValuesIn(scenes()),
                         [](const auto& scene) { return scene.param; });

TEST(BuiltSceneFile, KeepsWhatSetSays) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("alone.toml");
  std::ofstream(path) << built_scene(
      load(kModels + "/scenes/wall.toml", "stage",
           {"rig.arm.filter_hz=90", "behaviour.phantom_wall.stiffness_N_per_mm=0.5"}));
  const models::Setup alone = load(path, "");
  EXPECT_EQ(alone.rig.arm.filter, 90.0);
  EXPECT_EQ(alone.rig.arm.machine.kind, ArmKind::chain);
  EXPECT_EQ(alone.scene.behaviours.at(0).stiffness, 500.0);
  EXPECT_EQ(
      load(path, "", {"behaviour.phantom_wall.stiffness_N_per_mm=0.4"}).scene.behaviours.at(0).stiffness,
      400.0);
  EXPECT_EQ(place_of(alone, "rig.arm.filter").substr(0, path.size()), path);
  // --rig takes precedence.
  EXPECT_EQ(load(path, kModels + "/rigs/vishap.toml").rig.arm.machine.kind, ArmKind::phantom);
}

TEST(BuiltSceneFile, TakesAnotherResponseOrBehaviour) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("alone.toml");
  std::ofstream(path) << built_scene(shipped("tennis_ball"));
  const auto curve = [&](const char* set) {
    return load(path, "", {set}).scene.behaviours.back().curves.press;
  };
  EXPECT_NE(curve("behaviour.tennis_ball.response=regulation_ball"), curve("user.depth_mm=5"));
  EXPECT_EQ(load(path, "", {"object.ball.behaviour=wall"}).scene.behaviours.back().name, "wall");
}

TEST(BuiltSceneFile, NamesNoPartThatIsNotBuilt) {
  const std::string wall = built_scene(shipped("wall"));
  for (const char* part :
       {"[rig.manipulator]", "[rig.force]", "[truth.hexapod", "[truth.ball]", "[truth.camera]"})
    EXPECT_THAT(wall, Not(HasSubstr(part)));
  EXPECT_THAT(wall, HasSubstr("[rig.arm.machine]"));
  EXPECT_THAT(built_scene(shipped("tennis_ball")), Not(HasSubstr("[rig.arm")));
}

}  // namespace
}  // namespace enc::models
