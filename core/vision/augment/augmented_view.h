// The user's view with virtual objects in place of the haptic device [VisHap 3]. Its inputs are the left
// image, the measured joints, and the rig's model of arm and camera.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/base/image.h"
#include "core/control/world/object.h"
#include "core/machine/arm.h"
#include "core/spec/optics_rig.h"
#include "core/spec/vision_rig.h"

namespace enc {

// Constants of a run, all from the rig file and the scene.
struct AugmentedSpec {
  StereoRig camera;
  SegmentationSpec segmentation;
  std::optional<ArmMachine> arm;  // unset: no arm is removed
  std::optional<Vec3> prop;       // size of the prop, m
  Pose<'W', 'R'> X_WR;
  Pose<'W', 'C'> X_WC;
  // px around the arm's outline that are replaced too. At 650 mm a pixel is 0.9 mm. A registration off by 0.3
  // mm and joints a tick older than the image at 300 mm/s are 0.5 px together. A prop rotated 5 degrees more
  // than assumed is 1.4 px at its corners, and an edge is a pixel wide.
  double margin = 3.0;
  double opacity = 0.6;  // opacity of a virtual object
};

// The state at the exposure of an image.
struct AugmentedMoment {
  PerJoint joints{};  // measured
  // The prop's assumed orientation: its front faces along z of N.
  Quat q_WN = Quat::Identity();
  // The tracked fingertip: parts of an object that are nearer than it cover the hand. NaN: no fingertip is
  // seen, and a hand covers the objects.
  Point<'C'> finger;
  // Each object's displacement from its position in the scene; empty: no object moved.
  std::vector<Vec<'W'>> moved;
};

class AugmentedView {
 public:
  // The objects of a scene at their places. Throws Error if rig or spec are impossible.
  AugmentedView(const AugmentedSpec& spec, std::span<const Object> objects);
  virtual ~AugmentedView();
  AugmentedView(const AugmentedView&) = delete;
  AugmentedView& operator=(const AugmentedView&) = delete;

  // Takes a raw left image of the rig's size, each later than the last one. The first images teach the
  // background, as for the tracker.
  virtual void see(const ImageView& left, const AugmentedMoment& moment);

  // Results for the last image, rectified. Replaced: pixels that belong to the arm by its model and are not
  // skin.
  [[nodiscard]] virtual const Image& removed() const;
  [[nodiscard]] virtual const Image& augmented() const;
  [[nodiscard]] virtual const Mask& replaced() const;
  // Pixels with known background, from frames in which it was uncovered.
  [[nodiscard]] virtual const Mask& known() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace enc
