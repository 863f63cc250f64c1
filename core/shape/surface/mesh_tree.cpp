// The search. What a node or leaf says in float is at most wrong by `pad`; nothing that could be nearest by
// that much is left out, so the answer is that of trying every triangle in double.
#include "core/shape/surface/mesh_tree.h"

#include <bit>
#include <cmath>
#include <limits>

#include "core/shape/surface/lanes.h"
#include "core/shape/surface/triangle.h"

namespace enc {
namespace {

constexpr double kFarthest = 1e9;  // m; squares stay finite in float

// Squares of distances in the coarse order in which ties are ties: cut to 40 binary digits.
double coarse(double square, double least) {
  constexpr std::uint64_t kKept = ~((1ULL << 13U) - 1U);
  return square < least ? 0.0 : std::bit_cast<double>(std::bit_cast<std::uint64_t>(square) & kKept);
}

Lanes square(Lanes x) { return x * x; }

using Point3f = std::array<float, 3>;

}  // namespace

struct MeshTree::Search {
  const MeshTree& tree;
  Vec3 p;        // in O
  Point3f q;     // the same from the centre of the mesh
  double pad;    // m: most that float arithmetic can be wrong by, here
  double least;  // m^2: below it, all distances are 0
  double best = std::numeric_limits<double>::infinity();  // coarse square of the distance
  std::int32_t triangle = -1;
  OnTriangle at;
  float limit = std::numeric_limits<float>::max();  // m^2: what is farther than this in float is farther

  Search(const MeshTree& t, const Vec3& query, const Vec3& from_centre)
      : tree(t),
        p(query),
        q{static_cast<float>(from_centre.x()), static_cast<float>(from_centre.y()),
          static_cast<float>(from_centre.z())},
        pad(2e-6 * (from_centre.norm() + t.radius_)),
        least(1e-28 * t.radius_ * t.radius_) {}

  void offer(std::int32_t candidate) {
    if (candidate == triangle) return;
    const auto& ids = tree.mesh_.triangles[static_cast<std::size_t>(candidate)];
    const OnTriangle found = nearest_on_triangle(p, tree.corners(candidate), ids);
    const double key = coarse(found.square, least);
    if (key > best || (key == best && candidate > triangle)) return;
    best = key;
    triangle = candidate;
    at = found;
    const double reach = std::sqrt(found.square) + pad;
    limit = static_cast<float>(reach * reach * (1.0 + 1e-6));
  }

  void visit_leaf(const Leaf& leaf) {
    const std::array<float, kWay> squares = to_leaf(leaf);
    unsigned open = (Lanes::load(squares.data()) <= Lanes::all(limit)).bits();
    while (open != 0) {  // nearest first: it often shuts out the others
      int next = std::countr_zero(open);
      for (unsigned rest = open & (open - 1); rest != 0; rest &= rest - 1) {
        const int i = std::countr_zero(rest);
        if (squares[static_cast<std::size_t>(i)] < squares[static_cast<std::size_t>(next)]) next = i;
      }
      open &= ~(1U << static_cast<unsigned>(next));
      if (!(squares[static_cast<std::size_t>(next)] <= limit)) return;
      offer(leaf.triangle[static_cast<std::size_t>(next)]);
    }
  }

  // Squares of the distances to the triangles of a leaf.
  [[nodiscard]] std::array<float, kWay> to_leaf(const Leaf& leaf) const {
    const auto at_lanes = [](const Eight& e) { return Lanes::load(e.data()); };
    const Lanes zero = Lanes::all(0.0F);
    const Lanes one = Lanes::all(1.0F);
    const Lanes tiny = Lanes::all(1e-30F);
    const Lanes dx = Lanes::all(q[0]) - at_lanes(leaf.a[0]);
    const Lanes dy = Lanes::all(q[1]) - at_lanes(leaf.a[1]);
    const Lanes dz = Lanes::all(q[2]) - at_lanes(leaf.a[2]);
    const Lanes ux = at_lanes(leaf.u[0]), uy = at_lanes(leaf.u[1]), uz = at_lanes(leaf.u[2]);
    const Lanes vx = at_lanes(leaf.v[0]), vy = at_lanes(leaf.v[1]), vz = at_lanes(leaf.v[2]);
    const Lanes x = dx * ux + dy * uy + dz * uz;
    const Lanes y = dx * vx + dy * vy + dz * vz;
    const Lanes z = dx * (uy * vz - uz * vy) + dy * (uz * vx - ux * vz) + dz * (ux * vy - uy * vx);
    const Lanes bx = at_lanes(leaf.bx), cx = at_lanes(leaf.cx), cy = at_lanes(leaf.cy);
    // From a to b, from a to c, from b to c.
    const Lanes ab = square(x - min(max(x, zero), bx)) + square(y);
    const Lanes ac_t = min(max((x * cx + y * cy) / max(cx * cx + cy * cy, tiny), zero), one);
    const Lanes ac = square(x - ac_t * cx) + square(y - ac_t * cy);
    const Lanes xb = x - bx, gx = cx - bx;
    const Lanes bc_t = min(max((xb * gx + y * cy) / max(gx * gx + cy * cy, tiny), zero), one);
    const Lanes bc = square(xb - bc_t * gx) + square(y - bc_t * cy);
    const Lanes::Mask inside = (zero <= y) & (cx * y <= cy * x) & (cy * xb <= gx * y);
    const Lanes aside = unless(inside, min(ab, min(ac, bc)));
    std::array<float, kWay> squares;
    (z * z + aside).store(squares.data());
    return squares;
  }

