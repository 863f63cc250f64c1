// Faces that pass through each other or touch: a tree of boxes, walked against itself.
#include <algorithm>
#include <array>
#include <limits>

#include "core/base/frames.h"
#include "core/shape/surface/triangle.h"
#include "models/mesh_files/mesh_check.h"

namespace enc::models {
namespace {

constexpr std::size_t kLeaf = 4;
constexpr double kTouching =
    1e-12;  // share of the mesh's size: below it, the search takes two faces as equally near
constexpr std::size_t kMostPairs = 100'000'000;  // pairs of faces whose boxes overlap: some seconds

struct Box {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void add(const Vec3& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Box& b) {
    add(b.low);
    add(b.high);
  }
  [[nodiscard]] bool meets(const Box& b) const {
    return (low.array() <= b.high.array()).all() && (b.low.array() <= high.array()).all();
  }
};

// Least distance of two segments [Ericson 2005, 5.1.9].
double between(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 u = b - a, v = d - c, w = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double sine = uu * vv - uv * uv;
  double s = sine > 0.0 ? std::clamp((uv * vw - uw * vv) / sine, 0.0, 1.0) : 0.0;
  const double t = std::clamp((uv * s + vw) / vv, 0.0, 1.0);
  s = std::clamp((uv * t - uw) / uu, 0.0, 1.0);
  return (w + s * u - t * v).norm();
}

class Toucher {
 public:
  explicit Toucher(const Mesh& mesh)
      : mesh_(mesh),
        order_(mesh.triangles.size()),
        boxes_(order_.size()),
        crosses_(order_.size()),
        touched_(order_.size(), static_cast<std::uint32_t>(order_.size())) {
    Box all;
    for (const auto& v : mesh.vertices) all.add(Vec3(v.data()));
    near_ = kTouching * (all.high - all.low).norm();
    for (std::size_t i = 0; i < order_.size(); ++i) {
      order_[i] = static_cast<std::uint32_t>(i);
      for (std::size_t k = 0; k < 3; ++k) boxes_[i].add(corner(i, k));
      boxes_[i].low.array() -= near_;
      boxes_[i].high.array() += near_;
    }
    nodes_.reserve(order_.size());
    build(0, order_.size());
  }

  Touching find() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs{{0, 0}};
    while (!pairs.empty() && result_.finished) {
      const auto [i, j] = pairs.back();
      pairs.pop_back();
      const Node &a = nodes_[i], &b = nodes_[j];
      if (!a.box.meets(b.box)) continue;
      if (a.child == 0 && b.child == 0) {
        test_leaves(a, b, i == j);
      } else if (i == j) {
        pairs.insert(pairs.end(), {{a.child, a.child}, {i + 1, a.child}, {i + 1, i + 1}});
      } else if (b.child == 0 || (a.child != 0 && a.size >= b.size)) {
        pairs.insert(pairs.end(), {{i + 1, j}, {a.child, j}});
      } else {
        pairs.insert(pairs.end(), {{i, j + 1}, {i, b.child}});
      }
    }
    for (std::size_t i = 0; i < order_.size(); ++i) {
      if (crosses_[i]) result_.crossing.push_back(i);
      if (touched_[i] < order_.size()) result_.touching.push_back(i);
    }
    if (!result_.touching.empty()) result_.touched = touched_[result_.touching[0]];
    return std::move(result_);
  }

 private:
  using Common = std::array<bool, 3>;  // corners of a face that are shared with another one
  struct Node {
    Box box;
    std::size_t first, size;
    std::uint32_t child = 0;  // the second child; the first follows its parent. 0: a leaf
  };

  [[nodiscard]] Vec3 corner(std::size_t face, std::size_t i) const {
    return Vec3(mesh_.vertices[static_cast<std::size_t>(mesh_.triangles[face][i])].data());
  }

