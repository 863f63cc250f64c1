#include "trial/identify/camera/guided.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/error.h"

namespace enc::trial {
namespace {

constexpr int kJointSteps = 25;    // steps of the grid for each joint
constexpr double kMargin = 20.0;   // px, distance of a place from the images' edges
constexpr double kSpeed = 0.2;     // m/s, mean speed of a KinematicArm
constexpr double kSettling = 0.5;  // s, time of a KinematicArm to come to rest
constexpr double kPi = 3.14159265358979323846;

bool well_in_view(const sim::StereoPoints& eyes, const sim::CameraTruth& camera, const Point<'C'>& p) {
  const std::optional<sim::StereoPixel> seen = eyes.project(p);
  return seen && seen->column - seen->disparity >= kMargin &&
         seen->column <= static_cast<double>(camera.width - 1) - kMargin && seen->row >= kMargin &&
         seen->row <= static_cast<double>(camera.height - 1) - kMargin;
}

}  // namespace

KinematicArm::KinematicArm(const ArmMachine& believed, const sim::ArmTruth& truth)
    : believed_(believed), true_(truth.machine), X_WR_(base_of(believed_)) {
  for (std::size_t i = 0; i < believed_.joints(); ++i)
    step_[i] = 2.0 * kPi / (truth.counts[i] * believed.drives[i].ratio);
}

double KinematicArm::go(const Point<'W'>& wanted) {
  if (!believed_.inverse(X_WR_.inverse() * wanted, joints_))
    throw Error("no joints of the arm put its tip at a place; expected one that it reaches");
  const double way = (wanted - at_).norm();
  at_ = wanted;
  return way / kSpeed + kSettling;
}

TipStand KinematicArm::read(double /*later*/) {
  PerJoint told{};
  for (std::size_t i = 0; i < believed_.joints(); ++i) told[i] = std::round(joints_[i] / step_[i]) * step_[i];
  return {X_WR_ * true_.tip(joints_), X_WR_ * believed_.tip(told), joints_};
}

Pose<'W', 'R'> base_of(const Arm& arm) { return {Quat::Identity(), Vec3(-arm.tip(arm.zero()).e())}; }

std::vector<Point<'W'>> places_in_view(const Arm& arm, double least_dexterity, const Pose<'W', 'C'>& X_WC,
                                       const sim::CameraTruth& camera) {
  const sim::StereoPoints eyes(camera, 0);
  const Pose<'W', 'R'> X_WR = base_of(arm);
  const Pose<'C', 'W'> X_CW = X_WC.inverse();
  std::vector<Point<'W'>> places;
  const auto joint = [&](std::size_t j, int step) {
    const ArmDrive& drive = arm.machine().drives[j];
    return drive.low + (drive.high - drive.low) * (step + 0.5) / kJointSteps;  // never at a joint limit
  };
  const auto steps = [&](std::size_t j) { return j < arm.joints() ? kJointSteps : 1; };
  for (int a = 0; a < steps(0); ++a)
    for (int b = 0; b < steps(1); ++b)
      for (int c = 0; c < steps(2); ++c) {
        PerJoint q{};
        const std::array<int, kMostJoints> at{a, b, c};
        for (std::size_t j = 0; j < arm.joints(); ++j) q[j] = joint(j, at[j]);
        if (!arm.within_limits(q) || arm.dexterity(arm.jacobian(q)) < least_dexterity) continue;
        const Point<'W'> p = X_WR * arm.tip(q);
        if (well_in_view(eyes, camera, X_CW * p)) places.push_back(p);
      }
  return places;
}

std::vector<Point<'W'>> well_spread(const std::vector<Point<'W'>>& places, std::size_t count) {
  std::vector<Point<'W'>> chosen;
  if (places.empty()) return chosen;
  Vec3 middle = Vec3::Zero();
  for (const Point<'W'>& p : places) middle += p.e() / static_cast<double>(places.size());
  std::vector<double> nearest(places.size());  // distance to the chosen places; at first, to the middle
  std::transform(places.begin(), places.end(), nearest.begin(),
                 [&](const Point<'W'>& p) { return (p.e() - middle).norm(); });
  while (chosen.size() < std::min(count, places.size())) {
    const auto farthest = std::max_element(nearest.begin(), nearest.end());
    const Point<'W'> next = places[static_cast<std::size_t>(farthest - nearest.begin())];
    for (std::size_t i = 0; i < places.size(); ++i) {
      const double distance = (places[i] - next).norm();
      nearest[i] = chosen.empty() ? distance : std::min(nearest[i], distance);
    }
    chosen.push_back(next);
  }
  return chosen;
}

std::vector<TipVisit> visit_places(MovedArm& arm, const std::vector<Point<'W'>>& places, double rate,
                                   std::size_t frames) {
  std::vector<TipVisit> visits;
  double now = 0.0;
  for (const Point<'W'>& wanted : places) {
    now += arm.go(wanted);
    TipVisit visit{now, {}};
    for (std::size_t f = 0; f < frames; ++f) visit.frames.push_back(arm.read(1.0 / rate));
    now += static_cast<double>(frames) / rate;
    visits.push_back(std::move(visit));
  }
  return visits;
}

GuidedRun see_visits(const std::vector<TipVisit>& visits, TipEyes& eyes, double share) {
  GuidedRun run;
  for (const TipVisit& visit : visits) {
    eyes.move();
    models::SeenPlace place{static_cast<std::int64_t>(run.points.size()) + 1, {}};
    for (const TipStand& tip : visit.frames) {
      const std::optional<Point<'C'>> seen = eyes.see(tip);
      if (seen) place.frames.push_back({*seen, tip.reading});
    }
    run.seen.push_back(place.frames.size());
    if (static_cast<double>(place.frames.size()) < share * static_cast<double>(visit.frames.size())) {
      ++run.unseen;
      continue;
    }
    run.points.push_back(std::move(place));
    run.seconds.push_back(visit.still);
  }
  return run;
}

namespace {

class PointEyes final : public TipEyes {
 public:
  PointEyes(const Pose<'W', 'C'>& X_WC, const sim::CameraTruth& camera, std::uint64_t seed)
      : X_CW_(X_WC.inverse()), eyes_(camera, seed) {}
  void move() override { eyes_.move(); }
  std::optional<Point<'C'>> see(const TipStand& tip) override { return eyes_.see(X_CW_ * tip.truth); }

 private:
  Pose<'C', 'W'> X_CW_;
  sim::StereoPoints eyes_;
};

}  // namespace

GuidedRun see_visits(const std::vector<TipVisit>& visits, const Pose<'W', 'C'>& X_WC,
                     const sim::CameraTruth& camera, std::uint64_t seed) {
  PointEyes eyes(X_WC, camera, seed);
  return see_visits(visits, eyes, 1.0);
}

Vec3 target_error(const Pose<'W', 'C'>& found, const Pose<'W', 'C'>& truth, const Point<'W'>& place) {
  return (found * (truth.inverse() * place) - place).e();
}

}  // namespace enc::trial
