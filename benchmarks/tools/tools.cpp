// Which tool is it? All tools that scenes name, seen by their markers with a tracker's noise: how often one
// is taken for another [VHMR 3.2]. The tools that ship are two.
#include <algorithm>
#include <array>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/kit.h"
#include "core/track/markers.h"
#include "models/setup/scene_file.h"

namespace enc::bench::tools {
namespace {

using Markers = std::vector<Vec3>;

constexpr double kWorst =
    0.3e-3;  // m rms of a marker, each axis; the paper's tracker: 0.09 mm of all three [VHMR 2]
constexpr std::array kNoises{0.1e-3, kWorst, 1e-3, 2e-3};

struct Stored {
  std::vector<std::string> names;
  std::vector<Markers> markers;
};

// Of every scene, each geometry once, by the first name it has.
Stored stored_tools(const std::string& models) {
  std::vector<std::filesystem::path> scenes;
  for (const auto& entry : std::filesystem::directory_iterator(models + "/scenes"))
    if (entry.path().extension() == ".toml") scenes.push_back(entry.path());
  std::sort(scenes.begin(), scenes.end());
  Stored stored;
  for (const auto& scene : scenes)
    for (const ToolSpec& tool : models::load(scene.string(), "", {}).scene.tools) {
      const bool known =
          std::find(stored.markers.begin(), stored.markers.end(), tool.markers) != stored.markers.end();
      if (tool.markers.empty() || known) continue;
      stored.names.push_back(tool.name);
      stored.markers.push_back(tool.markers);
    }
  return stored;
}

// As a tracker sees it: anywhere, any way up, its markers in any order.
class Tracker {
 public:
  Tracker(std::uint64_t seed, double noise) : random_(seed), noise_(noise) {}
  Markers see(const Markers& tool) {
    const Quat q = Quat(normal(), normal(), normal(), normal()).normalized();
    const Pose<'C', 'T'> X_CT(q, Vec3(0.2 * normal(), 0.2 * normal(), 1.0 + 0.1 * normal()));
    Markers seen;
    for (const Vec3& marker : tool)
      seen.push_back((X_CT * Point<'T'>(marker)).e() + noise_ * Vec3(normal(), normal(), normal()));
    std::shuffle(seen.begin(), seen.end(), random_);
    return seen;
  }

 private:
  double normal() { return normal_(random_); }
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
  double noise_;
};

struct Confusion {
  std::vector<std::vector<std::int64_t>> taken;  // [tool][taken for]; the last: for none
  [[nodiscard]] std::int64_t wrong() const {
    std::int64_t sum = 0;
    for (std::size_t i = 0; i < taken.size(); ++i)
      for (std::size_t j = 0; j < taken[i].size(); ++j) sum += i == j ? 0 : taken[i][j];
    return sum;
  }
};

Confusion confusion(const std::vector<Markers>& tools, double noise, std::uint64_t seed, int looks) {
  Confusion of;
  Tracker tracker(seed, noise);
  for (const Markers& tool : tools) {
    std::vector<std::int64_t>& row = of.taken.emplace_back(tools.size() + 1, 0);
    for (int i = 0; i < looks; ++i) {
      const std::int32_t found = recognise(tracker.see(tool), tools).tool;
      ++row[found < 0 ? tools.size() : static_cast<std::size_t>(found)];
    }
  }
  return of;
}

// The closest pair that a scene may name together: triangles of which one side is longer, half at each end,
// so that the other two hardly are, and the error of that one distance decides.
std::vector<Markers> just_apart() {
  const Vec3 a(-0.04, 0, 0), b(0.04, 0, 0), c(0.01, 0.12, 0), half(1e-5, 0, 0);
  std::vector<Markers> tools{{a, b, c}, {a, b, c}};
  while (alike(tools[0], tools[1])) {
    tools[1][0] -= half;
    tools[1][1] += half;
  }
  return tools;
}

void run(Bench& bench) {
  const Stored stored = stored_tools(bench.context.models);
  const int looks = bench.context.quick ? 500 : 20'000;
  Table table{"confusion",
              "Which tool is it taken for?",
              {"marker noise, mm", "tool"},
              {},
              fmt::format("Of {} looks at each, in any pose, markers in any order.", looks),
              true};
  for (const std::string& name : stored.names) table.columns.push_back(name);
  table.columns.emplace_back("none");
  std::vector<double> noises(kNoises.begin(), kNoises.end());
  const std::vector<Confusion> all = bench.each(
      noises, [&](double noise) { return confusion(stored.markers, noise, bench.context.seed, looks); });
  for (std::size_t n = 0; n < noises.size(); ++n) {
    for (std::size_t tool = 0; tool < stored.names.size(); ++tool) {
      std::vector<std::string> row{fmt::format("{:g}", 1e3 * noises[n]), stored.names[tool]};
      for (const std::int64_t count : all[n].taken[tool]) row.push_back(fmt::format("{}", count));
      table.rows.push_back(std::move(row));
    }
    if (noises[n] == kWorst)
      bench.figure("wrong.count", static_cast<double>(all[n].wrong()), "", exactly(0),
                   fmt::format("of {} looks at each of {} tools, markers known to {:g} mm", looks,
                               stored.names.size(), 1e3 * kWorst));
  }
  bench.table(std::move(table));
  const std::int64_t closest = confusion(just_apart(), kWorst, bench.context.seed, looks).wrong();
  bench.figure("just_apart.wrong.share", static_cast<double>(closest) / (2.0 * looks), "", at_most(1e-4),
               fmt::format("of two tools that a scene may just name together: one distance {:g} mm longer",
                           1e3 * kMarkersApart));
}

const Entry kEntry{"tools", "session", "tools told apart by their markers: a confusion matrix", run};

}  // namespace
}  // namespace enc::bench::tools
