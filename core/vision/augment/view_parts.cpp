#include "core/vision/augment/view_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <vector>

#include "core/shape/surface/mesh_tree.h"
#include "core/vision/stereo/rectify.h"

namespace enc::augment {
namespace {

// Colours at the ends of a gap in a row or a column, weighted by the inverse of the squared distance.
using WeightedColour = std::array<float, 4>;  // r, g, b times the weight; and the weight

// Sweeps one line of pixels, `step` apart, there or back: each unknown pixel gets the last known colour.
void sweep(const Image& image, const Mask& known, std::ptrdiff_t first, std::ptrdiff_t step, int count,
           std::vector<WeightedColour>& sums) {
  std::ptrdiff_t last = -1;
  int since = 0;
  for (int i = 0; i < count; ++i) {
    const std::ptrdiff_t at = first + i * step;
    if (known.on[static_cast<std::size_t>(at)] != 0) {
      last = at;
      since = 0;
      continue;
    }
    ++since;
    if (last < 0) continue;
    const float weight = 1.0F / static_cast<float>(since * since);
    WeightedColour& sum = sums[static_cast<std::size_t>(at)];
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] += weight * static_cast<float>(image.rgb[3 * static_cast<std::size_t>(last) + c]);
    sum[3] += weight;
  }
}

}  // namespace

CleanBackground::CleanBackground(int width, int height, int frames)
    : frames_(frames),
      known_(width, height),
      image_(width, height),
      sum_(image_.rgb.size()),
      count_(known_.on.size()) {}

void CleanBackground::add(const ImageView& frame, const Mask& covered) {
  for (std::size_t i = 0; i < count_.size(); ++i) {
    if (known_.on[i] != 0 || covered.on[i] != 0) continue;
    const std::uint8_t* p = frame.rgb + 3 * i;
    std::uint16_t* sum = sum_.data() + 3 * i;
    int n = count_[i];
    for (std::size_t c = 0; c < 3 && n > 0; ++c)
      if (std::abs(n * p[c] - sum[c]) > n * kAlike) n = 0;
    for (std::size_t c = 0; c < 3; ++c) sum[c] = static_cast<std::uint16_t>((n > 0 ? sum[c] : 0) + p[c]);
    count_[i] = static_cast<std::uint8_t>(++n);
    if (n < frames_) continue;
    for (std::size_t c = 0; c < 3; ++c)
      image_.rgb[3 * i + c] = static_cast<std::uint8_t>((sum[c] + n / 2) / n);
    known_.on[i] = 255;
    any_ = stale_ = true;
  }
}

// A gap is filled from its four sides, so that edges along rows and columns continue behind it.
void CleanBackground::fill() {
  std::vector<WeightedColour> sums(count_.size());
  const std::ptrdiff_t width = image_.width, height = image_.height;
  for (std::ptrdiff_t y = 0; y < height; ++y) {
    sweep(image_, known_, y * width, 1, image_.width, sums);
    sweep(image_, known_, (y + 1) * width - 1, -1, image_.width, sums);
  }
  for (std::ptrdiff_t x = 0; x < width; ++x) {
    sweep(image_, known_, x, width, image_.height, sums);
    sweep(image_, known_, (height - 1) * width + x, -width, image_.height, sums);
  }
  for (std::size_t i = 0; i < count_.size(); ++i)
    for (std::size_t c = 0; c < 3 && known_.on[i] == 0; ++c)
      image_.rgb[3 * i + c] =
          sums[i][3] > 0.0F ? static_cast<std::uint8_t>(sums[i][c] / sums[i][3] + 0.5F) : std::uint8_t{0};
}

const Image& CleanBackground::image() {
  if (stale_) fill();
  stale_ = false;
  return image_;
}

