#include "core/vision/hand/hand_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/vision/finger/cap.h"
#include "core/vision/finger/fingertip.h"
#include "core/vision/hand/hand_form.h"

namespace enc {
namespace {

// The smallest box around the skin within `window`; empty without skin.
Region box_of(const Mask& skin, const Region& window) {
  if (window.empty()) return {};
  Region box{window.x1, window.y1, window.x0, window.y0};
  for (int y = window.y0; y < window.y1; ++y) {
    const std::uint8_t* row = skin.row(y);
    for (int x = window.x0; x < window.x1; ++x)
      if (row[x] != 0) {
        box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1), y + 1};
        x = std::max(x, box.x1 - 1);  // pixels in between change nothing
      }
  }
  return box;
}

Region grown(const Region& region, int by) {
  return {region.x0 - by, region.y0 - by, region.x1 + by, region.y1 + by};
}

constexpr double kOther = 1.6;  // ratio of cap sizes: more than the error of K and the mask

// True if the ratio of disparity to expected disparity is plausible: 3 m/s at 600 mm and 20 Hz.
bool is_near(double ratio) {
  constexpr double kNearer = 1.25;
  return ratio < kNearer && ratio > 1.0 / kNearer;
}

// Every tile counts as foreground, so that hue alone decides.
SegmentationSpec without_background(SegmentationSpec spec) {
  spec.method = SegmentationMethod::published;
  spec.background_frames = 1;
  spec.match = 2.0;
  return spec;
}

}  // namespace

HandScene::HandScene(const StereoRig& rig, const SegmentationSpec& segmentation,
                     const FingertipSpec& fingertip, const MatchSpec& match)
    : rectifier_(rig),
      segmentation_(segmentation),
      segmenter_(segmentation, rectifier_.width(), rectifier_.height()),
      matcher_(match, pair()),
      exchanged_(pair(), rectifier_.width(), rectifier_.height()),
      finder_(finder_with(fingertip)),
      palm_(rectifier_.width(), rectifier_.height()),
      limits_{match.nearest, match.farthest, fingertip.radius},
      grey_left_(rectifier_.width(), rectifier_.height()),
      grey_right_(rectifier_.width(), rectifier_.height()),
      skin_(rectifier_.width(), rectifier_.height()),
      right_skin_(rectifier_.width(), rectifier_.height()),
      disparity_(rectifier_.width(), rectifier_.height()) {
  if (rectifier_.none_needed()) return;
  left_ = Image(rectifier_.width(), rectifier_.height());
  right_ = left_;
}

FingertipFinder HandScene::finder_with(const FingertipSpec& fingertip) const {
  return {fingertip, pair(), fingertip.radius / pair().baseline * matcher_.most(), rectifier_.width(),
          rectifier_.height()};
}

ImageView HandScene::rectified(Side side, const ImageView& raw, const Region& part) {
  if (rectifier_.none_needed()) return raw;
  Image& to = side == Side::left ? left_ : right_;
  rectifier_.part(side, raw, part, to);
  return to.view();
}

// The region that tiles and median read, a little beyond their result.
Region HandScene::read_for(const Segmenter& segmenter, const Region& wanted) const {
  return grown(segmenter.on_grid(wanted), segmentation_.median + 2 * segmentation_.tile);
}

Region HandScene::segment(Segmenter& segmenter, const ImageView& raw, const Region& wanted) {
  // The light of a frame is measured over the whole frame.
  const bool all = segmentation_.method == SegmentationMethod::ours;
  const Region part = all ? this->frame() : read_for(segmenter, wanted);
  const ImageView image = rectified(Side::left, raw, part);
  return segmenter.segment(image, wanted, skin_);
}

ImageView HandScene::segment_right(const StereoFrame& frame, const Region& wanted) {
  const ImageView right =
      rectified(Side::right, frame.right, read_for(*hue_alone_, wanted).cut(this->frame()));
  hue_alone_->segment(right, wanted, right_skin_);
  return right;
}

