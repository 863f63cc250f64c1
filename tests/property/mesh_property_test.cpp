// The nearest point on a mesh against CGAL, and its sign against the winding number: on faces, edges and
// corners, far away, and at points with several nearest points.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include <CGAL/AABB_traits.h>
#include <CGAL/AABB_tree.h>
#include <CGAL/AABB_triangle_primitive.h>
#include <CGAL/Simple_cartesian.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/shape/surface/mesh_tree.h"
#include "models/mesh_files/mesh_check.h"
#include "models/mesh_files/mesh_file.h"
#include "models/shapes/shapes.h"

namespace enc {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kQueries = 2000;  // sanitizers are slow, and check other things
constexpr double kWindings = 1e6;
#else
constexpr int kQueries = 100000;
constexpr double kWindings =
    2e7;  // solid angles for each mesh: signs for all points of the small ones, 198 on the largest
#endif
constexpr double kClose = 1e-9;  // m

Vec3 corner(const Mesh& mesh, std::size_t triangle, std::size_t i) {
  return Eigen::Map<const Vec3>(mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][i])].data());
}

// CGAL's tree over the same triangles.
class Cgal {
 public:
  explicit Cgal(const Mesh& mesh) {
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k)
      triangles_.emplace_back(point(corner(mesh, k, 0)), point(corner(mesh, k, 1)),
                              point(corner(mesh, k, 2)));
    tree_.insert(triangles_.begin(), triangles_.end());
    tree_.build();
    tree_.accelerate_distance_queries();
  }
  [[nodiscard]] double distance(const Vec3& p) const {
    const Kernel::Point_3 at = tree_.closest_point(point(p));
    return (p - Vec3(at.x(), at.y(), at.z())).norm();
  }

 private:
  using Kernel = CGAL::Simple_cartesian<double>;
  using Triangles = std::vector<Kernel::Triangle_3>;
  using Primitive = CGAL::AABB_triangle_primitive<Kernel, Triangles::iterator>;
  static Kernel::Point_3 point(const Vec3& p) { return {p.x(), p.y(), p.z()}; }
  Triangles triangles_;
  CGAL::AABB_tree<CGAL::AABB_traits<Kernel, Primitive>> tree_;
};

// Counts how often the surface goes round p: 1 inside, 0 outside [van Oosterom and Strackee 1983].
double winding_number(const Mesh& mesh, const Vec3& p) {
  double sum = 0.0;
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    const Vec3 a = corner(mesh, k, 0) - p;
    const Vec3 b = corner(mesh, k, 1) - p;
    const Vec3 c = corner(mesh, k, 2) - p;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    sum += std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2.0 * std::numbers::pi);
}

// Queries of all kinds, `count` in all.
class Queries {
 public:
  // One in `medial_every` is on the medial axis or near the centre.
  Queries(const Mesh& mesh, const MeshTree& tree, int medial_every)
      : mesh_(mesh), tree_(tree), medial_every_(medial_every) {}

  Vec3 next() {
    const Vec3 on = on_surface();
    if (++count_ % medial_every_ == 0) return count_ / medial_every_ % 2 == 0 ? medial(on) : 1e-3 * any();
    if (count_ == 1) return Vec3::Zero();  // the centre
    switch (count_ % 4) {
      case 0:
        return on;  // inside a face, on an edge, on a corner
      case 1:
        return on + std::pow(10.0, uniform(-9.0, -2.0)) * any();  // near the surface
      case 2:
        return 0.05 * any();
      default:
        return std::pow(10.0, uniform(-1.0, 2.0)) * any();  // far away
    }
  }

 private:
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3 any() { return {uniform(-1.0, 1.0), uniform(-1.0, 1.0), uniform(-1.0, 1.0)}; }

  Vec3 on_surface() {
    triangle_ = std::uniform_int_distribution<std::size_t>(0, mesh_.triangles.size() - 1)(random_);
    const Vec3 a = corner(mesh_, triangle_, 0);
    const Vec3 b = corner(mesh_, triangle_, 1);
    const Vec3 c = corner(mesh_, triangle_, 2);
    const double s = uniform(0.0, 1.0);
    const double t = uniform(0.0, 1.0 - s);
    switch (std::uniform_int_distribution<int>(0, 2)(random_)) {
      case 0:
        return a + s * (b - a) + t * (c - a);
      case 1:
        return a + s * (b - a);
      default:
        return a;
    }
  }

