#include "models/mesh_files/mesh_check.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/base/frames.h"
#include "core/base/words.h"
#include "core/shape/surface/mesh_tree.h"
#include "models/mesh_files/mesh_edges.h"
#include "models/mesh_files/mesh_file.h"
#include "models/sizes/mesh_size.h"

namespace enc::models {
namespace {

constexpr std::size_t kMostParts = 1000;
constexpr double kNarrow = 1e-4;  // share of the mesh's size: a narrower gap is no intended hole
constexpr double kFlat = 1e-10;   // height over longest side: a flatter triangle has no normal

using Faces = std::vector<std::size_t>;

Vec3 corner(const Mesh& mesh, std::size_t face, std::size_t i) {
  return Vec3(mesh.vertices[static_cast<std::size_t>(mesh.triangles[face][i % 3])].data());
}

class Checker {
 public:
  Checker(Mesh mesh, const std::string& name, const std::vector<std::int32_t>& lines)
      : name_(name),
        result_{std::move(mesh), {}},
        mesh_(result_.mesh),
        number_(lines.begin(), lines.end()),
        lines_(!lines.empty()) {}

  CheckedMesh check() {
    if (!lines_) {
      number_.resize(mesh_.triangles.size());
      std::iota(number_.begin(), number_.end(), std::size_t{0});
    }
    if (mesh_.triangles.empty()) fail("there are no faces; expected a closed surface; export the mesh again");
    check_places();
    drop_degenerate();
    edges_ = edges_of(mesh_);
    weld_open_corners();
    check_areas();
    refuse_crowded();
    refuse_open();
    orient();
    check_vertices();
    check_touching();
    check_sides();
    drop_unused_vertices();
    return std::move(result_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error(fmt::format("{}: {}", name_, what)); }
  void refuse_if(const Faces& faces, const std::string& what) const {
    if (faces.empty()) return;
    const std::string line = lines_ ? fmt::format(":{}", number_[faces[0]]) : "";
    throw Error(fmt::format("{}{}: {} {}", name_, line, numbered(faces), what));
  }
  void note(const std::string& what) { result_.notes.push_back(fmt::format("{}: {}", name_, what)); }
  // List of faces by their numbers in the file. One face of the file may have become several.
  [[nodiscard]] std::string numbered(Faces faces) const {
    for (std::size_t& face : faces) face = number_[face];
    return face_list(sorted(faces), lines_);
  }

  void check_places() const {
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v)
      for (std::size_t i = 0; i < 3; ++i)
        if (const double x = mesh_.vertices[v][i]; !(std::abs(x) <= kFarthestVertex))
          fail(
              fmt::format("vertex {} is at {} = {:g} m; expected at most {:g} m from the origin; export the "
                          "mesh in metres",
                          v, "xyz"[i], x, kFarthestVertex));
  }

  // A triangle with one vertex twice is an edge; without it the other faces still close.
  void drop_degenerate() {
    Faces dropped;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const auto t = mesh_.triangles[i];
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
        dropped.push_back(number_[i]);
        continue;
      }
      number_[kept] = number_[i];
      mesh_.triangles[kept++] = t;
    }
    if (dropped.empty()) return;
    mesh_.triangles.resize(kept);
    number_.resize(kept);
    note(fmt::format("removed {} of zero area", face_list(sorted(dropped), lines_)));
    if (kept == 0) fail("no face has an area; expected a closed surface; export the mesh again");
  }

  void check_areas() const {
    Faces flat;
    for (std::size_t i = 0; i < mesh_.triangles.size(); ++i) {
      const Vec3 a = corner(mesh_, i, 0), b = corner(mesh_, i, 1), c = corner(mesh_, i, 2);
      const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
      if (!((b - a).cross(c - a).norm() > kFlat * longest)) flat.push_back(i);
    }
    refuse_if(flat,
              "of zero area between different vertices; expected triangles with a normal; merge their "
              "vertices, or mesh the part again");
  }

