#include "core/vision/stereo/lens.h"

#include <cmath>

namespace enc {
namespace {

struct Bent {
  Ray ray;
  double xx, xy, yy;  // its derivatives; the matrix is symmetric
};

Bent bend(const Lens& lens, const Ray& ray) {
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
  constexpr int kSteps = 30;
  constexpr double kExact = 1e-12;
  const Ray wanted{(pixel.column - lens.centre_x) / lens.focal_x, (pixel.row - lens.centre_y) / lens.focal_y};
  Ray ray = wanted;
  for (int i = 0; i < kSteps; ++i) {  // Newton
    const Bent now = bend(lens, ray);
    const double dx = wanted.x - now.ray.x, dy = wanted.y - now.ray.y;
    if (std::abs(dx) + std::abs(dy) < kExact) return ray;
    const double det = now.xx * now.yy - now.xy * now.xy;
    if (!(det > 0.0)) break;  // beyond the fold
    ray.x += (now.yy * dx - now.xy * dy) / det;
    ray.y += (now.xx * dy - now.xy * dx) / det;
  }
  return {};
}

}  // namespace enc