  // Moves inwards from the surface until another part of it is as near.
  Vec3 medial(const Vec3& from) {
    const Vec3 in = -tree_.face_normal(static_cast<std::int32_t>(triangle_));
    double low = 0.0;
    double high = 0.1;
    for (int i = 0; i < 40; ++i) {
      const double way = 0.5 * (low + high);
      const double distance = std::abs(tree_.nearest(Point<'O'>(Vec3(from + way * in))).distance);
      (distance < way * (1.0 - 1e-9) ? high : low) = way;
    }
    return from + low * in;
  }

  const Mesh& mesh_;
  const MeshTree& tree_;
  std::mt19937_64 random_{4};
  std::size_t triangle_ = 0;
  int medial_every_;
  int count_ = 0;
};

void compare(const std::string& name, const Mesh& mesh, int medial_every = 5, int points = kQueries) {
  const MeshTree tree(mesh);
  const Cgal cgal(mesh);
  Queries next(mesh, tree, medial_every);
  const int windings =
      std::min(points, static_cast<int>(kWindings / static_cast<double>(mesh.triangles.size())));
  int every = points / windings;
  while (std::gcd(every, 2) != 1) ++every;  // gives every kind of point its turn
  std::int32_t hint = -1;
  double worst = 0.0;
  int apart = 0;
  int wrong = 0;
  int signs = 0;
  int hinted = 0;
  int off = 0;
  for (int i = 0; i < points; ++i) {
    const Vec3 p = next.next();
    const SurfacePoint at = tree.nearest(Point<'O'>(p), hint);
    const SurfacePoint again = tree.nearest(Point<'O'>(p));
    hinted += at.feature == again.feature && at.distance == again.distance &&
                      at.point.xyz == again.point.xyz && at.normal.xyz == again.normal.xyz
                  ? 0
                  : 1;
    hint = at.feature;
    const double difference = std::abs(std::abs(at.distance) - cgal.distance(p));
    worst = std::max(worst, difference);
    apart += difference <= kClose ? 0 : 1;
    off += std::abs((p - at.point.e()).norm() - std::abs(at.distance)) <= 1e-14 * (1.0 + p.norm()) &&
                   std::abs(at.normal.norm() - 1.0) < 1e-12
               ? 0
               : 1;
    // A point on the surface has no sign; its winding number is a half.
    if (i % every != 0 || std::abs(at.distance) < 1e-10) continue;
    ++signs;
    wrong += (winding_number(mesh, p) > 0.5) == (at.distance < 0.0) ? 0 : 1;
  }
  std::printf("%s: %zu triangles, %d points, at most %.2g m from CGAL; %d signs, %d wrong\n", name.c_str(),
              mesh.triangles.size(), points, worst, signs, wrong);
  EXPECT_EQ(apart, 0);
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(signs, windings / 4);
  EXPECT_EQ(hinted, 0);  // a hint changes nothing
  EXPECT_EQ(off, 0);     // distance and point belong together, normals are unit
}

TEST(MeshProperty, Sphere) { compare("sphere", models::geodesic_ball(3)); }
TEST(MeshProperty, Cube) { compare("cube", models::cube(2)); }
TEST(MeshProperty, PartWithSlivers) { compare("turned part", models::turned_part()); }
TEST(MeshProperty, TorusKnot) { compare("knot", models::knot(400, 24)); }
// Near the centre of a ball all triangles are equally near, and CGAL tries each: 200 such points are enough.
TEST(MeshProperty, BallOf100000) { compare("ball", models::geodesic_ball(71), 500); }