  // Coordinates stored as float differ in their last digits where a corner was computed twice. The nearest
  // corners are joined first, so that a narrow gap does not depend on the widest one.
  void weld_open_corners() {
    Weld all;
    for (int steps = 1; steps <= kMostSteps && !edges_.open.empty(); steps *= 2) {
      const Weld weld = weld_open(mesh_, edges_.open, steps);
      if (weld.corners == 0) continue;
      all += weld;
      drop_degenerate();
      edges_ = edges_of(mesh_);
    }
    if (all.corners == 0) return;
    note(fmt::format("joined {} with others at most {} away, {:.1g} of the mesh's size",
                     counted(all.corners, "corner"), length_text(all.farthest),
                     all.farthest / MeshBox(mesh_).size()));
  }

  void refuse_crowded() const {
    refuse_doubles(edges_.crowded);
    refuse_if(sorted(edges_.crowded),
              "share an edge with two or more others (non-manifold); expected exactly two faces at "
              "each edge; separate the parts");
  }
  void refuse_open() const {
    if (edges_.open.empty()) return;
    const Gap gap = widest_gap(mesh_, edges_.open);
    std::string wide, advice = "close the hole";
    if (!std::isnan(gap.width))
      wide = fmt::format(" (the widest gap is {}, {:.1g} of the mesh's size)", length_text(gap.width),
                         gap.of_size);
    if (gap.of_size < kNarrow)
      advice = gap.beside_edge ? "split the edges that have a corner of another face beside them "
                                 "(T-junctions), or mesh the part again"
                               : "merge the corners that are so near to each other";
    Faces faces;
    for (const OpenEdge& edge : edges_.open) faces.push_back(static_cast<std::size_t>(edge.face));
    refuse_if(
        sorted(faces),
        fmt::format("at a hole: an edge of only one face{}; expected a closed surface; {}", wide, advice));
  }
  static Faces sorted(Faces faces) {
    std::sort(faces.begin(), faces.end());
    faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
    return faces;
  }
  // Refuses faces with equal vertices.
  void refuse_doubles(const Faces& crowded) const {
    std::vector<std::pair<std::array<std::int32_t, 3>, std::size_t>> keys;
    for (const std::size_t face : sorted(crowded)) {
      auto key = mesh_.triangles[face];
      std::sort(key.begin(), key.end());
      keys.emplace_back(key, face);
    }
    std::sort(keys.begin(), keys.end());
    Faces twice;
    for (std::size_t i = 1; i < keys.size(); ++i)
      if (keys[i].first == keys[i - 1].first) twice.push_back(keys[i].second);
    refuse_if(sorted(twice),
              "doubled: another face has the same three vertices; expected each face once; remove them");
  }

  // Walks over each connected part and orients all its faces like its first one.
  void orient() {
    part_.assign(mesh_.triangles.size(), -1);
    std::vector<bool> turn(mesh_.triangles.size(), false);
    Faces walk, twisted, turned;
    for (std::size_t seed = 0; seed < mesh_.triangles.size(); ++seed) {
      if (part_[seed] >= 0) continue;
      part_[seed] = parts_++;
      walk = {seed};
      for (std::size_t i = 0; i < walk.size(); ++i)
        for (const Neighbour& n : edges_.neighbours[walk[i]]) {
          const auto face = static_cast<std::size_t>(n.face);
          const bool turns = turn[walk[i]] == n.same;  // orientation required along this path
          if (part_[face] < 0) {
            part_[face] = parts_ - 1;
            turn[face] = turns;
            walk.push_back(face);
          } else if (turn[face] != turns) {
            twisted.push_back(face);
          }
        }
      // The minority is wrong; the outer side is decided later.
      const auto count = static_cast<std::size_t>(
          std::count_if(walk.begin(), walk.end(), [&](std::size_t f) { return turn[f]; }));
      const bool most = 2 * count > walk.size();
      for (const std::size_t face : walk)
        if (turn[face] != most) turned.push_back(face);
    }
    refuse_if(
        sorted(twisted),
        "make the surface one-sided; expected an orientable surface, with an inside; mesh the part again");
    for (const std::size_t face : turned) flip(face);
    if (!turned.empty())
      note(fmt::format("turned {} to run the same way as their neighbours", numbered(sorted(turned))));
    if (static_cast<std::size_t>(parts_) > kMostParts)
      fail(fmt::format("{} separate parts; expected at most {}; keep the surface only", parts_, kMostParts));
  }
  // Keeps side 1-2 in its place; afterwards edges_ is only valid for walking on.
  void flip(std::size_t face) { std::swap(mesh_.triangles[face][1], mesh_.triangles[face][2]); }

