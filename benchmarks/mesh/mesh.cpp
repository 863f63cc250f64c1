// Costs of a fine mesh: from its file to the first tick, and in each tick after that.
#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/cost.h"
#include "benchmarks/kit/kit.h"
#include "core/base/error.h"
#include "core/shape/surface/mesh_tree.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/shapes/shapes.h"
#include "trial/trial.h"

namespace enc::bench::mesh {
namespace {

// A temporary file in its own folder; the destructor removes both.
class ScratchFile {
 public:
  explicit ScratchFile(const char* name) {
    std::string folder = (std::filesystem::temp_directory_path() / "encounter_XXXXXX").string();
    if (mkdtemp(folder.data()) == nullptr) throw Error(folder + ": this folder cannot be made; set TMPDIR");
    folder_ = folder;
    path_ = (folder_ / name).string();
  }
  ~ScratchFile() {
    std::error_code none;
    std::filesystem::remove_all(folder_, none);
  }
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::filesystem::path folder_;
  std::string path_;
};

double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// The tennis ball's scene with its sphere in triangles.
models::Setup with_mesh(const Bench& bench, Mesh mesh) {
  models::Setup setup = bench.setup();
  ObjectSpec& ball = setup.scene.objects.front();
  ball.shape = ShapeKind::mesh;
  ball.radius = kUnset;
  ball.surface = std::make_shared<const Mesh>(std::move(mesh));
  return setup;
}

// The median of several runs for each tick: a timer interrupt of the machine hits another tick each time.
std::vector<std::uint32_t> middle_of(const std::vector<trial::TrialResult>& runs) {
  std::vector<std::uint32_t> middle = runs.front().step_ns;
  for (std::size_t i = 0; i < middle.size(); ++i) {
    std::vector<std::uint32_t> same;
    same.reserve(runs.size());
    for (const trial::TrialResult& r : runs) same.push_back(r.step_ns[i]);
    middle[i] = static_cast<std::uint32_t>(median(same));
  }
  return middle;
}

// The mesh from its file and its search tree, with the times that they took.
struct LoadResult {
  models::CheckedMesh solid;
  MeshTree tree;
  std::size_t triangles;
  double file_and_check, wall, cpu;  // s; the last two of all
};
LoadResult loaded() {
  std::optional<ScratchFile> file(std::in_place, "ball.glb");
  models::write_mesh(models::geodesic_ball(224), file->path(), models::OverwritePolicy::keep);
  const double cpu_start = thread_seconds();
  const double start = wall_seconds();
  models::CheckedMesh solid = models::load_solid(file->path());
  const double checked = wall_seconds();
  file.reset();  // removed now and not at the end: a run may be stopped
  MeshTree tree(solid.mesh);
  const double ready = wall_seconds();
  const double cpu = thread_seconds() - cpu_start;
  const std::size_t triangles = solid.mesh.triangles.size();
  return {std::move(solid), std::move(tree), triangles, checked - start, ready - start, cpu};
}

void add_load(Bench& bench, const LoadResult& load) {
  bench.cost("load.wall", load.wall, "s",
             fmt::format("{} triangles, .glb; file, check and search tree", load.triangles));
  bench.cost("load.cpu", load.cpu, "s", "the same, CPU time of its thread");
  bench.cost("load.file_and_check", load.file_and_check, "s", "of it");
  bench.cost("tree.bytes_per_triangle",
             static_cast<double>(load.tree.memory_bytes()) / static_cast<double>(load.triangles), "B",
             "mesh, normals and tree");
}

void add_steps(Bench& bench, const std::vector<trial::TrialResult>& runs) {
  const trial::TrialResult& run = runs.front();
  bench.cost("step.p50", percentile(run.step_ns, 0.5) * 1e-3, "us",
             "step() of the tennis ball's scene with this mesh as its ball");
  bench.cost("step.p99_9", percentile(middle_of(runs), 0.999) * 1e-3, "us",
             fmt::format("the same; of each tick the lower median of {} runs", runs.size()));
  bench.cost("step.one_run.p99_9", percentile(run.step_ns, 0.999) * 1e-3, "us",
             "of one run, with the interrupts of the machine");
}

void run(Bench& bench) {
  LoadResult load = loaded();
  if (bench.context.mutated("four_meshes"))
    for (int more = 0; more < 3; ++more) load.cpu += loaded().cpu;
  const double share = bench.context.mutated("worst_tick") ? 0.999 : 0.5;
  trial::TrialOptions options{.seed = bench.context.seed, .seconds = bench.context.quick ? 10.0 : 40.0};
  Yardstick yardstick;
  options.watch = yardstick.watch();
  const models::Setup setup = with_mesh(bench, std::move(load.solid.mesh));
  std::vector<std::unique_ptr<trial::Trial>> trials(bench.context.quick ? 2 : 3);
  in_parallel(trials.size(),
              [&](std::size_t i) { trials[i] = std::make_unique<trial::Trial>(setup, options); });
  bench.progress(0.5);
  std::vector<trial::TrialResult> runs;
  runs.reserve(trials.size());
  for (const auto& trial : trials) runs.push_back(trial->run());  // in turn on this thread
  const trial::TrialResult& run = runs.front();
  bench.result.simulated = run.simulated;

  add_load(bench, load);
  add_steps(bench, runs);
  bench.cost("step_over_yardstick.median", percentile(run.step_ns, share) * 1e-9 / yardstick.seconds(), "x",
             at_most(4.0), "step() over a fixed piece of work of the same run (kit/cost.h)");
  // Measured: 1.5e5 to 3.0e5, with the computer's load. It notices a load that costs four times as much.
  bench.cost("load_over_yardstick.total", load.cpu / yardstick.seconds(), "x", at_most(4.5e5),
             "mesh.load.cpu, likewise");
  bench.figure("contacts", run.contacts, "", at_least(1.0), "it was pressed");
  bench.figure("hold.time", run.mode_time[static_cast<std::size_t>(Mode::hold)], "s", exactly(0.0),
               "and never held");
}

const Entry kEntry{"mesh", "tennis_ball",
                   "a ball of a million triangles: from file to tree, and step() on it", run};

}  // namespace
}  // namespace enc::bench::mesh
