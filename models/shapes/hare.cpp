#include "models/shapes/hare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/frames.h"

namespace enc::models {
namespace {

// ---- the shape, as a field: negative inside, about the distance outside; mm
// -----------------------------------------------------------------------------

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

// A rod with round ends, of one radius at a and another at b.
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
  const Vec3 p(at.x(), std::abs(at.y()), at.z());                        // left and right are the same
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

// ---- its surface: one vertex in each cell that the surface crosses, one quad around each crossed edge
// [Gibson 1998, "Constrained elastic surface nets"] ------------------------------------------------

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
      vertex[0] += 12.0;  // so that the origin is under the highest place of the back
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

  // The mean of where the cell's edges are crossed, moved onto the surface.
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

  // Newton's steps down the gradient, within the cell whose lowest corner is `low`.
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
    const std::size_t s = apart(0, 2) <= apart(1, 3) ? 0 : 1;  // along the shorter diagonal
    mesh_.triangles.push_back({q[s], q[s + 1], q[s + 2]});
    mesh_.triangles.push_back({q[s], q[s + 2], q[(s + 3) % 4]});
  }

  std::vector<double> value_;
  std::vector<std::int32_t> vertex_;  // of each cell; -1: none
  Mesh mesh_;
};

}  // namespace

Mesh hare_mesh() { return Net().make(); }

}  // namespace enc::models
