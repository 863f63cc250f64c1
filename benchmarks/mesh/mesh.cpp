// What a fine mesh costs: from its file to the first tick, and in each tick after that.
#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <unistd.h>

#include "benchmarks/kit/bench.h"
#include "benchmarks/kit/load_scene.h"
#include "benchmarks/kit/parallel.h"
#include "benchmarks/kit/statistics.h"
#include "benchmarks/kit/yardstick.h"
#include "core/mesh/mesh_tree.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_write.h"
#include "models/shapes/shapes.h"
#include "trial/trial.h"

namespace enc::bench::mesh {
namespace {

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// A file that is gone when this is.
struct TemporaryFile {
  std::filesystem::path path =
      std::filesystem::temp_directory_path() / fmt::format("encounter_bench_{}.glb", getpid());
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path, ignored);
  }
};

// The tennis ball's scene with its sphere in triangles.
models::Setup with_mesh(const BenchContext& context, Mesh mesh) {
  models::Setup setup = load_scene(context, "tennis_ball");
  ObjectSpec& ball = setup.scene.objects.front();
  ball.shape = ShapeKind::mesh;
  ball.radius = kUnset;
  ball.surface = std::make_shared<const Mesh>(std::move(mesh));
  return setup;
}

}  // namespace

BenchResult run(const BenchContext& context) {
  BenchResult result{"mesh", "tennis_ball", 0, 0, {}};
  std::optional<TemporaryFile> file(std::in_place);
  const Mesh made = models::geodesic_ball(224);
  models::write_mesh(made, file->path.string(), models::Existing::replace);
  const double cpu_start = thread_seconds();
  const double start = wall_seconds();
  models::CheckedMesh solid = models::load_solid(file->path.string());
  const double checked = wall_seconds();
  file.reset();  // now, and not at the end: a run may be stopped
  const MeshTree tree(solid.mesh);
  const double ready = wall_seconds();
  const double cpu = thread_seconds() - cpu_start;
  const auto triangles = solid.mesh.triangles.size();

  trial::TrialOptions options;
  options.seed = context.seed;
  options.seconds = context.quick ? 10.0 : 40.0;
  Yardstick yardstick;
  const auto measure = [&](const trial::Glance& glance) {
    if (glance.tick.index % 100 == 0) yardstick.measure();
  };
  const models::Setup setup = with_mesh(context, std::move(solid.mesh));
  options.watch = measure;
  // The same ticks several times over: a timer interrupt of the machine meets another tick each time.
  std::vector<std::unique_ptr<trial::Trial>> trials(context.quick ? 2 : 3);
  in_parallel(trials.size(),
              [&](std::size_t i) { trials[i] = std::make_unique<trial::Trial>(setup, options); });
  if (context.progress) context.progress(0.5);
  std::vector<trial::TrialResult> runs;
  runs.reserve(trials.size());
  for (const auto& trial : trials) runs.push_back(trial->run());  // one after the other, on this thread
  const trial::TrialResult& run = runs.front();
  std::vector<std::uint32_t> middle = run.step_ns;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    std::vector<std::uint32_t> same;
    same.reserve(runs.size());
    for (const trial::TrialResult& r : runs) same.push_back(r.step_ns[i]);
    middle[i] = static_cast<std::uint32_t>(median(same));
  }
  result.simulated = run.simulated;
  const auto add = [&](const char* id, double twin, const char* unit, double low, double high,
                       std::string note) {
    result.figures.push_back({id, kUnset, twin, unit, Role::ours, low, high, std::move(note)});
  };
  const std::string of = fmt::format("{} triangles, .glb", triangles);
  add("mesh.load.wall", ready - start, "s", kUnset, kUnset, of + "; file, check and search tree");
  add("mesh.load.cpu", cpu, "s", kUnset, kUnset, "the same, CPU time of its thread");
  add("mesh.load.file_and_check", checked - start, "s", kUnset, kUnset, "of it");
  add("mesh.tree.bytes_per_triangle",
      static_cast<double>(tree.memory_bytes()) / static_cast<double>(triangles), "B", kUnset, kUnset,
      "mesh, normals and tree");
  add("mesh.step.p50", percentile(run.step_ns, 0.5) * 1e-3, "us", kUnset, kUnset,
      "step() of the tennis ball's scene with this mesh as its ball");
  add("mesh.step.p99_9", percentile(middle, 0.999) * 1e-3, "us", kUnset, kUnset,
      fmt::format("the same; of each tick the lower median of {} runs", runs.size()));
  add("mesh.step.one_run.p99_9", percentile(run.step_ns, 0.999) * 1e-3, "us", kUnset, kUnset,
      "of one run, with the interrupts of the machine");
  add("mesh.step_over_yardstick.median", percentile(run.step_ns, 0.5) * 1e-9 / yardstick.seconds(), "x",
      kUnset, 4.0, "step() over a fixed piece of work of the same run (kit/yardstick.h)");
  add("mesh.load_over_yardstick.total", cpu / yardstick.seconds(), "x", kUnset, 8e5,
      "mesh.load.cpu, likewise");
  add("mesh.contacts", run.contacts, "", 1.0, kUnset, "it was pressed");
  add("mesh.hold.time", run.mode_time[static_cast<std::size_t>(Mode::hold)], "s", 0.0, 0.0, "and never held");
  return result;
}

}  // namespace enc::bench::mesh