bool HandScene::exchanged(const StereoFrame& frame) {
  for (int row = 0; row < ExchangeCheck::kRows; ++row) {
    const Region strip = exchanged_.strip(row);
    to_grey(rectified(Side::left, frame.left, strip), strip, grey_left_);
    to_grey(rectified(Side::right, frame.right, strip), strip, grey_right_);
  }
  return exchanged_.see(grey_left_, grey_right_);
}

void HandScene::learn(const StereoFrame& frame) {
  look_for_finger_in_background(frame);
  segmenter_.learn(rectified(Side::left, frame.left, this->frame()));
}

void HandScene::look_for_finger_in_background(const StereoFrame& frame) {
  if (!hue_alone_) {
    hue_alone_ = std::make_unique<Segmenter>(without_background(segmentation_), rectifier_.width(),
                                             rectifier_.height());
    hue_alone_->learn(rectified(Side::left, frame.left, this->frame()));
  }
  if (finger_in_background_ || !hue_alone_->learned()) return;
  segment(*hue_alone_, frame.left, this->frame());
  match(frame, this->frame(), this->frame());
  HandFinding seen;
  seen.tip = finder_.find(skin_, disparity_, this->frame());
  finger_in_background_ = seen.tip.found && (seen.tip.fitted || seen.tip.score > 0.8);
}

// `around`: region that later steps may read in the images; `window`: region whose disparity is needed now.
void HandScene::match(const StereoFrame& frame, const Region& window, const Region& around) {
  disparity_.match(matcher_, grey_left_, grey_right_, skin_, Region{});
  const Region box = box_of(skin_, around);
  if (box.empty()) return;
  constexpr int kBeyond = 8;  // px that the fit of the cap reads beyond the mask
  const Region cells = grown(box, DisparityMap::kCell + kBeyond);
  const Region left = matcher_.left_of(cells), right = matcher_.right_of(cells);
  to_grey(rectified(Side::left, frame.left, left), left, grey_left_);
  to_grey(rectified(Side::right, frame.right, right), right, grey_right_);
  disparity_.match(matcher_, grey_left_, grey_right_, skin_, window.cut(box));
}

// Largest reach beyond any skin pixel, by its depth.
int HandScene::farthest_reach(const Region& window) const {
  float most = 0.0F;
  const Region box = box_of(skin_, window);
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x)
      if (skin_.at(x, y) && disparity_.at(x, y) > most) most = disparity_.at(x, y);
  return finder_.reach(static_cast<double>(most));
}

HandScene::HandFinding HandScene::look(const StereoFrame& frame, const Region& window,
                                       const FingerHint& followed) {
  const Triplet& expected = followed.at;
  palm_measured_ = false;
  const double thought = expected.disparity > 0.0 ? 1.3 * expected.disparity : 0.0;
  const int first = std::max(DisparityMap::kReach, finder_.reach(thought));
  Region around = grown(window, first).cut(this->frame());
  segmented_ = segment(segmenter_, frame.left, around);
  match(frame, window, around);
  // A finger nearer than expected needs a larger region.
  if (const int reach = farthest_reach(window); reach > first) {
    around = grown(window, reach).cut(this->frame());
    segmented_ = segment(segmenter_, frame.left, around);
    match(frame, window, around);
  }
  (void)finder_.find(skin_, disparity_, window, expected);
  const std::int64_t pixels = segmented_.pixels();
  HandFinding seen = choose(frame, followed);
  seen.pixels = pixels;
  return seen;
}