  // Squares of the distances to the boxes of a node's children.
  [[nodiscard]] Lanes to_boxes(const Node& node) const {
    Lanes sum = Lanes::all(0.0F);
    for (std::size_t i = 0; i < 3; ++i) {
      const Point3f& axis = node.axes[i];
      const Lanes x = Lanes::all(axis[0] * q[0] + axis[1] * q[1] + axis[2] * q[2] + node.shift[i]);
      const Lanes out = max(max(Lanes::load(node.low[i].data()) - x, x - Lanes::load(node.high[i].data())),
                            Lanes::all(0.0F));
      sum = sum + out * out;
    }
    return sum;
  }

  struct Entry {
    float square;
    std::int32_t index, level;  // level -1: a leaf
  };

  void run() {
    // At each level at most seven wait beside the one that is entered.
    std::array<Entry, (kWay - 1) * kMostLevels + kWay> stack;
    std::size_t size = 0;
    stack[size++] = {0.0F, 0, tree.levels_ - 1};
    while (size > 0) {
      const Entry top = stack[--size];
      if (!(top.square <= limit)) continue;
      if (top.level < 0) {
        visit_leaf(tree.leaves_[static_cast<std::size_t>(top.index)]);
        continue;
      }
      const std::int32_t first = tree.level_[static_cast<std::size_t>(top.level)];
      const Lanes boxes = to_boxes(tree.nodes_[static_cast<std::size_t>(first + top.index)]);
      unsigned open = (boxes <= Lanes::all(limit)).bits();
      std::array<float, kWay> squares;
      boxes.store(squares.data());
      const std::size_t base = size;
      for (; open != 0; open &= open - 1) {
        const int i = std::countr_zero(open);
        const Entry child{squares[static_cast<std::size_t>(i)], kWay * top.index + i, top.level - 1};
        std::size_t to = size++;
        for (; to > base && stack[to - 1].square < child.square; --to) stack[to] = stack[to - 1];
        stack[to] = child;  // the nearest ends on top
      }
    }
  }

  [[nodiscard]] Nearest answer() const {
    const auto& ids = tree.mesh_.triangles[static_cast<std::size_t>(triangle)];
    Vec3 n = Vec3::Zero();
    if (at.part.kind == Part::corner) n = tree.vertex_normal(ids[at.part.i]);
    if (at.part.kind == Part::edge) n = tree.edge_normal(triangle, at.part.i);
    if (n.isZero(0.0)) n = tree.face_normal(triangle);
    const double side = n.dot(p - at.point);
    return {Point<'O'>(at.point), Vec<'O'>(n), std::copysign(std::sqrt(at.square), side), triangle};
  }
};

Nearest MeshTree::nearest(const Point<'O'>& p, std::int32_t hint) const noexcept {
  const Vec3 from_centre = p.e() - centre_;
  if (!(from_centre.norm() <= kFarthest)) return {};  // NaN as well
  Search search(*this, p.e(), from_centre);
  if (hint >= 0 && static_cast<std::size_t>(hint) < mesh_.triangles.size()) search.offer(hint);
  search.run();
  return search.triangle >= 0 ? search.answer() : Nearest{};
}

std::array<Vec3, 3> MeshTree::corners(std::int32_t triangle) const noexcept {
  const auto& ids = mesh_.triangles[static_cast<std::size_t>(triangle)];
  const auto at = [&](std::int32_t id) { return vec(mesh_.vertices[static_cast<std::size_t>(id)]); };
  return {at(ids[0]), at(ids[1]), at(ids[2])};
}

Vec3 MeshTree::face_normal(std::int32_t triangle) const noexcept {
  const std::array<Vec3, 3> c = corners(triangle);
  const Vec3 n = (c[1] - c[0]).cross(c[2] - c[1]);
  const double size = n.norm();
  return size > 0.0 ? Vec3(n / size) : Vec3(Vec3::Zero());
}

Vec3 MeshTree::edge_normal(std::int32_t triangle, int edge) const noexcept {
  const std::int32_t other = neighbours_[static_cast<std::size_t>(triangle)][static_cast<std::size_t>(edge)];
  const Vec3 n = face_normal(triangle);
  if (other < 0) return n;
  const Vec3 sum = n + face_normal(other);
  const double size = sum.norm();
  return size > 1e-9 ? Vec3(sum / size) : n;  // two faces back to back have no edge normal
}

Vec3 MeshTree::vertex_normal(std::int32_t vertex) const noexcept {
  return vec(vertex_normals_[static_cast<std::size_t>(vertex)]);
}

std::size_t MeshTree::memory_bytes() const {
  const auto bytes = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
  return sizeof(*this) + bytes(mesh_.vertices) + bytes(mesh_.triangles) + bytes(neighbours_) +
         bytes(vertex_normals_) + bytes(nodes_) + bytes(leaves_);
}

}  // namespace enc
