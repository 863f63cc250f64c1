#include "core/spec/vision_check.h"

#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"

namespace enc {
namespace {

[[noreturn]] void refuse(const char* key, const std::string& what) {
  throw Error(what, std::string("rig.") + key);
}

// Whole numbers as files write them. Callers without a file get the limits of the schema here, too.
void within(const char* key, double value, double least, double most) {
  const auto text = [](double v) {
    std::string digits = std::to_string(v);
    digits.erase(digits.find_last_not_of('0') + 1);
    if (digits.back() == '.') digits.pop_back();
    return digits;
  };
  if (!(value >= least && value <= most))
    refuse(key, text(value) + " is out of range; expected " + text(least) + " to " + text(most));
}

}  // namespace

void check(const SegmentationSpec& spec) {
  within("vision.background_frames", spec.background_frames, 1, 255);
  within("vision.tile_px", spec.tile, 1, 15);
  within("vision.bins", spec.bins, 1, 8);
  within("vision.median_px", spec.median, 1, 15);
  if (spec.median % 2 == 0)
    refuse("vision.median_px",
           "the side of the median filter is even; expected an odd number, so that it has a middle");
  within("vision.match", spec.match, 0.0, 2.0);
  within("vision.change_sigmas", spec.change, 0.0, 1e3);
  within("vision.skin_sigmas", spec.skin, 0.0, 1e3);
  const SkinModel& skin = spec.model;
  if (!(skin.spread > 0.0) || !std::isfinite(skin.spread) || !std::isfinite(skin.hue))
    refuse(
        "vision.skin_spread_deg",
        "the model of skin has no spread; expected more than 0; learn it by `encounter calibrate skin FOLDER "
        "--masks MASKS`");
}

void check(const FingertipSpec& spec, double per_disparity, double r_most) {
  constexpr double kLargest = 200.0;  // px
  if (!(per_disparity > 0.0))
    refuse("vision.finger_radius_mm", "a finger has a radius; expected more than 0");
  if (!(r_most < kLargest))
    refuse("vision.finger_radius_mm",
           "at 'nearest_mm' the finger's radius is " + std::to_string(std::lround(r_most)) +
               " px; expected less than 200; raise 'nearest_mm' or lower 'finger_radius_mm'");
  within("vision.circle_share", spec.circle_share, 0.0, 1.0);
  within("vision.square_radii", spec.square_radii, 1.0, 4.0);
  within("vision.stretch_radii", spec.stretch_radii, 0.0, 10.0);
  if (!(spec.radius_least >= 1.0)) refuse("vision.finger_radius_mm", "a circle has at least 1 px of radius");
}

void check(const TrackSpec& spec) {
  within("vision.pixel_noise_px", spec.pixel_noise, 1e-3, 100.0);
  within("vision.disparity_noise_px", spec.disparity_noise, 1e-3, 100.0);
  within("vision.acceleration_noise", spec.acceleration_noise, 1e-3, 1e6);
  within("vision.disparity_acceleration_noise", spec.disparity_acceleration_noise, 1e-3, 1e6);
  within("vision.gate_sigmas", spec.gate, 0.1, 1e3);
  within("vision.window_sigmas", spec.window_sigmas, 0.1, 1e3);
  within("vision.window_least_px", spec.window_least, 1.0, 1e4);
  within("vision.window_growth", spec.window_growth, 1.0, 100.0);
  within("vision.full_frame_after", spec.full_frame_after, 0, 1000);
  within("vision.predicted_for_ms", spec.predicted_for * 1e3, 0.0, 1e4);
}

void check(const BallSpec& spec) {
  within("vision.ball_radius_mm", spec.radius * 1e3, 1.0, 100.0);
  within("vision.ball_hue_within_deg", spec.hue_within * (180.0 / std::numbers::pi), 1.0, 90.0);
  within("vision.ball_saturation", spec.least_saturation, 0.05, 1.0);
  if (!std::isfinite(spec.hue)) refuse("vision.ball_hue_deg", "a ball has a hue; expected a number");
}

void check(const MatchSpec& spec, double product) {
  if (spec.columns != 8 && spec.columns != 12 && spec.columns != 16)
    refuse("vision.block_columns_px",
           "a block has " + std::to_string(spec.columns) + " columns; expected 8, 12 or 16");
  if (spec.rows % 2 != 1 || spec.rows < 3 || spec.rows > 15)
    refuse("vision.block_rows_px",
           "a block has " + std::to_string(spec.rows) + " rows; expected 3, 5, 7, 9, 11, 13 or 15");
  if (!(spec.nearest > 0.0 && spec.farthest > spec.nearest))
    refuse("vision.farthest_mm",
           "'farthest_mm' is not beyond 'nearest_mm'; expected more than that; raise it");
  if (const double most = std::ceil(product / spec.nearest); !(most <= kMostDisparity))
    refuse("vision.nearest_mm",
           "so near, the two images are " + std::to_string(std::lround(std::min(most, 1e9))) +
               " px apart; expected at most " + std::to_string(kMostDisparity) + "; raise 'nearest_mm'");
}

void check_timing(const StereoRig& camera) {
  constexpr double kOnTheirWay = 60.0;
  within("camera.rate_hz", camera.rate, 0.1, 1000.0);
  within("camera.latency_ms", camera.latency * 1e3, 0.0, 1e4);
  if (camera.latency * camera.rate > kOnTheirWay)
    refuse("camera.latency_ms",
           "more than 60 frames are on their way at once; expected less; lower 'latency_ms' or 'rate_hz'");
}

void check(const StereoRig& camera, const VisionRig& vision) {
  check_timing(camera);
  check(vision.segmentation);
  check(vision.track);
  check(vision.ball);
  const double focal =
      0.25 * (camera.left.focal_x + camera.left.focal_y + camera.right.focal_x + camera.right.focal_y);
  const double baseline = camera.X_CD.p().norm();
  check(vision.match, focal * baseline);
  const double per_disparity = vision.fingertip.radius / baseline * vision.fingertip.scale;
  check(vision.fingertip, per_disparity, per_disparity * std::ceil(focal * baseline / vision.match.nearest));
  const Region& search = vision.search;
  if (!search.empty() && search.cut({0, 0, camera.size().width, camera.size().height}).empty())
    refuse("vision.search_px", "the rectangle is outside of the image; expected columns below " +
                                   std::to_string(camera.width) + " and rows below " +
                                   std::to_string(camera.height));
}

}  // namespace enc
