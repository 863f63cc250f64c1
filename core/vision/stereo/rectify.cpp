#include "core/vision/stereo/rectify.h"

#include <cmath>

#include "core/base/error.h"

namespace enc {
namespace {

struct RayDerivatives {
  Ray ray;
  double xx, xy, yy;  // derivatives of that ray; the matrix is symmetric
};

RayDerivatives bend(const Lens& lens, const Ray& ray) {
  const auto& [k1, k2, p1, p2, k3] = lens.distortion;
  const double x = ray.x, y = ray.y;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  const double slope = 2.0 * (k1 + r2 * (2.0 * k2 + r2 * 3.0 * k3));  // d radial / dx = slope x
  return {{x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
           y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y},
          radial + slope * x * x + 2.0 * p1 * y + 6.0 * p2 * x,
          slope * x * y + 2.0 * p1 * x + 2.0 * p2 * y,
          radial + slope * y * y + 6.0 * p1 * y + 2.0 * p2 * x};
}

}  // namespace

Pixel project(const Lens& lens, const Ray& ray) {
  const Ray bent = bend(lens, ray).ray;
  return {lens.centre_x + lens.focal_x * bent.x, lens.centre_y + lens.focal_y * bent.y};
}

Ray ray_of(const Lens& lens, const Pixel& pixel) {
  constexpr int kRounds = 30;
  constexpr double kExact = 1e-12;
  const Ray wanted{(pixel.column - lens.centre_x) / lens.focal_x, (pixel.row - lens.centre_y) / lens.focal_y};
  Ray ray = wanted;
  for (int i = 0; i < kRounds; ++i) {  // Newton
    const RayDerivatives now = bend(lens, ray);
    const double dx = wanted.x - now.ray.x, dy = wanted.y - now.ray.y;
    if (std::abs(dx) + std::abs(dy) < kExact) return ray;
    const double det = now.xx * now.yy - now.xy * now.xy;
    if (!(det > 0.0)) break;  // beyond the fold
    ray.x += (now.yy * dx - now.xy * dy) / det;
    ray.y += (now.xx * dy - now.xy * dx) / det;
  }
  return {};
}

namespace {

bool usable(const Lens& lens) {
  bool good = lens.focal_x > 0.0 && lens.focal_y > 0.0 && std::isfinite(lens.focal_x) &&
              std::isfinite(lens.focal_y) && std::isfinite(lens.centre_x) && std::isfinite(lens.centre_y);
  for (const double k : lens.distortion) good = good && std::isfinite(k);
  return good;
}

void check(const StereoRig& rig) {
  constexpr std::int64_t kLargest = 8192;  // px, a side
  constexpr double kApart = 0.966;         // cosine of half of 30 degrees
  if (rig.width < 1 || rig.height < 1 || rig.width > kLargest || rig.height > kLargest)
    throw Error("an image has 1 to 8192 px along each side", "camera.width");
  if (!usable(rig.left))
    throw Error("the lens needs a positive focal length and finite numbers", "camera.left");
  if (!usable(rig.right))
    throw Error("the lens needs a positive focal length and finite numbers", "camera.right");
  const bool right = rig.X_CD.valid() && rig.X_CD.p().x() > 0.9 * rig.X_CD.p().norm();
  if (!right)
    throw Error("the right camera must stand to the right of the left one, along its x", "camera.X_CD");
  if (std::abs(rig.X_CD.q().w()) < kApart)
    throw Error("the cameras look apart by more than 30 degrees", "camera.X_CD");
}

bool same(const Lens& a, const Lens& b) {
  return a.focal_x == b.focal_x && a.focal_y == b.focal_y && a.centre_x == b.centre_x &&
         a.centre_y == b.centre_y;
}

bool aligned(const StereoRig& rig) {
  const std::array<double, 5> none{};
  return rig.left.distortion == none && rig.right.distortion == none && same(rig.left, rig.right) &&
         rig.left.focal_x == rig.left.focal_y && rig.X_CD.q().coeffs().head<3>().isZero(0.0) &&
         rig.X_CD.p().y() == 0.0 && rig.X_CD.p().z() == 0.0;
}

Ray turned(const Mat3& by, const Ray& ray) {
  const Vec3 v = by * Vec3(ray.x, ray.y, 1.0);
  return v.z() > 0.0 ? Ray{v.x() / v.z(), v.y() / v.z()} : Ray{};
}

}  // namespace

Rectifier::Rectifier(const StereoRig& rig)
    : width_(static_cast<int>(rig.width)), height_(static_cast<int>(rig.height)), lens_{rig.left, rig.right} {
  check(rig);
  pair_.baseline = rig.X_CD.p().norm();
  pair_.focal = 0.25 * (rig.left.focal_x + rig.left.focal_y + rig.right.focal_x + rig.right.focal_y);
  if (aligned(rig)) {
    turn_ = {Mat3::Identity(), Mat3::Identity()};
    pair_.centre_x = rig.left.centre_x;
    pair_.centre_y = rig.left.centre_y;
    return;
  }
  // Turn each camera by half of the rotation between them, then both so that x is along the baseline.
  Quat between(rig.X_CD.q());
  if (between.w() < 0.0) between.coeffs() *= -1.0;
  const Mat3 half = Quat::Identity().slerp(0.5, between).toRotationMatrix();
  const Vec3 along = half.transpose() * rig.X_CD.p();
  pair_.turn = half * Quat::FromTwoVectors(Vec3::UnitX(), along).toRotationMatrix();
  turn_[0] = pair_.turn;
  turn_[1] = between.toRotationMatrix().transpose() * pair_.turn;
  choose_centre();
  make_map();
}

// The rectified image's middle is the middle of the rectified eight corners of both raw images.
void Rectifier::choose_centre() {
  pair_.centre_x = pair_.centre_y = 0.0;
  double x = 0.0, y = 0.0;
  const double right = width_ - 1, low = height_ - 1;
  for (const Side side : {Side::left, Side::right})
    for (const Pixel& corner : {Pixel{0, 0}, Pixel{right, 0}, Pixel{0, low}, Pixel{right, low}}) {
      const Pixel to = rectified(side, corner);
      if (!std::isfinite(to.column) || !std::isfinite(to.row))
        throw Error("its distortion folds within the image",
                    side == Side::left ? "camera.left" : "camera.right");
      x += to.column / 8.0;
      y += to.row / 8.0;
    }
  pair_.centre_x = 0.5 * right - x;
  pair_.centre_y = 0.5 * low - y;
}

Pixel Rectifier::rectified(Side side, const Pixel& raw) const {
  const auto i = static_cast<std::size_t>(side);
  const Ray ray = turned(turn_[i].transpose(), ray_of(lens_[i], raw));
  return {pair_.centre_x + pair_.focal * ray.x, pair_.centre_y + pair_.focal * ray.y};
}

Pixel Rectifier::raw(Side side, const Pixel& rectified) const {
  const auto i = static_cast<std::size_t>(side);
  const Ray ray{(rectified.column - pair_.centre_x) / pair_.focal,
                (rectified.row - pair_.centre_y) / pair_.focal};
  return project(lens_[i], turned(turn_[i], ray));
}

void Rectifier::make_map() {
  for (const Side side : {Side::left, Side::right}) {
    std::vector<SourcePixel>& map = map_[static_cast<std::size_t>(side)];
    map.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), SourcePixel{});
    std::size_t i = 0;
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x, ++i) {
        const Pixel from = raw(side, {static_cast<double>(x), static_cast<double>(y)});
        if (!(from.column >= 0.0 && from.row >= 0.0 && from.column < width_ - 1 && from.row < height_ - 1))
          continue;
        const int column = static_cast<int>(from.column * 256.0 + 0.5),
                  row = static_cast<int>(from.row * 256.0 + 0.5);
        if (column / 256 >= width_ - 1 || row / 256 >= height_ - 1) continue;  // rounded up
        map[i] = {static_cast<std::int16_t>(column / 256), static_cast<std::int16_t>(row / 256),
                  static_cast<std::uint8_t>(column % 256), static_cast<std::uint8_t>(row % 256)};
      }
  }
}

