// The guided registration [VisHap 2.2]: an arm's tip goes to places that are well spread in the camera's
// view and stands still at each for a number of frames; then the camera sees these, and what it and the arm
// say is kept. What the arm does knows nothing of the camera's noise: one walk serves any number of seeds.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/machine/arm.h"
#include "models/identify/camera/point_set.h"
#include "sim/plants/stereo_noise.h"
#include "sim/spec/arm_spec.h"

namespace enc::trial {

// A tip at rest: where it is, and where the arm's encoders and kinematics say that it is. With the true
// joints, for whoever draws the arm.
struct TipStand {
  Point<'W'> truth, reading;
  PerJoint joints{};
};

// Whatever carries the tip.
class MovedArm {
 public:
  virtual ~MovedArm() = default;
  // Goes there and waits until it stands still; s of experiment. Throws Error where it cannot.
  virtual double go(const Point<'W'>& wanted) = 0;
  virtual TipStand read(double later) = 0;  // after so many s more
};

// The arm by its kinematics alone: it gets where it is sent, and its encoders have steps.
class KinematicArm final : public MovedArm {
 public:
  // believed: as the controller knows it. truth.machine: as it is.
  KinematicArm(const ArmMachine& believed, const sim::ArmTruth& truth);
  double go(const Point<'W'>& wanted) override;
  TipStand read(double later) override;

 private:
  Arm believed_, true_;
  PerJoint step_{};  // of each encoder at its joint, rad or m
  Pose<'W', 'R'> X_WR_;
  PerJoint joints_{};
  Point<'W'> at_{0, 0, 0};
};

// W is where the tip is at the arm's zero, with R's axes.
[[nodiscard]] Pose<'W', 'R'> base_of(const Arm& arm);

// What both cameras see of where the arm can be without being near a singular pose: on a grid of its joints.
[[nodiscard]] std::vector<Point<'W'>> places_in_view(const Arm& arm, double least_dexterity,
                                                     const Pose<'W', 'C'>& X_WC,
                                                     const sim::CameraTruth& camera);
// The first is the farthest from the middle of all, each next one the farthest from those before. The first n
// of a longer list are the list for n.
[[nodiscard]] std::vector<Point<'W'>> well_spread(const std::vector<Point<'W'>>& places, std::size_t count);

// A place at which the tip stood.
struct TipVisit {
  double still = kUnset;  // s of experiment until then
  std::vector<TipStand> frames;
};
// rate: of the camera, Hz.
[[nodiscard]] std::vector<TipVisit> visit_places(MovedArm& arm, const std::vector<Point<'W'>>& places,
                                                 double rate, std::size_t frames);

// Whatever sees the tip.
class TipEyes {
 public:
  virtual ~TipEyes() = default;
  virtual void move() {}  // the tip is at another place
  // A frame of it; nothing where it is not seen.
  virtual std::optional<Point<'C'>> see(const TipStand& tip) = 0;
};

struct GuidedRun {
  models::PointSet points;
  std::vector<double> seconds;  // of experiment, from the beginning until the tip stands still at each place
  std::size_t unseen = 0;       // places that were not seen
  std::vector<std::size_t> seen;  // frames of each visit
};
// A place that fewer than `share` of its frames show was not seen.
[[nodiscard]] GuidedRun see_visits(const std::vector<TipVisit>& visits, TipEyes& eyes, double share);
// As points, by a head with the errors of matching.
[[nodiscard]] GuidedRun see_visits(const std::vector<TipVisit>& visits, const Pose<'W', 'C'>& X_WC,
                                   const sim::CameraTruth& camera, std::uint64_t seed);

// What a registration is wrong by at a place of the tip, along W's axes, m.
[[nodiscard]] Vec3 target_error(const Pose<'W', 'C'>& found, const Pose<'W', 'C'>& truth,
                                const Point<'W'>& place);

}  // namespace enc::trial
