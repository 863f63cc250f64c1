#include "trial/measure/programme_measures.h"

#include <algorithm>
#include <cmath>

#include "core/control/scene/scene.h"
#include "core/control/task/tasks.h"

namespace enc::trial {

void ProbeMeasure::Range::add(double force) {
  low = pushes == 0 ? force : std::min(low, force);
  high = pushes == 0 ? force : std::max(high, force);
  ++pushes;
}

// Adds the force at each level between the last tick and this one, by linear interpolation.
void ProbeMeasure::compare(double deflection, double force) {
  if (deflection == deflection_) return;
  std::vector<Range>& ranges = levels_[deflection > deflection_ ? 0 : 1];
  const auto [from, to] = std::minmax(deflection_, deflection);
  const auto last = static_cast<std::size_t>(std::floor(std::max(0.0, to) / kLevel));
  for (auto i = static_cast<std::size_t>(std::ceil(std::max(0.0, from) / kLevel)); i <= last; ++i) {
    const double level = static_cast<double>(i) * kLevel;
    if (level <= 0.0 || level < from || level >= to) continue;
    if (ranges.size() <= i) ranges.resize(i + 1);
    ranges[i].add(force_ + (force - force_) * (level - deflection_) / (deflection - deflection_));
  }
}

void ProbeMeasure::see(const Glance& glance) {
  if (glance.out.mode != Mode::probe || glance.out.contacts == 0 || !glance.out.force_unfiltered.finite())
    return;
  const Vec<'W'> axis = glance.scene.indentation()->X_WN * Vec<'N'>(0, 0, 1);
  const double force = dot(glance.out.force_unfiltered, axis);
  const double deflection = glance.out.deflection;
  if (pushes_.size() != static_cast<std::size_t>(glance.out.contacts)) {
    pushes_.resize(static_cast<std::size_t>(glance.out.contacts));
    deflection_ = kUnset;
  }
  PushFigures& push = pushes_.back();
  if (deflection > 0.0) {
    push.peak_force = std::max(push.peak_force, force);
    push.peak_deflection = std::max(push.peak_deflection, deflection);
    force_error_ = std::max(force_error_, std::abs(force - dot(glance.truth.contact_force, axis)));
    if (!std::isnan(deflection_)) {
      const double way = deflection - std::max(0.0, deflection_);
      (way > 0.0 ? push.work_in : push.work_out) += 0.5 * (force + force_) * std::abs(way);
    }
  }
  if (!std::isnan(deflection_)) compare(deflection, force);
  deflection_ = deflection;
  force_ = force;
}

double ProbeMeasure::spread() const {
  double most = kUnset;
  for (const std::vector<Range>& ranges : levels_)
    for (const Range& range : ranges)
      if (range.pushes > 1) most = std::fmax(most, range.high - range.low);
  return most;
}

namespace {

constexpr double kSettled = 0.3;  // s of rest before a stop counts: longer than any packet's delay

std::int32_t next_axis(const TrackingTask& travel, std::int32_t leg) {
  return travel.on_leg(leg + 1) ? travel.legs[static_cast<std::size_t>(leg) + 1].axis : -1;
}

}  // namespace

void ErrorSum::add(double error) {
  sum_ += error;
  size_ += std::abs(error);
  square_ += error * error;
  ++n_;
}

void ErrorSum::add(const ErrorSum& other) {
  sum_ += other.sum_;
  size_ += other.size_;
  square_ += other.square_;
  n_ += other.n_;
}

Errors ErrorSum::errors() const {
  if (n_ == 0) return {kUnset, kUnset, kUnset};
  const auto n = static_cast<double>(n_);
  return {std::sqrt(square_ / n), size_ / n, std::abs(sum_) / n};
}

void TravelSums::add(const TravelSums& other) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    stopped[axis].add(other.stopped[axis]);
    forward[axis].add(other.forward[axis]);
    back[axis].add(other.back[axis]);
  }
  largest = std::max(largest, other.largest);
  packets.insert(packets.end(), other.packets.begin(), other.packets.end());
}

std::int64_t TravelSums::size() const {
  std::int64_t n = 0;
  for (const auto* sums : {&stopped, &forward, &back})
    for (const ErrorSum& sum : *sums) n += sum.size();
  return n;
}

void TravelMeasure::see(const Glance& glance) {
  const Scene& scene = glance.scene;
  if (scene.tracking() == nullptr || glance.state == nullptr) return;
  const Inputs& in = glance.in;
  const TrackingState& now = recall<TrackingState>(*glance.state);
  if (in.tip.health == Health::absent || !scene.tracking()->on_leg(now.leg)) return;
  const TravelLeg& leg = scene.tracking()->legs[static_cast<std::size_t>(now.leg)];
  const Vec3 velocity = (scene.X_WR * in.tip.value.velocity).e();
  const double t = seconds(in.tip.t.time_since_epoch());
  if (velocity.norm() > kMoving) moved_ = t;
  if (in.tool.health != Health::ok || in.tool.t == stamp_) return;
  stamp_ = in.tool.t;
  // A position read over a network is some milliseconds old.
  const Vec<'W'> since(Vec3(age(glance.tick.t, in.tip.t) * velocity));
  const Point<'W'> tip = scene.X_WR * in.tip.value.X_RH.origin() + since;
  const Tool& tool = scene.tools[static_cast<std::size_t>(in.tool.value.tool)];
  const Vec3 error = (scene.X_WC * in.tool.value.X_CT * tool.tip.centre - tip).e();
  sums_.largest = std::max(sums_.largest, error.norm());
  // A leg to a start counts only for the stop at its end.
  const bool at_rest = now.phase == TravelPhase::dwell && t - moved_ > kSettled;
  const std::int32_t axis = leg.axis >= 0 ? leg.axis : next_axis(*scene.tracking(), now.leg);
  if (axis < 0 || (leg.axis < 0 && !at_rest)) return;
  count({t, tip.xyz[static_cast<std::size_t>(axis)], error[axis], MotionDirection::stopped, axis},
        velocity[axis], at_rest);
}

void TravelMeasure::count(PacketError packet, double speed, bool at_rest) {
  const auto axis = static_cast<std::size_t>(packet.axis);
  if (std::abs(speed) > kMoving) {
    packet.moving = speed > 0.0 ? MotionDirection::forward : MotionDirection::back;
    (speed > 0.0 ? sums_.forward : sums_.back)[axis].add(packet.error);
  } else if (at_rest) {
    sums_.stopped[axis].add(packet.error);
  }
  if (keeps_) sums_.packets.push_back(packet);
}

}  // namespace enc::trial
