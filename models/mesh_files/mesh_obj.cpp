// Wavefront OBJ: the lines `v x y z` and `f a b c ...`; all lines that only affect the look are skipped.
#include <algorithm>
#include <charconv>
#include <cmath>

#include <fmt/format.h>

#include "core/base/frames.h"
#include "models/mesh_files/mesh_file.h"
#include "models/schema/wording.h"

namespace enc::models {
namespace {

constexpr std::array<std::string_view, 17> kPassedOver{
    "vt", "vn", "o",   "g",     "s",      "mg",         "usemtl",    "mtllib", "l",
    "p",  "vp", "lod", "bevel", "usemap", "shadow_obj", "trace_obj", "maplib"};

class ObjReader {
 public:
  explicit ObjReader(const MeshBytes& file) : file_(file), text_(file.bytes) {
    if (text_.starts_with(kBom)) at_ = kBom.size();
  }

  FileMesh read() {
    while (at_ < text_.size()) {
      take_line();
      const std::string_view what = word();
      if (what.empty()) continue;
      if (what == "v") {
        vertex();
      } else if (what == "f") {
        face();
      } else if (std::find(kPassedOver.begin(), kPassedOver.end(), what) == kPassedOver.end()) {
        fail(fmt::format(
            "{} is nothing a triangle mesh has; expected lines 'v x y z' and 'f a b c'; export the "
            "surface as polygons",
            quoted(std::string(what))));
      }
    }
    return {std::move(mesh_), std::move(lines_), {}};
  }

 private:
  // Takes the next line into line_, without its comment.
  void take_line() {
    const std::size_t end = std::min(text_.find('\n', at_), text_.size());
    line_ = text_.substr(at_, end - at_);
    line_start_ = word_start_ = at_;
    at_ = end + 1;
    ++number_;
    line_ = line_.substr(0, line_.find('#'));
    while (!line_.empty() && is_space(line_.back())) line_.remove_suffix(1);
    cursor_ = 0;
    if (line_.ends_with('\\')) {
      word_start_ = line_start_ + line_.size() - 1;
      fail(
          "a line that goes on in the next is not read; expected one whole statement in a line; join the "
          "two");
    }
  }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
  // Takes the next word of the line; empty at its end.
  std::string_view word() {
    while (cursor_ < line_.size() && is_space(line_[cursor_])) ++cursor_;
    const std::size_t start = cursor_;
    while (cursor_ < line_.size() && !is_space(line_[cursor_])) ++cursor_;
    word_start_ = line_start_ + start;
    return line_.substr(start, cursor_ - start);
  }
  [[noreturn]] void fail(const std::string& what) const { file_.fail_at_text(word_start_, what); }

  void vertex() {
    std::array<double, 3> v{};
    for (double& x : v) {
      const std::string_view text = word();
      if (!read_number(text, x))
        fail(
            fmt::format("{} is no coordinate; expected 'v x y z' with three finite numbers; correct the line",
                        quoted(std::string(text))));
    }
    mesh_.vertices.push_back(v);  // a weight or a colour may follow
  }

  // "7", "7/1", "7//3", "7/1/3" or "-1"; only the first number is used.
  std::int32_t corner(std::string_view text) const {
    const std::string_view first = text.substr(0, text.find('/'));
    std::int64_t index = 0;
    const auto [end, bad] = std::from_chars(first.data(), first.data() + first.size(), index);
    const bool rest_good = text.find_first_not_of("-0123456789/") == std::string_view::npos;
    if (bad != std::errc() || end != first.data() + first.size() || !rest_good)
      fail(fmt::format(
          "{} is no corner of a face; expected the number of a vertex, as in 'f 1 2 3' or 'f 1/1/1 ...'; "
          "correct the line",
          quoted(std::string(text))));
    const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
    if (index == 0 || index > count || index < -count)
      fail(fmt::format(
          "vertex {} is not there; expected 1 to {} (or -1 to -{}), those above this line; correct the line",
          index, count, count));
    return static_cast<std::int32_t>(index > 0 ? index - 1 : count + index);
  }