// Disparities of blocks of the finger next to the tip. A block with more background than finger measures the
// background, and skin of little detail matches elsewhere. So keep every disparity at which the cap's
// apparent size stays plausible. The candidate's own disparity comes first.
std::size_t HandScene::surfaces_of(const Fingertip& tip, Surfaces& surfaces) {
  std::size_t count = 0;
  const auto take = [&](float surface) {
    const auto end = surfaces.begin() + static_cast<std::ptrdiff_t>(count);
    const auto same = [&](float other) { return std::abs(surface - other) < 1.0F; };
    const double size = finder_.radius_of(static_cast<double>(surface)) / tip.outline;
    if (size < kOther && size > 1.0 / kOther && std::none_of(surfaces.begin(), end, same))
      surfaces[count++] = surface;
  };
  take(disparity_.at(tip.x, tip.y));
  for (const double back : {0.0, 0.5, 1.0, 1.5})
    for (const double aside : {-0.4, 0.0, 0.4}) {
      const auto x = static_cast<int>(tip.column + tip.outline * (back * tip.along_x - aside * tip.along_y));
      const auto y = static_cast<int>(tip.row + tip.outline * (back * tip.along_y + aside * tip.along_x));
      if (skin_.whole().contains(x, y) && skin_.at(x, y))
        take(matcher_.at(grey_left_, grey_right_, x, y, &skin_).pixels);
    }
  if (count == 0) surfaces[count++] = disparity_.at(tip.x, tip.y);
  return count;
}

// Position of the tip's shape in the right image, within the same bounds.
std::size_t HandScene::shapes_of(const Fingertip& tip, const StereoFrame& frame, std::span<float> surfaces) {
  const double middle = tip.outline / finder_.radius_of(1.0);
  const ShiftRange range{std::max(matcher_.least(), static_cast<int>(middle / kOther)),
                         std::min(matcher_.most(), static_cast<int>(middle * kOther))};
  const Region part = opposite(tip, range, this->frame());
  if (range.most <= range.least || part.empty()) return 0;
  segment_right(frame, part);
  const std::size_t count = alike_shapes(skin_, right_skin_, tip, range, surfaces);
  for (float& shift : surfaces.first(count))
    shift = static_cast<float>(front_of(static_cast<double>(shift), tip.outline, pair().focal));
  return count;
}

void HandScene::sharpen(Fingertip& tip) const {
  const CapFit fit{true, {tip.column, tip.row}, tip.outline, tip.along_x, tip.along_y};
  const CapFit sharp = sharpen_cap(skin_, grey_left_, pair(), fit);
  tip.column = sharp.centre.column;
  tip.row = sharp.centre.row;
  tip.outline = sharp.radius;
  tip.along_x = sharp.along_x;
  tip.along_y = sharp.along_y;
}

// Disparity of the cap's middle by its outline in the right image. NaN if the outline cannot be fitted there,
// or if it differs from that of the left image in size or row.
double HandScene::outline_disparity(const Fingertip& tip, const StereoFrame& frame, double disparity) {
  constexpr double kAlike = 0.15;                  // of the radius
  constexpr double kSameRow = 1.0, kMisfit = 0.7;  // px
  // Radii: largest shift of the fit, and the distance that it reads from there.
  constexpr double kMoves = 2.0, kAround = kFarthest * (1.0 + kAlike) + kMoves;
  const Pixel start{tip.column - disparity, tip.row};
  const auto x = static_cast<int>(start.column), y = static_cast<int>(start.row);
  const int far = static_cast<int>(kAround * tip.outline) + 1;
  const Region part = Region{x - far, y - far, x + far + 1, y + far + 1}.cut(this->frame());
  if (part.empty()) return kUnset;
  to_grey(segment_right(frame, part), part, grey_right_);
  const auto fits = [&](const CapFit& fit) {
    return fit.good && std::abs(fit.radius / tip.outline - 1.0) < kAlike &&
           std::hypot(fit.centre.column - start.column, fit.centre.row - start.row) < kMoves * tip.outline;
  };
  const CapFit rough = fit_cap(right_skin_, pair(), start, tip.outline);
  if (!fits(rough)) return kUnset;
  const CapFit fine = sharpen_cap(right_skin_, grey_right_, pair(), rough);
  const bool same = fits(fine) && std::abs(fine.centre.row - tip.row) < kSameRow && fine.misfit < kMisfit;
  const double found = tip.column - fine.centre.column;
  return same && found >= matcher_.least() && found <= matcher_.most() ? found : kUnset;
}

