#include "core/track/reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/track/minimum_jerk.h"

namespace enc {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec6 = Eigen::Matrix<double, 6, 1>;

constexpr double kCrosses = 0.7;  // share of a correction's time at which it crosses the surface
constexpr double kOverlap =
    0.8;  // a correction begins when at least so much of the first movement's time is over
constexpr double kLongest = 3.0;  // longest correction over the shortest
constexpr double kLeastShare =
    0.6;                       // of its way a first movement has made, at least, where it crosses the surface
constexpr double kWide = 1.0;  // m, m/s: where a hand is and goes, as long as nothing is known of it
constexpr double kExactly = 1e-4;   // m
constexpr double kEven = 0.2;       // share of the hands that come with an even speed
constexpr double kLength = 0.17;    // m, of a first movement, to begin with
constexpr double kShortest = 0.02;  // m, of one that is found
constexpr double kOldest = 1.0;     // s, of a picture

struct Tries {
  int times, corrections, begins;  // of the first movement; of the second, or of how far the first has got
};
constexpr Tries kFew{12, 3, 2}, kAll{12, 5, 3};

// Unknown numbers, each seen through sums of them: their mean, and how probable it is that what is seen is
// seen.
template <int kSize>
class Normal {
 public:
  using Vector = Eigen::Matrix<double, kSize, 1>;
  void see(const Vector& share, double value, double sigma) {
    const double w = 1.0 / (sigma * sigma);
    information_.noalias() += (w * share) * share.transpose();
    right_ += (w * value) * share;
    evidence_ -= 0.5 * w * value * value + std::log(sigma);
  }
  void expect(int from,
              const Eigen::Matrix2d& covariance) {  // two of them, about 0, not in a row: from, from + 3
    const Eigen::Matrix2d inverse = covariance.inverse();
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) information_(from + 3 * i, from + 3 * j) += inverse(i, j);
    evidence_ -= 0.5 * std::log(covariance.determinant());
  }
  void solve() {
    factors_.compute(information_);
    mean_ = factors_.solve(right_);
    evidence_ += 0.5 * right_.dot(mean_) - 0.5 * factors_.vectorD().array().log().sum();
  }
  [[nodiscard]] const Vector& mean() const { return mean_; }
  [[nodiscard]] double evidence() const { return evidence_; }  // logarithm
  [[nodiscard]] double variance(const Vector& share) const { return share.dot(factors_.solve(share)); }

 private:
  Eigen::Matrix<double, kSize, kSize> information_ = Eigen::Matrix<double, kSize, kSize>::Zero();
  Vector right_ = Vector::Zero(), mean_ = Vector::Zero();
  Eigen::LDLT<Eigen::Matrix<double, kSize, kSize>> factors_;
  double evidence_ = 0.0;
};

// The pictures, turned about the normal so that the hand's way has no y; and what the belief makes of that
// way.
struct Seen {
  std::array<Vec3, kSightings> at;
  std::array<double, kSightings> age{};
  std::size_t count = 0;
  double noise = kUnset;
  Vec2 x = Vec2::UnitX(), y = Vec2::UnitY();  // turned, in the axes that were given
  double length = kLength;                    // m, of the first movement
  Eigen::Matrix2d left_xz;  // covariance of what is left when the first movement is over, m^2
  double left_y = kUnset;   // its standard deviation, m

  Seen(const ReachBelief& hand, std::span<const Sighting> pictures, double noise_of, const Vec3& first)
      : count(std::min(pictures.size(), kSightings)), noise(noise_of), length(first.norm()) {
    const double aside = first.head<2>().norm();
    if (aside > 1e-9) x = first.head<2>() / aside;
    y = Vec2(-x.y(), x.x());
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3& p = pictures[i].at;
      at[i] = {x.dot(p.head<2>()), y.dot(p.head<2>()), p.z()};
      age[i] = pictures[i].age;
    }
    const double far = hand.scatter / (hand.share * hand.share) * length;
    left_y = hand.aside / (hand.share * hand.share) * length;
    const Vec2 along = Vec2(aside, first.z()) / length;
    left_xz = left_y * left_y * Eigen::Matrix2d::Identity() +
              (far * far - left_y * left_y) * along * along.transpose();
  }
  [[nodiscard]] Vec2 given(const Vec2& turned) const { return turned.x() * x + turned.y() * y; }
};

// When the movements of a reach that touches now begin, s from now, and how long they take.
struct Timing {
  double begins = kUnset, first = kUnset, corrects = kUnset, second = kUnset;
  bool falls_short = true;  // the first movement; else it crosses the surface by itself, and
  double crossed = 1.0;     // so much of its way is made by then
};

