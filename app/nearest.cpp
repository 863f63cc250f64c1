#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>

#include <fmt/format.h>

#include "app/built.h"
#include "app/options.h"
#include "core/error.h"
#include "core/mesh/mesh_tree.h"
#include "models/csv_reader.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"
#include "trial/prepare.h"

namespace enc::app {
namespace {

// A surface and where it stands: in its own axes, or in W.
struct Placed {
  Surface surface;
  Pose<'W', 'O'> X_WO = Pose<'W', 'O'>::identity();
};

Placed object_of(const std::string& scene_path, const std::string& name) {
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

Placed placed(const std::string& what) {
  if (const auto mark = what.rfind('#'); mark != std::string::npos)
    return object_of(what.substr(0, mark), what.substr(mark + 1));
  const models::CheckedMesh solid = models::load_solid(what);
  print_notes(solid.notes);
  return {Surface(MeshSurface{std::make_shared<const MeshTree>(solid.mesh)})};
}

constexpr double kFarthest = 1e6;  // m: beyond, squares of double cannot tell a mesh from a point

class PointsReader {
 public:
  explicit PointsReader(const std::string& path) : path_(path) {
    text_ = models::csv_text(path, "list of points", "a CSV file with the header x_m,y_m,z_m");
    if (line() != "x_m,y_m,z_m")
      fail(1, fmt::format("the header is {}; expected x_m,y_m,z_m; write it in the first line",
                          models::quoted(line_)));
  }

  // False at the end of the file.
  bool next(Vec3& point) {
    if (at_ >= text_.size()) return false;
    if (line().empty()) {
      if (text_.find_first_not_of("\r\n", start_) != std::string::npos)
        fail(1, "an empty line; expected three numbers; remove it");
      return false;
    }
    std::size_t from = 0;
    for (Eigen::Index i = 0; i < 3; ++i) {
      const std::size_t to = std::min(line_.find(',', from), line_.size());
      if (!models::read_number(std::string_view(line_).substr(from, to - from), point[i]))
        fail(from + 1, fmt::format("{} is no number; expected x,y,z in metres; correct the line",
                                   models::quoted(line_.substr(from, to - from))));
      if (std::abs(point[i]) > kFarthest)
        fail(from + 1, fmt::format("{} m is farther than {:g} m; expected x,y,z in metres; correct the line",
                                   line_.substr(from, to - from), kFarthest));
      from = std::min(to + 1, line_.size());
      if (i == 2 && to < line_.size())
        fail(to + 1, "more than three numbers; expected x,y,z; correct the line");
    }
    return true;
  }

 private:
  const std::string& line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    start_ = at_;
    line_ = text_.substr(at_, end - at_);
    if (line_.ends_with('\r')) line_.pop_back();
    at_ = end + 1;
    ++number_;
    return line_;
  }
  [[noreturn]] void fail(std::size_t column, const std::string& what) const {
    throw Error(fmt::format("{}:{}:{}: {}", path_, std::max<std::size_t>(number_, 1), column, what));
  }

  std::string path_, text_, line_;
  std::size_t at_ = 0, start_ = 0, number_ = 0;
};

}  // namespace

int nearest(const NearestOptions& options) {
  PointsReader points(options.points);
  const Placed object = placed(options.what);
  // All is read before anything is printed, so that a bad line gives no half answer.
  std::vector<Vec3> all;
  for (Vec3 point; points.next(point);) all.push_back(point);
  fmt::memory_buffer out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "distance_m,x_m,y_m,z_m,nx,ny,nz,triangle\n");
  std::int32_t hint = -1;
  for (const Vec3& p : all) {
    const Nearest near = object.surface.nearest(object.X_WO.inverse() * Point<'W'>(p), hint);
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
