#include "core/shape/surface/mesh_tree.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include <Eigen/Eigenvalues>

#include "core/shape/surface/mesh.h"
#include "core/shape/surface/triangle.h"

namespace enc {
// ---- Builds the tree of a mesh. The triangles are sorted so that every run of 8, 64, 512... of them lies
// close together: node by node, in the node's own principal axes, halved across the longest extent. The order
// affects the speed of a search, not its answer.

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

  // Number of triangles under one full child of a node of this level.
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
    // Equal extents leave the directions arbitrary, but they must form a frame.
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

namespace {

// Eight floats side by side, as generic vectors of the compiler: two SSE registers on any x86-64, so that
// every machine computes the same bits.
struct Lanes {
  using Four = float __attribute__((vector_size(16)));
  using Bits = int __attribute__((vector_size(16)));
  Four lo, hi;

  static Lanes all(float x) { return {Four{x, x, x, x}, Four{x, x, x, x}}; }
  // Loads and stores eight consecutive floats.
  static Lanes load(const float* p) {
    Lanes x;
    std::memcpy(&x, p, sizeof x);
    return x;
  }
  void store(float* p) const { std::memcpy(p, this, sizeof *this); }
  friend Lanes operator+(Lanes a, Lanes b) { return {a.lo + b.lo, a.hi + b.hi}; }
  friend Lanes operator-(Lanes a, Lanes b) { return {a.lo - b.lo, a.hi - b.hi}; }
  friend Lanes operator*(Lanes a, Lanes b) { return {a.lo * b.lo, a.hi * b.hi}; }
  friend Lanes operator/(Lanes a, Lanes b) { return {a.lo / b.lo, a.hi / b.hi}; }
  friend Lanes min(Lanes a, Lanes b) { return {a.lo < b.lo ? a.lo : b.lo, a.hi < b.hi ? a.hi : b.hi}; }
  friend Lanes max(Lanes a, Lanes b) { return {a.lo > b.lo ? a.lo : b.lo, a.hi > b.hi ? a.hi : b.hi}; }

  // One truth value for each lane.
  struct Mask {
    Bits lo, hi;
    friend Mask operator&(Mask a, Mask b) { return {a.lo & b.lo, a.hi & b.hi}; }
    // Bit i is lane i.
    [[nodiscard]] unsigned bits() const {
#ifdef __SSE2__
      return static_cast<unsigned>(__builtin_ia32_movmskps(reinterpret_cast<Four>(lo)) |
                                   (__builtin_ia32_movmskps(reinterpret_cast<Four>(hi)) << 4));
#else
      unsigned set = 0;
      for (int i = 0; i < 4; ++i) set |= (lo[i] != 0 ? 1U << i : 0U) | (hi[i] != 0 ? 16U << i : 0U);
      return set;
#endif
    }
  };
  friend Mask operator<=(Lanes a, Lanes b) { return {a.lo <= b.lo, a.hi <= b.hi}; }
  // 0 in lanes where the mask is true, else `a`.
  friend Lanes unless(Mask yes, Lanes a) {
    const Four zero{};
    return {yes.lo ? zero : a.lo, yes.hi ? zero : a.hi};
  }
};

constexpr double kFarthest = 1e9;  // m; squares stay finite in float

// Squared distance cut to 40 binary digits, so that equal distances compare as equal.
double coarse(double square, double least) {
  constexpr std::uint64_t kKept = ~((1ULL << 13U) - 1U);
  return square < least ? 0.0 : std::bit_cast<double>(std::bit_cast<std::uint64_t>(square) & kKept);
}

Lanes square(Lanes x) { return x * x; }

using Point3f = std::array<float, 3>;

}  // namespace

// The search. A float distance of a node or leaf is wrong by at most `pad`. The search keeps every candidate
// that could be nearest within that error, so its answer equals that of trying every triangle in double.
struct MeshTree::Search {
  const MeshTree& tree;
  Vec3 p;                                                 // in O
  Point3f q;                                              // p relative to the centre of the mesh
  double pad;                                             // m: largest float error here
  double least;                                           // m^2: below it, all distances are 0
  double best = std::numeric_limits<double>::infinity();  // coarse square of the distance
  std::int32_t triangle = -1;
  OnTriangle at;
  float limit = std::numeric_limits<float>::max();  // m^2: a larger float distance is certainly larger

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
    while (open != 0) {  // the nearest child first: it often excludes the rest
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
    // Distances to the edges a to b, a to c, b to c.
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
    // Each level has at most seven pending nodes beside the one that is entered.
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

  [[nodiscard]] SurfacePoint answer() const {
    const auto& ids = tree.mesh_.triangles[static_cast<std::size_t>(triangle)];
    Vec3 n = Vec3::Zero();
    if (at.part.kind == Part::corner) n = tree.vertex_normal(ids[at.part.i]);
    if (at.part.kind == Part::edge) n = tree.edge_normal(triangle, at.part.i);
    if (n.isZero(0.0)) n = tree.face_normal(triangle);
    const double side = n.dot(p - at.point);
    return {Point<'O'>(at.point), Vec<'O'>(n), std::copysign(std::sqrt(at.square), side), triangle};
  }
};

SurfacePoint MeshTree::nearest(const Point<'O'>& p, std::int32_t hint) const noexcept {
  const Vec3 from_centre = p.e() - centre_;
  if (!(from_centre.norm() <= kFarthest)) return {};  // NaN as well
  Search search(*this, p.e(), from_centre);
  if (hint >= 0 && static_cast<std::size_t>(hint) < mesh_.triangles.size()) search.offer(hint);
  search.run();
  return search.triangle >= 0 ? search.answer() : SurfacePoint{};
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
