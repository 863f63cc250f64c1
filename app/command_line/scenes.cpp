// `encounter scenes`: what ships to be run, a line each.
#include <algorithm>

#include <fmt/format.h>

#include "app/common/options.h"
#include "core/base/error.h"
#include "models/schema/printable.h"
#include "models/setup/scene_file.h"
#include "models/setup/scene_names.h"

namespace enc::app {

int scenes() {
  const std::vector<models::ListedScene> listed = models::listed_scenes(models::models_dir());
  std::size_t widest = 0;
  for (const models::ListedScene& scene : listed) widest = std::max(widest, scene.name.size());
  for (const models::ListedScene& scene : listed) {
    const std::string text = !scene.mistake.empty() ? "CANNOT BE READ: " + scene.mistake
                             : scene.rig == "sim"   ? scene.title
                                                    : fmt::format("{} (rig {})", scene.title, scene.rig);
    fmt::print("{:<{}}  {}\n", models::printable(scene.name), widest, models::printable(text));
  }
  if (listed.empty())
    throw Error(
        fmt::format("{}/scenes: there are no scenes; expected the models of Encounter; see to "
                    "ENCOUNTER_MODELS, or leave it unset",
                    models::models_dir()));
  return 0;
}

}  // namespace enc::app