  void face() {
    polygon_.clear();
    const std::size_t start = word_start_;
    for (std::string_view text = word(); !text.empty(); text = word()) polygon_.push_back(corner(text));
    word_start_ = start;
    if (polygon_.size() < 3)
      fail(fmt::format("a face with {} corners; expected at least 3; correct the line", polygon_.size()));
    if (mesh_.triangles.size() + polygon_.size() > kMostTriangles)
      fail(fmt::format("more than {} triangles; expected fewer; make the mesh coarser", kMostTriangles));
    const std::string wrong = add_polygon(mesh_, polygon_);
    if (!wrong.empty()) fail(wrong);
    lines_.resize(mesh_.triangles.size(), number_);
  }

  const MeshBytes& file_;
  std::string_view text_, line_;
  std::size_t at_ = 0, line_start_ = 0, word_start_ = 0, cursor_ = 0;
  std::vector<std::int32_t> polygon_, lines_;
  std::int32_t number_ = 0;  // of the line
  Mesh mesh_;
};

}  // namespace

FileMesh read_obj(const MeshBytes& file) { return ObjReader(file).read(); }

// ---- Polygons of a file as triangles: in their plane, ear by ear [Meisters 1975].

namespace {

constexpr std::size_t kMostConcave = 2'000;  // corners: every side is compared with every other side
constexpr double kWarp = 0.1;                // accepted warp, over the polygon's size
// Least height of an ear over its longest side. If no better ear exists, it may be nearly as flat as
// check_mesh() accepts.
constexpr double kThin = 1e-6, kThinnest = 1e-9;

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }
// Twice the area, positive if the corners turn left.
double turn(const Vec2& a, const Vec2& b, const Vec2& c) { return cross(b - a, c - a); }
double longest(const Vec2& a, const Vec2& b, const Vec2& c) {
  return std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
}

// True if two sides have a common point, ends included.
bool meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto apart = [](double p, double q, double r, double s) {
    return std::max(p, q) < std::min(r, s) || std::max(r, s) < std::min(p, q);
  };
  if (apart(a.x(), b.x(), c.x(), d.x()) || apart(a.y(), b.y(), c.y(), d.y())) return false;
  const auto beside = [](double p, double q) { return (p > 0.0 && q > 0.0) || (p < 0.0 && q < 0.0); };
  return !beside(turn(a, b, c), turn(a, b, d)) && !beside(turn(c, d, a), turn(c, d, b));
}

class Polygon {
 public:
  Polygon(Mesh& mesh, const std::vector<std::int32_t>& corners) : mesh_(mesh) {
    for (const std::int32_t corner : corners)  // a corner named twice in a row counts once
      if (left_.empty() || place(corner) != place(left_.back())) left_.push_back(corner);
    while (left_.size() > 1 && place(left_.front()) == place(left_.back())) left_.pop_back();
  }

  std::string cut() {
    if (left_.size() <= 3) {
      while (left_.size() < 3) left_.push_back(left_.back());  // check_mesh() reports that it has no area
      add(0, 1, 2);
      return {};
    }
    std::string wrong = lay_flat();
    if (!wrong.empty()) return wrong;
    if (convex()) {
      for (std::size_t i = 2; i < left_.size(); ++i) add(0, i - 1, i);
      return {};
    }
    if (left_.size() > kMostConcave)
      return fmt::format(
          "a face with {} corners that is not convex; expected at most {}; export the surface as triangles",
          left_.size(), kMostConcave);
    if (crosses_itself() || !clip_all())
      return "a face whose sides cross or touch each other; expected a simple polygon; export the surface as "
             "triangles";
    return {};
  }

 private:
  [[nodiscard]] Vec3 place(std::int32_t corner) const {
    return Vec3(mesh_.vertices[static_cast<std::size_t>(corner)].data());
  }
  void add(std::size_t a, std::size_t b, std::size_t c) {
    mesh_.triangles.push_back({left_[a], left_[b], left_[c]});
  }