void Rectifier::part(Side side, const ImageView& raw, const Region& wanted, Image& rectified) const {
  const std::vector<SourcePixel>& map = map_[static_cast<std::size_t>(side)];
  const Region cut = wanted.cut({0, 0, width_, height_});
  const std::size_t next = 3 * static_cast<std::size_t>(raw.width);
  for (int y = cut.y0; y < cut.y1; ++y) {
    std::uint8_t* to = rectified.at(cut.x0, y);
    if (map.empty()) {
      std::copy_n(raw.at(cut.x0, y), 3 * std::max(0, cut.width()), to);
      continue;
    }
    const SourcePixel* from =
        map.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + cut.x0;
    for (int x = cut.x0; x < cut.x1; ++x, ++from, to += 3) {
      if (from->x < 0) {
        to[0] = to[1] = to[2] = 0;
        continue;
      }
      const std::uint8_t* p = raw.at(from->x, from->y);
      const unsigned right = from->right, down = from->down;
      for (std::size_t c = 0; c < 3; ++c) {
        const unsigned above = p[c] * (256U - right) + p[c + 3] * right;
        const unsigned below = p[c + next] * (256U - right) + p[c + next + 3] * right;
        to[c] = static_cast<std::uint8_t>((above * (256U - down) + below * down + 32768U) >> 16U);
      }
    }
  }
}

Point<'C'> triangulate(const RectifiedPair& pair, const Triplet& at) {
  if (!(at.disparity > 0.0)) return {};
  const double each = pair.baseline / at.disparity;  // m per pixel there
  return Point<'C'>(
      Vec3(pair.turn * (each * Vec3(at.column - pair.centre_x, at.row - pair.centre_y, pair.focal))));
}

Triplet seen_at(const RectifiedPair& pair, const Point<'C'>& point) {
  const Vec3 p = pair.turn.transpose() * point.e();
  if (!(p.z() > 0.0)) return {};
  const double scale = pair.focal / p.z();
  return {pair.centre_x + scale * p.x(), pair.centre_y + scale * p.y(), scale * pair.baseline};
}

Mat3 slope_of(const RectifiedPair& pair, const Triplet& at) {
  if (!(at.disparity > 0.0)) return Mat3::Constant(kUnset);
  const double each = pair.baseline / at.disparity;
  Mat3 slope;
  slope << each, 0.0, -each * (at.column - pair.centre_x) / at.disparity,  //
      0.0, each, -each * (at.row - pair.centre_y) / at.disparity,          //
      0.0, 0.0, -each * pair.focal / at.disparity;
  return pair.turn * slope;
}

}  // namespace enc