// Joins parts as a file may hold them: `more` is shifted, and inside out for a hollow.
struct Parts {
  Mesh mesh;
  Parts& add(const Mesh& more, const Vec3& at, bool hollow = false) {
    const auto first = static_cast<std::int32_t>(mesh.vertices.size());
    for (const auto& v : more.vertices)
      mesh.vertices.push_back({v[0] + at.x(), v[1] + at.y(), v[2] + at.z()});
    for (auto t : more.triangles) {
      if (hollow) std::swap(t[1], t[2]);
      mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
    models::weld(mesh);
    return *this;
  }
};

constexpr int kFew = kQueries / 4;

void expect_right(const std::string& name, const Mesh& mesh) {
  const models::CheckedMesh checked = models::check_mesh(mesh, name);
  EXPECT_TRUE(checked.notes.empty()) << name;
  compare(name, checked.mesh, 5, kFew);
}

TEST(MeshProperty, PartsApart) {
  const Mesh cube = models::cube(2, 0.02), ball = models::geodesic_ball(2, 0.01);
  expect_right("two cubes", Parts().add(cube, {0, 0, 0}).add(cube, {0.025, 0.004, 0}).mesh);
  expect_right("a gap of 1 um", Parts().add(cube, {0, 0, 0}).add(cube, {0.020001, 0.003, 0.001}).mesh);
  expect_right("a gap of 1 nm", Parts().add(cube, {0, 0, 0}).add(ball, {0, 0.001, 0.020000001}).mesh);
}

TEST(MeshProperty, HollowAndNested) {
  const Mesh out = models::cube(3, 0.06), in = models::cube(2, 0.04), ball = models::geodesic_ball(3, 0.012);
  expect_right("hollow", Parts().add(out, {0, 0, 0}).add(in, {0.002, 0, 0.001}, true).mesh);
  expect_right("two hollows", Parts()
                                  .add(out, {0, 0, 0})
                                  .add(ball, {0.014, 0, 0}, true)
                                  .add(ball, {-0.014, 0.001, 0.002}, true)
                                  .mesh);
  expect_right("nested",
               Parts().add(out, {0, 0, 0}).add(in, {0, 0, 0}, true).add(ball, {0.003, 0.002, 0}).mesh);
}

// The nearest point is on both parts where they touch; one part may report outside where the other reports
// inside.
TEST(MeshProperty, PartsThatTouchAreRefused) {
  const Mesh cube = models::cube(2, 0.02), ball = models::geodesic_ball(2, 0.01);
  const auto refused = [&](const std::string& name, const Parts& parts) {
    try {
      (void)models::check_mesh(parts.mesh, name);
      ADD_FAILURE() << name << " was taken";
      compare(name, parts.mesh, 5, kFew);
    } catch (const Error& e) {
      const std::string said = e.what();
      std::printf("%s\n", e.what());
      EXPECT_TRUE(said.find("touching others") != said.npos || said.find("doubled") != said.npos ||
                  said.find("(non-manifold)") != said.npos);
    }
  };
  const auto beside = [&](const Vec3& at) { return Parts().add(cube, {0, 0, 0}).add(cube, at); };
  refused("face to face", beside({0.02, 0.003, 0.001}));
  refused("face to the same face", beside({0.02, 0, 0}));
  refused("edge to edge", beside({0.02, 0.02, 0.003}));
  refused("edge to the same edge", beside({0.02, 0.02, 0}));
  refused("corner to corner", beside({0.02, 0.02, 0.02}));
  refused("corner on a face", Parts().add(cube, {0, 0, 0}).add(ball, {0.001, 0.002, 0.02}));
  refused("face in a hollow", Parts()
                                  .add(models::cube(3, 0.06), {0, 0, 0})
                                  .add(models::cube(2, 0.04), {0, 0, 0}, true)
                                  .add(cube, {0.01, 0.001, 0.002}));
  // The turned mesh has its common plane only up to rounding.
  Mesh turned = beside({0.02, 0.003, 0.001}).mesh;
  const Quat q = Quat(0.8, 0.3, -0.4, 0.2).normalized();
  for (auto& v : turned.vertices) {
    const Vec3 p = q * Vec3(v.data());
    v = {p.x(), p.y(), p.z()};
  }
  refused("face to face, turned", Parts{turned});
}

}  // namespace
}  // namespace enc
