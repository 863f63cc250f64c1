// Keys of a stereo head and of vision: rig tables [camera] and [vision].
#include <array>
#include <cmath>
#include <span>

#include "core/base/rotation.h"
#include "models/schema/schema_walk.h"
#include "models/schema/units.h"

namespace enc::models {
namespace {

using enum Confidence;
using enum Presence;
constexpr std::string_view kHead = "sources/tracking 7";

void whole(Visitor& v, const Key& key, int& number) {
  std::int64_t wide = number;
  v.value(key, &wide);
  number = static_cast<int>(wide);
}

void describe(Visitor& v, Lens& lens, const HeadKeys& k) {
  std::array<double, 2> focal{lens.focal_x, lens.focal_y}, centre{lens.centre_x, lens.centre_y};
  v.value({"focal_px", "focal length along the rows, along the columns", k.source, derived, kPositive,
           k.presence},
          std::span<double>(focal));
  v.value({"centre_px", "image of the optical axis", k.source, assumed, kAny, k.presence},
          std::span<double>(centre));
  v.value({"distortion",
           "distortion k1, k2, p1, p2, k3 by OpenCV's model",
           k.source,
           assumed,
           {-100.0, 100.0},
           k.presence},
          std::span<double>(lens.distortion));
  lens.focal_x = focal[0];
  lens.focal_y = focal[1];
  lens.centre_x = centre[0];
  lens.centre_y = centre[1];
}

// The right camera's pose: three angles, rounded to far less than a camera resolves, so that a text that is
// read is written unchanged.
void describe(Visitor& v, Pose<'C', 'D'>& X_CD, const HeadKeys& k) {
  Vec3 position = X_CD.p(), rotation = angles_xyz(Quat(X_CD.q()));
  for (double& angle : rotation)
    angle = to_si(unit_of("rotation_deg"), std::round(angle * (180e9 / M_PI)) / 1e9);
  v.value({"position_mm", "position of the right camera in the left camera's frame", k.source, published,
           kAny, k.presence},
          &position);
  v.value({"rotation_deg",
           "about the fixed x, then y, then z axis",
           k.source,
           assumed,
           {-180.0, 180.0},
           k.presence},
          &rotation);
  X_CD = {rotation_xyz(rotation), position};
}

void describe(Visitor& v, SegmentationSpec& s) {
  choice(v,
         {"method", "published, or ours, which copes with changing light and skin-hued backgrounds",
          "[VisHap 2.1.1]", chosen},
         s.method);
  whole(v,
        {"background_frames", "frames averaged into the background at each start", "[VisHap 3]", published,
         Range{1.0, 255.0}},
        s.background_frames);
  whole(v, {"tile_px", "side of a tile", "[VisHap 3]", published, Range{1.0, 15.0}}, s.tile);
  whole(v, {"bins", "hue bins of a tile's histogram", "[VisHap 3]", published, Range{1.0, 8.0}}, s.bins);
  v.value({"match", "match with its background below which a tile is foreground",
           "docs/notes/segmentation.md", derived, Range{0.0, 1.0}},
          &s.match);
  v.value({"skin_sigmas", "distance from skin's mean hue up to which a hue is skin, in standard deviations",
           "docs/notes/segmentation.md", derived, Range{0.0, 1000.0}},
          &s.skin);
  v.value({"change_sigmas",
           "ours: difference from its background up to which a pixel is background, in standard deviations",
           "docs/notes/segmentation.md", derived, Range{0.0, 1000.0}},
          &s.change);
  whole(v,
        {"median_px", "side of the median filter; odd", "docs/notes/segmentation.md", assumed,
         Range{1.0, 15.0}},
        s.median);
  v.value({"skin_hue_deg", "mean hue of skin", "encounter calibrate skin", derived, Range{-360.0, 360.0}},
          &s.model.hue);
  v.value({"skin_spread_deg", "standard deviation of skin's hue", "encounter calibrate skin", derived,
           Range{0.0, 180.0, true}},
          &s.model.spread);
}

void describe(Visitor& v, FingertipSpec& f) {
  v.value({"finger_radius_mm",
           "radius of the fingertip's cap; K is this times the focal length",
           "sources/tracking 7",
           assumed,
           {1.0, 50.0}},
          &f.radius);
  v.value({"radius_scale",
           "factor on K, to study a wrong radius",
           "docs/notes/fingertip.md",
           chosen,
           {0.1, 10.0}},
          &f.scale);
  choice(v,
         {"square", "step 6: reading of the paper for the square's distance from the pixel",
          "docs/notes/fingertip.md", chosen},
         f.square);
  v.value({"circle_share",
           "step 5: least share of skin in the circle",
           "docs/notes/fingertip.md",
           derived,
           {0.0, 1.0}},
          &f.circle_share);
  v.value({"square_radii",
           "step 6: half a side of the square, in r",
           "docs/notes/fingertip.md",
           derived,
           {1.0, 4.0}},
          &f.square_radii);
  v.value({"square_least_radii", "step 7: least skin along the square, in r", "docs/notes/fingertip.md",
           derived, kNotNegative},
          &f.square_least);
  v.value({"square_most_radii", "step 7: most skin along the square, in r", "docs/notes/fingertip.md",
           derived, kPositive},
          &f.square_most);
  v.value({"stretch_radii",
           "ours: half a side of a second square, in r; 0: as published",
           "docs/notes/fingertip.md",
           derived,
           {0.0, 10.0}},
          &f.stretch_radii);
  v.value(
      {"stretch_most_radii", "ours: most skin along the second square if another candidate has less, in r",
       "docs/notes/fingertip.md", derived, kPositive},
      &f.stretch_most);
  v.value({"pairs", "step 9: most pairs of skin pixels across the square", "[VisHap 2.1.2]", published,
           kNotNegative},
          &f.pairs);
}

void describe(Visitor& v, TrackSpec& t) {
  constexpr Range kNoise{1e-3, 100.0}, kRestless{1e-3, 1e6}, kSigmas{0.1, 1e3};
  v.value({"pixel_noise_px", "noise of the tip's position, rms", "docs/notes/fingertip.md", derived, kNoise},
          &t.pixel_noise);
  v.value({"disparity_noise_px", "noise of the disparity, rms, besides that reported by the match",
           "docs/notes/fingertip.md", derived, kNoise},
          &t.disparity_noise);
  v.value({"acceleration_noise", "process noise of the tip in the image, px/s/sqrt(s)", "sources/hand 2",
           assumed, kRestless},
          &t.acceleration_noise);
  v.value({"disparity_acceleration_noise", "process noise of the disparity, px/s/sqrt(s)", "sources/hand 2",
           assumed, kRestless},
          &t.disparity_acceleration_noise);
  v.value({"gate_sigmas",
           "distance from the prediction up to which a detection is the finger, in standard deviations",
           "sources/choices 5", assumed, kSigmas},
          &t.gate);
  v.value({"window_sigmas", "half a side of the search window, in standard deviations", "sources/choices 5",
           assumed, kSigmas},
          &t.window_sigmas);
  v.value({"window_least_px", "smallest half side of the search window", "sources/choices 5", assumed,
           Range{1.0, 1e4}},
          &t.window_least);
  v.value({"window_growth", "growth factor of the search window for each frame without a finger",
           "sources/choices 5", assumed, Range{1.0, 100.0}},
          &t.window_growth);
  whole(v,
        {"full_frame_after", "frames without a finger after which the whole frame is searched",
         "sources/choices 5", assumed, Range{1.0, 1000.0}},
        t.full_frame_after);
  v.value({"predicted_for_ms", "longest time for which the filter predicts an undetected finger",
           "sources/choices 5", assumed, Range{0.0, 1e4}},
          &t.predicted_for);
}

void describe(Visitor& v, MatchSpec& m) {
  whole(v,
        {"block_columns_px",
         "width of a matched block: 8, 12 or 16",
         "docs/notes/fingertip.md",
         chosen,
         {8.0, 16.0}},
        m.columns);
  whole(v,
        {"block_rows_px", "height of a matched block; odd", "docs/notes/fingertip.md", chosen, {3.0, 15.0}},
        m.rows);
  v.value({"nearest_mm", "smallest depth that is matched", "docs/notes/fingertip.md", chosen, kPositive},
          &m.nearest);
  v.value({"farthest_mm", "largest depth that is matched", "docs/notes/fingertip.md", chosen, kPositive},
          &m.farthest);
}

void describe(Visitor& v, BallSpec& b) {
  constexpr const char* kBall = "docs/guide/registration.md";
  v.value({"ball_radius_mm",
           "radius of the ball at the arm's tip, used for registration",
           kBall,
           assumed,
           {1.0, 100.0}},
          &b.radius);
  v.value({"ball_hue_deg", "hue of the ball", kBall, assumed, {-360.0, 360.0}}, &b.hue);
  v.value({"ball_hue_within_deg",
           "largest difference of a ball pixel's hue from ball_hue_deg",
           kBall,
           assumed,
           {1.0, 90.0}},
          &b.hue_within);
  v.value({"ball_saturation",
           "smallest saturation of a ball pixel: chroma over the brightest channel",
           kBall,
           assumed,
           {0.05, 1.0}},
          &b.least_saturation);
}

}  // namespace

void describe_size(Visitor& v, StereoRig& c, const HeadKeys& k) {
  v.value({"width_px", "width of each image", k.source, assumed, {16.0, 4096.0}, k.presence}, &c.width);
  v.value({"height_px", "height of each image", k.source, assumed, {16.0, 4096.0}, k.presence}, &c.height);
}

void describe_lenses(Visitor& v, StereoRig& c, const HeadKeys& k) {
  table(v, "left", [&] { describe(v, c.left, k); });
  table(v, "right", [&] {
    describe(v, c.right, k);
    describe(v, c.X_CD, k);
  });
}

void describe(Visitor& v, StereoRig& c) {
  v.value({"driver", "driver: sim, or a folder of hw_drivers that has a stereo camera", "rig", chosen, kAny,
           needed},
          &c.driver);
  v.value(
      {"calibration", "file of `encounter calibrate stereo`, beside the rig file; empty: the numbers below",
       "rig", chosen},
      &c.calibration);
  describe_size(v, c, {kHead});
  v.value({"rate_hz",
           "expected frame rate; three missing frames are a stall",
           "[VisHap 2.3.1]",
           published,
           {0.1, 1000.0}},
          &c.rate);
  v.value({"latency_ms",
           "delay from exposure to the arrival of the fingertip at the core",
           kHead,
           assumed,
           {0.0, 1e4}},
          &c.latency);
  describe_lenses(v, c, {kHead});
}

void describe(Visitor& v, VisionRig& vision) {
  Region& s = vision.search;
  std::array<double, 4> search{static_cast<double>(s.x0), static_cast<double>(s.y0),
                               static_cast<double>(s.x1), static_cast<double>(s.y1)};
  v.value({"search_px",
           "region in which an untracked finger is searched: left column, upper row, right column, lower "
           "row; all 0: everywhere",
           "[VisHap 2.1.1]",
           chosen,
           {0.0, 4096.0}},
          std::span<double>(search));
  s = {static_cast<int>(search[0]), static_cast<int>(search[1]), static_cast<int>(search[2]),
       static_cast<int>(search[3])};
  describe(v, vision.segmentation);
  describe(v, vision.fingertip);
  describe(v, vision.track);
  describe(v, vision.match);
  describe(v, vision.ball);
}

}  // namespace enc::models
