#include "core/vision/finger_tracker.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"
#include "core/spec/vision_check.h"
#include "core/vision/finger/cap.h"
#include "core/vision/hand/hand_scene.h"

namespace enc {
struct FingerTracker::Parts {
  Parts(const StereoRig& rig, const SegmentationSpec& segmentation, const FingertipSpec& fingertip,
        const TrackSpec& track_spec, const MatchSpec& match, const Region& search_in)
      : scene(rig, segmentation, fingertip, match), track(track_spec) {
    check(track);
    search = search_in.empty() ? scene.frame() : search_in.cut(scene.frame());
    if (search.empty()) throw Error("the search rectangle is outside of the image", "rig.vision.search_px");
  }

  HandScene scene;
  TrackSpec track;
  Region search;
  TripletFilter filter;
  LookStats stats;
  std::optional<Time> newest;
  Time last_seen{};
  Point<'C'> last_place;  // last seen position; NaN: never seen
  // m, cap widths at recognition: of the tracked finger, and of the detected one.
  double cap = kUnset, found_cap = kUnset;

  [[nodiscard]] FrameRefusal usable(const StereoFrame& frame, Time exposed) const;
  [[nodiscard]] Region window() const;
  [[nodiscard]] HandScene::FingerHint followed() const;
  [[nodiscard]] bool look(const StereoFrame& frame, Time exposed, Triplet& at, Vec3& variance);
  [[nodiscard]] bool too_fast(const HandScene::HandFinding& seen, Time exposed) const;
  void forget_nonsense();
  void take(bool found, Time exposed, const Triplet& at, const Vec3& variance);
  [[nodiscard]] Finger told(Time exposed) const;
};

FrameRefusal FingerTracker::Parts::usable(const StereoFrame& frame, Time exposed) const {
  const Region all = scene.frame();
  if (frame.left.rgb == nullptr || frame.right.rgb == nullptr) return FrameRefusal::missing;
  for (const ImageView& image : {frame.left, frame.right})
    if (image.width != all.x1 || image.height != all.y1) return FrameRefusal::size;
  if (newest && exposed <= *newest) return FrameRefusal::stamp;
  return FrameRefusal::no;
}

// Search window of the finger. The filter is already at this frame's exposure.
Region FingerTracker::Parts::window() const {
  if (!filter.known()) return search;
  const Triplet at = filter.at();
  const Vec3 variance = filter.variance();
  double growth = 1.0;
  for (int i = 0; i < stats.misses; ++i) growth *= track.window_growth;
  const double most = std::max(search.width(), search.height());
  const auto half = [&](double v) {
    return std::min(most, growth * std::max(track.window_least, track.window_sigmas * std::sqrt(v)));
  };
  const double w = half(variance[0]), h = half(variance[1]);
  if (!(std::abs(at.column) < 1e6 && std::abs(at.row) < 1e6)) return search;
  const Region window =
      Region{static_cast<int>(std::floor(at.column - w)), static_cast<int>(std::floor(at.row - h)),
             static_cast<int>(std::ceil(at.column + w)) + 1, static_cast<int>(std::ceil(at.row + h)) + 1}
          .cut(scene.frame());
  return window.empty() ? search : window;  // the finger left the image and may come back anywhere
}

// After more than two frames without the finger it must be recognised anew.
HandScene::FingerHint FingerTracker::Parts::followed() const {
  constexpr int kMisses = 2;
  if (stats.whole_frame) return {};
  return {filter.at(), stats.misses <= kMisses ? cap : kUnset};
}

// True if no hand moves that fast from the last seen position. After a long gap it is another hand.
bool FingerTracker::Parts::too_fast(const HandScene::HandFinding& seen, Time exposed) const {
  constexpr double kFastest = 3.0, kVague = 0.02, kForgotten = 0.5;  // m/s, m, s
  const double since = age(exposed, last_seen);
  if (!last_place.finite() || since > kForgotten) return false;
  return (seen.evidence.tip - last_place).norm() > kVague + kFastest * since;
}

bool FingerTracker::Parts::look(const StereoFrame& frame, Time exposed, Triplet& at, Vec3& variance) {
  HandScene::HandFinding seen = scene.look(frame, stats.window, followed());
  if (seen.doubt == Doubt::no && seen.tip.found && too_fast(seen, exposed)) seen.doubt = Doubt::speed;
  stats.doubt = seen.doubt;
  stats.evidence = seen.evidence;
  stats.pixels = seen.pixels;
  stats.cells_sought = scene.disparity().sought();
  stats.cells_matched = scene.disparity().found();
  stats.steps = scene.finder().counts();
  stats.tip = seen.tip;
  if (!seen.tip.found || !(seen.disparity > 0.0)) return false;
  at = {seen.tip.column, seen.tip.row, seen.disparity};
  const double place = track.pixel_noise * track.pixel_noise;
  variance = {place, place, track.disparity_noise * track.disparity_noise + seen.variance};
  stats.found = at;
  stats.variance = variance;
  found_cap = seen.followed ? cap : seen.evidence.cap;
  return seen.doubt == Doubt::no;
}

void FingerTracker::Parts::take(bool found, Time exposed, const Triplet& at, const Vec3& variance) {
  if (found && filter.known() && filter.surprise(at, variance) > track.gate * track.gate) {
    stats.beyond_gate = true;
    found = false;
  }
  if (!found) {
    ++stats.misses;
    if (stats.misses >= track.full_frame_after && filter.known() &&
        age(exposed, last_seen) > track.predicted_for)
      filter.forget();
    return;
  }
  stats.misses = 0;
  last_seen = exposed;
  last_place = triangulate(scene.pair(), at);
  cap = found_cap;
  if (filter.known())
    filter.correct(at, variance);
  else
    filter.begin(track, exposed, at, variance);
}

// Resets a diverged filter, so that no search relies on it.
void FingerTracker::Parts::forget_nonsense() {
  const Triplet at = filter.at(), rate = filter.rate();
  if (filter.known() && !(at.e().allFinite() && rate.e().allFinite() && filter.variance().allFinite()))
    filter.forget();
}

Finger FingerTracker::Parts::told(Time exposed) const {
  Finger finger;
  finger.exposed = exposed;
  finger.state = FingerState::away;
  if (!filter.known()) return finger;
  const Triplet at = filter.at();
  const bool seen = stats.misses == 0;
  if (!(at.disparity > 0.0) || (!seen && age(exposed, last_seen) > track.predicted_for)) return finger;
  finger.state = seen ? FingerState::seen : FingerState::predicted;
  const Mat3 slope = slope_of(scene.pair(), at);
  finger.tip = triangulate(scene.pair(), at);
  finger.velocity = Vec<'C'>(Vec3(slope * filter.rate().e()));
  finger.covariance = slope * filter.variance().asDiagonal() * slope.transpose();
  if (seen) {
    const Mat3 by = slope_of(scene.pair(), stats.found);
    finger.shown = triangulate(scene.pair(), stats.found);
    finger.shown_covariance = by * stats.variance.asDiagonal() * by.transpose();
  }
  finger.column = at.column;
  finger.row = at.row;
  finger.disparity = at.disparity;
  finger.score = seen ? stats.tip.score : kUnset;
  return finger;
}

FingerTracker::FingerTracker(const StereoRig& rig, const SegmentationSpec& segmentation,
                             const FingertipSpec& fingertip, const TrackSpec& track, const MatchSpec& match,
                             const Region& search)
    : parts_(std::make_unique<Parts>(rig, segmentation, fingertip, track, match, search)) {}
FingerTracker::~FingerTracker() = default;
FingerTracker::FingerTracker(FingerTracker&&) noexcept = default;

const LookStats& FingerTracker::stats() const { return parts_->stats; }
const RectifiedPair& FingerTracker::pair() const { return parts_->scene.pair(); }
const std::vector<FingertipFinder::Candidate>& FingerTracker::candidates() const {
  return parts_->scene.finder().candidates();
}
const Mask& FingerTracker::skin() const { return parts_->scene.skin(); }
bool FingerTracker::finger_in_background() const { return parts_->scene.finger_in_background(); }
bool FingerTracker::learned() const { return parts_->scene.learned(); }
void FingerTracker::forget() {
  parts_->filter.forget();
  parts_->last_place = {};
}

Finger FingerTracker::see(const StereoFrame& frame, Time exposed) noexcept {
  Parts& p = *parts_;
  const int misses = p.stats.misses;
  p.stats = {};
  p.stats.misses = misses;
  Finger finger;
  finger.exposed = exposed;
  finger.state = p.scene.learned() ? FingerState::away : FingerState::learning;
  p.stats.refused = p.usable(frame, exposed);
  if (p.stats.refused == FrameRefusal::no && p.scene.exchanged(frame))
    p.stats.refused = FrameRefusal::exchanged;
  if (p.stats.refused != FrameRefusal::no) return finger;
  p.newest = exposed;
  if (!p.scene.learned()) {
    p.scene.learn(frame);
    return finger;
  }
  if (p.filter.known()) p.filter.predict(p.track, exposed);
  p.forget_nonsense();
  const bool lost = p.stats.misses >= p.track.full_frame_after;
  p.stats.whole_frame = lost || !p.filter.known();
  p.stats.window = p.stats.whole_frame ? p.search : p.window();
  Triplet at;
  Vec3 variance = Vec3::Constant(kUnset);
  const bool found = p.look(frame, exposed, at, variance);
  if (found && lost) p.filter.forget();  // too much may have happened since for a prediction
  p.take(found, exposed, at, variance);
  p.forget_nonsense();
  return p.told(exposed);
}

}  // namespace enc
