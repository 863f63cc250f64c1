// Builds the tree of a mesh. The triangles are sorted such that every run of 8, 64, 512... of them lies close
// together: node by node, in the node's own principal axes, halved across the longest extent. What is
// computed here decides the speed of a search, not its answer.
#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/shape/surface/mesh_normals.h"
#include "core/shape/surface/mesh_tree.h"

namespace enc {

class MeshTree::Builder {
 public:
  explicit Builder(MeshTree& tree) : tree_(tree) {
    place();
    const std::size_t count = tree.mesh_.triangles.size();
    items_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) {
      const auto& t = tree.mesh_.triangles[i];
      Vec3f sum = Vec3f::Zero();
      for (const std::int32_t v : t) sum += vertex(v);
      items_.push_back({sum / 3.0F, static_cast<std::int32_t>(i)});
    }
    const std::size_t leaves = (count + kWay - 1) / kWay;
    tree.leaves_.resize(leaves);
    for (std::size_t under = 1; under < leaves || tree.levels_ == 0; under *= kWay) ++tree.levels_;
    std::size_t nodes = 0;
    for (int level = tree.levels_ - 1; level >= 0; --level) {
      tree.level_[static_cast<std::size_t>(level)] = static_cast<std::int32_t>(nodes);
      const std::size_t held = triangles_under(level) * kWay;
      nodes += (count + held - 1) / held;
    }
    tree.nodes_.resize(nodes);
    build(tree.levels_ - 1, 0, items_.begin(), items_.end());
  }

 private:
  using Vec3f = Eigen::Vector3f;
  struct Item {
    Vec3f middle;
    std::int32_t triangle;
  };
  using Items = std::vector<Item>::iterator;

  // Triangles under one child of a node of a level, where it is full.
  static std::size_t triangles_under(int level) {
    return std::size_t{kWay} << (3U * static_cast<unsigned>(level));
  }
  [[nodiscard]] const Vec3f& vertex(std::int32_t i) const { return vertices_[static_cast<std::size_t>(i)]; }
  [[nodiscard]] const std::array<std::int32_t, 3>& corners(const Item& item) const {
    return tree_.mesh_.triangles[static_cast<std::size_t>(item.triangle)];
  }