  // Projects onto the plane of the mean normal [Newell 1972], so that the polygon turns left.
  std::string lay_flat() {
    Vec3 normal = Vec3::Zero(), middle = Vec3::Zero();
    const Vec3 first = place(left_[0]);
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const Vec3 a = place(left_[i]) - first, b = place(left_[(i + 1) % left_.size()]) - first;
      normal += a.cross(b);
      middle += a / static_cast<double>(left_.size());
    }
    double size = 0.0;
    for (const std::int32_t corner : left_) size = std::max(size, (place(corner) - first - middle).norm());
    if (!(normal.norm() > kThinnest * size * size))
      return "a face of no area; expected a polygon that encloses some; correct it, or export the surface as "
             "triangles";
    normal.normalize();
    const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
    double warp = 0.0;
    for (const std::int32_t corner : left_) {
      const Vec3 p = place(corner) - first - middle;
      flat_.emplace_back(u.dot(p), v.dot(p));
      warp = std::max(warp, std::abs(normal.dot(p)));
    }
    if (warp > kWarp * size)
      return fmt::format(
          "a face that is not flat: a corner is off its plane by {:.0f} % of its size; expected at most "
          "{:.0f} %; export the surface as triangles",
          100.0 * warp / size, 100.0 * kWarp);
    return {};
  }

  // True if every corner turns left and the polygon goes round once.
  [[nodiscard]] bool convex() const {
    int turns = 0;  // changes of direction along x: two for one round
    for (std::size_t i = 0, n = flat_.size(); i < n; ++i) {
      const Vec2 &a = flat_[i], &b = flat_[(i + 1) % n], &c = flat_[(i + 2) % n];
      if (!(turn(a, b, c) > kThin * longest(a, b, c))) return false;
      turns += (b.x() > a.x()) != (c.x() > b.x()) ? 1 : 0;
    }
    return turns == 2;
  }

  [[nodiscard]] bool crosses_itself() const {
    const std::size_t n = flat_.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = i + 2; k < n; ++k)
        if (!(i == 0 && k == n - 1) && meet(flat_[i], flat_[i + 1], flat_[k], flat_[(k + 1) % n]))
          return true;
    return false;
  }

  // True if the corner at `i` and its neighbours form a triangle without another corner in it or on it.
  [[nodiscard]] bool ear(std::size_t i, double flat) const {
    const std::size_t n = flat_.size(), before = (i + n - 1) % n, after = (i + 1) % n;
    const Vec2 &a = flat_[before], &b = flat_[i], &c = flat_[after];
    if (!(turn(a, b, c) > flat * longest(a, b, c))) return false;
    for (std::size_t k = 0; k < n; ++k) {
      if (k == before || k == i || k == after) continue;
      const Vec2& p = flat_[k];
      if (turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0) return false;
    }
    return true;
  }

  // Starts at the second corner, like a fan; cutting an ear may turn its neighbours into ears.
  bool clip_all() {
    std::size_t i = 1;
    while (left_.size() > 3) {
      std::size_t tried = 0;
      for (const double flat : {kThin, kThinnest})
        for (tried = 0; tried < left_.size() && !ear(i % left_.size(), flat);) ++i, ++tried;
      if (tried == left_.size()) return false;
      i %= left_.size();
      add((i + left_.size() - 1) % left_.size(), i, (i + 1) % left_.size());
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
      flat_.erase(flat_.begin() + static_cast<std::ptrdiff_t>(i));
    }
    add(0, 1, 2);
    return true;
  }

  Mesh& mesh_;
  std::vector<std::int32_t> left_;  // corners that are not cut off yet
  std::vector<Vec2> flat_;          // those corners in their plane
};

}  // namespace

std::string add_polygon(Mesh& mesh, const std::vector<std::int32_t>& polygon) {
  return Polygon(mesh, polygon).cut();
}

}  // namespace enc::models
