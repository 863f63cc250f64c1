#include "trial/identify/camera/point_study.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "core/base/error.h"
#include "models/order_statistics.h"
#include "sim/truth/random.h"

namespace enc::trial {
namespace {

constexpr std::size_t kDraws = 200;  // random choices for each number of pairs and frames

Vec3 error_of(const Pose<'W', 'C'>& X_WC, const models::PointPair& pair) {
  return (X_WC * pair.camera - pair.device).e();
}

// The pose without pair k; empty if the other pairs do not determine it.
std::optional<models::Registration> without(std::vector<models::PointPair> pairs, std::size_t k) {
  pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(k));
  try {
    return models::register_points(pairs, 3);
  } catch (const Error&) {
    return std::nullopt;
  }
}

// The rotation vector between two rotations that differ little, about the fixed axes.
Vec3 turn_between(const Quat& from, const Quat& to) {
  const Eigen::AngleAxisd turn(to * from.conjugate());
  return turn.angle() * turn.axis();
}

// Half of the 95 % interval of a number, from its estimates without one pair each.
double jackknife(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  if (values.size() < models::kFewestPairs) return kUnset;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double square = 0.0;
  for (const double x : values) square += (x - mean) * (x - mean);
  return models::student(n - 1.0) * std::sqrt((n - 1.0) / n * square);
}

models::Interval mean_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto n = static_cast<double>(values.size());
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  double square = 0.0;
  for (const double x : values) square += (x - mean) * (x - mean);
  if (values.size() < 2) return {mean, kUnset};
  return {mean, models::student(n - 1.0) * std::sqrt(square / (n - 1.0) / n)};
}

void leave_one_out(const std::vector<models::PointPair>& pairs, PointStudy& study) {
  std::array<std::vector<double>, 3> position, turn, error;
  std::vector<double> sizes, scale;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const std::optional<models::Registration> one = without(pairs, k);
    if (!one) continue;
    const Vec3 off = error_of(one->X_WC, pairs[k]);
    const Vec3 turned = turn_between(study.found.X_WC.q(), one->X_WC.q());
    for (std::size_t a = 0; a < 3; ++a) {
      const auto i = static_cast<Eigen::Index>(a);
      position[a].push_back(one->X_WC.p()(i));
      turn[a].push_back(turned(i));
      error[a].push_back(std::abs(off(i)));
    }
    if (!(off.norm() <= study.worst_error)) study.worst = k, study.worst_error = off.norm();
    sizes.push_back(off.norm());
    scale.push_back(one->scale);
  }
  for (std::size_t a = 0; a < 3; ++a) {
    study.position[a] = {study.found.X_WC.p()(static_cast<Eigen::Index>(a)), jackknife(position[a])};
    study.turn[a] = {0.0, jackknife(turn[a])};
    study.left_out[a] = mean_of(error[a]);
  }
  study.scale = {study.found.scale, jackknife(scale)};
  study.usual_error = models::median(sizes);
}

// Splits the error: the scatter within pairs gives the noise of a frame; the rest stays, however many frames
// are averaged.
void split_noise(const models::PointSet& places, PointStudy& study) {
  Vec3 within = Vec3::Zero(), averaged = Vec3::Zero();
  double freedom = 0.0;
  for (const models::SeenPlace& place : places) {
    const Vec3 mean = error_of(study.found.X_WC, place.average());
    for (const models::PointPair& frame : place.frames)
      within += (error_of(study.found.X_WC, frame) - mean).cwiseAbs2();
    freedom += static_cast<double>(place.frames.size() - 1);
    study.frames += static_cast<double>(place.frames.size()) / static_cast<double>(places.size());
  }
  if (freedom < 1.0) return;
  const Vec3 variance = within / freedom;
  study.frame_noise = variance.cwiseSqrt();
  for (const models::SeenPlace& place : places)
    averaged += variance / static_cast<double>(place.frames.size() * places.size());
  // Six numbers were fitted to 3 n values, which reduces the residual: correct for it.
  const auto n = static_cast<double>(places.size());
  const Vec3 left = study.found.rms_error.cwiseAbs2() * n / (n - 2.0);
  study.standing = (left - averaged).cwiseMax(0.0).cwiseSqrt();
}

// Mean |error| at the pairs left out of a random draw.
std::optional<Vec3> draw(const models::PointSet& places, std::size_t pairs, std::size_t frames,
                         sim::Stream& random) {
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto swap_in = [&](auto& list, std::size_t i) {
    std::swap(list[i], list[i + static_cast<std::size_t>(random.bits() % (list.size() - i))]);
  };
  std::vector<models::PointPair> drawn;
  for (std::size_t i = 0; i < pairs; ++i) {
    swap_in(order, i);
    models::SeenPlace place = places[order[i]];
    for (std::size_t f = 0; f < std::min(frames, place.frames.size()); ++f) swap_in(place.frames, f);
    drawn.push_back(place.average(frames));
  }
  try {
    const models::Registration found = models::register_points(drawn);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = pairs; i < order.size(); ++i)
      sum += error_of(found.X_WC, places[order[i]].average()).cwiseAbs();
    return Vec3(sum / static_cast<double>(order.size() - pairs));
  } catch (const Error&) {
    return std::nullopt;  // the drawn points lie on a line by chance
  }
}

void try_fewer(const models::PointSet& places, std::uint64_t seed, PointStudy& study) {
  std::size_t most = 0;
  for (const models::SeenPlace& place : places) most = std::max(most, place.frames.size());
  sim::Stream random(seed, "point_study");
  for (const std::size_t pairs : {4UL, 5UL, 6UL, 8UL, 12UL, 16UL, 20UL}) {
    if (pairs >= places.size()) break;
    std::vector<std::size_t> counts;
    for (const std::size_t frames : {1UL, 5UL, 20UL, 100UL})
      if (frames < most) counts.push_back(frames);
    counts.push_back(most);
    for (const std::size_t frames : counts) {
      std::vector<Vec3> errors;
      for (std::size_t i = 0; i < kDraws; ++i)
        if (const std::optional<Vec3> one = draw(places, pairs, frames, random)) errors.push_back(*one);
      if (!errors.empty()) study.fewer.push_back({pairs, frames, band_of(errors)});
    }
  }
}

}  // namespace

AxisBand band_of(const std::vector<Vec3>& values) {
  AxisBand band;
  for (Eigen::Index a = 0; a < 3; ++a) {
    std::vector<double> axis;
    axis.reserve(values.size());
    for (const Vec3& v : values) axis.push_back(v(a));
    band.median(a) = models::median(axis);
    band.low(a) = models::percentile(axis, 0.025);
    band.high(a) = models::percentile(axis, 0.975);
  }
  return band;
}

PointStudy study_points(const models::PointSet& places, std::uint64_t seed) {
  const std::vector<models::PointPair> pairs = averages(places);
  PointStudy study;
  study.found = models::register_points(pairs);
  leave_one_out(pairs, study);
  split_noise(places, study);
  try_fewer(places, seed, study);
  return study;
}

}  // namespace enc::trial