namespace {

constexpr float kDark = 0.72F;  // dark field of a chequerboard, and sides of a button

// A grid of (across + 1) x (down + 1) corners, row by row; each field is two triangles.
void add_grid(int across, int down, bool chequered, Facets& facets) {
  const auto first = static_cast<std::int32_t>(facets.corners.size()) - (across + 1) * (down + 1);
  for (int j = 0; j < down; ++j)
    for (int i = 0; i < across; ++i) {
      const std::int32_t a = first + j * (across + 1) + i, b = a + across + 1;
      const float shade = chequered && (i + j) % 2 != 0 ? kDark : 1.0F;
      facets.triangles.push_back({{a, a + 1, b + 1}, shade});
      facets.triangles.push_back({{a, b + 1, b}, shade});
    }
}

Facets of(const Plane&) {
  constexpr int kFields = 6;
  Facets facets;
  for (int j = 0; j <= kFields; ++j)
    for (int i = 0; i <= kFields; ++i)
      facets.corners.emplace_back(kPatch * (static_cast<double>(i) / kFields - 0.5),
                                  kPatch * (static_cast<double>(j) / kFields - 0.5), 0.0);
  add_grid(kFields, kFields, true, facets);
  return facets;
}

Facets of(const Sphere& sphere) {
  constexpr int kAround = 32, kDown = 16;
  Facets facets;
  for (int j = 0; j <= kDown; ++j)
    for (int i = 0; i <= kAround; ++i) {
      const double polar = M_PI * j / kDown, azimuth = 2.0 * M_PI * i / kAround;
      facets.corners.emplace_back(
          Vec3(sphere.radius * Vec3(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                                    std::cos(polar))));
    }
  add_grid(kAround, kDown, false, facets);
  return facets;
}

// The face of the button, then a side at each edge.
Facets of(const Button& button) {
  Facets facets;
  const double x = 0.5 * button.width, y = 0.5 * button.height;
  for (const double z : {0.0, -button.thickness})
    for (const auto& [u, v] : {std::pair{-x, -y}, {x, -y}, {x, y}, {-x, y}})
      facets.corners.emplace_back(u, v, z);
  facets.triangles = {{{0, 1, 2}, 1.0F}, {{0, 2, 3}, 1.0F}};
  for (std::int32_t i = 0; i < 4; ++i) {
    const std::int32_t next = (i + 1) % 4;
    facets.triangles.push_back({{i, i + 4, next + 4}, kDark});
    facets.triangles.push_back({{i, next + 4, next}, kDark});
  }
  return facets;
}

Facets of(const MeshSurface& surface) {
  Facets facets;
  for (const auto& [x, y, z] : surface.tree->mesh().vertices) facets.corners.emplace_back(x, y, z);
  for (const auto& corner : surface.tree->mesh().triangles) facets.triangles.push_back({corner, 1.0F});
  return facets;
}

struct Corner {
  double column, row, near;  // px, px, 1/m
};

double edge(const Corner& a, const Corner& b, double x, double y) {
  return (b.column - a.column) * (y - a.row) - (b.row - a.row) * (x - a.column);
}

// Interpolates 1 / depth, which is linear in the image.
void fill(const std::array<Corner, 3>& c, float shade, DepthPicture& seen) {
  const double area = edge(c[0], c[1], c[2].column, c[2].row);
  if (area == 0.0) return;
  const auto [left, right] = std::minmax({c[0].column, c[1].column, c[2].column});
  const auto [top, bottom] = std::minmax({c[0].row, c[1].row, c[2].row});
  const int x0 = static_cast<int>(std::ceil(std::max(0.0, left)));
  const int x1 = static_cast<int>(std::floor(std::min(right, seen.width - 1.0)));
  const int y1 = static_cast<int>(std::floor(std::min(bottom, seen.height - 1.0)));
  for (int y = static_cast<int>(std::ceil(std::max(0.0, top))); y <= y1; ++y)
    for (int x = x0; x <= x1; ++x) {
      const double u = edge(c[1], c[2], x, y) / area, v = edge(c[2], c[0], x, y) / area, w = 1.0 - u - v;
      if (u < 0.0 || v < 0.0 || w < 0.0) continue;
      const auto at =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(seen.width) + static_cast<std::size_t>(x);
      const auto depth = static_cast<float>(1.0 / (u * c[0].near + v * c[1].near + w * c[2].near));
      if (depth >= seen.depth[at]) continue;
      seen.depth[at] = depth;
      seen.shade[at] = shade;
    }
}

}  // namespace

Facets facets_of(const Surface& surface) {
  return std::visit([](const auto& shape) { return of(shape); }, surface.shape());
}

DepthPicture::DepthPicture(int w, int h)
    : width(w),
      height(h),
      depth(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)),
      shade(depth.size()) {
  clear();
}

void DepthPicture::clear() { std::fill(depth.begin(), depth.end(), std::numeric_limits<float>::infinity()); }

void draw(const Facets& facets, const RectifiedPair& pair, const Pose<'C', 'O'>& X_CO, DepthPicture& seen) {
  std::vector<Vec3> in_C;
  std::vector<Corner> corners;
  for (const Point<'O'>& corner : facets.corners) {
    const Point<'C'> p = X_CO * corner;
    const Triplet at = seen_at(pair, p);
    in_C.emplace_back(p.e());
    corners.push_back({at.column, at.row, at.disparity / (pair.focal * pair.baseline)});
  }
  for (const Facets::Triangle& triangle : facets.triangles) {
    std::array<Corner, 3> c{};
    std::array<Vec3, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      c[i] = corners[static_cast<std::size_t>(triangle.corner[i])];
      p[i] = in_C[static_cast<std::size_t>(triangle.corner[i])];
    }
    if (!(c[0].near > 0.0 && c[1].near > 0.0 && c[2].near > 0.0)) continue;
    // The light comes from the camera.
    const Vec3 normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized();
    const double light = 0.5 + 0.5 * std::abs(normal.dot(p[0].normalized()));
    fill(c, triangle.shade * static_cast<float>(light), seen);
  }
}

