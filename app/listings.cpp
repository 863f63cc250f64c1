// `encounter params`: lists all names that --set takes. `encounter scenes`: lists the shipped scenes, one
// line each.
#include <algorithm>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/options.h"
#include "app/common/words.h"
#include "app/modules/modules.h"
#include "models/schema/printable.h"
#include "models/setup/scene_file.h"
#include "models/setup/scene_names.h"
#include "models/tables/csv_field.h"

namespace enc::app {
int params(const ParamsOptions& options) {
  const models::Setup setup = load_setup(options);
  const std::vector<models::Parameter> list = models::parameters(setup);
  if (!options.json) {
    fmt::print("name,unit,value,source,confidence,meaning\n");
    for (const auto& p : list)
      fmt::print("{},{},{},{},{},{}\n", models::csv_field(p.name), models::csv_field(p.unit),
                 models::csv_field(p.value), models::csv_field(p.source), models::csv_field(p.confidence),
                 models::csv_field(p.meaning));
    return 0;
  }
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const auto& p : list)
    json.push_back({{"name", p.name},
                    {"unit", p.unit},
                    {"value", p.value},
                    {"source", p.source},
                    {"confidence", p.confidence},
                    {"meaning", p.meaning}});
  fmt::print("{}\n", json.dump(2));
  return 0;
}

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
  if (listed.empty()) throw no_scenes();
  return 0;
}

}  // namespace enc::app
