// From a pair of raw images to the fingertip in C: rectified where it is looked at, skin, disparity,
// fingertip, filter [VisHap 2.1].
#pragma once

#include <cstdint>
#include <memory>

#include "core/base/words.h"
#include "core/devices/stereo_camera.h"
#include "core/spec/vision/stereo_rig.h"
#include "core/vision/finger/finger.h"
#include "core/vision/finger/fingertip.h"
#include "core/vision/finger/triplet_filter.h"
#include "core/vision/hand/certainty.h"
#include "core/vision/segmentation/segmenter.h"
#include "core/vision/stereo/match.h"

namespace enc {

// Why a frame told nothing.
enum class Refused : std::uint8_t { no, size, missing, stamp, exchanged };
constexpr auto words(Refused) { return enum_words("no", "size", "missing", "stamp", "exchanged"); }

// What the last frame took.
struct LookStats {
  Refused refused = Refused::no;
  Region window;             // in which candidates were sought
  bool whole_frame = false;  // the window is all there is
  std::int64_t pixels = 0;   // segmented
  std::int64_t cells_sought = 0, cells_matched = 0;
  StepCounts steps;
  Fingertip tip;            // as found in the image: neither the filter nor a doubt has been asked yet
  Doubt doubt = Doubt::no;  // why the fingertip that there was is not believed
  FingerEvidence evidence;  // of that or of the one that is believed
  Triplet found;            // the same, with its disparity
  Vec3 variance = Vec3::Constant(kUnset);
  bool beyond_gate = false;  // there was one, but too far from where the finger can be
  int misses = 0;            // frames in a row without a finger
};

class FingerTracker {
 public:
  // Throws Error where a spec or the rig is impossible. `search`: where a finger that is not tracked is
  // sought, px of the rectified left image; empty: everywhere.
  FingerTracker(const StereoRig& rig, const SegmentationSpec& segmentation, const FingertipSpec& fingertip,
                const TrackSpec& track, const MatchSpec& match = {}, const Region& search = {});
  ~FingerTracker();
  FingerTracker(FingerTracker&&) noexcept;

  // A frame that cannot be used (another size, an image missing, not later than the one before, left and
  // right exchanged) changes nothing and gives no place. Allocates nothing once the background is learned.
  Finger see(const StereoFrame& frame, Time exposed) noexcept;

  [[nodiscard]] const LookStats& stats() const;
  [[nodiscard]] const RectifiedPair& pair() const;
  [[nodiscard]] const std::vector<FingertipFinder::Candidate>& candidates() const;  // of the last look
  [[nodiscard]] const Mask& skin() const;  // valid where the last frame was segmented
  [[nodiscard]] bool learned() const;      // the background
  // A fingertip of the hue of skin stood in some frame from which the background was learned: it has become
  // background itself and will be seen badly there. Start again without it.
  [[nodiscard]] bool finger_in_background() const;
  // Forgets the finger, not the background.
  void forget();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace enc
