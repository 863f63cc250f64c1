// `encounter export SCENE world.xml` of each scene that is shipped: MuJoCo's own programs open it.
#include <algorithm>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "models/setup/scene_file.h"
#include "sim/bodies/mujoco.h"
#include "sim/world.h"
#include "tests/support/built.h"
#include "trial/assemble/assemble.h"
#include "trial/assemble/prepare.h"

namespace enc {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> shipped_scenes() {
  std::vector<std::string> scenes;
  for (const auto& entry : fs::recursive_directory_iterator(tests::source_dir() + "/models/scenes"))
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path().string());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

sim::ModelPtr compiled(const std::string& xml) {
  std::array<char, 500> why{};
  const sim::SpecPtr spec(mj_parseXMLString(xml.c_str(), nullptr, why.data(), static_cast<int>(why.size())));
  EXPECT_TRUE(spec) << why.data();
  if (!spec) return {};
  sim::ModelPtr model(mj_compile(spec.get(), nullptr));
  EXPECT_TRUE(model) << mjs_getError(spec.get());
  return model;
}

TEST(ShippedExport, OpensInMujocoAsTheWorldThatItIs) {
  const std::vector<std::string> scenes = shipped_scenes();
  ASSERT_GE(scenes.size(), 28U);
  for (const std::string& path : scenes) {
    SCOPED_TRACE(path);
    const models::Setup setup = models::load(path, "");
    const Scene scene = trial::prepare_setup(setup);
    const auto world = trial::make_world(setup, scene, 1, true);
    const sim::ModelPtr opened = compiled(world->physics().xml());
    if (!opened) continue;
    const mjModel& built = *world->physics().model();
    EXPECT_EQ(opened->nbody, built.nbody);
    EXPECT_EQ(opened->njnt, built.njnt);
    EXPECT_EQ(opened->ngeom, built.ngeom);
    EXPECT_EQ(opened->nsensor, built.nsensor);
    EXPECT_EQ(opened->ntendon, built.ntendon);
    for (int i = 0; i < built.nbody && i < opened->nbody; ++i) {
      EXPECT_NEAR(opened->body_mass[i], built.body_mass[i], 1e-5 * built.body_mass[i]) << "body " << i;
      for (int k = 3 * i; k < 3 * i + 3; ++k)
        EXPECT_NEAR(opened->body_inertia[k], built.body_inertia[k], 1e-5 * built.body_inertia[k])
            << "body " << i;
    }
  }
}

}  // namespace
}  // namespace enc
