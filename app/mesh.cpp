#include <array>
#include <string_view>

#include <fmt/format.h>

#include "app/options.h"
#include "benchmarks/hare.h"
#include "core/error.h"
#include "models/mesh_write.h"
#include "models/wording.h"

namespace enc::app {
namespace {

struct Maker {
  const char* name;
  Mesh (*make)();
};
constexpr std::array<Maker, 1> kMakers{{{"hare", bench::hare_mesh}}};

}  // namespace

int mesh(const MeshOptions& options) {
  std::vector<std::string> names;
  for (const Maker& maker : kMakers) {
    names.emplace_back(maker.name);
    if (options.name != maker.name) continue;
    const Mesh made = maker.make();
    models::write_mesh(made, options.out);
    fmt::print("{}: {} vertices, {} triangles\n", options.out, made.vertices.size(), made.triangles.size());
    return 0;
  }
  throw Error(
      fmt::format("unknown mesh {}; {}", models::quoted(options.name), models::advice(options.name, names)));
}

}  // namespace enc::app
