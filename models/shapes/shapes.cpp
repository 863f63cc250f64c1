#include "models/shapes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <utility>

#include "core/base/frames.h"

namespace enc::models {
namespace {

constexpr double kPi = std::numbers::pi;

std::int32_t add(Mesh& mesh, const Vec3& p) {
  mesh.vertices.push_back({p.x(), p.y(), p.z()});
  return static_cast<std::int32_t>(mesh.vertices.size() - 1);
}

// Squares (i, j) of a grid that is closed in both directions.
void close_torus(Mesh& mesh, int rows, int columns) {
  const auto at = [&](int i, int j) { return (i % rows) * columns + j % columns; };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
    }
}

// Points on lattices of the faces of a solid, each made once: faces share corners and edges.
class Lattice {
 public:
  explicit Lattice(Mesh& mesh) : mesh_(mesh) {}
  // `key` identifies the point by integers, equal for every face that has it.
  std::int32_t at(const std::array<std::int64_t, 3>& key, const Vec3& p) {
    const auto [found, fresh] = known_.try_emplace(key, 0);
    if (fresh) found->second = add(mesh_, p);
    return found->second;
  }

 private:
  Mesh& mesh_;
  std::map<std::array<std::int64_t, 3>, std::int32_t> known_;
};

// The edges have length 2.
std::array<Vec3, 12> corners_of_icosahedron() {
  const double g = std::numbers::phi;
  return {Vec3(-1, g, 0),  Vec3(1, g, 0),  Vec3(-1, -g, 0), Vec3(1, -g, 0), Vec3(0, -1, g),  Vec3(0, 1, g),
          Vec3(0, -1, -g), Vec3(0, 1, -g), Vec3(g, 0, -1),  Vec3(g, 0, 1),  Vec3(-g, 0, -1), Vec3(-g, 0, 1)};
}
// By their corners.
constexpr std::array<std::array<int, 3>, 20> kFaces{
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

// Adds the triangles of a face that is cut n times each way; its points are row by row.
void add_face(Mesh& mesh, const std::vector<std::int32_t>& ids, int n) {
  const auto id = [&](int i, int j) {
    return ids[static_cast<std::size_t>(j * (n + 1) - j * (j - 1) / 2 + i)];
  };
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n - j; ++i) {
      mesh.triangles.push_back({id(i, j), id(i + 1, j), id(i, j + 1)});
      if (i + j < n - 1) mesh.triangles.push_back({id(i + 1, j), id(i + 1, j + 1), id(i, j + 1)});
    }
}

}  // namespace

Mesh geodesic_ball(int n, double radius) {
  const std::array<Vec3, 12> corner = corners_of_icosahedron();
  Mesh mesh;
  Lattice edges(mesh);  // corners and edges only: faces do not share their insides
  std::vector<std::int32_t> ids;
  for (std::size_t f = 0; f < kFaces.size(); ++f) {
    const int a = kFaces[f][0];
    const int b = kFaces[f][1];
    const int c = kFaces[f][2];
    const auto corner_at = [&](int k) { return corner[static_cast<std::size_t>(k)]; };
    const auto point = [&](int i, int j) {  // i towards b, j towards c
      const Vec3 p = (n - i - j) * corner_at(a) + i * corner_at(b) + j * corner_at(c);
      return Vec3(radius * p.normalized());
    };
    const auto on_edge = [&](int from, int to, int step, const Vec3& p) {
      if (step == 0) return edges.at({from, from, 0}, p);
      if (step == n) return edges.at({to, to, 0}, p);
      return from < to ? edges.at({from, to, step}, p) : edges.at({to, from, n - step}, p);
    };
    ids.clear();
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n - j; ++i) {
        const Vec3 p = point(i, j);
        if (j == 0)
          ids.push_back(on_edge(a, b, i, p));
        else if (i == 0)
          ids.push_back(on_edge(a, c, j, p));
        else if (i + j == n)
          ids.push_back(on_edge(b, c, j, p));
        else
          ids.push_back(add(mesh, p));
      }
    add_face(mesh, ids, n);
  }
  return mesh;
}

