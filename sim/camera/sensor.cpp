#include "sim/camera/sensor.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/base/error.h"
#include "sim/truth/random.h"

namespace enc::sim {

std::array<double, 2> distorted(const Lens& lens, double x, double y) {
  const auto& [k1, k2, p1, p2, k3] = lens.distortion;
  const double r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
  return {x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
          y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y};
}

// Newton's method, started at the distorted point; the derivative is that of distorted().
std::array<double, 2> undistorted(const Lens& lens, double x, double y) {
  const auto& [k1, k2, p1, p2, k3] = lens.distortion;
  double u = x, v = y;
  for (int i = 0; i < 30; ++i) {
    const double r2 = u * u + v * v;
    const double radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
    const double slope = k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3);  // derivative of radial by r2
    const auto [du, dv] = distorted(lens, u, v);
    const double xx = radial + 2.0 * u * u * slope + 2.0 * p1 * v + 6.0 * p2 * u;
    const double xy = 2.0 * u * v * slope + 2.0 * p1 * u + 2.0 * p2 * v;
    const double yy = radial + 2.0 * v * v * slope + 6.0 * p1 * v + 2.0 * p2 * u;
    const double determinant = xx * yy - xy * xy;
    // Beyond the fold of the lens there is no image.
    if (!(determinant > 0.0 && xx + yy > 0.0)) return {kUnset, kUnset};
    const double ex = x - du, ey = y - dv;
    u += (yy * ex - xy * ey) / determinant;
    v += (xx * ey - xy * ex) / determinant;
    if (ex * ex + ey * ey < 1e-24) return {u, v};
  }
  return {kUnset, kUnset};
}

std::array<double, 2> projected(const Lens& lens, const Vec3& point) {
  const auto [x, y] = distorted(lens, point.x() / point.z(), point.y() / point.z());
  return {lens.centre_x + lens.focal_x * x, lens.centre_y + lens.focal_y * y};
}

Warp::Warp(const Lens& lens, int width, int height)
    : width_(width), height_(height), drawn_width_(width), drawn_height_(height) {
  for (const double k : lens.distortion) bends_ = bends_ || k != 0.0;
  // The centre of the first pixel is (0, 0), so that its edge is at -0.5.
  left_ = (-0.5 - lens.centre_x) / lens.focal_x;
  right_ = (width - 0.5 - lens.centre_x) / lens.focal_x;
  top_ = (-0.5 - lens.centre_y) / lens.focal_y;
  bottom_ = (height - 0.5 - lens.centre_y) / lens.focal_y;
  if (bends_) find_taps(lens);
}

void Warp::find_taps(const Lens& lens) {
  std::vector<std::array<double, 2>> seen;  // px of an undistorted picture of the same focal length
  seen.reserve(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  std::array<double, 4> edge{0, 0, 0, 0};  // least column and row, greatest column and row
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      const auto [u, v] =
          undistorted(lens, (x - lens.centre_x) / lens.focal_x, (y - lens.centre_y) / lens.focal_y);
      if (!std::isfinite(u) || !std::isfinite(v))
        throw Error(
            "this lens distortion leaves pixels of the camera without a direction; give one that was "
            "measured",
            "truth.camera.distortion");
      seen.push_back({lens.centre_x + lens.focal_x * u, lens.centre_y + lens.focal_y * v});
      edge = {std::min(edge[0], seen.back()[0]), std::min(edge[1], seen.back()[1]),
              std::max(edge[2], seen.back()[0]), std::max(edge[3], seen.back()[1])};
    }
  if (edge[2] - edge[0] > 3.0 * width_ || edge[3] - edge[1] > 3.0 * height_)
    throw Error(
        "this lens distortion needs a drawing more than three times as large; give one that was measured",
        "truth.camera.distortion");
  const int first_x = static_cast<int>(std::floor(edge[0]));
  const int first_y = static_cast<int>(std::floor(edge[1]));
  drawn_width_ = static_cast<int>(std::floor(edge[2])) + 3 - first_x;
  drawn_height_ = static_cast<int>(std::floor(edge[3])) + 3 - first_y;
  left_ = (first_x - 0.5 - lens.centre_x) / lens.focal_x;
  right_ = left_ + drawn_width_ / lens.focal_x;
  top_ = (first_y - 0.5 - lens.centre_y) / lens.focal_y;
  bottom_ = top_ + drawn_height_ / lens.focal_y;

  taps_.reserve(seen.size());
  for (const auto& [column, row] : seen) {
    // To 1/256 px.
    const auto x = static_cast<std::uint32_t>(std::lround(256.0 * (column - first_x)));
    const auto y = static_cast<std::uint32_t>(std::lround(256.0 * (row - first_y)));
    const std::uint32_t up = static_cast<std::uint32_t>(drawn_height_) - 1 - y / 256;
    taps_.push_back({up * static_cast<std::uint32_t>(drawn_width_) + x / 256,
                     static_cast<std::uint8_t>(x % 256), static_cast<std::uint8_t>(y % 256)});
  }
}