namespace {

constexpr int kAround = 24;  // points of a circle: they lose less than 1 % of its radius

double cross(const Pixel& o, const Pixel& a, const Pixel& b) {
  return (a.column - o.column) * (b.row - o.row) - (a.row - o.row) * (b.column - o.column);
}

// Convex hull in order, by Andrew's chain.
std::vector<Pixel> hull(std::vector<Pixel> points) {
  if (points.size() < 3) return {};
  std::sort(points.begin(), points.end(), [](const Pixel& a, const Pixel& b) {
    return a.column < b.column || (a.column == b.column && a.row < b.row);
  });
  std::vector<Pixel> out;
  const auto take = [&](const Pixel& p, std::size_t least) {
    while (out.size() >= least + 2 && cross(out[out.size() - 2], out.back(), p) <= 0.0) out.pop_back();
    out.push_back(p);
  };
  for (const Pixel& p : points) take(p, 0);
  const std::size_t lower = out.size() - 1;
  for (auto p = points.rbegin() + 1; p != points.rend(); ++p) take(*p, lower);
  out.pop_back();
  return out;
}

std::vector<Pixel> grown(const std::vector<Pixel>& polygon, double margin) {
  std::vector<Pixel> points;
  const double out = margin / std::cos(M_PI / kAround);  // the polygon encloses the circle
  for (const Pixel& p : polygon)
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * M_PI * i / kAround;
      points.push_back({p.column + out * std::cos(angle), p.row + out * std::sin(angle)});
    }
  return hull(std::move(points));
}

void fill(const std::vector<Pixel>& polygon, Mask& mask) {
  if (polygon.empty()) return;
  const auto by_row = [](const Pixel& a, const Pixel& b) { return a.row < b.row; };
  const auto [top, bottom] = std::minmax_element(polygon.begin(), polygon.end(), by_row);
  const int last = static_cast<int>(std::floor(std::min(bottom->row, mask.height - 1.0)));
  for (int y = static_cast<int>(std::ceil(std::max(0.0, top->row))); y <= last; ++y) {
    double from = mask.width, to = -1.0;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Pixel &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if ((a.row > y) == (b.row > y)) continue;
      const double x = a.column + (y - a.row) / (b.row - a.row) * (b.column - a.column);
      from = std::min(from, x);
      to = std::max(to, x);
    }
    const int x0 = static_cast<int>(std::ceil(std::max(0.0, from)));
    const int x1 = static_cast<int>(std::floor(std::min(to, mask.width - 1.0)));
    if (x0 <= x1) std::fill(mask.row(y) + x0, mask.row(y) + x1 + 1, std::uint8_t{255});
  }
}

// Points whose convex hull is the part, in C. For a ball, those are the points in which rays from the camera
// touch it.
std::vector<Vec3> corners(const ArmPart& part, const Pose<'C', 'W'>& X_CW) {
  const Vec3 middle = (X_CW * part.middle).e();
  const Mat3 axes = X_CW.q().toRotationMatrix() * part.axes;
  std::vector<Vec3> points;
  if (part.form == PartForm::box) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
      points.emplace_back(middle + axes * sign.cwiseProduct(part.half));
    }
    return points;
  }
  const auto circle = [&](const Vec3& at, const Vec3& a, const Vec3& b) {
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * M_PI * i / kAround;
      points.emplace_back(at + std::cos(angle) * a + std::sin(angle) * b);
    }
  };
  const double radius = part.half.x();
  for (const double end : {-1.0, 1.0}) {
    const Vec3 at = middle + end * part.half.z() * axes.col(2);
    if (part.form == PartForm::cylinder) {
      circle(at, radius * axes.col(0), radius * axes.col(1));
      continue;
    }
    const double share = radius * radius / at.squaredNorm();
    if (share >= 1.0) continue;  // the camera is inside
    const Vec3 a = at.unitOrthogonal(), b = at.normalized().cross(a);
    const double rim = radius * std::sqrt(1.0 - share);
    circle((1.0 - share) * at, rim * a, rim * b);
  }
  return points;
}

}  // namespace

void cover(const RectifiedPair& pair, const Pose<'C', 'W'>& X_CW, const ArmPart& part, double margin,
           Mask& mask) {
  std::vector<Pixel> seen;
  for (const Vec3& corner : corners(part, X_CW)) {
    const Triplet at = seen_at(pair, Point<'C'>(corner));
    if (at.disparity > 0.0) seen.push_back({at.column, at.row});
  }
  fill(grown(hull(std::move(seen)), margin), mask);
}

}  // namespace enc::augment