Mesh box(const std::array<int, 3>& squares, const Vec3& size) {
  Mesh mesh;
  Lattice lattice(mesh);
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int top : {0, 1}) {
      const std::size_t along = (axis + 1) % 3, across = (axis + 2) % 3;
      const auto at = [&](int i, int j) {
        std::array<std::int64_t, 3> key{};
        key[axis] = top * squares[axis];
        key[along] = i;
        key[across] = j;
        const auto x = [&](std::size_t k) {
          return size[static_cast<Eigen::Index>(k)] * (static_cast<double>(key[k]) / squares[k] - 0.5);
        };
        return lattice.at(key, Vec3(x(0), x(1), x(2)));
      };
      for (int i = 0; i < squares[along]; ++i)
        for (int j = 0; j < squares[across]; ++j) {
          std::array<std::int32_t, 4> q{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
          if (top == 0) std::swap(q[1], q[3]);
          mesh.triangles.push_back({q[0], q[1], q[2]});
          mesh.triangles.push_back({q[0], q[2], q[3]});
        }
    }
  return mesh;
}

std::shared_ptr<const Mesh> box_surface(const Vec3& size) {
  constexpr double kFine = 0.0025, kMost = 40.0;  // m, side of a square; squares along an edge
  std::array<int, 3> squares{};
  for (std::size_t i = 0; i < 3; ++i)
    squares[i] =
        static_cast<int>(std::clamp(std::ceil(size[static_cast<Eigen::Index>(i)] / kFine), 1.0, kMost));
  return std::make_shared<const Mesh>(box(squares, size));
}

Mesh cube(int n, double side) { return box({n, n, n}, {side, side, side}); }

Mesh turned_part(int sides) {
  struct Ring {
    double height, radius;  // m
  };
  // Profile up the outside. Neighbours a few um apart make slivers; so do the fans at both ends.
  constexpr std::array<Ring, 12> kRings{{{-0.020, 0.010},
                                         {-0.020, 0.030},
                                         {-0.012, 0.030},
                                         {-0.01199, 0.02999},
                                         {-0.01199, 0.012},
                                         {0.000, 0.012},
                                         {0.000, 0.025},
                                         {0.000004, 0.025},
                                         {0.006, 0.025},
                                         {0.006, 0.024995},
                                         {0.006, 0.008},
                                         {0.022, 0.008}}};
  Mesh mesh;
  for (const Ring& ring : kRings)
    for (int i = 0; i < sides; ++i) {
      const double angle = 2.0 * kPi * i / sides;
      add(mesh, Vec3(ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.height));
    }
  const std::int32_t bottom = add(mesh, Vec3(0, 0, kRings.front().height));
  const std::int32_t top = add(mesh, Vec3(0, 0, kRings.back().height));
  const int rings = static_cast<int>(kRings.size());
  for (int i = 0; i < sides; ++i) {
    const int j = (i + 1) % sides;
    mesh.triangles.push_back({bottom, j, i});
    for (int r = 0; r + 1 < rings; ++r) {
      const int low = r * sides;
      const int high = low + sides;
      mesh.triangles.push_back({low + i, low + j, high + j});
      mesh.triangles.push_back({low + i, high + j, high + i});
    }
    mesh.triangles.push_back({(rings - 1) * sides + i, (rings - 1) * sides + j, top});
  }
  return mesh;
}

Mesh knot(int along, int around) {
  // The curve and its derivative. The tube's frame uses the axis of the torus, which is never parallel to the
  // curve.
  const double size = 0.011;  // m
  const auto curve = [=](double s) {
    const double r = 2.0 + std::cos(3.0 * s);
    return Vec3(size * Vec3(r * std::cos(2.0 * s), r * std::sin(2.0 * s), -std::sin(3.0 * s)));
  };
  Mesh mesh;
  for (int i = 0; i < along; ++i) {
    const double s = 2.0 * kPi * i / along;
    const Vec3 ahead = (curve(s + 1e-5) - curve(s - 1e-5)).normalized();
    const Vec3 side = ahead.cross(Vec3::UnitZ()).normalized();
    const Vec3 up = side.cross(ahead);
    for (int j = 0; j < around; ++j) {
      const double a = 2.0 * kPi * j / around;
      const double radius = 0.0055 * (1.0 + 0.08 * std::sin(25.0 * s) * std::cos(4.0 * a));
      add(mesh, curve(s) + radius * (std::cos(a) * side + std::sin(a) * up));
    }
  }
  close_torus(mesh, along, around);
  return mesh;
}

