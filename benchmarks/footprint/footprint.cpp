// Costs of each scene that ships before it runs: libraries, threads, parts of the physics, memory, and the
// time from the program's start to its first tick. The program loads only the parts that a scene names.
#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "benchmarks/kit/child.h"
#include "benchmarks/kit/kit.h"
#include "core/base/error.h"

namespace enc::bench::footprint {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr double kMostMemory = 50.0;  // MiB, of the plane

struct Row {
  std::string scene;
  std::size_t libraries = 0;
  int threads = 0, elements = 0;
  double memory = kUnset;  // MiB
  double start = kUnset;   // CPU time of the whole process over that of an empty one
};

// One tick of a scene, and an empty process right after it, so that other load on the machine affects both.
Row measured(const std::string& program, const fs::path& scene, int repeats) {
  Row row{scene.stem(), 0, 0, 0, kUnset, kUnset};
  std::vector<double> ratios;
  for (int i = 0; i < repeats; ++i) {
    const Child run = run_child({program, "run", scene.string(), "--for-s", "0.001", "--json"});
    const Child nothing = run_child({"true"});
    const Json json = Json::parse(run.out, nullptr, false);
    if (run.code != 0 || json.is_discarded())
      throw Error(fmt::format("{} could not be run: {}", scene.string(), run.err));
    row.libraries = json["libraries"].size();
    row.threads = json["threads"];
    row.elements = json["mujoco_elements"];
    row.memory = json["peak_memory_MiB"];
    ratios.push_back(run.cpu / std::max(nothing.cpu, 1e-5));
  }
  row.start = median(ratios);
  return row;
}

void run(Bench& bench) {
  const std::string program = this_program();
  std::set<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator(bench.context.models + "/scenes"))
    if (entry.path().extension() == ".toml") scenes.insert(entry.path());
  Table table{"scenes",
              "What each scene costs",
              {"scene", "libraries", "threads", "MuJoCo elements", "MiB", "start, empty process = 1"}};
  std::optional<Row> other;
  if (bench.context.mutated("camera_scene"))
    other = measured(program, bench.context.models + "/scenes/camera/wall.toml", 1);
  for (const fs::path& scene : scenes) {
    Row row = other ? *other : measured(program, scene, bench.context.quick ? 3 : 9);
    row.scene = scene.stem();
    table.add(row.scene, row.libraries, row.threads, row.elements, fixed(row.memory, 1), fixed(row.start, 1));
    const auto id = [&](const char* what) { return row.scene + "." + what; };
    bench.cost(id("libraries"), static_cast<double>(row.libraries), "");
    bench.figure(id("threads"), row.threads, "", at_most(1.0));
    bench.figure(id("elements"), row.elements, "");
    bench.cost(id("memory"), row.memory, "MiB", at_most(row.scene == "plane" ? kMostMemory : kUnset));
    bench.cost(id("start"), row.start, "x");
    bench.progress(static_cast<double>(table.rows.size()) / static_cast<double>(scenes.size()));
  }
  table.note = "MuJoCo elements: bodies, joints, geoms, sites, sensors, actuators, tendons, equalities";
  bench.table(std::move(table));
}

const Entry kEntry{"footprint", "all", "libraries, threads, memory and start of each scene that ships", run};

}  // namespace
}  // namespace enc::bench::footprint
