#include "models/mesh_files/mesh_edges.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/base/frames.h"
#include "models/sizes/mesh_size.h"

namespace enc::models {
namespace {

constexpr std::size_t kMostOpen = 4'000'000;
constexpr std::size_t kMostWeldPairs = 100'000'000;  // pairs of corners: some seconds
constexpr std::size_t kMostMeasured = 9'000'001;  // pairs of edges: 3,000 with each other, or fewer with more
constexpr double kBeside = 4.0;                   // times the widest gap: a corner that far from all others
constexpr double kOpposite = -0.1;                // cosine between edges with opposite directions, at most

Vec3 place(const Mesh& mesh, std::int32_t vertex) {
  return Vec3(mesh.vertices[static_cast<std::size_t>(vertex)].data());
}

// Distance of neighbouring floats at the size of the largest coordinate, or of the mesh.
Vec3 float_step(const MeshBox& box) {
  return std::numeric_limits<float>::epsilon() *
         box.low.cwiseAbs().cwiseMax(box.high.cwiseAbs()).cwiseMax(box.size());
}

std::vector<std::int32_t> ends_of(const std::vector<OpenEdge>& open) {
  std::vector<std::int32_t> ends;
  ends.reserve(2 * open.size());
  for (const OpenEdge& edge : open) ends.insert(ends.end(), {edge.from, edge.to});
  std::sort(ends.begin(), ends.end());
  ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
  return ends;
}

// Points in cells of twice the reach: every point within reach of a given one lies in one of eight cells.
class Grid {
 public:
  Grid(const Vec3& reach, std::size_t points)
      : reach_(reach), first_(std::bit_ceil(2 * points + 1), -1), next_(points, -1) {}

  // Visits the earlier points whose cells are within reach, and others that share their slots.
  template <class Use>
  void each_near(const Vec3& p, const Use& use) const {
    const Cell low = cell(p - reach_), high = cell(p + reach_);
    std::array<std::size_t, 8> met{};
    std::size_t slots = 0;
    for (std::int64_t x = low[0]; x <= high[0]; ++x)
      for (std::int64_t y = low[1]; y <= high[1]; ++y)
        for (std::int64_t z = low[2]; z <= high[2]; ++z) {
          const std::size_t slot = slot_of({x, y, z});
          if (std::find(met.begin(), met.begin() + slots, slot) != met.begin() + slots) continue;
          if (slots < met.size()) met[slots++] = slot;
          for (std::int32_t i = first_[slot]; i >= 0; i = next_[static_cast<std::size_t>(i)])
            use(static_cast<std::size_t>(i));
        }
  }
  void add(const Vec3& p, std::size_t number) {
    std::int32_t& first = first_[slot_of(cell(p))];
    next_[number] = first;
    first = static_cast<std::int32_t>(number);
  }