struct Fit {
  double evidence = -std::numeric_limits<double>::infinity();  // logarithm
  Vec2 place = Vec2::Zero();                                   // turned axes
  Vec3 first{kUnset, kUnset, kUnset};                          // the first movement, likewise
};

// Probability that a hand whose second movement has this way down, m, takes this time for it. Each corrects
// so that it crosses the surface with the speed that it wants; the shortest time stands for all faster ones.
double takes(const ReachBelief& hand, double down, double second, double width) {
  const double speed = down * MinimumJerk(kCrosses).v / second;
  const double range = hand.touch_fastest - hand.touch_slowest;
  if (down <= 0.0) return 0.0;
  if (second <= hand.shortest)
    return std::clamp((hand.touch_fastest - std::max(hand.touch_slowest, speed)) / range, 0.0, 1.0);
  return speed >= hand.touch_slowest && speed <= hand.touch_fastest ? speed / second * width / range : 0.0;
}

// The unknowns along an axis: where the hand began, the first movement, and what of the rest of the way the
// belief does not foresee. The second movement makes the rest of the way; across the surface it aims beyond
// it.
Fit fit(const ReachBelief& hand, const Seen& seen, const Timing& t, double width) {
  const double rest = 1.0 / hand.share - 1.0;  // of the first movement
  const double beyond = t.falls_short ? 1.0 / MinimumJerk(kCrosses).x : 0.0;
  Normal<3> across;
  Normal<6> plane;  // x, then z
  const auto on_x = [](const Vec3& share) { return (Vec6() << share, Vec3::Zero()).finished(); };
  const auto on_z = [](const Vec3& share) { return (Vec6() << Vec3::Zero(), share).finished(); };
  for (int i = 0; i < 2; ++i) {
    across.see(Vec3::Unit(i), 0.0, kWide);
    plane.see(on_x(Vec3::Unit(i)), 0.0, kWide);
  }
  plane.see(on_z(Vec3::UnitY()), 0.0, kWide);
  across.see(Vec3::UnitZ(), 0.0, seen.left_y);
  plane.expect(2, seen.left_xz);
  plane.see(on_z({1.0, 1.0 + rest, 1.0}), 0.0, kExactly);  // the whole way leads to the surface
  if (!t.falls_short) plane.see(on_z({1.0, t.crossed, 0.0}), 0.0, kExactly);
  for (std::size_t i = 0; i < seen.count; ++i) {
    const double p = MinimumJerk((-seen.age[i] - t.begins) / t.first).x;
    const double s = MinimumJerk((-seen.age[i] - t.corrects) / t.second).x;
    across.see({1.0, p + rest * s, s}, seen.at[i].y(), seen.noise);
    plane.see(on_x({1.0, p + rest * s, s}), seen.at[i].x(), seen.noise);
    plane.see(on_z({1.0, p + beyond * rest * s, beyond * s}), seen.at[i].z(), seen.noise);
  }
  across.solve();
  plane.solve();
  const Vec6& m = plane.mean();
  // How far down the second movement goes says how long it takes: three points for a normal distribution.
  const Vec6 down = on_z(Vec3(0.0, -rest, -1.0) / MinimumJerk(kCrosses).x);
  const double middle = down.dot(m), spread = std::sqrt(3.0 * std::max(0.0, plane.variance(down)));
  double share = 0.0;
  for (const auto& [at, weight] : {std::pair{-1.0, 1.0 / 6.0}, {0.0, 2.0 / 3.0}, {1.0, 1.0 / 6.0}}) {
    const double d = middle + at * spread;
    share += weight * (t.falls_short ? takes(hand, d, t.second, width) : d <= 0.0 ? 1.0 : 0.0);
  }
  Fit fit;
  fit.first = {m[1], across.mean()[1], m[4]};
  const double p = MinimumJerk(-t.begins / t.first).x, s = MinimumJerk(-t.corrects / t.second).x;
  const Vec3 touching(1.0, p + rest * s, s);
  fit.place = {touching.dot(m.head<3>()), touching.dot(across.mean())};
  fit.evidence = across.evidence() + plane.evidence() + std::log(std::max(share, 1e-12));
  // That it crosses just now, where nothing else says so: the density of its height, times its speed.
  if (!t.falls_short) {
    const double speed = MinimumJerk(-t.begins / t.first).v * std::abs(m[4]);
    fit.evidence += std::log(std::max(speed * width, 1e-12)) - 0.5 * std::log(2.0 * M_PI);
  }
  return fit;
}

