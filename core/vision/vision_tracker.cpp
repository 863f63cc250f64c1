#include "core/vision/vision_tracker.h"

#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/spec/vision_check.h"

namespace enc {
namespace {

constexpr std::array kReasons{"", "another size than the rig file's", "an image is missing",
                              "a stamp not after the last one, or to come",
                              "left and right are exchanged; exchange the two cables or files"};

// Of Doubt.
constexpr std::array kDoubts{
    "",
    "no fingertip's outline fits them",
    "left and right do not agree on their distance, or it is out of reach",
    "they are not as wide as the finger of the scene, or as the one that was followed",
    "what they are the end of does not have the shape of a finger with its hand",
    "they are as near to their hand as a thumb",
    "their hand has three or more straight fingers; point with one",
    "no hand is as fast as that"};
static_assert(kDoubts.size() == kWords<Doubt>.size());

std::string text_of(const ImageSize& size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height) + " px";
}

// The position from this frame alone, because the core has a filter of its own and two filters in series lag.
// Gives its covariance along the view, and the mean of both sides across.
TrackedTool tool_of(const Finger& finger) {
  const Vec3 view = finger.shown.e().normalized();
  const double along = view.dot(finger.shown_covariance * view);
  const double across = 0.5 * (finger.shown_covariance.trace() - along);
  return {VisionTracker::kFinger, {Quat::Identity(), finger.shown}, std::sqrt(along), std::sqrt(across)};
}

}  // namespace

VisionTracker::VisionTracker(std::unique_ptr<StereoCamera> camera, const StereoRig& rig,
                             FingerTracker tracker, Release release)
    : camera_(std::move(camera)), tracker_(std::move(tracker)) {
  check_timing(rig);
  if (const ImageSize is = camera_->size(); is != ImageSize{} && is != rig.size())
    throw Error("the images are " + text_of(is) + " and the rig file says " + text_of(rig.size()) +
                    "; expected the same; give the numbers of the camera that made them",
                "rig.camera.width_px");
  wait_ = release == Release::when_due ? from_seconds(rig.latency) : Duration::min();
  patience_ = from_seconds(rig.latency + 3.0 / rig.rate);
}

std::string VisionTracker::describe() const { return "fingertip of " + camera_->describe(); }

std::vector<std::string> VisionTracker::remarks() const {
  std::vector<std::string> lines = camera_->remarks();
  if (!tracker_.learned())
    lines.push_back("vision: the background was not learned, of which " + std::to_string(background_) +
                    " frames came; no finger was looked for");
  if (tracker_.finger_in_background())
    lines.emplace_back(
        "vision: a finger stood in the frames of which the background was learned, and is seen badly there; "
        "start again without it");
  constexpr int kMany = 20;  // frames: with fewer, the hand may not have come yet
  if (looked_ >= kMany && seen_ == 0)
    lines.push_back(
        "vision: none of " + std::to_string(looked_) +
        " frames showed a finger; see to the light, to skin_hue_deg and to where the camera looks "
        "(encounter view --through-camera raw)");
  for (std::size_t i = 1; i < refused_.size(); ++i)
    if (refused_[i] > 0)
      lines.push_back("vision: " + std::to_string(refused_[i]) + " frames were not used: " + kReasons[i]);
  for (std::size_t i = 1; i < doubtful_.size(); ++i)
    if (doubtful_[i] > 0)
      lines.push_back("vision: " + std::to_string(doubtful_[i]) +
                      " finds were not taken for the fingertip: " + kDoubts[i]);
  return lines;
}

void VisionTracker::take(Time now, const Measurement<StereoFrame>& frame) {
  if (frame.health != Health::ok) return;
  const bool to_come = frame.t > now;
  Finger finger;
  if (!to_come) finger = tracker_.see(frame.value, frame.t);
  if (const FrameRefusal refused = to_come ? FrameRefusal::stamp : tracker_.stats().refused;
      refused != FrameRefusal::no) {
    ++refused_[static_cast<std::size_t>(refused)];
    return;
  }
  background_ += finger.state == FingerState::learning ? 1 : 0;
  looked_ += finger.state == FingerState::learning ? 0 : 1;
  ++doubtful_[static_cast<std::size_t>(tracker_.stats().doubt)];
  seen_ += finger.state == FingerState::seen ? 1 : 0;
  if (count_ == line_.size()) {  // drops the oldest, as a socket's buffer would
    first_ = (first_ + 1) % line_.size();
    --count_;
  }
  line_[(first_ + count_) % line_.size()] = finger;
  ++count_;
}

bool VisionTracker::stalled(Time now, Measurement<TrackedTool>& newest) {
  if (said_stale_ || last_.health == Health::absent || age(now, last_.t) <= seconds(patience_)) return false;
  said_stale_ = true;
  last_.health = Health::stale;
  newest = last_;
  return true;
}

bool VisionTracker::poll(Time now, Measurement<TrackedTool>& newest) noexcept {
  if (camera_->poll(now, frame_)) take(now, frame_);
  bool due = false;
  while (count_ > 0 && age(now, line_[first_].exposed) >= seconds(wait_)) {  // up to the newest that is due
    told_ = line_[first_];
    first_ = (first_ + 1) % line_.size();
    --count_;
    due = true;
  }
  if (!due) return stalled(now, newest);
  said_stale_ = false;
  last_ = {{-1, {}}, told_.exposed, Health::ok};
  if (told_.state == FingerState::seen) last_.value = tool_of(told_);
  newest = last_;
  return true;
}

}  // namespace enc
