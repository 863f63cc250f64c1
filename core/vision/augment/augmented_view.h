// The user's view without the haptic device and with the virtual objects in its place [VisHap 3]: out of the
// left image, the joints as measured, and what is believed of arm and camera.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "core/base/image.h"
#include "core/control/world/object.h"
#include "core/machine/arm.h"
#include "core/spec/vision/segmentation_spec.h"
#include "core/spec/vision/stereo_rig.h"

namespace enc {

// What does not change while it runs. All of it as believed.
struct AugmentedSpec {
  StereoRig camera;
  SegmentationSpec segmentation;
  std::optional<ArmMachine> arm;  // none: nothing is taken out
  std::optional<Vec3> prop;       // its size, m
  Pose<'W', 'R'> X_WR;
  Pose<'W', 'C'> X_WC;
  // px round the arm's outline that are replaced, too. At 650 mm a pixel is 0.9 mm: a registration off by 0.3
  // mm and joints a tick older than the image at 300 mm/s are 0.5 px together, a prop that is turned by 5
  // degrees more than believed 1.4 px at its corners, and an edge is a pixel wide.
  double margin = 3.0;
  double opacity = 0.6;  // of a virtual object
};

// What an image was exposed in.
struct AugmentedMoment {
  PerJoint joints{};             // measured
  Quat q_WN = Quat::Identity();  // the prop's front faces along z of N, as is believed
  // Of the fingertip that the tracker sees: what of an object is nearer than that covers the hand. NaN: none
  // is seen, and a hand covers the objects.
  Point<'C'> finger;
  std::vector<Vec<'W'>> moved;  // each object, from where the scene has it; empty: none
};

class AugmentedView {
 public:
  // The objects of a scene, where they stand. Throws Error where rig or spec are impossible.
  AugmentedView(const AugmentedSpec& spec, std::span<const Object> objects);
  virtual ~AugmentedView();
  AugmentedView(const AugmentedView&) = delete;
  AugmentedView& operator=(const AugmentedView&) = delete;

  // A raw left image of the rig's size; each later than the one before. The first ones are the background's,
  // as the tracker's.
  virtual void see(const ImageView& left, const AugmentedMoment& moment);

  // Of the last image, rectified. Replaced: pixels that are believed to be the arm's and are no skin.
  [[nodiscard]] virtual const Image& removed() const;
  [[nodiscard]] virtual const Image& augmented() const;
  [[nodiscard]] virtual const Mask& replaced() const;
  // Where the background is known, from frames in which nothing stood before it.
  [[nodiscard]] virtual const Mask& known() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace enc
