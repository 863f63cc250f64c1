// What each scene that ships costs before it does anything: libraries, threads, parts of the physics, memory,
// and how long the program takes to its first tick. What a scene does not name is not there.
#include <algorithm>
#include <filesystem>
#include <set>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/child.h"
#include "benchmarks/kit/statistics.h"
#include "core/error.h"

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
  double start = kUnset;   // CPU time of the whole process over that of one that does nothing
};

// One tick of a scene, and an empty process right after it: whatever else the machine does, both feel it.
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

}  // namespace

BenchResult run(const BenchContext& context) {
  BenchResult result{"footprint", "all", 0, 0, {}};
  std::error_code none;
  const std::string program = fs::read_symlink("/proc/self/exe", none).string();
  std::set<fs::path> scenes;
  for (const auto& entry : fs::directory_iterator(context.models + "/scenes"))
    if (entry.path().extension() == ".toml") scenes.insert(entry.path());
  Table table{"footprint_scenes",
              "What each scene costs",
              {"scene", "libraries", "threads", "MuJoCo elements", "MiB", "start, empty process = 1"}};
  double done = 0.0;
  for (const fs::path& scene : scenes) {
    const Row row = measured(program, scene, context.quick ? 3 : 9);
    table.rows.push_back({row.scene, fmt::format("{}", row.libraries), fmt::format("{}", row.threads),
                          fmt::format("{}", row.elements), fmt::format("{:.1f}", row.memory),
                          fmt::format("{:.1f}", row.start)});
    const bool plane = row.scene == "plane";
    const auto add = [&](const char* what, double value, const char* unit, double high) {
      result.figures.push_back({fmt::format("footprint.{}.{}", row.scene, what), kUnset, value, unit,
                                Role::ours, kUnset, high, ""});
    };
    add("libraries", static_cast<double>(row.libraries), "", kUnset);
    add("threads", row.threads, "", 1.0);
    add("elements", row.elements, "", kUnset);
    add("memory", row.memory, "MiB", plane ? kMostMemory : kUnset);
    add("start", row.start, "x", kUnset);
    if (context.progress) context.progress(++done / static_cast<double>(scenes.size()));
  }
  table.note = "MuJoCo elements: bodies, joints, geoms, sites, sensors, actuators, tendons, equalities";
  result.tables.push_back(std::move(table));
  return result;
}

}  // namespace enc::bench::footprint