CapDisparity HandScene::match_from(const Fingertip& tip, double middle) const {
  const std::array front{static_cast<float>(front_of(middle, tip.outline, pair().focal))};
  return match_cap(grey_left_, grey_right_, skin_, tip, pair(), front);
}

// Dark skin of little detail fits nearly as well a pixel off, with another slope. If it fits as well at the
// disparity of the outline, that disparity is right. It is not used if it contradicts the expected position
// of a tracked finger.
void HandScene::confirm(const Fingertip& tip, const StereoFrame& frame, double expected, CapDisparity& cap) {
  constexpr double kApart = 0.8, kElsewhere = 6.0;  // px
  constexpr double kAlike = 1.2;                    // times the residual
  constexpr double kDisagree = 0.5;                 // px rms, if outline and match differ
  const double outline = outline_disparity(tip, frame, cap.disparity);
  if (expected > 0.0 && !is_near(outline / expected)) return;
  const double apart = std::abs(outline - cap.disparity);
  if (!(apart > kApart && apart <= kElsewhere)) return;
  const CapDisparity there = match_cap_at(grey_left_, grey_right_, skin_, tip, pair(), outline);
  if (!there.good || there.left_over > kAlike * cap.left_over) return;
  cap = there;
  cap.variance = kDisagree * kDisagree;
}

// A tracked finger cannot come much nearer or move much farther away within a frame. If the blocks say so,
// search at the expected disparity instead.
void HandScene::measure(HandFinding& seen, const StereoFrame& frame, double expected) {
  constexpr double kUnrefined = 0.5;  // px rms, error of a block on a cap
  Surfaces surfaces{};
  std::size_t count = surfaces_of(seen.tip, surfaces);
  if (!(expected > 0.0)) count += shapes_of(seen.tip, frame, std::span(surfaces).subspan(count));
  CapDisparity cap = match_cap(grey_left_, grey_right_, skin_, seen.tip, pair(),
                               std::span<const float>(surfaces.data(), count));
  if (expected > 0.0 && !(cap.good && is_near(cap.disparity / expected))) {
    if (const CapDisparity there = match_from(seen.tip, expected); there.good) cap = there;
  }
  if (cap.good && seen.tip.fitted) confirm(seen.tip, frame, expected, cap);
  const auto surface = static_cast<double>(disparity_.at(seen.tip.x, seen.tip.y));
  seen.evidence.matched = cap.good;
  seen.evidence.cap_slope = std::tan(cap.slope);
  seen.disparity = cap.good ? cap.disparity : middle_of(surface, seen.tip.outline, pair().focal);
  seen.variance = cap.good ? cap.variance : kUnrefined * kUnrefined;
}

// ---- Evidence for and against a detection of HandScene: the finger behind the tip, and the hand behind that
// finger.