 private:
  using Cell = std::array<std::int64_t, 3>;
  [[nodiscard]] Cell cell(const Vec3& p) const {
    const auto along = [&](int i) { return static_cast<std::int64_t>(std::floor(0.5 * p[i] / reach_[i])); };
    return {along(0), along(1), along(2)};
  }
  [[nodiscard]] std::size_t slot_of(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t i : cell) {
      hash = (hash ^ static_cast<std::uint64_t>(i)) * 0xff51afd7ed558ccdULL;
      hash ^= hash >> 32U;
    }
    return static_cast<std::size_t>(hash) & (first_.size() - 1);
  }
  Vec3 reach_;
  std::vector<std::int32_t> first_, next_;  // chains of points, one for each slot
};

// Sets that grow together; the lowest number represents each set.
class Sets {
 public:
  explicit Sets(std::size_t count) : above_(count) {
    std::iota(above_.begin(), above_.end(), std::size_t{0});
  }
  std::size_t lowest(std::size_t i) {
    while (above_[i] != i) i = above_[i] = above_[above_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t low_a = lowest(a), low_b = lowest(b);
    above_[std::max(low_a, low_b)] = std::min(low_a, low_b);
  }

 private:
  std::vector<std::size_t> above_;
};

double distance(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 along = b - a;
  const double t = std::clamp(along.dot(p - a) / along.squaredNorm(), 0.0, 1.0);
  return (a + t * along - p).norm();
}

// The sides of all faces, sorted into buckets by their lower vertex, then by the upper one.
struct Side {
  std::int32_t high, face;
  bool up;  // runs from the lower vertex to the higher one
};
struct Sides {
  std::vector<std::size_t> start;  // first side of each vertex, and the end
  std::vector<Side> all;
};

Sides sides_of(const Mesh& mesh) {
  const auto each = [&](auto use) {
    for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
      for (std::size_t i = 0; i < 3; ++i) use(f, mesh.triangles[f][i], mesh.triangles[f][(i + 1) % 3]);
  };
  const auto low = [](std::int32_t a, std::int32_t b) { return static_cast<std::size_t>(std::min(a, b)); };
  Sides sides;
  sides.start.assign(mesh.vertices.size() + 1, 0);
  each([&](std::size_t, std::int32_t a, std::int32_t b) { ++sides.start[low(a, b) + 1]; });
  std::partial_sum(sides.start.begin(), sides.start.end(), sides.start.begin());
  sides.all.resize(sides.start.back());
  std::vector<std::size_t> next(sides.start.begin(), sides.start.end() - 1);
  each([&](std::size_t f, std::int32_t a, std::int32_t b) {
    sides.all[next[low(a, b)]++] = {std::max(a, b), static_cast<std::int32_t>(f), a < b};
  });
  return sides;
}

void link(const Mesh& mesh, Edges& edges, std::int32_t low, const Side& a, const Side& b) {
  const auto side_of = [&](const Side& s) {
    const auto& t = mesh.triangles[static_cast<std::size_t>(s.face)];
    const std::int32_t first = s.up ? low : s.high;
    return static_cast<std::size_t>(std::find(t.begin(), t.end(), first) - t.begin());
  };
  const bool same = a.up != b.up;  // neighbours run in opposite directions along their edge
  edges.neighbours[static_cast<std::size_t>(a.face)][side_of(a)] = {b.face, same};
  edges.neighbours[static_cast<std::size_t>(b.face)][side_of(b)] = {a.face, same};
}

}  // namespace

Edges edges_of(const Mesh& mesh) {
  Sides sides = sides_of(mesh);
  Edges edges;
  edges.neighbours.resize(mesh.triangles.size());
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const auto low = static_cast<std::int32_t>(v);
    const auto from = sides.all.begin() + static_cast<std::ptrdiff_t>(sides.start[v]);
    const auto to = sides.all.begin() + static_cast<std::ptrdiff_t>(sides.start[v + 1]);
    std::sort(from, to, [](const Side& a, const Side& b) {
      return a.high != b.high ? a.high < b.high : a.face < b.face;
    });
    for (auto i = from; i != to;) {
      const auto end = std::find_if(i, to, [&](const Side& s) { return s.high != i->high; });
      if (end - i == 2)
        link(mesh, edges, low, i[0], i[1]);
      else if (end - i == 1)
        edges.open.push_back({i->up ? low : i->high, i->up ? i->high : low, i->face});
      else
        for (auto s = i; s != end; ++s) edges.crowded.push_back(static_cast<std::size_t>(s->face));
      i = end;
    }
  }
  return edges;
}

Weld weld_open(Mesh& mesh, const std::vector<OpenEdge>& open, int steps) {
  if (open.size() > kMostOpen) return {};
  const std::vector<std::int32_t> ends = ends_of(open);
  const Vec3 reach = steps * (1.0 + 1e-9) * float_step(MeshBox(mesh));
  if (!(reach.minCoeff() > std::numeric_limits<double>::min())) return {};
  Grid grid(reach, ends.size());
  Sets sets(ends.size());
  std::size_t pairs = 0;
  for (std::size_t i = 0; i < ends.size() && pairs < kMostWeldPairs; ++i) {
    const Vec3 p = place(mesh, ends[i]);
    grid.each_near(p, [&](std::size_t other) {
      ++pairs;
      if (((place(mesh, ends[other]) - p).cwiseAbs().array() <= reach.array()).all()) sets.join(i, other);
    });
    grid.add(p, i);
  }
  Weld weld;
  std::vector<std::int32_t> now(mesh.vertices.size());
  std::iota(now.begin(), now.end(), 0);
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const std::int32_t from = ends[i], to = ends[sets.lowest(i)];
    if (from == to) continue;
    now[static_cast<std::size_t>(from)] = to;
    weld += {1, (place(mesh, from) - place(mesh, to)).norm()};
  }
  if (weld.corners > 0)
    for (auto& triangle : mesh.triangles)
      for (std::int32_t& corner : triangle) corner = now[static_cast<std::size_t>(corner)];
  return weld;
}

