// One look at a pair of images: the skin in a window, its distance, and the fingertip. It uses no earlier
// frame except the background.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "core/devices/device.h"
#include "core/vision/finger/cap.h"
#include "core/vision/finger/fingertip.h"
#include "core/vision/hand/certainty.h"
#include "core/vision/hand/hand_form.h"
#include "core/vision/segmentation/segmenter.h"
#include "core/vision/stereo/match.h"
#include "core/vision/stereo/rectify.h"

namespace enc {

class HandScene {
 public:
  HandScene(const StereoRig& rig, const SegmentationSpec& segmentation, const FingertipSpec& fingertip,
            const MatchSpec& match);

  // True if left and right are exchanged. Call it for each frame, before everything else.
  bool exchanged(const StereoFrame& frame);
  // Takes a frame of the background.
  void learn(const StereoFrame& frame);
  [[nodiscard]] bool learned() const { return segmenter_.learned(); }
  [[nodiscard]] bool finger_in_background() const { return finger_in_background_; }

  struct HandFinding {
    Fingertip tip;
    double disparity = kUnset, variance = kUnset;  // px, px^2, cap's middle
    FingerEvidence evidence;
    // Reason to doubt the tip; then no other tip is accepted either.
    Doubt doubt = Doubt::no;
    bool followed = false;    // continues the tracked finger, without a new recognition
    std::int64_t pixels = 0;  // pixels segmented
  };
  // A finger seen in earlier frames.
  struct FingerHint {
    Triplet at;           // predicted position, or NaN
    double cap = kUnset;  // m, its width when recognised; NaN: it must be recognised anew
  };
  // Candidates are searched within `window`. The predicted position of a tracked finger selects among several
  // fingers, and its disparity decides how much is segmented at first. Without a tracked finger, the most
  // certain pointing finger is chosen.
  HandFinding look(const StereoFrame& frame, const Region& window, const FingerHint& followed);

  [[nodiscard]] Region frame() const { return {0, 0, rectifier_.width(), rectifier_.height()}; }
  [[nodiscard]] const RectifiedPair& pair() const { return rectifier_.pair(); }
  [[nodiscard]] const Mask& skin() const { return skin_; }
  [[nodiscard]] const DisparityMap& disparity() const { return disparity_; }
  [[nodiscard]] const FingertipFinder& finder() const { return finder_; }
  // A finder for the same images, with other factors.
  [[nodiscard]] FingertipFinder finder_with(const FingertipSpec& fingertip) const;

 private:
  // The rectified image, up to date within `part`.
  ImageView rectified(Side side, const ImageView& raw, const Region& part);
  [[nodiscard]] Region read_for(const Segmenter& segmenter, const Region& wanted) const;
  Region segment(Segmenter& segmenter, const ImageView& raw, const Region& wanted);
  // Segments the right image by the hue of skin into right_skin_. Returns the rectified image.
  ImageView segment_right(const StereoFrame& frame, const Region& wanted);
  void match(const StereoFrame& frame, const Region& window, const Region& around);
  [[nodiscard]] int farthest_reach(const Region& window) const;
  using Surfaces = std::array<float, 17>;  // px of disparity
  std::size_t surfaces_of(const Fingertip& tip, Surfaces& surfaces);
  std::size_t shapes_of(const Fingertip& tip, const StereoFrame& frame, std::span<float> surfaces);
  void sharpen(Fingertip& tip) const;
  [[nodiscard]] double outline_disparity(const Fingertip& tip, const StereoFrame& frame, double disparity);
  void confirm(const Fingertip& tip, const StereoFrame& frame, double expected, CapDisparity& cap);
  // Starts from a disparity of the cap's middle.
  [[nodiscard]] CapDisparity match_from(const Fingertip& tip, double middle) const;
  void measure(HandFinding& seen, const StereoFrame& frame, double expected);

  // The evidence of a detection.
  void segment_too(const StereoFrame& frame, const Region& wanted);
  void make_ready(const StereoFrame& frame, const Region& part);
  [[nodiscard]] Vec3 in_image(const Triplet& to, const Triplet& from) const;
  void weigh_cap(HandFinding& seen) const;
  FingerForm form_behind(HandFinding& seen, const StereoFrame& frame, double reach);
  void weigh_finger(const FingerForm& form, const StereoFrame& frame, HandFinding& seen);
  [[nodiscard]] int flanks(const Pixel& at, const Fingertip& tip, double width, double disparity);
  void weigh_hand(const StereoFrame& frame, double width, HandFinding& seen);
  [[nodiscard]] double disparity_around(const StereoFrame& frame, const Pixel& at);
  bool goes_on(HandFinding& seen, const StereoFrame& frame, const FingerHint& followed);
  void recognise(HandFinding& seen, const StereoFrame& frame);
  [[nodiscard]] static bool near_many(const HandFinding& one, std::span<const HandFinding> all);
  HandFinding choose(const StereoFrame& frame, const FingerHint& followed);
  void look_for_finger_in_background(const StereoFrame& frame);

  Rectifier rectifier_;
  SegmentationSpec segmentation_;
  Segmenter segmenter_;
  std::unique_ptr<Segmenter> hue_alone_;  // fed from the first frame of the background on
  Matcher matcher_;
  ExchangeCheck exchanged_;
  FingertipFinder finder_;
  PalmFinder palm_;
  bool palm_measured_ = false;  // measured in this frame
  Region segmented_;            // part of this frame's left image
  FingerLimits limits_;
  Image left_, right_;
  Grey grey_left_, grey_right_;
  Mask skin_, right_skin_;  // right_skin_: by hue alone, where a tip may be
  DisparityMap disparity_;
  bool finger_in_background_ = false;
};

}  // namespace enc