namespace {

// ---- The shape as a field: negative inside, roughly the distance outside; mm.

// Union that rounds the seam over a width k.
double joined(double a, double b, double k) {
  const double h = std::max(k - std::abs(a - b), 0.0) / k;
  return std::min(a, b) - 0.25 * h * h * k;
}

double ellipsoid(const Vec3& p, const Vec3& centre, const Vec3& radii) {
  const Vec3 q = (p - centre).cwiseQuotient(radii);
  const double near = q.norm();
  const double slope = q.cwiseQuotient(radii).norm();
  return slope > 0.0 ? near * (near - 1.0) / slope : -radii.minCoeff();
}

// A rod with round ends, with one radius at a and another at b.
double rod(const Vec3& p, const Vec3& a, const Vec3& b, double ra, double rb) {
  const double t = std::clamp((p - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
  return (p - a - t * (b - a)).norm() - (ra + t * (rb - ra));
}

// A leaf from its root to its tip: `wide` across, `thick` along `face`.
double ear(const Vec3& p, const Vec3& root, const Vec3& tip, const Vec3& face, double wide, double thick) {
  const Vec3 along = (tip - root).normalized();
  const Vec3 flat = (face - along * along.dot(face)).normalized();
  const Vec3 q = p - 0.5 * (root + tip);
  const Vec3 local(q.dot(along), q.dot(flat.cross(along)), q.dot(flat));
  const double body = ellipsoid(local, Vec3::Zero(), {0.5 * (tip - root).norm(), wide, thick});
  // Hollow in front.
  const double hollow =
      ellipsoid(local, {0.0, 0.0, 1.15 * thick}, {0.38 * (tip - root).norm(), 0.62 * wide, 0.85 * thick});
  return -joined(-body, hollow, 1.2);
}

double hare(const Vec3& at) {
  const Vec3 p(at.x(), std::abs(at.y()), at.z());                        // left and right are mirror images
  double d = ellipsoid(p, {-3, 0, 17}, {20, 11.5, 12.5});                // trunk
  d = joined(d, ellipsoid(p, {-14, 0, 16}, {13, 12, 14.5}), 6.0);        // rump
  d = joined(d, ellipsoid(p, {11, 0, 15}, {9.5, 8.5, 10.5}), 6.0);       // chest
  d = joined(d, ellipsoid(p, {-12, 9.5, 11}, {11, 5.5, 10}), 2.5);       // haunch
  d = joined(d, rod(p, {-13, 11, 3.0}, {5, 12, 2.8}, 3.2, 2.8), 2.0);    // hind foot
  d = joined(d, rod(p, {11, 4.8, 13}, {15.5, 5, 4}, 4.0, 2.8), 2.5);     // fore leg
  d = joined(d, rod(p, {15, 5, 2.7}, {20, 5.3, 2.4}, 2.7, 2.4), 1.5);    // paw
  d = joined(d, rod(p, {10, 0, 19}, {19, 0, 29}, 8.0, 6.0), 5.0);        // neck
  d = joined(d, ellipsoid(p, {22, 0, 31.5}, {9.5, 7.2, 7.8}), 3.0);      // head
  d = joined(d, ellipsoid(p, {28.5, 0, 29}, {5.5, 4.6, 4.6}), 3.5);      // muzzle
  d = joined(d, ellipsoid(p, {26, 3.6, 28.6}, {4, 3.2, 3.4}), 2.0);      // cheek
  d = joined(d, ellipsoid(p, {33.6, 0, 30.4}, {1.5, 1.7, 1.2}), 1.0);    // nose
  d = joined(d, ellipsoid(p, {25.2, 6.0, 33.6}, {1.9, 1.5, 1.9}), 0.6);  // eye
  d = joined(d, ellipsoid(p, {-29, 0, 16}, {5, 4.6, 5}), 1.5);           // tail
  return joined(d, ear(p, {19.5, 2.4, 35}, {12.5, 7.5, 61}, {1, 0.45, 0.2}, 4.6, 2.3), 2.0);
}

// ---- Its surface: one vertex in each cell that the surface crosses, one quad around each crossed edge
// [Gibson 1998, "Constrained elastic surface nets"].

constexpr double kCell = 0.99;  // mm
constexpr std::array<int, 3> kCells{73, 34, 65};
const Vec3 kLow(-36.0, -0.5 * 34 * kCell, -2.0);

Vec3 place(const Vec3& cells) { return kLow + kCell * cells; }

class Net {
 public:
  Mesh make() {
    sample();
    for (int k = 0; k < kCells[2]; ++k)
      for (int j = 0; j < kCells[1]; ++j)
        for (int i = 0; i < kCells[0]; ++i) add_vertex({i, j, k});
    for (int k = 0; k <= kCells[2]; ++k)
      for (int j = 0; j <= kCells[1]; ++j)
        for (int i = 0; i <= kCells[0]; ++i)
          for (std::size_t axis = 0; axis < 3; ++axis) add_quad({i, j, k}, axis);
    for (auto& vertex : mesh_.vertices) {
      vertex[0] += 12.0;  // puts the origin under the highest point of the back
      for (double& x : vertex) x *= 1e-3;
    }
    return std::move(mesh_);
  }

 private:
  using Cell = std::array<int, 3>;
  static std::size_t index(const Cell& c) {
    return static_cast<std::size_t>((c[2] * (kCells[1] + 1) + c[1]) * (kCells[0] + 1) + c[0]);
  }
  [[nodiscard]] double value(const Cell& c) const { return value_[index(c)]; }

  void sample() {
    const std::size_t size = index({kCells[0], kCells[1], kCells[2]}) + 1;
    value_.resize(size);
    vertex_.assign(size, -1);
    for (int k = 0; k <= kCells[2]; ++k)
      for (int j = 0; j <= kCells[1]; ++j)
        for (int i = 0; i <= kCells[0]; ++i) value_[index({i, j, k})] = hare(place(Vec3(i, j, k)));
  }

  // The mean of the crossings on the cell's edges, moved onto the surface.
  void add_vertex(const Cell& c) {
    Vec3 sum = Vec3::Zero();
    int crossings = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 4; ++side) {
        Cell a = c;
        a[(axis + 1) % 3] += side & 1;
        a[(axis + 2) % 3] += side >> 1;
        Cell b = a;
        ++b[axis];
        if ((value(a) < 0) == (value(b) < 0)) continue;
        Vec3 at(a[0], a[1], a[2]);
        at[static_cast<Eigen::Index>(axis)] += value(a) / (value(a) - value(b));
        sum += at;
        ++crossings;
      }
    if (crossings == 0) return;
    const Vec3 p = onto_surface(place(sum / crossings), place(Vec3(c[0], c[1], c[2])));
    vertex_[index(c)] = static_cast<std::int32_t>(mesh_.vertices.size());
    mesh_.vertices.push_back({p.x(), p.y(), p.z()});
  }

  // Newton steps along the gradient, within the cell whose lowest corner is `low`.
  static Vec3 onto_surface(Vec3 p, const Vec3& low) {
    constexpr double kStep = 1e-4;
    for (int i = 0; i < 4; ++i) {
      Vec3 slope;
      for (Eigen::Index axis = 0; axis < 3; ++axis)
        slope[axis] =
            (hare(p + kStep * Vec3::Unit(axis)) - hare(p - kStep * Vec3::Unit(axis))) / (2.0 * kStep);
      if (slope.squaredNorm() < 1e-6) break;
      p -= slope * (hare(p) / slope.squaredNorm());
      p = p.cwiseMax(low + Vec3::Constant(0.05 * kCell)).cwiseMin(low + Vec3::Constant(0.95 * kCell));
    }
    return p;
  }

  void add_quad(const Cell& a, std::size_t axis) {
    Cell b = a;
    const std::size_t u = (axis + 1) % 3, v = (axis + 2) % 3;
    if (++b[axis] > kCells[axis] || a[u] == 0 || a[v] == 0 || a[u] == kCells[u] || a[v] == kCells[v]) return;
    if ((value(a) < 0) == (value(b) < 0)) return;
    std::array<std::int32_t, 4> q{};
    for (std::size_t i = 0; i < 4; ++i) {  // once around the edge, from u to v
      Cell c = a;
      c[u] -= i == 0 || i == 3 ? 1 : 0;
      c[v] -= i < 2 ? 1 : 0;
      q[i] = vertex_[index(c)];
    }
    if (value(a) >= 0) std::swap(q[1], q[3]);  // the inside is ahead
    const auto apart = [&](std::size_t i, std::size_t j) {
      return (Vec3(mesh_.vertices[static_cast<std::size_t>(q[i])].data()) -
              Vec3(mesh_.vertices[static_cast<std::size_t>(q[j])].data()))
          .squaredNorm();
    };
    const std::size_t s = apart(0, 2) <= apart(1, 3) ? 0 : 1;  // splits along the shorter diagonal
    mesh_.triangles.push_back({q[s], q[s + 1], q[s + 2]});
    mesh_.triangles.push_back({q[s], q[s + 2], q[(s + 3) % 4]});
  }

  std::vector<double> value_;
  std::vector<std::int32_t> vertex_;  // vertex of each cell; -1: none
  Mesh mesh_;
};

}  // namespace

Mesh hare_mesh() { return Net().make(); }

}  // namespace enc::models
