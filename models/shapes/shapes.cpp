#include "models/shapes/shapes.h"

#include <algorithm>
#include <array>
#include <cmath>
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

// Squares (i, j) of a grid that closes on itself in both directions.
void close_torus(Mesh& mesh, int rows, int columns) {
  const auto at = [&](int i, int j) { return (i % rows) * columns + j % columns; };
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) {
      mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
      mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
    }
}

// Points on lattices of the faces of a solid, each made once: corners and edges are shared.
class Lattice {
 public:
  explicit Lattice(Mesh& mesh) : mesh_(mesh) {}
  // `key` names the point in whole numbers, the same from each face that has it.
  std::int32_t at(const std::array<std::int64_t, 3>& key, const Vec3& p) {
    const auto [found, fresh] = known_.try_emplace(key, 0);
    if (fresh) found->second = add(mesh_, p);
    return found->second;
  }

 private:
  Mesh& mesh_;
  std::map<std::array<std::int64_t, 3>, std::int32_t> known_;
};

// Its edges are 2 long.
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

// The triangles of a face that is cut n times each way; its points row by row.
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
  Lattice edges(mesh);  // corners and edges only: the insides of faces are nobody else's
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
  constexpr double kFine = 0.0025, kMost = 40.0;  // m of a square; squares along an edge
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
  // Up the outside. Neighbours that differ by um make slivers; the fan at each end does so by itself.
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
  // Curve and its derivative; the tube's frame leans on the axis of the torus, which the curve never follows.
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

}  // namespace enc::models