  // All faces at a vertex must form one fan: as many as a walk from neighbour to neighbour meets.
  void check_vertices() const {
    std::vector<std::int32_t> count(mesh_.vertices.size(), 0), first(mesh_.vertices.size(), -1);
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f)
      for (const std::int32_t v : mesh_.triangles[f]) {
        ++count[static_cast<std::size_t>(v)];
        first[static_cast<std::size_t>(v)] = static_cast<std::int32_t>(f);
      }
    Faces bad;
    for (std::size_t v = 0; v < mesh_.vertices.size(); ++v) {
      if (count[v] == 0) continue;
      const auto has = [&](std::int32_t face) {
        const auto& t = mesh_.triangles[static_cast<std::size_t>(face)];
        return std::find(t.begin(), t.end(), static_cast<std::int32_t>(v)) != t.end();
      };
      std::int32_t before = -1, at = first[v], met = 0;
      do {
        const auto& around = edges_.neighbours[static_cast<std::size_t>(at)];
        const auto next = std::find_if(around.begin(), around.end(),
                                       [&](const Neighbour& n) { return n.face != before && has(n.face); });
        ++met;
        if (next == around.end()) break;
        before = at;
        at = next->face;
      } while (at != first[v] && met <= count[v]);
      if (met != count[v]) bad.push_back(static_cast<std::size_t>(first[v]));
    }
    refuse_if(sorted(bad),
              "with a corner where two surfaces meet in a point (non-manifold); expected one fan of faces "
              "around each vertex; separate the parts");
  }

  // Six times the signed volume of each part, about a point near it.
  [[nodiscard]] std::vector<double> volumes() const {
    std::vector<double> volume(static_cast<std::size_t>(parts_), 0.0);
    const Vec3 about = corner(mesh_, 0, 0);
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f)
      volume[static_cast<std::size_t>(part_[f])] +=
          (corner(mesh_, f, 0) - about).dot((corner(mesh_, f, 1) - about).cross(corner(mesh_, f, 2) - about));
    return volume;
  }

  // A part inside another one is a hollow, and its faces must face the hollow.
  void check_sides() {
    const std::vector<double> volume = volumes();
    const std::vector<int> depth = depths_of(mesh_, part_, static_cast<std::size_t>(parts_));
    if (depth.empty())
      fail(fmt::format(
          "too many of its {} parts lie in the boxes around others; expected few; unite the parts, or "
          "keep the outer surface only",
          parts_));
    std::vector<bool> wrong(volume.size());
    for (std::size_t p = 0; p < volume.size(); ++p) {
      wrong[p] = (volume[p] > 0.0) == (depth[p] % 2 == 1);
      if (volume[p] == 0.0) fail("a part encloses no volume; expected a solid; remove it");
    }
    const auto count = std::count(wrong.begin(), wrong.end(), true);
    if (count == 0) return;
    const bool all = count == static_cast<std::ptrdiff_t>(wrong.size());
    Faces turned;
    for (std::size_t f = 0; f < mesh_.triangles.size(); ++f) {
      const auto part = static_cast<std::size_t>(part_[f]);
      if (!wrong[part]) continue;
      if (!all && depth[part] > 0)
        refuse_if({f},
                  "belongs to a part inside another one and looks out; expected a hollow (faces looking "
                  "into it) or one outer surface; remove the inner part, or turn its faces");
      turned.push_back(f);
    }
    for (const std::size_t face : turned) flip(face);
    note(all ? std::string("the surface was inside out: turned all faces")
             : fmt::format("turned {} of a part that was inside out", numbered(turned)));
  }

  void drop_unused_vertices() {
    std::vector<std::int32_t> now(mesh_.vertices.size(), -1);
    for (const auto& t : mesh_.triangles)
      for (const std::int32_t v : t) now[static_cast<std::size_t>(v)] = 0;
    std::int32_t kept = 0;
    for (std::size_t v = 0; v < now.size(); ++v) {
      if (now[v] < 0) continue;
      now[v] = kept;
      mesh_.vertices[static_cast<std::size_t>(kept++)] = mesh_.vertices[v];
    }
    mesh_.vertices.resize(static_cast<std::size_t>(kept));
    for (auto& t : mesh_.triangles)
      for (std::int32_t& v : t) v = now[static_cast<std::size_t>(v)];
  }

  [[nodiscard]] std::string depth_text(const Touching& touching) const {
    if (!(touching.depth > 0.0)) return {};
    return fmt::format(" (each by at most {}, {:.1g} of the mesh's size)", length_text(touching.depth),
                       touching.depth / MeshBox(mesh_).size());
  }
  void check_touching() {
    if (mesh_.triangles.size() > kMostTouchTested)
      return note(fmt::format("not looked whether the surface passes through itself: more than {} faces",
                              kMostTouchTested));
    const Touching touching = touching_faces(mesh_);
    refuse_if(touching.crossing,
              fmt::format("passing through other faces{}; expected a surface that does not meet itself; "
                          "unite the parts",
                          depth_text(touching)));
    refuse_if(touching.touching,
              fmt::format("touching others (the first {}), so that inside and outside are not told apart "
                          "there; expected a surface that does not meet itself; unite the parts, or move "
                          "them apart",
                          numbered({touching.touched})));
    if (!touching.finished)
      note("gave up looking whether the surface passes through itself: too many faces lie close together");
  }

  const std::string& name_;
  CheckedMesh result_;
  Mesh& mesh_;
  std::vector<std::size_t> number_;  // number or line of each face in the file
  bool lines_ = false;
  Edges edges_;
  std::vector<std::int32_t> part_;  // connected part of each face
  std::int32_t parts_ = 0;
};

}  // namespace

std::string face_list(const std::vector<std::size_t>& faces, bool lines) {
  constexpr std::size_t kShown = 3;
  const std::string what = lines ? " of line" : "";
  std::string list = faces.size() == 1 ? "face" + what + " " : "faces" + what + (lines ? "s " : " ");
  const std::size_t shown = faces.size() <= kShown ? faces.size() : kShown - 1;
  for (std::size_t i = 0; i < shown; ++i) {
    const bool last = i + 1 == faces.size();
    list += fmt::format("{}{}", i == 0 ? "" : last ? " and " : ", ", faces[i]);
  }
  return faces.size() > shown ? list + fmt::format(" and {} more", faces.size() - shown) : list;
}

CheckedMesh check_mesh(Mesh mesh, const std::string& name, const std::vector<std::int32_t>& lines) {
  return Checker(std::move(mesh), name, lines).check();
}

CheckedMesh load_solid(const std::string& path) {
  FileMesh file = load_faces(path);
  CheckedMesh checked = check_mesh(std::move(file.mesh), path, file.lines);
  checked.notes.insert(checked.notes.begin(), file.notes.begin(), file.notes.end());
  checked.material = file.material;
  return checked;
}

}  // namespace enc::models