namespace {

constexpr double kReach = 16.0;         // radii of the cap: a finger and the start of its hand
constexpr double kFollowedReach = 3.0;  // radii, for a tracked finger, which needs less evidence
constexpr double kHandReach = 9.0;      // widths of the finger, from its tip to its palm
// A part that comes nearer looks larger. If its slope is unknown, the finger may be shorter than the image
// shows by this factor.
constexpr double kUnsloped = 0.9;
constexpr std::size_t kFirstSpot = 2;  // first point of the middle line beyond the cap itself

// Slope of a path away from the camera, per length along the image.
double slope_along(const Vec3& way) { return way.z() / std::max(1e-6, std::hypot(way.x(), way.y())); }

// A straight finger is longer than a thumb.
bool is_straight(const FingerEvidence& e) {
  constexpr double kStraight = 3.2;  // widths
  return e.length > kStraight * e.width;
}

// Positions along a finger with the disparities of blocks there. Skin of little detail matches anywhere, so
// only positions on one line count.
class Spots {
 public:
  void add(double off, double disparity) { at_[count_++] = {off, disparity}; }
  // Disparity changes linearly along a straight line [Theil].
  void fit() {
    constexpr double kOff = 0.004, kBlockOff = 0.4;  // share of the disparity; px
    std::array<double, FingerForm::kSpots * FingerForm::kSpots> rates{};
    std::array<double, FingerForm::kSpots> starts{};
    std::size_t rate_count = 0;
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t j = i + 1; j < count_; ++j)
        if (const double apart = at_[j].off - at_[i].off; apart > 1.0)
          rates[rate_count++] = (at_[j].disparity - at_[i].disparity) / apart;
    rate_ = upper_median(std::span(rates.data(), rate_count));
    for (std::size_t i = 0; i < count_; ++i) starts[i] = at_[i].disparity - rate_ * at_[i].off;
    start_ = upper_median(std::span(starts.data(), count_));
    good_ =
        count_ + 1 >= FingerForm::kSpots - kFirstSpot &&
        std::all_of(at_.begin(), at_.begin() + static_cast<std::ptrdiff_t>(count_), [&](const At& at) {
          return std::abs(start_ + rate_ * at.off - at.disparity) < std::max(kBlockOff, kOff * at.disparity);
        });
  }
  [[nodiscard]] bool good() const { return good_; }
  [[nodiscard]] double disparity(double off) const { return start_ + rate_ * off; }

 private:
  struct At {
    double off = 0.0, disparity = 0.0;  // px from the tip; px
  };
  std::array<At, FingerForm::kSpots> at_;
  std::size_t count_ = 0;
  double start_ = kUnset, rate_ = kUnset;
  bool good_ = false;
};

}  // namespace

// Segments more of the left image than look() needed.
void HandScene::segment_too(const StereoFrame& frame, const Region& wanted) {
  if (wanted.cut(segmented_) == wanted) return;
  const Region more = segment(segmenter_, frame.left, wanted);
  if (segmented_.cut(more) == segmented_) segmented_ = more;
}

// Prepares the images for matching blocks within `part`.
void HandScene::make_ready(const StereoFrame& frame, const Region& part) {
  const Region left = matcher_.left_of(part), right = matcher_.right_of(part);
  to_grey(rectified(Side::left, frame.left, left), left, grey_left_);
  to_grey(rectified(Side::right, frame.right, right), right, grey_right_);
}

// Counts the sides of the finger with an equally near surface; then the finger is part of that surface.
int HandScene::flanks(const Pixel& at, const Fingertip& tip, double width, double disparity) {
  constexpr double kBeyond = 0.9;   // radii
  constexpr double kClear = 6.0;    // px: a block of 8 px beside the finger does not touch it
  constexpr double kAsNear = 0.04;  // of the distance
  const double aside = 0.5 * width + std::max(kBeyond * tip.outline, kClear);
  int count = 0;
  for (const double side : {-aside, aside}) {
    const auto x = static_cast<int>(at.column - side * tip.along_y);
    const auto y = static_cast<int>(at.row + side * tip.along_x);
    const auto there = static_cast<double>(matcher_.at(grey_left_, grey_right_, x, y).pixels);
    count += std::abs(there / disparity - 1.0) < kAsNear ? 1 : 0;
  }
  return count;
}

// The path from one position to another along the axes of the rectified image, m.
Vec3 HandScene::in_image(const Triplet& to, const Triplet& from) const {
  return pair().turn.transpose() * (triangulate(pair(), to) - triangulate(pair(), from)).e();
}

// Evidence of the cap, which is measured in any case.
void HandScene::weigh_cap(HandFinding& seen) const {
  FingerEvidence& e = seen.evidence;
  e.outlined = seen.tip.fitted;
  e.tip = triangulate(pair(), {seen.tip.column, seen.tip.row, seen.disparity});
  if (!seen.tip.fitted || !(seen.disparity > 0.0)) return;
  e.depth = pair().focal * pair().baseline / seen.disparity;
  e.depth_noise = e.depth / seen.disparity * std::sqrt(seen.variance);
  e.cap = 2.0 * seen.tip.outline * pair().baseline / seen.disparity;
}

