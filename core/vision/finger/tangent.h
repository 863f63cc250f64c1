// The image that a camera would take if it looked straight at a point: there a sphere's outline is a circle
// around its middle. In the image itself the outline is an ellipse, and its middle is not the sphere's.
#pragma once

#include "core/vision/stereo/rectify.h"

namespace enc {

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

}  // namespace enc