// A hand that comes with an even speed: where it is now, and its velocity.
Fit fit_even(const Seen& seen) {
  Normal<2> axes[3];
  for (int k = 0; k < 3; ++k) {
    Normal<2>& axis = axes[k];
    for (int i = 0; i < 2; ++i) axis.see(Vec2::Unit(i), 0.0, kWide);
    if (k == 2) axis.see(Vec2::UnitX(), 0.0, kExactly);
    for (std::size_t i = 0; i < seen.count; ++i) axis.see({1.0, -seen.age[i]}, seen.at[i][k], seen.noise);
    axis.solve();
  }
  Fit fit;
  fit.place = {axes[0].mean()[0], axes[1].mean()[0]};
  fit.evidence = axes[0].evidence() + axes[1].evidence() + axes[2].evidence() +
                 std::log(std::max(std::abs(axes[2].mean()[1]), 1e-6)) - 0.5 * std::log(2.0 * M_PI);
  return fit;
}

// The place that all together say, weighted by how probable each is. Nothing is kept of each.
class Mean {
 public:
  void add(const Fit& fit) {
    if (!(fit.evidence > -1e30) || !fit.place.allFinite()) return;
    if (fit.evidence > most_) {
      const double less = std::exp(most_ - fit.evidence);
      place_ *= less;
      first_ *= less;
      weight_ *= less;
      most_ = fit.evidence;
    }
    const double w = std::exp(fit.evidence - most_);
    place_ += w * fit.place;
    first_ += w * fit.first;
    weight_ += w;
  }
  [[nodiscard]] double evidence() const { return most_ + std::log(weight_); }  // logarithm
  [[nodiscard]] Vec2 place() const { return place_ / weight_; }
  [[nodiscard]] Vec3 first() const { return first_ / weight_; }  // movement

 private:
  double most_ = -std::numeric_limits<double>::infinity(), weight_ = 0.0;
  Vec2 place_ = Vec2::Zero();
  Vec3 first_ = Vec3::Zero();
};

void try_reaches(const ReachBelief& hand, const Seen& seen, const Tries& tries, Mean& mean) {
  const double share = std::log((1.0 - kEven) / (tries.times * tries.begins));
  for (int i = 0; i < tries.times; ++i)
    for (int j = 0; j < tries.begins; ++j)
      for (int k = 0; k < tries.corrections; ++k)
        for (const bool falls_short : {true, false}) {
          Timing t;
          // Even over the peak speed, and over when the correction begins.
          const double peak = hand.slowest + (hand.fastest - hand.slowest) * (i + 0.5) / tries.times;
          t.first = 1.875 * seen.length / peak;
          const double begins = (kOverlap + (1.0 - kOverlap) * (j + 0.5) / tries.begins) * t.first;
          t.falls_short = falls_short;
          double width = (1.0 - kLeastShare) / tries.corrections;
          if (falls_short) {
            const double each = std::log(kLongest) / std::max(1, tries.corrections - 1);
            t.second = hand.shortest * (k == 0 ? 1.0 : std::exp((k - 0.5) * each));
            width = t.second * each;
            t.corrects = -kCrosses * t.second;
            t.begins = t.corrects - begins;
          } else {
            t.begins = -(kLeastShare + (k + 0.5) * width) * t.first;
            t.second = hand.shortest;
            t.corrects = t.begins + begins;
            t.crossed = MinimumJerk(-t.begins / t.first).x;
          }
          Fit one = fit(hand, seen, t, width);
          one.evidence += share;
          mean.add(one);
        }
}

}  // namespace

Touch touch_then(const ReachBelief& hand, std::span<const Sighting> newest_first, double noise) noexcept {
  const Touch unknown;
  const std::size_t count = std::min(newest_first.size(), kSightings);
  if (count < 3 || !(noise > 0.0)) return unknown;
  bool sound = true;
  for (const Sighting& one : newest_first.first(count))
    sound = sound && one.at.allFinite() && std::isfinite(one.age) && one.age < kOldest;
  const Vec3 way = newest_first[0].at - newest_first[count - 1].at;
  if (!sound || !(way.z() < 0.0)) return unknown;
  const Seen coarse(hand, newest_first, noise, kLength * way.normalized());
  Mean few;
  try_reaches(hand, coarse, kFew, few);
  const Vec3 turned = few.first();
  Vec3 first;
  first << coarse.given(turned.head<2>()), turned.z();
  if (!(first.norm() > kShortest && first.norm() < kWide)) first = kLength * way.normalized();
  const Seen seen(hand, newest_first, noise, first);
  Mean mean;
  Fit even = fit_even(seen);
  even.evidence += std::log(kEven);
  mean.add(even);
  try_reaches(hand, seen, kAll, mean);
  return {seen.given(mean.place()), mean.evidence()};
}

}  // namespace enc