  void place() {
    Vec3 low = Vec3::Constant(INFINITY);
    Vec3 high = -low;
    for (const auto& v : tree_.mesh_.vertices) {
      const Eigen::Map<const Vec3> p(v.data());
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    tree_.centre_ = 0.5 * (low + high);
    vertices_.reserve(tree_.mesh_.vertices.size());
    double square = 0.0;
    for (const auto& v : tree_.mesh_.vertices) {
      const Vec3 p = Eigen::Map<const Vec3>(v.data()) - tree_.centre_;
      square = std::max(square, p.squaredNorm());
      vertices_.emplace_back(p.cast<float>());
    }
    tree_.radius_ = std::sqrt(square) * (1.0 + 1e-12);
  }

  // Principal axes of the corners, longest first; rows.
  [[nodiscard]] Eigen::Matrix3f axes_of(Items first, Items last) const {
    const Vec3f origin = first->middle;
    Vec3 sum = Vec3::Zero();
    Mat3 squares = Mat3::Zero();
    for (Items i = first; i != last; ++i)
      for (const std::int32_t v : corners(*i)) {
        const Vec3 p = (vertex(v) - origin).cast<double>();
        sum += p;
        squares += p * p.transpose();
      }
    const double count = 3.0 * static_cast<double>(last - first);
    Eigen::SelfAdjointEigenSolver<Mat3> solver;
    solver.computeDirect(squares / count - (sum / count) * (sum / count).transpose());
    const Mat3 axes = solver.eigenvectors().rowwise().reverse().transpose();
    // Where the directions are not told apart, any will do, but they must be a frame.
    const bool good = axes.allFinite() && (axes * axes.transpose() - Mat3::Identity()).norm() < 1e-6;
    return (good ? axes : Mat3(Mat3::Identity())).cast<float>();
  }

  // Sorts a range into `parts` runs of `size` (the last may be shorter).
  void split(Items first, Items last, std::size_t parts, std::size_t size, const Eigen::Matrix3f& axes) {
    if (parts <= 1) return;
    Vec3f low = Vec3f::Constant(INFINITY);
    Vec3f high = -low;
    for (Items i = first; i != last; ++i) {
      const Vec3f p = axes * i->middle;
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    int longest = 0;
    (high - low).maxCoeff(&longest);
    const Vec3f axis = axes.row(longest).transpose();
    const Items middle = first + static_cast<std::ptrdiff_t>(parts / 2 * size);
    std::nth_element(first, middle, last, [&](const Item& a, const Item& b) {
      const float x = axis.dot(a.middle);
      const float y = axis.dot(b.middle);
      return x < y || (x == y && a.triangle < b.triangle);
    });
    split(first, middle, parts / 2, size, axes);
    split(middle, last, parts - parts / 2, size, axes);
  }

  void build(int level, std::size_t number, Items first, Items last) {
    const auto count = static_cast<std::size_t>(last - first);
    const std::size_t size = triangles_under(level);
    const std::size_t parts = (count + size - 1) / size;
    const Eigen::Matrix3f axes = axes_of(first, last);
    split(first, last, parts, size, axes);
    const auto above = static_cast<std::size_t>(tree_.level_[static_cast<std::size_t>(level)]);
    Node& node = tree_.nodes_[above + number];
    const Vec3f origin = first->middle;
    for (std::size_t x = 0; x < 3; ++x) {
      const Vec3f axis = axes.row(static_cast<int>(x)).transpose();
      node.axes[x] = {axis.x(), axis.y(), axis.z()};
      node.shift[x] = -axis.dot(origin);
      node.low[x].fill(INFINITY);
      node.high[x].fill(-INFINITY);
    }
    for (std::size_t i = 0; i < parts; ++i) {
      const Items from = first + static_cast<std::ptrdiff_t>(i * size);
      const Items to = first + static_cast<std::ptrdiff_t>(std::min(count, (i + 1) * size));
      enclose(node, i, axes, origin, from, to);
      if (level > 0) {
        build(level - 1, kWay * number + i, from, to);
      } else {
        fill(tree_.leaves_[kWay * number + i], from, to);
      }
    }
  }

  void enclose(Node& node, std::size_t child, const Eigen::Matrix3f& axes, const Vec3f& origin, Items first,
               Items last) const {
    Vec3f low = Vec3f::Constant(INFINITY);
    Vec3f high = -low;
    for (Items i = first; i != last; ++i)
      for (const std::int32_t v : corners(*i)) {
        const Vec3f p = axes * (vertex(v) - origin);
        low = low.cwiseMin(p);
        high = high.cwiseMax(p);
      }
    for (std::size_t x = 0; x < 3; ++x) {
      node.low[x][child] = low[static_cast<int>(x)];
      node.high[x][child] = high[static_cast<int>(x)];
    }
  }

  void fill(Leaf& leaf, Items first, Items last) const {
    for (std::size_t lane = 0; lane < kWay; ++lane) {
      // A leaf that is not full repeats its last triangle.
      const Item& item = *std::min(first + static_cast<std::ptrdiff_t>(lane), last - 1);
      std::array<Vec3, 3> c = tree_.corners(item.triangle);
      std::size_t longest = 0;
      for (std::size_t i = 1; i < 3; ++i)
        if ((c[(i + 1) % 3] - c[i]).squaredNorm() > (c[(longest + 1) % 3] - c[longest]).squaredNorm())
          longest = i;
      std::rotate(c.begin(), c.begin() + static_cast<std::ptrdiff_t>(longest), c.end());
      const Vec3 u = (c[1] - c[0]).stableNormalized();
      const Vec3 ac = c[2] - c[0];
      const Vec3 up = ac - u.dot(ac) * u;
      const double height = up.norm();
      const Vec3 v = height > 1e-15 * ac.norm() ? Vec3(up / height) : u.unitOrthogonal();
      const Vec3 a = c[0] - tree_.centre_;
      for (std::size_t x = 0; x < 3; ++x) {
        leaf.a[x][lane] = static_cast<float>(a[static_cast<int>(x)]);
        leaf.u[x][lane] = static_cast<float>(u[static_cast<int>(x)]);
        leaf.v[x][lane] = static_cast<float>(v[static_cast<int>(x)]);
      }
      leaf.bx[lane] = static_cast<float>(u.dot(c[1] - c[0]));
      leaf.cx[lane] = static_cast<float>(u.dot(ac));
      leaf.cy[lane] = static_cast<float>(height);
      leaf.triangle[lane] = item.triangle;
    }
  }

  MeshTree& tree_;
  std::vector<Vec3f> vertices_;  // from the centre
  std::vector<Item> items_;
};

MeshTree::MeshTree(const Mesh& mesh)
    : mesh_(mesh), neighbours_(neighbours_of(mesh)), vertex_normals_(vertex_normals_of(mesh)) {
  Builder(*this);
}

}  // namespace enc
