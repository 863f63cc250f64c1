#include "tests/input/models/scene_folder.h"

#include <fstream>
#include <sstream>

#include <unistd.h>

#include "core/base/error.h"
#include "models/setup/scene_file.h"
#include "tests/support/built.h"
#include "tests/support/replaced.h"

namespace enc::test {

namespace fs = std::filesystem;

void SceneFile::SetUp() {
  folder_ = fs::temp_directory_path() / ("enc_scene_file_" + std::to_string(getpid()));
  models_.emplace("ENCOUNTER_MODELS", folder_.string());
  for (const char* sub : {"scenes", "rigs", "responses"}) fs::create_directories(folder_ / sub);
  std::ifstream rig(tests::source_dir() + "/models/rigs/sim.toml");
  std::stringstream text;
  text << rig.rdbuf();
  rig_ = text.str();
  write("rigs/sim.toml", rig_);
  write("behaviours.toml", kBehaviours);
  write("responses/tennis_ball.toml", kResponse);
  write("scenes/ball.toml", kScene);
}

void SceneFile::write(const std::string& name, const std::string& text) const {
  std::ofstream(folder_ / name) << text;
}

std::string SceneFile::said(const std::vector<std::string>& overrides, const std::string& scene,
                            const std::string& rig) const {
  try {
    models::load(path(scene), rig, overrides);
  } catch (const Error& e) {
    std::string what = e.what();
    EXPECT_EQ(what.find('\n'), std::string::npos) << "one line: " << what;
    EXPECT_EQ(e.kind(), ErrorKind::input);
    EXPECT_TRUE(e.key().empty()) << "the place is in the text already";
    for (auto at = what.find(folder_.string()); at != std::string::npos; at = what.find(folder_.string())) {
      what.erase(at, folder_.string().size() + 1);
    }
    return what;
  }
  return "(no error)";
}

std::string SceneFile::scene_said(const std::string& from, const std::string& to) const {
  write("rigs/sim.toml", rig_);
  write("scenes/ball.toml", replaced(kScene, from, to));
  return said();
}

std::string SceneFile::rig_said(const std::string& from, const std::string& to) const {
  write("scenes/ball.toml", kScene);
  write("rigs/sim.toml", replaced(rig_, from, to));
  return said();
}

}  // namespace enc::test
