// Set-ups that are refused by name before any motion: masses, steps, places, meshes.
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"
#include "core/base/error.h"
#include "core/shape/surface/mesh_tree.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"

namespace enc::bench::extremes {
namespace {

// The answer of a whole trial of a second to a set-up: refusal, divergence, or success.
struct TrialAnswer {
  std::string refusal;
  bool sound = true;  // if not refused: all finite and no warning
};
TrialAnswer said(const BenchContext& context, const std::string& scene, const std::vector<std::string>& set,
                 const std::function<void(models::Setup&)>& change = {}) {
  try {
    models::Setup setup = load_scene(context, scene, set);
    if (change) change(setup);
    trial::TrialOptions options{.seed = context.seed, .seconds = 1.0};
    const Run run = judged(context, setup, options);
    return {"", run.judge.broken() == 0 && run.result.diverged_at < 0};
  } catch (const Error& e) {
    return {e.what()};
  }
}

// The refusal is one line that names the parameter.
bool names(const TrialAnswer& said, const std::string& parameter) {
  return said.refusal.find(parameter) != std::string::npos && said.refusal.find('\n') == std::string::npos;
}

// 1 if a scene with that setting is refused in this way, else 0.
double refused_in(const BenchContext& context, const std::string& scene, const std::string& set,
                  const std::string& parameter) {
  return names(said(context, scene, {set}), parameter) ? 1.0 : 0.0;
}

CaseResult masses(const BenchContext& context) {
  CaseResult found{
      "tools of 1e-9, 1e-20, 0, -1, NaN kg and of 1 mg, 1 g", "refused, and named, or it runs", {}};
  std::array bad{"1e-9", "1e-20", "0", "-1", "nan", "1e-6", "1e-3"};
  std::array good{"0.0022", "1", "100"};
  if (context.mutated("exchange_values")) std::swap(bad[0], good[0]);
  double refused = 0.0, sound = 0.0;
  for (const char* mass : bad) {
    refused += refused_in(context, "wall", fmt::format("tool.finger.mass_kg={}", mass), "finger");
    refused += refused_in(context, "tennis_ball", fmt::format("tool.stylus.mass_kg={}", mass), "stylus");
  }
  for (const char* mass : good) {
    const TrialAnswer arm = said(context, "wall", {fmt::format("tool.finger.mass_kg={}", mass)});
    const TrialAnswer machine = said(context, "tennis_ball", {fmt::format("tool.stylus.mass_kg={}", mass)});
    sound += (arm.refusal.empty() && arm.sound ? 1.0 : 0.0) +
             (machine.refusal.empty() && machine.sound ? 1.0 : 0.0);
  }
  found.numbers = {
      {"refused.percent", 100.0 * refused / (2.0 * bad.size()), "%", exactly(100.0),
       "of 7, of both machines"},
      {"sound.percent", 100.0 * sound / 6.0, "%", exactly(100.0), "of 2.2 g, 1 kg and 100 kg: these run"}};
  return found;
}

CaseResult steps(const BenchContext& context) {
  CaseResult found{
      "steps of 5.001 ms to 1e6 s, 0, NaN; loops of 0 to 1e6 Hz", "refused, and named; 5 ms runs sound", {}};
  const std::array steps{
      context.mutated("exchange_values") ? "1000" : "5001", "20000", "1e6", "1e12", "0", "-1", "nan"};
  constexpr std::array kRates{"0", "1", "199", "1e6", "nan"};
  double refused = 0.0;
  for (const char* step : steps)
    for (const auto& [scene, table] : {std::pair{"wall", "arm"}, {"tennis_ball", "world"}})
      refused +=
          refused_in(context, scene, fmt::format("truth.{}.timestep_us={}", table, step), "timestep_us");
  for (const char* rate : kRates)
    for (const char* scene : {"wall", "tennis_ball"})
      refused += refused_in(context, scene, fmt::format("rig.loop.rate_hz={}", rate), "rate_hz");
  double sound = 0.0;
  for (const auto& [scene, table] : {std::pair{"wall", "arm"}, {"tennis_ball", "world"}}) {
    std::vector<std::string> set{"rig.loop.rate_hz=200", fmt::format("truth.{}.timestep_us=5000", table)};
    const TrialAnswer run = said(context, scene, set);
    sound += !run.refusal.empty() || run.sound ? 1.0 : 0.0;
    if (!run.refusal.empty())
      found.words += fmt::format("{}{} is refused at 200 Hz", found.words.empty() ? "" : "; ", scene);
  }
  found.numbers = {{"refused.percent", 100.0 * refused / (2.0 * (steps.size() + kRates.size())), "%",
                    exactly(100.0), "of both machines"},
                   {"sound.percent", 100.0 * sound / 2.0, "%", exactly(100.0),
                    "of 5 ms at 200 Hz: refused, or sound after 1 s"}};
  return found;
}

// Objects out of the machine's reach or at a singular pose of the arm; and a scene without objects.
CaseResult unreachable(const BenchContext& context) {
  CaseResult found{"objects out of reach, beside a singular pose; none at all", "refused, and named", {}};
  double refused = 0.0;
  const std::array far{context.mutated("exchange_values") ? "[0,0,0]" : "[0,0,400]", "[0,0,-300]",
                       "[0,0,1e9]"};
  for (const char* place : far) {
    refused += refused_in(context, "wall", fmt::format("object.wall.position_mm={}", place), "wall");
    refused += refused_in(context, "tennis_ball", fmt::format("object.ball.position_mm={}", place), "ball");
  }
  const auto clear = [](models::Setup& setup) { setup.scene.objects.clear(); };
  double empty = 0.0;
  for (const char* scene : {"wall", "tennis_ball"}) {
    const TrialAnswer run = said(context, scene, {}, clear);
    empty += !run.refusal.empty() || run.sound ? 1.0 : 0.0;
  }
  found.numbers = {
      {"refused.percent", 100.0 * refused / (2.0 * far.size()), "%", exactly(100.0),
       "of objects out of reach"},
      {"empty.percent", 100.0 * empty / 2.0, "%", {}, "of scenes without an object: refused, or sound"}};
  return found;
}

// Faces of a tetrahedron as OBJ, their defect, and the expected message; empty: the mesh is accepted.
struct BadMesh {
  const char* name;
  const char* text;
  const char* said;
};
constexpr const char* kCorners = "v 0 0 0\nv 0.01 0 0\nv 0 0.01 0\nv 0 0 0.01\n";
constexpr std::array kMeshes{
    BadMesh{"open", "f 1 3 2\nf 1 2 4\nf 2 3 4\n", "open"},
    BadMesh{"zero area", "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 1 2\n", ""},
    BadMesh{"collinear", "v 0.02 0 0\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 2 5\n", ""},
    BadMesh{"double face", "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 1 4 3\n", ""},
    BadMesh{"inverted", "f 1 2 3\nf 1 4 2\nf 2 4 3\nf 1 3 4\n", ""},
    BadMesh{"flat", "f 1 2 3\nf 1 3 2\n", ""},
    BadMesh{"NaN", "v nan 0 0\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n", ""},
    BadMesh{"bad index", "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 9\n", ""},
    BadMesh{"one face", "f 1 2 3\n", ""},
    BadMesh{"no face", "", ""},
    BadMesh{"through itself",
            "v 0.002 0.002 -0.005\nv 0.003 0.002 0.02\nv 0.002 0.003 0.02\nv 0.001 0.001 0.02\n"
            "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\nf 5 7 6\nf 5 6 8\nf 6 7 8\nf 5 8 7\n",
            ""},
};

// Wrong answers of the search: points on corners, edges, faces, far away.
std::int64_t not_finite(const BenchContext& context, const Mesh& mesh) {
  const Surface surface{MeshSurface{std::make_shared<const MeshTree>(mesh)}};
  std::vector<Vec3> points{Vec3(0, 0, 0), Vec3(1e8, -1e8, 1e8), Vec3(1e-300, 0, 0), Vec3(2e-3, 2e-3, 2e-3)};
  if (context.mutated("exchange_values")) points.front() = Vec3::Constant(kUnset);
  for (const auto& v : mesh.vertices) points.emplace_back(v[0], v[1], v[2]);
  const std::size_t corners = points.size();
  for (std::size_t i = 4; i < corners; ++i)
    for (std::size_t k = 4; k < i; ++k) points.emplace_back(0.5 * (points[i] + points[k]));
  std::int64_t wrong = 0;
  for (const Vec3& p : points) {
    const SurfacePoint near = surface.nearest(Point<'O'>(p));
    const bool unit = near.normal.finite() && std::abs(near.normal.norm() - 1.0) < 1e-9;
    wrong += near.point.finite() && unit && std::isfinite(near.distance) ? 0 : 1;
  }
  // Beyond 1e9 m there is no answer, and the search reports that.
  const SurfacePoint none = surface.nearest(Point<'O'>(1e12, -1e12, 1e12));
  wrong += none.feature == -1 && !none.point.finite() ? 0 : 1;
  return wrong;
}

CaseResult meshes(const BenchContext& context) {
  CaseResult found{
      "11 degenerate meshes", "a list of the bad faces, or repaired with a note; nearest finite", {}};
  double answered = 0.0, wrong = 0.0, taken = 0.0;
  for (const BadMesh& bad : kMeshes) {
    const std::string path = "bad.obj", text = std::string(kCorners) + bad.text;
    try {
      models::FileMesh file = models::read_obj({path, text});
      models::weld(file.mesh);
      const models::CheckedMesh checked = models::check_mesh(file.mesh, path, file.lines);
      answered += checked.notes.empty() ? 0.0 : 1.0;
      wrong += static_cast<double>(not_finite(context, checked.mesh));
      taken += 1.0;
      if (checked.notes.empty()) found.words += std::string(bad.name) + " is taken without a word; ";
    } catch (const Error& e) {
      const std::string what = e.what();
      answered += what.starts_with(context.mutated("exchange_values") ? "good.obj" : path) ? 1.0 : 0.0;
    }
  }
  found.numbers = {
      {"answered.percent", 100.0 * answered / kMeshes.size(), "%", exactly(100.0),
       "refused in a line, or a note"},
      {"not_finite.value", wrong, "", exactly(0.0), "answers of those that are taken: corners, edges, far"},
      {"repaired.value", taken, "", {}, "of them"}};
  return found;
}

}  // namespace

void add_refusals(Cases& cases) {
  cases.push_back({"both.mass", masses});
  cases.push_back({"both.step", steps});
  cases.push_back({"both.unreachable", unreachable});
  cases.push_back({"both.mesh", meshes});
}

}  // namespace enc::bench::extremes
