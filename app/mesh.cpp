// `encounter mesh`: makes simple closed meshes for experiments. `encounter nearest`: distances to a surface.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <memory>
#include <string_view>

#include <fmt/format.h>

#include "app/built.h"
#include "app/common/options.h"
#include "core/base/error.h"
#include "core/shape/surface/mesh_tree.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"
#include "models/shapes/shapes.h"
#include "models/tables/csv_reader.h"
#include "trial/assemble/assemble.h"

namespace enc::app {
namespace {

struct Maker {
  std::string_view name;
  Mesh (*make)(int fine);
  int fine;  // default of --fine
};
constexpr auto kMakers = std::to_array<Maker>({
    {"ball", [](int n) { return models::geodesic_ball(n); }, 71},
    {"cube", [](int n) { return models::cube(n); }, 16},
    {"hare", [](int) { return models::hare_mesh(); }, 1},
    {"knot", [](int n) { return models::knot(10 * n, n); }, 48},
    {"turned_part", [](int n) { return models::turned_part(n); }, 120},
});
constexpr int kFinest = 400;  // the ball has 20 n^2 triangles

}  // namespace

int mesh(const MeshOptions& options) {
  std::vector<std::string> names;
  for (const Maker& maker : kMakers) {
    names.emplace_back(maker.name);
    if (options.name != maker.name) continue;
    const int fine = options.fine.value_or(maker.fine);
    if (options.fine && (fine < 3 || fine > kFinest))
      throw Error("--fine: expected a whole number from 3 to 400");
    const Mesh made = maker.make(fine);
    models::write_mesh(made, options.out, models::existing(options.force));
    fmt::print("{}: {} vertices, {} triangles\n", options.out, made.vertices.size(), made.triangles.size());
    return 0;
  }
  throw Error(
      fmt::format("unknown mesh {}; {}", models::quoted(options.name), models::advice(options.name, names)));
}

namespace {

// A surface and its pose: in its own axes, or in W.
struct SurfacePlacement {
  Surface surface;
  Pose<'W', 'O'> X_WO = Pose<'W', 'O'>::identity();
};

SurfacePlacement object_of(const std::string& scene_path, const std::string& name) {
  const models::Setup setup = models::load(scene_path, "");
  print_notes(setup.notes);
  const Scene scene = trial::prepare_setup(setup);
  std::vector<std::string> names;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    names.push_back(setup.scene.objects[i].name);
    if (names.back() == name) return {scene.objects[i].surface, scene.objects[i].X_WO};
  }
  throw Error(fmt::format("{}: there is no object {}; {}", scene_path, models::quoted(name),
                          models::advice(name, names)));
}

SurfacePlacement placed(const std::string& what) {
  if (const auto mark = what.rfind('#'); mark != std::string::npos)
    return object_of(what.substr(0, mark), what.substr(mark + 1));
  const models::CheckedMesh solid = models::load_solid(what);
  print_notes(solid.notes);
  return {Surface(MeshSurface{std::make_shared<const MeshTree>(solid.mesh)})};
}

}  // namespace

int nearest(const NearestOptions& options) {
  // Read all points before printing, so that a bad line leaves no partial output.
  const std::vector<Vec3> all = models::parse_places(
      models::csv_text(options.points, "list of points", "a CSV file with the header x_m,y_m,z_m"),
      options.points);
  const SurfacePlacement object = placed(options.what);
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "distance_m,x_m,y_m,z_m,nx,ny,nz,triangle\n");
  std::int32_t hint = -1;
  for (const Vec3& p : all) {
    const SurfacePoint near = object.surface.nearest(object.X_WO.inverse() * Point<'W'>(p), hint);
    hint = near.feature;
    const Point<'W'> at = object.X_WO * near.point;
    const Vec<'W'> n = object.X_WO * near.normal;
    fmt::format_to(to, "{},{},{},{},{},{},{},{}\n", near.distance, at.xyz[0], at.xyz[1], at.xyz[2], n.xyz[0],
                   n.xyz[1], n.xyz[2], near.feature);
  }
  fmt::print("{}", std::string_view(out.data(), out.size()));
  return 0;
}

}  // namespace enc::app