// Form of the finger behind the tip in the mask.
FingerForm HandScene::form_behind(HandFinding& seen, const StereoFrame& frame, double reach) {
  const Region part = form_region(seen.tip, reach, this->frame());
  segment_too(frame, part);
  const FingerForm form = form_of(skin_, seen.tip, reach);
  const double each = pair().baseline / seen.disparity;  // m per pixel at the tip
  seen.evidence.width = form.width * each;
  seen.evidence.length = form.length * each;
  seen.evidence.end = form.end;
  return form;
}

// Length and slope of the finger, and the depth of its tip that follows from them.
void HandScene::weigh_finger(const FingerForm& form, const StereoFrame& frame, HandFinding& seen) {
  FingerEvidence& e = seen.evidence;
  const Fingertip& tip = seen.tip;
  make_ready(frame, form_region(tip, kReach, this->frame()));
  Spots spots;
  for (std::size_t i = kFirstSpot; i < FingerForm::kSpots; ++i) {
    const Pixel& at = form.spots[i];
    const double off = std::hypot(at.column - tip.column, at.row - tip.row);
    if (!(off >= 1.0)) continue;
    const auto x = static_cast<int>(at.column), y = static_cast<int>(at.row);
    const auto surface = static_cast<double>(matcher_.at(grey_left_, grey_right_, x, y, &skin_).pixels);
    if (!(surface > 0.0)) continue;
    e.flanks += flanks(at, tip, form.width, surface);
    spots.add(off, middle_of(surface, tip.outline * surface / seen.disparity, pair().focal));
  }
  spots.fit();
  const double pixels = form.length - tip.outline;
  if (!spots.good() || !(spots.disparity(pixels) > 0.0)) {
    e.length *= kUnsloped;
    return;
  }
  const Pixel& last = form.spots.back();
  const Vec3 way =
      in_image({last.column, last.row, spots.disparity(pixels)}, {tip.column, tip.row, spots.disparity(0.0)});
  e.length = way.norm() + 0.5 * e.cap;
  e.slope = slope_along(way);
  e.depth_off = e.depth * (seen.disparity / spots.disparity(0.0) - 1.0);
}

void HandScene::weigh_hand(const StereoFrame& frame, double width, HandFinding& seen) {
  if (!palm_measured_) {
    segment_too(frame, this->frame());
    palm_.measure(skin_);
    palm_measured_ = true;
  }
  const Pixel palm = palm_.near({seen.tip.column, seen.tip.row}, kHandReach * width);
  if (!(palm.column >= 0.0)) return;
  constexpr double kSteepest = 2.0;  // tangent: a steeper match is skin of little detail, matched elsewhere
  const Triplet tip{seen.tip.column, seen.tip.row, seen.disparity};
  Triplet at{palm.column, palm.row, disparity_around(frame, palm)};
  Vec3 way = in_image(at, tip);
  FingerEvidence& e = seen.evidence;
  if (std::abs(slope_along(way)) < kSteepest) {
    e.hand = way.norm();
    e.hand_slope = slope_along(way);
  } else {
    at.disparity = tip.disparity;
    way = in_image(at, tip);
    e.hand = kUnsloped * way.norm();
  }
  e.palm = triangulate(pair(), at);
}

// px, median disparity of some blocks of skin; NaN if too few match.
double HandScene::disparity_around(const StereoFrame& frame, const Pixel& at) {
  constexpr int kAround = 2, kStride = 6, kFewest = 4;  // blocks to each side; px; blocks
  constexpr int kFar = kAround * kStride;
  const auto x = static_cast<int>(at.column), y = static_cast<int>(at.row);
  make_ready(frame, Region{x - kFar, y - kFar, x + kFar + 1, y + kFar + 1}.cut(this->frame()));
  std::array<double, (2 * kAround + 1) * (2 * kAround + 1)> found{};
  std::size_t count = 0;
  for (int dy = -kFar; dy <= kFar; dy += kStride)
    for (int dx = -kFar; dx <= kFar; dx += kStride) {
      const float there = matcher_.at(grey_left_, grey_right_, x + dx, y + dy, &skin_).pixels;
      if (there > 0.0F) found[count++] = static_cast<double>(there);
    }
  return count >= kFewest ? upper_median(std::span(found.data(), count)) : kUnset;
}

