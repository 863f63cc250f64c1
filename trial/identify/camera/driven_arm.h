// The arm of the guided registration as it really moves: in the twin, under the core's own law.
//
//   place -> core (target, law, gravity) -> motors -> physics -> encoders -> core
//                                             physics -> true tip -> the camera's frames
//                                            encoders -> believed kinematics -> what the device says
#pragma once

#include "models/setup/scene_file.h"
#include "trial/identify/camera/guided.h"
#include "trial/trial.h"

namespace enc::trial {

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
    return trial_.scene().X_WR * (trial_.world().X_WR().inverse() * X_WC);
  }

 private:
  [[nodiscard]] TrialOptions for_ever();
  void tick();
  void bring(const Point<'W'>& to, double still_time);
  [[nodiscard]] bool straight_way(const Point<'W'>& to) const;
  [[nodiscard]] double time_limit(const Point<'W'>& to) const;  // s
  [[noreturn]] void give_up(const Point<'W'>& at, double after) const;
  [[nodiscard]] Point<'W'> reading() const { return trial_.scene().X_WR * trial_.inputs().arm.value.tip; }

  Point<'W'> sent_;
  Trial trial_;
  double now_ = 0.0, due_ = 0.0;  // s: of the newest tick; of the newest reading that was asked for
  int places_ = 0;                // that it was sent to
};

}  // namespace enc::trial