Gap widest_gap(const Mesh& mesh, const std::vector<OpenEdge>& open) {
  struct Line {
    Vec3 from, to, way;
  };
  std::vector<Line> lines;
  lines.reserve(open.size());
  for (const OpenEdge& edge : open) {
    const Vec3 from = place(mesh, edge.from), to = place(mesh, edge.to);
    if (const Vec3 way = to - from; way.squaredNorm() > 0.0) lines.push_back({from, to, way.normalized()});
  }
  struct Sample {
    double width, to_corner;  // distances to the nearest opposite edge, and to its nearer end
  };
  std::vector<Sample> ends;
  Gap gap;
  const std::size_t every = (lines.size() * lines.size()) / kMostMeasured + 1;
  for (std::size_t i = 0; i < lines.size(); i += every) {
    const Line& line = lines[i];
    const std::array<Vec3, 3> points{line.from, line.to, 0.5 * (line.from + line.to)};
    for (std::size_t k = 0; k < points.size(); ++k) {
      const Vec3& p = points[k];
      Sample sample{std::numeric_limits<double>::infinity(), 0.0};
      for (const Line& other : lines) {
        if (line.way.dot(other.way) > kOpposite) continue;
        const double width = distance(p, other.from, other.to);
        if (width < sample.width) sample = {width, std::min((p - other.from).norm(), (p - other.to).norm())};
      }
      if (std::isinf(sample.width)) continue;
      if (k < 2) ends.push_back(sample);
      if (!(sample.width <= gap.width)) gap.width = sample.width;
    }
  }
  gap.beside_edge = std::any_of(ends.begin(), ends.end(),
                                [&](const Sample& s) { return s.to_corner > kBeside * gap.width; });
  gap.of_size = gap.width / MeshBox(mesh).size();
  return gap;
}

namespace {

// Limits on visited faces: in total (some seconds), and as a multiple of all faces.
constexpr std::size_t kMostRound = 100'000'000, kMostRoundEach = 64;

Vec3 corner_of(const Mesh& mesh, std::size_t face, std::size_t i) {
  return Vec3(mesh.vertices[static_cast<std::size_t>(mesh.triangles[face][i])].data());
}

// The faces of a part, and a box around them.
struct Extent {
  std::vector<std::size_t> faces{};
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  [[nodiscard]] bool holds(const Vec3& p) const {
    return (low.array() <= p.array()).all() && (p.array() <= high.array()).all();
  }
};

std::vector<Extent> extents_of(const Mesh& mesh, const std::vector<std::int32_t>& part, std::size_t parts) {
  std::vector<Extent> all(parts);
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    Extent& of = all[static_cast<std::size_t>(part[f])];
    of.faces.push_back(f);
    for (std::size_t i = 0; i < 3; ++i) {
      of.low = of.low.cwiseMin(corner_of(mesh, f, i));
      of.high = of.high.cwiseMax(corner_of(mesh, f, i));
    }
  }
  return all;
}

// True if a part encloses a point, by its winding number there [van Oosterom and Strackee 1983].
bool goes_round(const Mesh& mesh, const Extent& part, const Vec3& probe) {
  double angle = 0.0;
  for (const std::size_t f : part.faces) {
    const Vec3 a = corner_of(mesh, f, 0) - probe, b = corner_of(mesh, f, 1) - probe,
               c = corner_of(mesh, f, 2) - probe;
    const double na = a.norm(), nb = b.norm(), nc = c.norm();
    angle +=
        2.0 * std::atan2(a.dot(b.cross(c)), na * nb * nc + a.dot(b) * nc + b.dot(c) * na + c.dot(a) * nb);
  }
  return std::abs(angle) > 2.0 * std::numbers::pi;
}

}  // namespace

// Tests one vertex of each part against the parts whose box contains it.
std::vector<int> depths_of(const Mesh& mesh, const std::vector<std::int32_t>& part, std::size_t parts) {
  std::vector<int> depth(parts, 0);
  if (parts < 2) return depth;
  const std::vector<Extent> all = extents_of(mesh, part, parts);
  std::size_t work = 0;
  for (std::size_t p = 0; p < parts; ++p) {
    const Vec3 probe = corner_of(mesh, all[p].faces.back(), 0);
    for (std::size_t other = 0; other < parts; ++other) {
      if (other == p || !all[other].holds(probe)) continue;
      work += all[other].faces.size();
      if (work > kMostRound + kMostRoundEach * mesh.triangles.size()) return {};
      depth[p] += goes_round(mesh, all[other], probe) ? 1 : 0;
    }
  }
  return depth;
}

}  // namespace enc::models
