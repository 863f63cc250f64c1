// `encounter mesh NAME`: closed meshes made by rule, to try things with.
#include <array>
#include <string_view>

#include <fmt/format.h>

#include "app/common/options.h"
#include "core/base/error.h"
#include "models/mesh_files/mesh_write.h"
#include "models/schema/wording.h"
#include "models/shapes/hare.h"
#include "models/shapes/shapes.h"

namespace enc::app {
namespace {

struct Maker {
  std::string_view name;
  Mesh (*make)(int fine);
  int fine;  // where --fine is not given
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

}  // namespace enc::app