// True if a detection continues the tracked finger: near the predicted position, equally wide, and straight.
// This reads no more of the images than was already needed.
bool HandScene::goes_on(HandFinding& seen, const StereoFrame& frame, const FingerHint& followed) {
  constexpr double kNear = 0.020;  // m: a detection farther off may be another finger of the hand
  if (!(followed.cap > 0.0)) return false;
  if (!((seen.evidence.tip - triangulate(pair(), followed.at)).norm() < kNear)) return false;
  if (seen.tip.fitted) (void)form_behind(seen, frame, kFollowedReach);
  seen.followed = doubt_of_followed(seen.evidence, limits_, followed.cap) == Doubt::no;
  return seen.followed;
}

void HandScene::recognise(HandFinding& seen, const StereoFrame& frame) {
  if (seen.tip.fitted && seen.disparity > 0.0) {
    const FingerForm form = form_behind(seen, frame, kReach);
    if (form.width > 0.0) weigh_finger(form, frame, seen);
    seen.doubt = doubt_of_finger(seen.evidence, limits_);
    if (seen.doubt != Doubt::no && !is_straight(seen.evidence)) return;
    weigh_hand(frame, std::max(form.width, 2.0 * seen.tip.outline), seen);
  }
  seen.doubt = doubt_of(seen.evidence, limits_);
}

// True if a hand near the detection has three or more straight fingers: then the pointing one is ambiguous.
bool HandScene::near_many(const HandFinding& one, std::span<const HandFinding> all) {
  constexpr double kSameHand = 5.0, kOfHand = 9.0;  // widths of the finger: between palms; from tip to palm
  constexpr std::ptrdiff_t kMany = 3;
  const double cap = one.evidence.cap;
  return std::any_of(all.begin(), all.end(), [&](const HandFinding& hand) {
    const Point<'C'>& palm = hand.evidence.palm;
    if (!((palm - one.evidence.tip).norm() < kOfHand * cap)) return false;
    return std::count_if(all.begin(), all.end(), [&](const HandFinding& finger) {
             const FingerEvidence& e = finger.evidence;
             return is_straight(e) && (e.palm - palm).norm() < kSameHand * cap;
           }) >= kMany;
  });
}

// Chooses the fingertip that continues the tracked finger, else the accepted one farthest from its palm. If
// none is accepted, it returns the first one with its doubt.
HandScene::HandFinding HandScene::choose(const StereoFrame& frame, const FingerHint& followed) {
  std::array<HandFinding, FingertipFinder::kMost> seen;
  const std::span<HandFinding> all(seen.data(), finder_.count());
  for (std::size_t i = 0; i < all.size(); ++i) {
    HandFinding& one = all[i];
    one.tip = finder_.tip(skin_, i);
    if (one.tip.fitted) sharpen(one.tip);
    measure(one, frame, followed.at.disparity);
    weigh_cap(one);
    if (goes_on(one, frame, followed)) return one;
  }
  for (HandFinding& one : all) recognise(one, frame);
  for (HandFinding& one : all)
    if (one.doubt == Doubt::no && near_many(one, all)) one.doubt = Doubt::fingers;
  const auto surer = [](const HandFinding& a, const HandFinding& b) {
    if (a.doubt != Doubt::no || b.doubt != Doubt::no) return b.doubt == Doubt::no && a.doubt != Doubt::no;
    return reach_of(a.evidence) < reach_of(b.evidence);
  };
  const auto best = std::max_element(all.begin(), all.end(), surer);
  return best == all.end() ? HandFinding{} : *best;
}

}  // namespace enc
