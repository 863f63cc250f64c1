// What speaks for a find of HandScene and against it: the finger behind the tip, and the hand behind that.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/vision/hand/hand_scene.h"
#include "core/vision/hand/median.h"

namespace enc {
namespace {

constexpr double kReach = 16.0;         // radii of the cap: a finger and the first of its hand
constexpr double kFollowedReach = 3.0;  // likewise, where less is asked of a finger that is followed
constexpr double kHandReach = 9.0;      // widths of the finger, from its tip to its palm
// What comes nearer looks larger: where its slope is not known a finger may be so much shorter than the image
// shows.
constexpr double kUnsloped = 0.9;
constexpr std::size_t kFirstSpot = 2;  // of the finger's middle line: not the cap itself

// How a way goes away from the camera, for each length along the image.
double slope_along(const Vec3& way) { return way.z() / std::max(1e-6, std::hypot(way.x(), way.y())); }

// Longer than a thumb.
bool is_straight(const FingerEvidence& e) {
  constexpr double kStraight = 3.2;  // widths
  return e.length > kStraight * e.width;
}

// Places along a finger, with what blocks there say of its depth. Skin of little detail is matched anywhere:
// only places that lie on one line count.
class Spots {
 public:
  void add(double off, double disparity) { at_[count_++] = {off, disparity}; }
  // Disparity is even along a straight line [Theil].
  void fit() {
    constexpr double kOff = 0.004, kBlockOff = 0.4;  // of the disparity; px
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

// More of the left image than look() needed.
void HandScene::segment_too(const StereoFrame& frame, const Region& wanted) {
  if (wanted.cut(segmented_) == wanted) return;
  const Region more = segment(segmenter_, frame.left, wanted);
  if (segmented_.cut(more) == segmented_) segmented_ = more;
}

// Blocks may be matched within `part`.
void HandScene::make_ready(const StereoFrame& frame, const Region& part) {
  const Region left = matcher_.left_of(part), right = matcher_.right_of(part);
  to_grey(rectified(Side::left, frame.left, left), left, grey_left_);
  to_grey(rectified(Side::right, frame.right, right), right, grey_right_);
}

// Counts the sides of the finger where something is as near as the finger: then it is part of a surface.
int HandScene::flanks(const Pixel& at, const Fingertip& tip, double width, double disparity) {
  constexpr double kBeyond = 0.9;   // radii
  constexpr double kClear = 6.0;    // px: a block of 8 px beside the finger has nothing of it
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

// The way from one place to another along the axes of the rectified image, m.
Vec3 HandScene::in_image(const Triplet& to, const Triplet& from) const {
  return pair().turn.transpose() * (triangulate(pair(), to) - triangulate(pair(), from)).e();
}

// What the cap tells, which is measured anyway.
void HandScene::weigh_cap(Seen& seen) const {
  FingerEvidence& e = seen.evidence;
  e.outlined = seen.tip.fitted;
  e.tip = triangulate(pair(), {seen.tip.column, seen.tip.row, seen.disparity});
  if (!seen.tip.fitted || !(seen.disparity > 0.0)) return;
  e.depth = pair().focal * pair().baseline / seen.disparity;
  e.depth_noise = e.depth / seen.disparity * std::sqrt(seen.variance);
  e.cap = 2.0 * seen.tip.outline * pair().baseline / seen.disparity;
}

// The finger behind the tip, as the mask shows it.
FingerForm HandScene::form_behind(Seen& seen, const StereoFrame& frame, double reach) {
  const Region part = form_region(seen.tip, reach, this->frame());
  segment_too(frame, part);
  const FingerForm form = form_of(skin_, seen.tip, reach);
  const double each = pair().baseline / seen.disparity;  // m that a pixel is wide at the tip
  seen.evidence.width = form.width * each;
  seen.evidence.length = form.length * each;
  seen.evidence.end = form.end;
  return form;
}

// Length and slope of the finger, and what it says of the depth of its tip.
void HandScene::weigh_finger(const FingerForm& form, const StereoFrame& frame, Seen& seen) {
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

void HandScene::weigh_hand(const StereoFrame& frame, double width, Seen& seen) {
  if (!palm_measured_) {
    segment_too(frame, this->frame());
    palm_.measure(skin_);
    palm_measured_ = true;
  }
  const Pixel palm = palm_.near({seen.tip.column, seen.tip.row}, kHandReach * width);
  if (!(palm.column >= 0.0)) return;
  constexpr double kSteepest = 2.0;  // tangent: what is steeper is skin of little detail, matched elsewhere
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

// px, the middle one of some blocks of skin; NaN where too few are matched.
double HandScene::disparity_around(const StereoFrame& frame, const Pixel& at) {
  constexpr int kAround = 2, kStep = 6, kFewest = 4;  // blocks to each side; px; blocks
  constexpr int kFar = kAround * kStep;
  const auto x = static_cast<int>(at.column), y = static_cast<int>(at.row);
  make_ready(frame, Region{x - kFar, y - kFar, x + kFar + 1, y + kFar + 1}.cut(this->frame()));
  std::array<double, (2 * kAround + 1) * (2 * kAround + 1)> found{};
  std::size_t count = 0;
  for (int dy = -kFar; dy <= kFar; dy += kStep)
    for (int dx = -kFar; dx <= kFar; dx += kStep) {
      const float there = matcher_.at(grey_left_, grey_right_, x + dx, y + dy, &skin_).pixels;
      if (there > 0.0F) found[count++] = static_cast<double>(there);
    }
  return count >= kFewest ? upper_median(std::span(found.data(), count)) : kUnset;
}

// Whether a find is the finger that is followed: where that is foreseen, of the same width, and straight. Of
// the images nothing more is asked than they were asked already.
bool HandScene::goes_on(Seen& seen, const StereoFrame& frame, const Followed& followed) {
  constexpr double kNear = 0.020;  // m: what is farther off may be another finger of the hand
  if (!(followed.cap > 0.0)) return false;
  if (!((seen.evidence.tip - triangulate(pair(), followed.at)).norm() < kNear)) return false;
  if (seen.tip.fitted) (void)form_behind(seen, frame, kFollowedReach);
  seen.followed = doubt_of_followed(seen.evidence, limits_, followed.cap) == Doubt::no;
  return seen.followed;
}

void HandScene::recognise(Seen& seen, const StereoFrame& frame) {
  if (seen.tip.fitted && seen.disparity > 0.0) {
    const FingerForm form = form_behind(seen, frame, kReach);
    if (form.width > 0.0) weigh_finger(form, frame, seen);
    seen.doubt = doubt_of_finger(seen.evidence, limits_);
    if (seen.doubt != Doubt::no && !is_straight(seen.evidence)) return;
    weigh_hand(frame, std::max(form.width, 2.0 * seen.tip.outline), seen);
  }
  seen.doubt = doubt_of(seen.evidence, limits_);
}

// Whether a hand near the find has three or more straight fingers: which of them points cannot be known.
bool HandScene::near_many(const Seen& one, std::span<const Seen> all) {
  constexpr double kSameHand = 5.0, kOfHand = 9.0;  // widths of the finger: between palms; from tip to palm
  constexpr std::ptrdiff_t kMany = 3;
  const double cap = one.evidence.cap;
  return std::any_of(all.begin(), all.end(), [&](const Seen& hand) {
    const Point<'C'>& palm = hand.evidence.palm;
    if (!((palm - one.evidence.tip).norm() < kOfHand * cap)) return false;
    return std::count_if(all.begin(), all.end(), [&](const Seen& finger) {
             const FingerEvidence& e = finger.evidence;
             return is_straight(e) && (e.palm - palm).norm() < kSameHand * cap;
           }) >= kMany;
  });
}

// The followed finger where one of the finder's fingertips goes on with it, else the one that is believed and
// farthest from its palm. Where none is believed, the first with its doubt.
HandScene::Seen HandScene::choose(const StereoFrame& frame, const Followed& followed) {
  std::array<Seen, FingertipFinder::kMost> seen;
  const std::span<Seen> all(seen.data(), finder_.count());
  for (std::size_t i = 0; i < all.size(); ++i) {
    Seen& one = all[i];
    one.tip = finder_.tip(skin_, i);
    if (one.tip.fitted) sharpen(one.tip);
    measure(one, frame, followed.at.disparity);
    weigh_cap(one);
    if (goes_on(one, frame, followed)) return one;
  }
  for (Seen& one : all) recognise(one, frame);
  for (Seen& one : all)
    if (one.doubt == Doubt::no && near_many(one, all)) one.doubt = Doubt::fingers;
  const auto surer = [](const Seen& a, const Seen& b) {
    if (a.doubt != Doubt::no || b.doubt != Doubt::no) return b.doubt == Doubt::no && a.doubt != Doubt::no;
    return reach_of(a.evidence) < reach_of(b.evidence);
  };
  const auto best = std::max_element(all.begin(), all.end(), surer);
  return best == all.end() ? Seen{} : *best;
}

}  // namespace enc