  // Splits at the median along the longest side, so the depth is log2 of the size.
  std::uint32_t build(std::size_t first, std::size_t size) {
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, first, size});
    for (std::size_t i = first; i < first + size; ++i) nodes_[at].box.add(boxes_[order_[i]]);
    if (size <= kLeaf) return at;
    Eigen::Index axis = 0;
    (nodes_[at].box.high - nodes_[at].box.low).maxCoeff(&axis);
    const auto from = order_.begin() + static_cast<std::ptrdiff_t>(first);
    std::nth_element(from, from + static_cast<std::ptrdiff_t>(size / 2),
                     from + static_cast<std::ptrdiff_t>(size), [&](std::uint32_t a, std::uint32_t b) {
                       return boxes_[a].low[axis] + boxes_[a].high[axis] <
                              boxes_[b].low[axis] + boxes_[b].high[axis];
                     });
    build(first, size / 2);
    const std::uint32_t second = build(first + size / 2, size - size / 2);
    nodes_[at].child = second;
    return at;
  }

  void test_leaves(const Node& a, const Node& b, bool same) {
    for (std::size_t i = a.first; i < a.first + a.size; ++i)
      for (std::size_t j = same ? i + 1 : b.first; j < b.first + b.size; ++j) {
        const std::uint32_t f = order_[i], g = order_[j];
        if (!boxes_[f].meets(boxes_[g])) continue;
        if (++tested_ > kMostPairs) result_.finished = false;
        compare(f, g);
      }
  }

  void compare(std::uint32_t f, std::uint32_t g) {
    const auto &s = mesh_.triangles[f], &t = mesh_.triangles[g];
    Common of_f{}, of_g{};
    std::size_t common = 0;
    for (std::size_t k = 0; k < 9; ++k)
      if (s[k / 3] == t[k % 3]) of_f[k / 3] = of_g[k % 3] = true, ++common;
    if (common >= 2) {
      const auto apex = [](const Common& of) {
        return static_cast<std::size_t>(std::find(of.begin(), of.end(), false) - of.begin());
      };
      if (common == 3 || folded(f, g, apex(of_f), apex(of_g))) crosses_[f] = crosses_[g] = true;
      return;
    }
    if (beside(f, g, of_f, of_g) || beside(g, f, of_g, of_f)) return;
    if (cross(f, g, of_f, of_g)) {
      crosses_[f] = crosses_[g] = true;
      result_.depth = std::max(result_.depth, depth(f, g));
    }
    if (touch(f, g, of_f, of_g)) touched_[f] = g, touched_[g] = f;
  }

  // Six times the volume of a tetrahedron; 0 if rounding decides its sign.
  static double side(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
    const Vec3 u = a - p, v = b - p, w = c - p;
    const double volume = u.dot(v.cross(w));
    const auto size = [](const Vec3& x) { return x.lpNorm<Eigen::Infinity>(); };
    const double bound =
        1e-14 * size(u) * size(v) * size(w);  // covers 7.8e-16 times the permanent [Shewchuk 1997]
    return std::abs(volume) > bound ? volume : 0.0;
  }

  // True if the side p-q of one face passes strictly through the inside of the other face.
  [[nodiscard]] bool pierces(const Vec3& p, const Vec3& q, std::size_t face) const {
    const Vec3 a = corner(face, 0), b = corner(face, 1), c = corner(face, 2);
    if (side(a, b, c, p) * side(a, b, c, q) >= 0.0) return false;
    const double ab = side(p, q, a, b), bc = side(p, q, b, c), ca = side(p, q, c, a);
    return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
  }

  // True if two faces with a common edge lie on each other.
  [[nodiscard]] bool folded(std::size_t f, std::size_t g, std::size_t apex_f, std::size_t apex_g) const {
    const Vec3 a = corner(f, (apex_f + 1) % 3), b = corner(f, (apex_f + 2) % 3), p = corner(f, apex_f),
               q = corner(g, apex_g);
    const Vec3 edge = (b - a).normalized();
    const Vec3 up = (p - a) - edge * edge.dot(p - a), uq = (q - a) - edge * edge.dot(q - a);
    return up.dot(uq) > 0.0 && up.cross(uq).norm() <= 1e-12 * up.norm() * uq.norm();
  }

  // True if two faces with at most one common corner pass through each other.
  [[nodiscard]] bool cross(std::size_t f, std::size_t g, const Common& of_f, const Common& of_g) const {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t l = (k + 1) % 3;
      // A side that starts at a common vertex cannot pass through the inside.
      if (!of_f[k] && !of_f[l] && pierces(corner(f, k), corner(f, l), g)) return true;
      if (!of_g[k] && !of_g[l] && pierces(corner(g, k), corner(g, l), f)) return true;
    }
    return false;
  }

  // The least shift that separates two faces: along a normal, or across a side of each [Cameron and Culley
  // 1986].
  [[nodiscard]] double depth(std::size_t f, std::size_t g) const {
    const std::array<Vec3, 3> a{corner(f, 0), corner(f, 1), corner(f, 2)},
        b{corner(g, 0), corner(g, 1), corner(g, 2)};
    double least = std::numeric_limits<double>::infinity();
    const auto along = [&](const Vec3& u, const Vec3& v) {
      const Vec3 axis = u.cross(v);
      if (!(axis.norm() > 1e-9 * u.norm() * v.norm())) return;  // parallel sides have no such axis
      const auto reach = [&](const std::array<Vec3, 3>& corners) {
        const Vec3 at(axis.dot(corners[0] - a[0]), axis.dot(corners[1] - a[0]), axis.dot(corners[2] - a[0]));
        return std::pair(at.minCoeff(), at.maxCoeff());
      };
      const auto [low_a, high_a] = reach(a);
      const auto [low_b, high_b] = reach(b);
      least = std::min(least, std::min(high_a - low_b, high_b - low_a) / axis.norm());
    };
    along(a[1] - a[0], a[2] - a[0]);
    along(b[1] - b[0], b[2] - b[0]);
    for (std::size_t i = 0; i < 9; ++i) along(a[(i / 3 + 1) % 3] - a[i / 3], b[(i % 3 + 1) % 3] - b[i % 3]);
    return std::max(least, 0.0);
  }

  // True if all corners of a face, except the common ones, are clearly above a plane. `rounding`: error of
  // each component of the normal.
  [[nodiscard]] bool above(const Vec3& on, const Vec3& normal, double rounding, std::size_t face,
                           const Common& shared) const {
    const double near = near_ * normal.norm();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 way = corner(face, k) - on;
      if (!shared[k] && !(normal.dot(way) > near + rounding * way.lpNorm<1>())) return false;
    }
    return true;
  }
  // True if `g` meets `f` at most in a common corner: it is beside the plane of `f`, or beyond one of its
  // sides (which has that corner).
  [[nodiscard]] bool beside(std::size_t f, std::size_t g, const Common& of_f, const Common& of_g) const {
    const std::array<Vec3, 3> c{corner(f, 0), corner(f, 1), corner(f, 2)};
    const Vec3 ab = c[1] - c[0], ac = c[2] - c[0], normal = ab.cross(ac);
    const double long_side = ab.lpNorm<1>() + ac.lpNorm<1>();
    const double rounding = 1e-15 * long_side * long_side;
    if (above(c[0], normal, rounding, g, of_g) || above(c[0], -normal, rounding, g, of_g)) return true;
    for (std::size_t k = 0; k < 3; ++k)
      if (!of_f[(k + 2) % 3] &&
          above(c[k], (c[(k + 1) % 3] - c[k]).cross(normal), 2.0 * rounding * long_side, g, of_g))
        return true;
    return false;
  }

  // True if a corner lies on a face or two sides meet, except at common corners.
  [[nodiscard]] bool touch(std::size_t f, std::size_t g, const Common& of_f, const Common& of_g) const {
    for (std::size_t k = 0; k < 3; ++k)
      if ((!of_f[k] && on(corner(f, k), g)) || (!of_g[k] && on(corner(g, k), f))) return true;
    for (std::size_t k = 0; k < 9; ++k) {
      const std::size_t i = k / 3, j = k % 3, after_i = (i + 1) % 3, after_j = (j + 1) % 3;
      const bool joined = (of_f[i] || of_f[after_i]) && (of_g[j] || of_g[after_j]);  // they share a corner
      if (!joined && between(corner(f, i), corner(f, after_i), corner(g, j), corner(g, after_j)) <= near_)
        return true;
    }
    return false;
  }
  [[nodiscard]] bool on(const Vec3& p, std::size_t face) const {
    const std::array<Vec3, 3> corners{corner(face, 0), corner(face, 1), corner(face, 2)};
    return nearest_on_triangle(p, corners, mesh_.triangles[face]).square <= near_ * near_;
  }

  const Mesh& mesh_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;
  std::vector<bool> crosses_;
  std::vector<std::uint32_t> touched_;  // touching face of each face; the number of faces: none
  double near_ = 0.0;                   // m: faces at most this far apart touch
  std::vector<Node> nodes_;
  std::size_t tested_ = 0;
  Touching result_;
};

}  // namespace

Touching touching_faces(const Mesh& mesh) { return Toucher(mesh).find(); }

}  // namespace enc::models
