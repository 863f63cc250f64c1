// Tracks the fingertip in C from pairs of raw images: rectification of the needed region, skin, disparity,
// fingertip, filter [VisHap 2.1].
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "core/base/frames.h"
#include "core/base/time.h"
#include "core/base/words.h"
#include "core/devices/device.h"
#include "core/spec/optics_rig.h"
#include "core/vision/finger/fingertip.h"
#include "core/vision/finger/triplet_filter.h"
#include "core/vision/hand/certainty.h"
#include "core/vision/segmentation/segmenter.h"
#include "core/vision/stereo/match.h"

namespace enc {

enum class FingerState : std::uint8_t {
  learning,  // learning the background, at every start
  away,      // no finger in view
  seen,
  // Not detected in this frame, but shortly before: the filter's prediction.
  predicted,
};

// The fingertip of one frame, as vision measures it [VisHap 2.1.2].
struct Finger {
  FingerState state = FingerState::learning;
  Time exposed{};
  Point<'C'> tip;                            // centre of the fingertip's cap, m
  Vec<'C'> velocity;                         // m/s
  Mat3 covariance = Mat3::Constant(kUnset);  // covariance of the tip, m^2
  // The tip from this frame alone, before the filter. Unset unless the state is seen.
  Point<'C'> shown;
  Mat3 shown_covariance = Mat3::Constant(kUnset);
  double column = kUnset, row = kUnset, disparity = kUnset;  // px, in the rectified left image
  double score = kUnset;                                     // share of skin in the circle, 0 to 1
};

// Reason for refusing a frame.
enum class FrameRefusal : std::uint8_t { no, size, missing, stamp, exchanged };
constexpr auto words(FrameRefusal) { return enum_words("no", "size", "missing", "stamp", "exchanged"); }

// Effort and results for the last frame.
struct LookStats {
  FrameRefusal refused = FrameRefusal::no;
  Region window;             // region searched for candidates
  bool whole_frame = false;  // the window covers the whole frame
  std::int64_t pixels = 0;   // pixels segmented
  std::int64_t cells_sought = 0, cells_matched = 0;
  StepCounts steps;
  Fingertip tip;            // as found in the image, before filter and doubt
  Doubt doubt = Doubt::no;  // reason to doubt the found fingertip
  FingerEvidence evidence;  // evidence of that fingertip, or of the accepted one
  Triplet found;            // that fingertip with its disparity
  Vec3 variance = Vec3::Constant(kUnset);
  bool beyond_gate = false;  // one was found, but too far from the possible positions
  int misses = 0;            // consecutive frames without a finger
};

class FingerTracker {
 public:
  // Throws Error if a spec or the rig is impossible. `search`: search region for an untracked finger, px of
  // the rectified left image; empty: everywhere.
  FingerTracker(const StereoRig& rig, const SegmentationSpec& segmentation, const FingertipSpec& fingertip,
                const TrackSpec& track, const MatchSpec& match = {}, const Region& search = {});
  ~FingerTracker();
  FingerTracker(FingerTracker&&) noexcept;

  // An unusable frame (another size, a missing image, not later than the last one, left and right exchanged)
  // changes nothing and gives no position. Allocates nothing once the background is learned.
  Finger see(const StereoFrame& frame, Time exposed) noexcept;

  [[nodiscard]] const LookStats& stats() const;
  [[nodiscard]] const RectifiedPair& pair() const;
  // Candidates of the last look.
  [[nodiscard]] const std::vector<FingertipFinder::Candidate>& candidates() const;
  [[nodiscard]] const Mask& skin() const;  // valid if the last frame was segmented
  [[nodiscard]] bool learned() const;      // the background is learned
  // True if a fingertip with the hue of skin was in a frame that taught the background. It is now part of the
  // background, and detection is poor there; start again without it.
  [[nodiscard]] bool finger_in_background() const;
  // Forgets the finger, but not the background.
  void forget();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace enc
