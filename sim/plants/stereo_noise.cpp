#include "sim/plants/stereo_noise.h"

#include <cmath>

namespace enc::sim {

StereoPoints::StereoPoints(const CameraTruth& truth, std::uint64_t seed)
    : truth_(truth), frames_(seed, "camera.frames"), places_(seed, "camera.places") {
  move();
}

std::optional<StereoPixel> StereoPoints::project(const Point<'C'>& point) const {
  const double z = point.e().z();
  if (!point.finite() || !(z > 0.0)) return std::nullopt;
  const double last_column = static_cast<double>(truth_.width - 1);
  const double last_row = static_cast<double>(truth_.height - 1);
  const StereoPixel pixel{0.5 * last_column + truth_.focal * point.e().x() / z,
                          0.5 * last_row + truth_.focal * point.e().y() / z,
                          truth_.focal * truth_.baseline / z};
  // The right camera stands to the right, so all of the scene is further to the left in its image.
  const bool seen = pixel.column - pixel.disparity >= 0.0 && pixel.column <= last_column &&
                    pixel.row >= 0.0 && pixel.row <= last_row;
  return seen ? std::optional(pixel) : std::nullopt;
}

Point<'C'> StereoPoints::triangulate(const StereoPixel& pixel) const {
  if (!(pixel.disparity > 0.0)) return {};
  const double z = truth_.focal * truth_.baseline / pixel.disparity;
  const double each = z / truth_.focal;  // m that a pixel is wide there
  return {(pixel.column - 0.5 * static_cast<double>(truth_.width - 1)) * each,
          (pixel.row - 0.5 * static_cast<double>(truth_.height - 1)) * each, z};
}

Vec<'C'> StereoPoints::scatter(const Point<'C'>& point) const {
  const double z = point.e().z();
  // A uniform step has a variance of a twelfth of its square; noise that is wider makes it independent.
  const double disparity = std::hypot(truth_.matching, truth_.disparity_step / std::sqrt(12.0));
  const double depth = z * z / (truth_.focal * truth_.baseline) * disparity;
  const double aside = z / truth_.focal * truth_.pointing;
  return {std::hypot(aside, point.e().x() / z * depth), std::hypot(aside, point.e().y() / z * depth), depth};
}

void StereoPoints::move() { standing_ = truth_.standing * places_.normal3(); }

std::optional<Point<'C'>> StereoPoints::see(const Point<'C'>& point) {
  std::optional<StereoPixel> pixel = project(point);
  if (!pixel) return std::nullopt;
  const Vec3 noise = frames_.normal3();
  pixel->column += standing_.x() + truth_.pointing * noise.x();
  pixel->row += standing_.y() + truth_.pointing * noise.y();
  pixel->disparity += standing_.z() + truth_.matching * noise.z();
  const double step = truth_.disparity_step;
  if (step > 0.0) pixel->disparity = std::round(pixel->disparity / step) * step;
  const Point<'C'> seen = triangulate(*pixel);
  return seen.finite() ? std::optional(seen) : std::nullopt;
}

}  // namespace enc::sim