void Warp::colours(const std::uint8_t* drawing, Image& picture) const {
  const std::size_t row = 3 * static_cast<std::size_t>(width_);
  if (!bends_) {
    for (int y = 0; y < height_; ++y)
      std::memcpy(picture.at(0, y), drawing + static_cast<std::size_t>(height_ - 1 - y) * row, row);
    return;
  }
  const std::size_t down = 3 * static_cast<std::size_t>(drawn_width_);
  std::uint8_t* to = picture.rgb.data();
  for (const Tap& tap : taps_) {
    const std::uint8_t* upper = drawing + 3 * static_cast<std::size_t>(tap.at);
    const std::uint8_t* lower = upper - down;
    const unsigned r = tap.right, l = 256U - r, b = tap.lower, t = 256U - b;
    for (int c = 0; c < 3; ++c, ++to)
      *to = static_cast<std::uint8_t>(
          (t * (l * upper[c] + r * upper[c + 3]) + b * (l * lower[c] + r * lower[c + 3]) + 32768U) >> 16U);
  }
}

std::size_t Warp::nearest(int x, int y) const {
  const auto here =
      static_cast<std::size_t>(x) + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
  if (!bends_)
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(height_ - 1 - y) * static_cast<std::size_t>(width_);
  const Tap& tap = taps_[here];
  return tap.at + (tap.right >= 128 ? 1U : 0U) -
         (tap.lower >= 128 ? static_cast<std::size_t>(drawn_width_) : 0U);
}

namespace {

constexpr std::size_t kTable = 1U << 18U;

double rms_of_rounded(const std::vector<float>& normal, double scale) {
  double sum = 0.0;
  for (const float n : normal) {
    const double whole = std::round(scale * static_cast<double>(n));
    sum += whole * whole;
  }
  return std::sqrt(sum / static_cast<double>(normal.size()));
}

// Scale of the normal numbers before rounding, found by bisection, because rounding adds noise of its own.
double scale_for(const std::vector<float>& normal, double rms) {
  double low = 0.0, high = rms + 1.0;
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (rms_of_rounded(normal, middle) < rms ? low : high) = middle;
  }
  return high;
}

}  // namespace

SensorNoise::SensorNoise(double rms, std::uint64_t seed) : seed_(seed) {
  if (!(rms >= 0.0 && rms <= 30.0))
    throw Error("the noise of an image sensor is 0 to 30 of 255", "truth.camera.noise_of_255");
  if (rms == 0.0) return;
  Stream stream(seed, "sensor");
  std::vector<float> normal(kTable);
  for (float& n : normal) n = static_cast<float>(stream.normal());
  const double scale = scale_for(normal, rms);
  table_.reserve(kTable);
  for (const float n : normal)
    table_.push_back(
        static_cast<std::int8_t>(std::clamp(std::round(scale * static_cast<double>(n)), -127.0, 127.0)));
}

// Each row takes a section of the table that begins at a random position.
void SensorNoise::add(Image& image, std::uint64_t frame, std::uint64_t eye) const {
  if (table_.empty()) return;
  Stream starts(seed_ ^ (2 * frame + eye + 1) * 0x9e3779b97f4a7c15ULL, "rows");
  const std::size_t row = std::min(3 * static_cast<std::size_t>(image.width), kTable);
  for (int y = 0; y < image.height; ++y) {
    std::uint8_t* pixel = image.at(0, y);
    const std::int8_t* noise = table_.data() + starts.bits() % (kTable - row + 1);
    for (std::size_t i = 0; i < row; ++i) {
      const int sum = pixel[i] + noise[i];
      pixel[i] = static_cast<std::uint8_t>(std::clamp(sum, 0, 255));
    }
  }
}

}  // namespace enc::sim
