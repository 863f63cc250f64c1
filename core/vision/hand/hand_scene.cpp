#include "core/vision/hand/hand_scene.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/vision/finger/cap_fit.h"
#include "core/vision/finger/silhouette.h"

namespace enc {
namespace {

// The least box round the skin within `window`; empty where there is none.
Region box_of(const Mask& skin, const Region& window) {
  if (window.empty()) return {};
  Region box{window.x1, window.y1, window.x0, window.y0};
  for (int y = window.y0; y < window.y1; ++y) {
    const std::uint8_t* row = skin.row(y);
    for (int x = window.x0; x < window.x1; ++x)
      if (row[x] != 0) {
        box = {std::min(box.x0, x), std::min(box.y0, y), std::max(box.x1, x + 1), y + 1};
        x = std::max(x, box.x1 - 1);  // what is between changes nothing
      }
  }
  return box;
}

Region grown(const Region& region, int by) {
  return {region.x0 - by, region.y0 - by, region.x1 + by, region.y1 + by};
}

constexpr double kOther = 1.6;  // times as large a cap: more than K and the mask may be off

// Of a disparity over the one that was expected: 3 m/s at 600 mm and 20 Hz.
bool is_near(double ratio) {
  constexpr double kNearer = 1.25;
  return ratio < kNearer && ratio > 1.0 / kNearer;
}

// Every tile is foreground, so that hue alone tells skin.
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

// Tiles and the median look a little beyond what they tell.
Region HandScene::read_for(const Segmenter& segmenter, const Region& wanted) const {
  return grown(segmenter.on_grid(wanted), segmentation_.median + 2 * segmentation_.tile);
}

Region HandScene::segment(Segmenter& segmenter, const ImageView& raw, const Region& wanted) {
  // The light of a frame is measured all over it.
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
  for (int row = 0; row < Exchanged::kRows; ++row) {
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
  Seen seen;
  seen.tip = finder_.find(skin_, disparity_, this->frame());
  finger_in_background_ = seen.tip.found && (seen.tip.fitted || seen.tip.score > 0.8);
}

// `around` is what may be asked of the images later, `window` what is asked of the disparity now.
void HandScene::match(const StereoFrame& frame, const Region& window, const Region& around) {
  disparity_.match(matcher_, grey_left_, grey_right_, skin_, Region{});
  const Region box = box_of(skin_, around);
  if (box.empty()) return;
  constexpr int kBeyond = 8;  // px: how far the fit of the cap looks beyond the mask
  const Region cells = grown(box, DisparityMap::kCell + kBeyond);
  const Region left = matcher_.left_of(cells), right = matcher_.right_of(cells);
  to_grey(rectified(Side::left, frame.left, left), left, grey_left_);
  to_grey(rectified(Side::right, frame.right, right), right, grey_right_);
  disparity_.match(matcher_, grey_left_, grey_right_, skin_, window.cut(box));
}

// Beyond each pixel of skin with its depth.
int HandScene::farthest_reach(const Region& window) const {
  float most = 0.0F;
  const Region box = box_of(skin_, window);
  for (int y = box.y0; y < box.y1; ++y)
    for (int x = box.x0; x < box.x1; ++x)
      if (skin_.at(x, y) && disparity_.at(x, y) > most) most = disparity_.at(x, y);
  return finder_.reach(static_cast<double>(most));
}

HandScene::Seen HandScene::look(const StereoFrame& frame, const Region& window, const Followed& followed) {
  const Triplet& expected = followed.at;
  palm_measured_ = false;
  const double thought = expected.disparity > 0.0 ? 1.3 * expected.disparity : 0.0;
  const int first = std::max(DisparityMap::kReach, finder_.reach(thought));
  Region around = grown(window, first).cut(this->frame());
  segmented_ = segment(segmenter_, frame.left, around);
  match(frame, window, around);
  // A finger that is nearer than thought needs more round it.
  if (const int reach = farthest_reach(window); reach > first) {
    around = grown(window, reach).cut(this->frame());
    segmented_ = segment(segmenter_, frame.left, around);
    match(frame, window, around);
  }
  (void)finder_.find(skin_, disparity_, window, expected);
  const std::int64_t pixels = segmented_.pixels();
  Seen seen = choose(frame, followed);
  seen.pixels = pixels;
  return seen;
}

// Of blocks of the finger next to the tip. One that has more of the background than of a thin finger tells
// how far that is, and skin of little detail is like itself elsewhere: all are told by which the cap would
// not look much larger or smaller than it does. The candidate's own comes first.
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

// Where in the right image the tip's shape is, within the same bounds.
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

// The cap's outline is that of its middle in the right image, too: where it lies there. NaN where it cannot
// be fitted, or not to one like that of the left image in the same row.
double HandScene::outline_disparity(const Fingertip& tip, const StereoFrame& frame, double disparity) {
  constexpr double kAlike = 0.15;                  // of the radius
  constexpr double kSameRow = 1.0, kMisfit = 0.7;  // px
  // Radii: how far the fit moves at most, and how far it looks from there.
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

// Dark skin of little detail fits nearly as well a pixel off, with another slope: where it does so at the
// place that the outline in the right image tells, that is right. It does not lead away from where a followed
// finger is expected.
void HandScene::confirm(const Fingertip& tip, const StereoFrame& frame, double expected, CapDisparity& cap) {
  constexpr double kApart = 0.8, kElsewhere = 6.0;  // px
  constexpr double kAlike = 1.2;                    // times what is left over
  constexpr double kDisagree = 0.5;                 // px rms, where outline and match are apart
  const double outline = outline_disparity(tip, frame, cap.disparity);
  if (expected > 0.0 && !is_near(outline / expected)) return;
  const double apart = std::abs(outline - cap.disparity);
  if (!(apart > kApart && apart <= kElsewhere)) return;
  const CapDisparity there = match_cap_at(grey_left_, grey_right_, skin_, tip, pair(), outline);
  if (!there.good || there.left_over > kAlike * cap.left_over) return;
  cap = there;
  cap.variance = kDisagree * kDisagree;
}

// A followed finger cannot have come much nearer or gone much farther since the last frame: where the blocks
// say so, it is looked for where it is expected.
void HandScene::measure(Seen& seen, const StereoFrame& frame, double expected) {
  constexpr double kUnrefined = 0.5;  // px rms, of a block that sees a cap
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

}  // namespace enc
