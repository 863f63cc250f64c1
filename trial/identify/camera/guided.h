// The guided registration [VisHap 2.2]. An arm's tip moves to positions that are well spread in the camera's
// view, and stands still at each for a number of frames. The camera then measures the tip, and the data of
// camera and arm are kept. The arm's motion is independent of the camera's noise, so one sequence of visits
// serves any number of seeds.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/machine/arm.h"
#include "models/identify/camera/register.h"
#include "sim/plants/tracker_plant.h"
#include "sim/spec/arm_spec.h"

namespace enc::trial {

// A tip at rest: its true position, and the position from the arm's encoders and kinematics. Includes the
// true joints, for code that draws the arm.
struct TipStand {
  Point<'W'> truth, reading;
  PerJoint joints{};
};

// Moves the tip.
class MovedArm {
 public:
  virtual ~MovedArm() = default;
  // Moves there and waits until it stands still; returns s of experiment. Throws Error if it cannot.
  virtual double go(const Point<'W'>& wanted) = 0;
  virtual TipStand read(double later) = 0;  // reads after `later` s more
};

// The arm by its kinematics alone: it reaches each commanded position, and its encoders have quantisation
// steps.
class KinematicArm final : public MovedArm {
 public:
  // `believed`: the controller's model. `truth.machine`: the true one.
  KinematicArm(const ArmMachine& believed, const sim::ArmTruth& truth);
  double go(const Point<'W'>& wanted) override;
  TipStand read(double later) override;

 private:
  Arm believed_, true_;
  PerJoint step_{};  // encoder's quantisation step at its joint, rad or m
  Pose<'W', 'R'> X_WR_;
  PerJoint joints_{};
  Point<'W'> at_{0, 0, 0};
};

// W is the tip's position at the arm's zero, with R's axes.
[[nodiscard]] Pose<'W', 'R'> base_of(const Arm& arm);

// Positions of the arm that both cameras see and that are not near a singular pose: on a grid of its joints.
[[nodiscard]] std::vector<Point<'W'>> places_in_view(const Arm& arm, double least_dexterity,
                                                     const Pose<'W', 'C'>& X_WC,
                                                     const sim::CameraTruth& camera);
// The first place is the farthest from the middle of all, each next one the farthest from those before. The
// first n of a longer list are the list for n.
[[nodiscard]] std::vector<Point<'W'>> well_spread(const std::vector<Point<'W'>>& places, std::size_t count);

// A position at which the tip stood.
struct TipVisit {
  double still = kUnset;  // s of experiment until it stood
  std::vector<TipStand> frames;
};
// `rate`: frame rate of the camera, Hz.
[[nodiscard]] std::vector<TipVisit> visit_places(MovedArm& arm, const std::vector<Point<'W'>>& places,
                                                 double rate, std::size_t frames);

// The sensor that sees the tip.
class TipEyes {
 public:
  virtual ~TipEyes() = default;
  virtual void move() {}  // the tip has moved to another position
  // Measures the tip in one frame; empty if the frame does not show it.
  virtual std::optional<Point<'C'>> see(const TipStand& tip) = 0;
};

struct GuidedRun {
  models::PointSet points;
  // s of experiment, from the beginning until the tip stands still at each position.
  std::vector<double> seconds;
  std::size_t unseen = 0;         // positions that were not seen
  std::vector<std::size_t> seen;  // frames of each visit
};
// A position counts as seen only if at least `share` of its frames show it.
[[nodiscard]] GuidedRun see_visits(const std::vector<TipVisit>& visits, TipEyes& eyes, double share);
// Measures points with the matching errors of a stereo head.
[[nodiscard]] GuidedRun see_visits(const std::vector<TipVisit>& visits, const Pose<'W', 'C'>& X_WC,
                                   const sim::CameraTruth& camera, std::uint64_t seed);

// Error of a registration at a position of the tip, along W's axes, m.
[[nodiscard]] Vec3 target_error(const Pose<'W', 'C'>& found, const Pose<'W', 'C'>& truth,
                                const Point<'W'>& place);

}  // namespace enc::trial
