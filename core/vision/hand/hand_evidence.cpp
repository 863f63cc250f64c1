// What speaks for a find of HandScene and against it: the finger behind the tip, and the hand behind that.
#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "core/vision/finger/hand_scene.h"

namespace enc {
namespace {

constexpr double kReach = 16.0;         // radii of the cap: a finger and the first of its hand
constexpr double kFollowedReach = 6.0;  // of a finger that is followed less is asked
constexpr double kHandReach = 9.0;      // widths of the finger, from its tip to its palm
constexpr std::size_t kFirstSpot = 2;   // of the finger's middle line: not the cap itself

template <std::size_t N>
double middle_of_some(std::array<double, N>& values, std::size_t count) {
  if (count == 0) return kUnset;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(count / 2);
  std::nth_element(values.begin(), middle, values.begin() + static_cast<std::ptrdiff_t>(count));
  return *middle;
}

// Places along a finger, with what blocks there say of its depth. Skin of little detail is matched anywhere:
// only places that lie on one line count.
class Spots {
 public:
  void add(double off, double disparity) { at_[count_++] = {off, disparity}; }
  // Disparity is even along a straight line [Theil].
  void fit() {
    constexpr double kOff = 0.004;  // of the disparity
    std::array<double, FingerForm::kSpots * FingerForm::kSpots> rates{};
    std::array<double, FingerForm::kSpots> starts{};
    std::size_t rate_count = 0;
    for (std::size_t i = 0; i < count_; ++i)
      for (std::size_t j = i + 1; j < count_; ++j)
        if (const double apart = at_[j].off - at_[i].off; apart > 1.0)
          rates[rate_count++] = (at_[j].disparity - at_[i].disparity) / apart;
    rate_ = middle_of_some(rates, rate_count);
    for (std::size_t i = 0; i < count_; ++i) starts[i] = at_[i].disparity - rate_ * at_[i].off;
    start_ = middle_of_some(starts, count_);
    good_ = count_ + 1 >= FingerForm::kSpots - kFirstSpot &&
            std::all_of(at_.begin(), at_.begin() + static_cast<std::ptrdiff_t>(count_), [&](const At& at) {
              return std::abs(start_ + rate_ * at.off - at.disparity) < kOff * at.disparity;
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

// On how many sides of the finger something is as near as the finger there: then it is part of a surface.
int HandScene::flanks(const Pixel& at, const Fingertip& tip, double width, double disparity) {
  constexpr double kBeyond = 0.9;   // radii
  constexpr double kAsNear = 0.04;  // of the distance
  const double aside = 0.5 * width + kBeyond * tip.outline;
  int count = 0;
  for (const double side : {-aside, aside}) {
    const auto x = static_cast<int>(at.column - side * tip.along_y);
    const auto y = static_cast<int>(at.row + side * tip.along_x);
    const auto there = static_cast<double>(matcher_.at(grey_left_, grey_right_, x, y).pixels);
    count += std::abs(there / disparity - 1.0) < kAsNear ? 1 : 0;
  }
  return count;
}

// Length and slope of the finger, and what it says of the depth of its tip. Where blocks do not tell how it
// slopes it is as long as the image shows.
void HandScene::weigh_finger(const FingerForm& form, Seen& seen) {
  FingerEvidence& e = seen.evidence;
  const Fingertip& tip = seen.tip;
  const double each = pair().baseline / seen.disparity;  // m that a pixel is wide at the tip
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
  e.width = form.width * each;
  e.end = form.end;
  e.slope = 0.0;
  e.length = form.length * each;
  const double pixels = form.length - tip.outline;
  const Pixel& last = form.spots.back();
  if (!spots.good() || !(spots.disparity(pixels) > 0.0)) return;
  const Vec3 way =
      pair().turn.transpose() * (triangulate(pair(), {last.column, last.row, spots.disparity(pixels)}) -
                                 triangulate(pair(), {tip.column, tip.row, spots.disparity(0.0)}))
                                    .e();
  e.length = way.norm() + tip.outline * each;
  e.slope = way.z() / std::max(1e-6, std::hypot(way.x(), way.y()));
  e.slope_known = true;
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
  constexpr int kAround = 2, kStep = 6, kFewest = 4;  // blocks to each side; px; blocks
  const auto x = static_cast<int>(palm.column), y = static_cast<int>(palm.row);
  constexpr int kFar = kAround * kStep;
  make_ready(frame, Region{x - kFar, y - kFar, x + kFar + 1, y + kFar + 1}.cut(this->frame()));
  std::array<double, (2 * kAround + 1) * (2 * kAround + 1)> found{};
  std::size_t count = 0;
  for (int dy = -kFar; dy <= kFar; dy += kStep)
    for (int dx = -kFar; dx <= kFar; dx += kStep) {
      const float there = matcher_.at(grey_left_, grey_right_, x + dx, y + dy, &skin_).pixels;
      if (there > 0.0F) found[count++] = static_cast<double>(there);
    }
  // Skin of little detail may be matched nowhere, and a finger of which the slope is not known is as long as
  // the image shows: then its hand is as far off as the image shows, too.
  FingerEvidence& e = seen.evidence;
  const bool told = e.slope_known && count >= kFewest;
  e.palm = triangulate(pair(), {palm.column, palm.row, told ? middle_of_some(found, count) : seen.disparity});
  const Vec3 way = pair().turn.transpose() * (e.palm - e.tip).e();
  e.hand = way.norm();
  if (told) e.hand_slope = way.z() / std::max(1e-6, std::hypot(way.x(), way.y()));
}

void HandScene::weigh(Seen& seen, const StereoFrame& frame, bool hand_too) {
  FingerEvidence& e = seen.evidence;
  const Fingertip& tip = seen.tip;
  const bool matched = e.matched;
  e = {};
  e.matched = matched;
  e.outlined = tip.fitted;
  e.tip = triangulate(pair(), {tip.column, tip.row, seen.disparity});
  if (!tip.fitted || !(seen.disparity > 0.0)) return;
  e.depth = pair().focal * pair().baseline / seen.disparity;
  e.depth_noise = e.depth / seen.disparity * std::sqrt(seen.variance);
  e.cap = 2.0 * tip.outline * pair().baseline / seen.disparity;
  const double reach = hand_too ? kReach : kFollowedReach;
  const Region part = form_region(tip, reach, this->frame());
  segment_too(frame, part);
  make_ready(frame, part);
  const FingerForm form = form_of(skin_, tip, reach);
  if (!(form.width > 0.0)) return;
  weigh_finger(form, seen);
  if (hand_too) weigh_hand(frame, std::max(form.width, 2.0 * tip.outline), seen);
}

void HandScene::judge(Seen& seen, const StereoFrame& frame, const Followed& followed) {
  constexpr double kNear = 0.025;  // m: farther off it may be another finger of the hand
  const Point<'C'> foreseen = triangulate(pair(), followed.at);
  if (followed.cap > 0.0) {
    weigh(seen, frame, false);
    if ((seen.evidence.tip - foreseen).norm() < kNear) {
      seen.doubt = doubt_of_followed(seen.evidence, limits_, followed.cap);
      if (seen.doubt == Doubt::no) return;
    }
  }
  weigh(seen, frame, true);
  seen.doubt = doubt_of(seen.evidence, limits_);
}

// Near the palm of a hand that has three or more straight fingers: which of them points cannot be known.
bool HandScene::near_many(const Seen& one, std::span<const Seen> all) {
  constexpr double kSameHand = 5.0, kOfHand = 9.0;  // widths of the finger: between palms; from tip to palm
  constexpr double kStraight = 3.2;                 // widths: so long is a thumb at most
  constexpr std::ptrdiff_t kMany = 3;
  const double cap = one.evidence.cap;
  return std::any_of(all.begin(), all.end(), [&](const Seen& hand) {
    const Point<'C'>& palm = hand.evidence.palm;
    if (!((palm - one.evidence.tip).norm() < kOfHand * cap)) return false;
    return std::count_if(all.begin(), all.end(), [&](const Seen& finger) {
             const FingerEvidence& e = finger.evidence;
             return e.length > kStraight * e.width && (e.palm - palm).norm() < kSameHand * cap;
           }) >= kMany;
  });
}

// Of the finder's fingertips the first that is believed where one is followed, else the surest. Where none
// is, the first with its doubt.
HandScene::Seen HandScene::choose(const StereoFrame& frame, const Followed& followed) {
  Seen best;
  std::array<Seen, FingertipFinder::kMost> seen;
  std::size_t count = 0;
  for (; count < finder_.count(); ++count) {
    Seen& one = seen[count];
    one.tip = finder_.tip(skin_, count);
    if (one.tip.fitted) sharpen(one.tip);
    measure(one, frame, followed.at.disparity);
    judge(one, frame, followed);
    if (one.doubt == Doubt::no && !std::isnan(followed.at.column)) return one;
  }
  const std::span<Seen> all(seen.data(), count);
  for (Seen& one : all)
    if (one.doubt == Doubt::no && near_many(one, all)) one.doubt = Doubt::fingers;
  if (!all.empty()) best = all.front();
  for (const Seen& one : all) {
    if (one.doubt != Doubt::no) continue;
    if (best.doubt != Doubt::no || trust_of(one.evidence, limits_) > trust_of(best.evidence, limits_))
      best = one;
  }
  return best;
}

}  // namespace enc
