// The stack of [VisHap] as a whole: parts of the benchmark `vishap`, and frames of an arm that comes to meet
// a finger, before the twin's stereo head.
#pragma once

#include <cstdint>
#include <memory>

#include "benchmarks/kit/kit.h"
#include "benchmarks/staged/staged.h"
#include "core/vision/augment/augmented_view.h"
#include "models/setup/scene_file.h"

namespace enc::bench::vishap {

// Frames of an arm that comes to meet a finger, before the twin's stereo head: the arm anywhere, often with
// its prop under the fingertip. Ground truth, and a rig's estimate of it.

// Difference of an estimate from the ground truth.
struct Belief {
  Vec<'C'> camera_off = Vec<'C'>::zero();
};

class ArmPlay {
 public:
  // Scenery, hands and poses come from the seed; the skin is that of the scene's user.
  ArmPlay(const models::Setup& setup, const sim::CameraModule& camera, std::uint64_t seed);

  struct Frame {
    staged::Pair pair;
    sim::CameraScene shown;
    AugmentedMoment moment;
    bool meets = false;  // the prop is just under the fingertip
  };
  // Exposures of the arm at its start without a person, and of the room without the arm.
  void rest(std::vector<Frame>& with, std::vector<staged::Pair>& without);
  void next(Frame& frame);
  // Draws the frame again without the arm.
  void without_arm(const Frame& frame, staged::Pair& pair);
  [[nodiscard]] Image empty();  // the room alone, without noise

  [[nodiscard]] AugmentedSpec believed(const Belief& belief) const;
  [[nodiscard]] Point<'C'> in_camera(const Point<'W'>& p) const { return X_CW_ * p; }  // truly

 private:
  void pose_arm(const Point<'W'>& tip, Frame& frame);
  void draw(Frame& frame);

  models::Setup setup_;
  Scene scene_;
  sim::StageSpec spec_;
  const sim::CameraModule& camera_;
  std::unique_ptr<sim::Stage> stage_;
  sim::Stream stream_;
  Pose<'C', 'W'> X_CW_;
  Pose<'W', 'R'> X_WR_;
  Vec<'W'> normal_;                 // of the wall
  Quat facing_ = Quat::Identity();  // attitude of the prop's front, q_WN
  sim::Rgb skin_;
  std::uint64_t frames_ = 0;
};

// [VisHap Fig 5]: the rendered force over the distance that vision measures, of each picture.
struct SeenForce {
  double distance = kUnset;  // m, negative: under the surface
  double felt = kUnset;      // N, commanded along the normal at the exposure, without the weight
  double pushed = kUnset;    // N, of finger and prop on each other then
};
// Figures and plot of a scene's object. `object`: of the prepared scene; `free`: K_p.
void add_fig5(Bench& bench, const std::string& scene, const std::vector<SeenForce>& pictures,
              const Object& object, double free);

// The haptic device removed from the left image, objects put in its place, and the effect of an arm in view
// on the tracker.
void add_device_removal(Bench& bench);

}  // namespace enc::bench::vishap
