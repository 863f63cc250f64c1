// The cap of a fingertip: its outline in one image, and its distance by both.
#pragma once

#include <span>

#include "core/base/image.h"
#include "core/vision/finger/fingertip.h"
#include "core/vision/stereo/grey.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

// The image that a camera would take if it looked straight at a point: there a sphere's outline is a circle
// around its middle. In the image itself the outline is an ellipse, and its middle is not the sphere's.
class Tangent {
 public:
  // `at`, px of the rectified left image, is the point to look at. The camera's up direction stays.
  Tangent(const RectifiedPair& pair, const Pixel& at)
      : focal_(pair.focal), centre_x_(pair.centre_x), centre_y_(pair.centre_y), view_(ray(at).normalized()) {
    right_ = Vec3(1.0 - view_.x() * view_.x(), -view_.x() * view_.y(), -view_.x() * view_.z()).normalized();
    down_ = view_.cross(right_);
  }
  // Converts a pixel in front of the camera to px from `at`, right and down; image() converts back.
  [[nodiscard]] Pixel of(const Pixel& image) const {
    const Vec3 v = ray(image);
    const double scale = focal_ / v.dot(view_);
    return {scale * v.dot(right_), scale * v.dot(down_)};
  }
  [[nodiscard]] Pixel image(const Pixel& plane) const {
    const Vec3 v = focal_ * view_ + plane.column * right_ + plane.row * down_;
    return {centre_x_ + focal_ * v.x() / v.z(), centre_y_ + focal_ * v.y() / v.z()};
  }
  // Ray with depth 1, in the rectified axes.
  [[nodiscard]] Vec3 ray(const Pixel& image) const {
    return {(image.column - centre_x_) / focal_, (image.row - centre_y_) / focal_, 1.0};
  }
  [[nodiscard]] double focal() const { return focal_; }
  [[nodiscard]] const Vec3& view() const { return view_; }  // unit vectors, in the rectified axes
  [[nodiscard]] const Vec3& right() const { return right_; }
  [[nodiscard]] const Vec3& down() const { return down_; }

 private:
  double focal_, centre_x_, centre_y_;
  Vec3 view_, right_, down_;
};

// The outline of a fingertip: a semicircle and the two straight sides that leave it, fitted to the edge of
// the mask. The steps before find many candidates of equal score, most of them behind the cap.
struct CapFit {
  bool good = false;
  Pixel centre;  // middle of the cap, in the image
  // Seen by a virtual camera that looks straight at the centre (Tangent):
  double radius = kUnset;               // px
  double along_x = 0.0, along_y = 0.0;  // unit vector, from the tip to the knuckle
  double misfit = kUnset;               // px rms, edge against outline
};

// Radii around the start within which the mask counts.
inline constexpr double kFarthest = 4.0;

// `start` lies in the finger, at most about `radius` from the circle's middle; `radius` may be wrong by half.
[[nodiscard]] CapFit fit_cap(const Mask& skin, const RectifiedPair& pair, const Pixel& start, double radius);

// Refits the outline to the sharpest image edge near the mask's edge. The mask lacks the rim of dark skin,
// which has too little hue. Returns `fit` if the refit fails.
[[nodiscard]] CapFit sharpen_cap(const Mask& skin, const Grey& image, const RectifiedPair& pair,
                                 const CapFit& fit);

// Distance of a fingertip: the disparity of the middle of its cap. A block of pixels measures the front of a
// sphere, not its middle, while a cap's outline belongs to its middle. So the fit models the cap as half a
// sphere and the adjacent finger as a cylinder. It compares their pixels with the other image [Lucas and
// Kanade]. The fit also gives the finger's slope.
struct CapDisparity {
  bool good = false;
  double disparity = kUnset;  // px, at the cap's middle
  double variance = kUnset;   // px^2: from the residual and the amount of detail
  // rad, away from the camera, from the tip to the knuckle.
  double slope = kUnset;
  double left_over = kUnset;  // grey levels^2 of a pixel, residual
};

// `surfaces` are disparities of the finger's front near the cap; some may be wrong.
[[nodiscard]] CapDisparity match_cap(const Grey& left, const Grey& right, const Mask& skin,
                                     const Fingertip& tip, const RectifiedPair& pair,
                                     std::span<const float> surfaces);
// As match_cap(), with a known disparity of the middle: only the slope is fitted.
[[nodiscard]] CapDisparity match_cap_at(const Grey& left, const Grey& right, const Mask& skin,
                                        const Fingertip& tip, const RectifiedPair& pair, double disparity);
// Disparity of the middle of a cap from that of its front, and the inverse.
[[nodiscard]] double middle_of(double surface, double outline, double focal);
[[nodiscard]] double front_of(double middle, double outline, double focal);

}  // namespace enc
