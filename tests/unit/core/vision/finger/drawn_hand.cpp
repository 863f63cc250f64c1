#include "tests/unit/core/vision/finger/drawn_hand.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace enc::drawn {

double hashed(std::int64_t x, std::int64_t y, std::int64_t z) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9e3779b97f4a7c15ULL ^
                    static_cast<std::uint64_t>(y) * 0xbf58476d1ce4e5b9ULL ^
                    static_cast<std::uint64_t>(z) * 0x94d049bb133111ebULL;
  h = (h ^ (h >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  h = (h ^ (h >> 27U)) * 0x94d049bb133111ebULL;
  return static_cast<double>((h ^ (h >> 31U)) >> 11U) * 0x1p-53;
}

double noise(const Vec3& p) {
  const Vec3 f = p.array().floor();
  const auto x = static_cast<std::int64_t>(f.x()), y = static_cast<std::int64_t>(f.y()),
             z = static_cast<std::int64_t>(f.z());
  const Vec3 t = p - f;
  double sum = 0.0;
  for (int i = 0; i < 8; ++i) {
    const int a = i & 1, b = (i >> 1) & 1, c = i >> 2;
    sum += hashed(x + a, y + b, z + c) * (a ? t.x() : 1 - t.x()) * (b ? t.y() : 1 - t.y()) *
           (c ? t.z() : 1 - t.z());
  }
  return sum;
}

namespace {

// Distance along the ray from `from` to the ball, or nothing.
std::optional<double> ball(const Vec3& from, const Vec3& ray, const Vec3& centre, double radius) {
  const Vec3 to = centre - from;
  const double b = ray.dot(to), root = b * b - ray.squaredNorm() * (to.squaredNorm() - radius * radius);
  if (root < 0.0) return std::nullopt;
  return (b - std::sqrt(root)) / ray.squaredNorm();
}

// A tube of `length` from `end` against `axis`.
std::optional<double> tube(const Vec3& from, const Vec3& ray, const Vec3& end, const Vec3& axis,
                           double length, double radius) {
  const Vec3 to = end - from;
  const Vec3 r = ray - axis * axis.dot(ray), c = to - axis * axis.dot(to);
  const double a = r.squaredNorm(), b = r.dot(c), root = b * b - a * (c.squaredNorm() - radius * radius);
  if (root < 0.0 || a < 1e-12) return std::nullopt;
  const double t = (b - std::sqrt(root)) / a, s = axis.dot(t * ray - to);
  return s <= 0.0 && s >= -length ? std::optional(t) : std::nullopt;
}

struct Shade {
  Vec3 colour;
  bool skin;
};

Shade wall(const Vec3& from, const Vec3& ray) {
  const double t = (1.3 - from.z()) / ray.z();
  const Vec3 p = from + t * ray;
  const double g = 60 + 120 * noise(p / 0.004) * noise(p / 0.05 + Vec3(7, 7, 7));
  return {Vec3(0.75 * g, 0.95 * g, 1.15 * g), false};
}

Shade shade(const HandAt* hand, const Vec3& from, const Vec3& ray) {
  if (hand == nullptr) return wall(from, ray);
  const Vec3 axis = hand->along.normalized(), knuckle = hand->tip - hand->length * axis;
  const Vec3 fist = knuckle - (hand->palm - 0.005) * axis;
  double least = 1e9;
  Vec3 normal(0, 0, -1);
  const auto nearer = [&](std::optional<double> t, const Vec3& centre, bool round) {
    if (!t || *t <= 0.0 || *t >= least) return;
    least = *t;
    Vec3 out = from + *t * ray - centre;
    if (!round) out -= axis * axis.dot(out);
    normal = out.normalized();
  };
  nearer(ball(from, ray, hand->tip, hand->radius), hand->tip, true);
  nearer(tube(from, ray, hand->tip, axis, hand->length, hand->radius), hand->tip, false);
  if (hand->fist) nearer(ball(from, ray, fist, hand->palm), fist, true);
  if (least > 1e8) return wall(from, ray);
  const Vec3 p = from + least * ray;
  const double light = 0.55 + 0.45 * std::max(0.0, normal.dot(Vec3(0.3, -0.5, -0.81)));
  const double g = light * (1.0 - hand->marks + 2.0 * hand->marks * noise((p - hand->tip) / 0.0015));
  return {g * Vec3(205, 150, 118), true};
}

}  // namespace

void draw(const StereoRig& rig, Side side, const HandAt* hand, std::uint64_t seed, double sensor,
          Image& image, Mask* skin) {
  const Lens& lens = side == Side::left ? rig.left : rig.right;
  const bool left = side == Side::left;
  const Mat3 turn = left ? Mat3(Mat3::Identity()) : Mat3(rig.X_CD.q().toRotationMatrix());
  const Vec3 from = left ? Vec3(0, 0, 0) : Vec3(rig.X_CD.p());
  image = Image(static_cast<int>(rig.width), static_cast<int>(rig.height));
  constexpr int kSub = 3;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const auto ray = [&](double dx, double dy) {
        const Ray r = ray_of(lens, {x + dx, y + dy});
        return Vec3(turn * Vec3(r.x, r.y, 1.0));
      };
      const Vec3 middle = ray(0, 0);
      const bool near = hand != nullptr && (hand->tip - from).normalized().dot(middle.normalized()) > 0.95;
      const int sub = near ? kSub : 1;
      Vec3 sum(0, 0, 0);
      int on = 0;
      for (int i = 0; i < sub * sub; ++i) {
        const Shade s = shade(near ? hand : nullptr, from,
                              near ? ray((i % sub + 0.5) / sub - 0.5, (i / sub + 0.5) / sub - 0.5) : middle);
        sum += s.colour;
        on += s.skin ? 1 : 0;
      }
      for (int c = 0; c < 3; ++c) {
        const auto key = static_cast<std::int64_t>(seed * 2 + (left ? 0 : 1));
        double n = 0.0;  // sensor noise: twelve evenly spread numbers are as good as normal
        if (sensor > 0.0)
          for (int k = 0; k < 4; ++k) n += hashed(x * 16 + c * 4 + k, y, key + 1000) - 0.5;
        const double v = sum[c] / (sub * sub) + sensor * n * std::sqrt(3.0);
        image.at(x, y)[c] = static_cast<std::uint8_t>(std::clamp(v + 0.5, 0.0, 255.0));
      }
      if (skin != nullptr) skin->row(y)[x] = 2 * on > sub * sub ? 255 : 0;
    }
}

}  // namespace enc::drawn
