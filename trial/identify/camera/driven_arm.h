// The arm of the guided registration in its true motion: in the twin, under the core's own law.
//
//   place -> core (target, law, gravity) -> motors -> physics -> encoders -> core
//                                             physics -> true tip -> the camera's frames
//                                            encoders -> rig's kinematics -> the device's reading
#pragma once

#include "models/setup/scene_file.h"
#include "trial/identify/camera/guided.h"
#include "trial/trial.h"

namespace enc::trial {

// The arm moves alone: a bare tip, no object, no finger. It judges only by the device's readings, as a real
// procedure must.
class DrivenArm final : public MovedArm {
 public:
  // rig: read without a scene. Throws Error with the place in the rig file.
  explicit DrivenArm(models::Setup rig);
  DrivenArm(const DrivenArm&) = delete;
  DrivenArm& operator=(const DrivenArm&) = delete;

  // Throws Error if the tip does not come to rest there in time, with the place and the remaining distance.
  double go(const Point<'W'>& wanted) override;
  TipStand read(double later) override;
  // The camera's pose as the arm would measure it: the arm's W follows from the rig's pose of its base.
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
  double now_ = 0.0, due_ = 0.0;  // s: newest tick; newest requested reading
  int places_ = 0;                // places commanded so far
};

}  // namespace enc::trial
