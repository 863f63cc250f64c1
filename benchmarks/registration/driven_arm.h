// The arm of the guided registration as it really moves: in the twin, under the core's own law.
//
//   place -> core (target, law, gravity) -> motors -> physics -> encoders -> core
//                                             physics -> true tip -> the camera's frames
//                                            encoders -> believed kinematics -> what the device says
#pragma once

#include <memory>

#include "benchmarks/registration/guided.h"
#include "core/rig.h"
#include "models/scene_file.h"
#include "sim/world.h"

namespace enc::bench {

// Nobody is there to meet: a bare tip, no object, no finger. Judges by the device's readings alone, as a real
// procedure has to.
class DrivenArm final : public MovedArm {
 public:
  // rig: read without a scene. Throws Error with the place in the rig file.
  explicit DrivenArm(models::Setup rig);
  DrivenArm(const DrivenArm&) = delete;
  DrivenArm& operator=(const DrivenArm&) = delete;

  // Throws Error where the tip does not come to rest there in time: which place, how far away it stayed.
  double go(const Point<'W'>& wanted) override;
  TipStand read(double later) override;
  // The camera as the arm would tell its pose: the arm's W is where it believes its base to stand.
  [[nodiscard]] Pose<'W', 'C'> as_it_believes(const Pose<'W', 'C'>& X_WC) const {
    return scene_.X_WR * (world_->X_WR().inverse() * X_WC);
  }

 private:
  void tick();
  void bring(const Point<'W'>& to, double still_time);
  [[nodiscard]] bool straight_way(const Point<'W'>& to) const;
  [[nodiscard]] double time_limit(const Point<'W'>& to) const;  // s
  [[noreturn]] void give_up(const Point<'W'>& at, double after) const;
  [[nodiscard]] Point<'W'> reading() const { return scene_.X_WR * in_.arm.value.tip; }

  models::Setup setup_;
  Scene scene_;
  std::unique_ptr<sim::World> world_;
  Rig devices_;
  Inputs in_;
  Outputs out_;
  State state_;
  Point<'W'> sent_;
  double now_ = 0.0, due_ = 0.0;  // s: of the newest tick; of the newest reading that was asked for
  int places_ = 0;                // that it was sent to
};

}  // namespace enc::bench
