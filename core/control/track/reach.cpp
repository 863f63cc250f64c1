#include "core/control/track/reach.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace enc {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double kCrosses = 0.7;  // share of a correction's time at which it crosses the surface
constexpr MinimumJerk kAtCrossing(kCrosses);
constexpr double kOverlap = 0.8;     // least share of the first movement's time before a correction
constexpr double kLongest = 3.0;     // longest correction over the shortest
constexpr double kLeastShare = 0.6;  // least share of a first movement at the surface
constexpr double kWide = 1.0;        // m, m/s: position and speed of a hand before anything is known about it
constexpr double kVague = 1.0 / (kWide * kWide);  // 1/m^2, 1/(m/s)^2: the weight of that prior
constexpr double kExact = 1e8;                    // 1/m^2: the weight of a value known to 0.1 mm
// Share of the hands that come at constant speed or pass by. Chosen: a large value predicts these best. It
// makes no difference to reaches from 0.2 to 0.99, because the pictures distinguish them by themselves.
constexpr double kEven = 0.95;
constexpr double kLength = 0.17;    // m, initial length of a first movement
constexpr double kShortest = 0.02;  // m, least estimated length
constexpr double kOldest = 1.0;     // s, oldest usable picture

struct Tries {
  int times, corrections, begins;  // trials: first movement, second, progress of the first
};
constexpr Tries kFew{12, 3, 2}, kAll{12, 5, 3};

// Normal equations of three unknowns a, b and c, where each value is a + u b + v c. All axes share the left
// sides; each axis has a right side of its own. Weights are 1 / variance.
struct LeftSide {
  double a = 0.0, ab = 0.0, b = 0.0, ac = 0.0, bc = 0.0, c = 0.0;
  void see(double u, double v, double weight) {
    a += weight;
    ab += weight * u;
    b += weight * u * u;
    ac += weight * v;
    bc += weight * u * v;
    c += weight * v * v;
  }
};
struct RightSide {
  double a = 0.0, b = 0.0, c = 0.0;
  void see(double u, double v, double weighted) {
    a += weighted;
    b += weighted * u;
    c += weighted * v;
  }
};
// Gaussian elimination: a and b are eliminated, and the rest depends on c alone.
struct Pivots {
  double a, ab, b, ac, bc, c;
  explicit Pivots(const LeftSide& m)
      : a(m.a),
        ab(m.ab / m.a),
        b(m.b - ab * m.ab),
        ac(m.ac / m.a),
        bc((m.bc - ac * m.ab) / b),
        c(m.c - ac * m.ac - bc * bc * b) {}
};
struct AxisSolution {
  double a, b, c;  // right side
  double agrees;   // twice the logarithm of the probability, as far as a and b determine it
  AxisSolution(const Pivots& p, const RightSide& r)
      : a(r.a), b(r.b - p.ab * a), c(r.c - p.ac * a - p.bc * b), agrees(a * a / p.a + b * b / p.b) {}
  // The unknowns for a given c.
  [[nodiscard]] Vec3 solved(const Pivots& p, double last) const {
    const double middle = b / p.b - p.bc * last;
    return {a / p.a - p.ab * middle - p.ac * last, middle, last};
  }
};

// The pictures, turned about the normal so that the hand's path has no y; and the prior of that path.
struct TurnedSightings {
  std::array<Sighting, kSightings> turned;
  std::size_t count = 0;
  double weight = kUnset;                     // weight of one picture, 1 / m^2
  Vec2 x = Vec2::UnitX(), y = Vec2::UnitY();  // turned axes, in the given ones
  double length = kLength;                    // m, length of the first movement
  Eigen::Matrix2d left_xz;  // inverse covariance of the error left after the first movement, 1/m^2
  double left_y = kUnset;   // its inverse variance, 1/m^2
  double certain = kUnset;  // log-precision of both

  TurnedSightings(const ReachBelief& hand, std::span<const Sighting> pictures, double noise_of,
                  const Vec3& first)
      : count(std::min(pictures.size(), kSightings)),
        weight(1.0 / (noise_of * noise_of)),
        length(first.norm()) {
    const double aside = first.head<2>().norm();
    if (aside > 1e-9) x = first.head<2>() / aside;
    y = Vec2(-x.y(), x.x());
    for (std::size_t i = 0; i < count; ++i) {
      const Vec3& p = pictures[i].at;
      turned[i] = {{x.dot(p.head<2>()), y.dot(p.head<2>()), p.z()}, pictures[i].age};
    }
    const double far = hand.scatter / (hand.share * hand.share) * length;
    const double beside = hand.aside / (hand.share * hand.share) * length;
    const Vec2 along = Vec2(aside, first.z()) / length;
    left_y = 1.0 / (beside * beside);
    left_xz = left_y * Eigen::Matrix2d::Identity() + (1.0 / (far * far) - left_y) * along * along.transpose();
    certain = -std::log(beside * beside * far);
  }
  [[nodiscard]] std::span<const Sighting> pictures() const { return {turned.data(), count}; }
  [[nodiscard]] Vec2 given(const Vec2& place) const { return place.x() * x + place.y() * y; }
};

// Start (s from now) and duration of the movements of a reach that touches now.
struct Timing {
  double begins = kUnset, first = kUnset, corrects = kUnset, second = kUnset;
  bool falls_short = true;  // the first movement falls short; else it crosses the surface itself
  double crossed = 1.0;     // share of its path covered by then
};

struct Fit {
  double evidence = -std::numeric_limits<double>::infinity();  // logarithm
  Vec2 place = Vec2::Zero();                                   // turned axes
  Vec3 first{kUnset, kUnset, kUnset};                          // the first movement along each axis
};

// Probability that a hand whose second movement goes down by `down`, m, takes this time for it. Each hand
// corrects so that it crosses the surface at its touch speed; the shortest time stands for all faster ones.
double takes(const ReachBelief& hand, double down, double second, double width) {
  const double speed = down * kAtCrossing.v / second;
  const double range = hand.touch_fastest - hand.touch_slowest;
  if (down <= 0.0) return 0.0;
  if (second <= hand.shortest)
    return std::clamp((hand.touch_fastest - std::max(hand.touch_slowest, speed)) / range, 0.0, 1.0);
  return speed >= hand.touch_slowest && speed <= hand.touch_fastest ? speed / second * width / range : 0.0;
}

// Evidence of the pictures on the unknowns along each axis.
struct Axes {
  LeftSide xy, z;
  RightSide of_x, of_y, of_z;
  // Adds a picture in which each movement has covered the given share of its path.
  void see(const Vec3& at, double weight, double first, double second, double rest, double beyond) {
    const double u = first + rest * second;
    xy.see(u, second, weight);
    of_x.see(u, second, weight * at.x());
    of_y.see(u, second, weight * at.y());
    const double uz = first + rest * beyond * second, vz = beyond * second;
    z.see(uz, vz, weight);
    of_z.see(uz, vz, weight * at.z());
  }
};

// Evidence of pictures, prior and surface for a reach with these times. `rest`: of the first movement;
// `beyond`: how far the second aims beyond, as a share of its path.
Axes axes_of(const TurnedSightings& seen, const Timing& t, double rest, double beyond) {
  Axes axes;
  for (const auto& [at, age] : seen.pictures())
    axes.see(at, seen.weight, MinimumJerk((-age - t.begins) / t.first).x,
             MinimumJerk((-age - t.corrects) / t.second).x, rest, beyond);
  axes.xy.a += kVague;
  axes.xy.b += kVague;
  axes.z.b += kVague;
  axes.z.see(1.0 + rest, 1.0, kExact);  // the whole path leads to the surface
  if (!t.falls_short) axes.z.see(t.crossed, 0.0, kExact);
  return axes;
}

// Probability of the second movement's time if its descent is normally distributed: by three points.
double share_that_takes(const ReachBelief& hand, const Timing& t, double middle, double spread,
                        double width) {
  double share = 0.0;
  for (const auto& [at, weight] : {std::pair{-1.0, 1.0 / 6.0}, {0.0, 2.0 / 3.0}, {1.0, 1.0 / 6.0}}) {
    const double d = middle + at * spread;
    share += weight * (t.falls_short ? takes(hand, d, t.second, width) : d <= 0.0 ? 1.0 : 0.0);
  }
  return share;
}

// The unknowns along an axis: the hand's start, the first movement, and the part of the rest that the prior
// does not predict. The second movement covers the rest; across the surface it aims beyond it. The evidence
// omits how much the pictures differ from zero, because that is common to all reaches.
Fit fit(const ReachBelief& hand, const TurnedSightings& seen, const Timing& t, double width) {
  const double rest = 1.0 / hand.share - 1.0;  // fraction of the first movement
  const double beyond = t.falls_short ? 1.0 / kAtCrossing.x : 0.0;
  const Axes axes = axes_of(seen, t, rest, beyond);
  const Pivots xy(axes.xy), z(axes.z);
  const AxisSolution of_x(xy, axes.of_x), of_y(xy, axes.of_y), of_z(z, axes.of_z);
  // The errors left along x and z are correlated.
  const double y_weight = xy.c + seen.left_y;
  const double x_weight = xy.c + seen.left_xz(0, 0), z_weight = z.c + seen.left_xz(1, 1);
  const double both = seen.left_xz(0, 1), area = x_weight * z_weight - both * both;
  const double x_left = (z_weight * of_x.c - both * of_z.c) / area;
  const double z_left = (x_weight * of_z.c - both * of_x.c) / area;
  const Vec3 along = of_x.solved(xy, x_left), across = of_y.solved(xy, of_y.c / y_weight),
             down = of_z.solved(z, z_left);
  // The descent of the second movement determines its duration.
  const double middle = -(rest * down[1] + down[2]) / kAtCrossing.x;
  const double by_left = 1.0 - rest * z.bc,
               variance = rest * rest / z.b + by_left * by_left * x_weight / area;
  const double spread = std::sqrt(3.0 * variance) / kAtCrossing.x;
  double share = share_that_takes(hand, t, middle, spread, width);
  Fit fit;
  fit.first = {along[1], across[1], down[1]};
  const double p = MinimumJerk(-t.begins / t.first).x, s = MinimumJerk(-t.corrects / t.second).x;
  const Vec3 touching(1.0, p + rest * s, s);
  fit.place = {touching.dot(along), touching.dot(across)};
  const double agrees = of_x.agrees + of_y.agrees + of_z.agrees + of_y.c * of_y.c / y_weight +
                        of_x.c * x_left + of_z.c * z_left;
  const double pivots = xy.a * xy.b;
  double certain = pivots * pivots * y_weight * area * (z.a * z.b);
  // Density of crossing just now, if nothing else determines it: the density of its height, times its speed.
  if (!t.falls_short) {
    const double speed = MinimumJerk(-t.begins / t.first).v * std::abs(down[1]) * width;
    share *= std::max(speed, 1e-12);
    certain *= 2.0 * M_PI / kExact;
  }
  fit.evidence = 0.5 * (agrees - std::log(certain)) + seen.certain + std::log(std::max(share, 1e-24));
  return fit;
}

// A hand at constant speed: a is its present position, b its velocity.
Axes even(std::span<const Sighting> pictures, double weight) {
  Axes axes;
  for (const auto& [at, age] : pictures) axes.see(at, weight, -age, 0.0, 0.0, 0.0);
  for (LeftSide* one : {&axes.xy, &axes.z}) {
    one->a += kVague;
    one->b += kVague;
  }
  return axes;
}

// A hand at constant speed that touches now.
Fit fit_even(const TurnedSightings& seen) {
  Axes axes = even(seen.pictures(), seen.weight);
  axes.z.a += kExact;
  const Pivots aside(axes.xy), z(axes.z);
  const AxisSolution x(aside, axes.of_x), y(aside, axes.of_y), down(z, axes.of_z);
  Fit fit;
  fit.place = {x.solved(aside, 0.0)[0], y.solved(aside, 0.0)[0]};
  const double speed = std::abs(down.solved(z, 0.0)[1]), pivots = aside.a * aside.b;
  fit.evidence =
      0.5 * (x.agrees + y.agrees + down.agrees - std::log(pivots * pivots * (z.a * z.b) * (2.0 * M_PI))) +
      std::log(std::max(speed, 1e-6));
  return fit;
}

// The mean touch, weighted by probability. The single reaches are not stored.
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

void try_reaches(const ReachBelief& hand, const TurnedSightings& seen, const Tries& tries, Mean& mean) {
  const double share = std::log((1.0 - kEven) / (tries.times * tries.begins));
  for (int i = 0; i < tries.times; ++i)
    for (int j = 0; j < tries.begins; ++j)
      for (int k = 0; k < tries.corrections; ++k)
        for (const bool falls_short : {true, false}) {
          Timing t;
          // Uniform in the peak speed and in the start of the correction.
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

// The newest pictures, as many as are useful, if all are sound; else none.
std::span<const Sighting> usable(std::span<const Sighting> newest_first, double noise) {
  const auto some = newest_first.first(std::min(newest_first.size(), kSightings));
  const bool sound = std::all_of(some.begin(), some.end(), [](const Sighting& one) {
    return one.at.allFinite() && std::isfinite(one.age) && one.age < kOldest;
  });
  return sound && some.size() >= 3 && noise > 0.0 ? some : std::span<const Sighting>();
}

}  // namespace

double passes_by(std::span<const Sighting> newest_first, double noise, double until) noexcept {
  constexpr double kLogistic = 1.702;  // matches a logistic curve to a normal distribution, to 0.01
  const auto pictures = usable(newest_first, noise);
  if (pictures.empty()) return -std::numeric_limits<double>::infinity();
  const Axes axes = even(pictures, 1.0 / (noise * noise));
  const Pivots pivots(axes.xy);
  const AxisSolution x(pivots, axes.of_x), y(pivots, axes.of_y), z(pivots, axes.of_z);
  const Vec3 down = z.solved(pivots, 0.0);
  const double later = until - pivots.ab, height = down[0] + until * down[1];
  const double spread = std::sqrt(1.0 / pivots.a + later * later / pivots.b);
  const double share = 1.0 / (1.0 + std::exp(-kLogistic * height / spread));
  // kExact: precision with which a finger is at the surface when it touches; touch_then() leaves it out.
  const double evidence =
      0.5 * (x.agrees + y.agrees + z.agrees - 3.0 * std::log(pivots.a * pivots.b) - std::log(kExact)) +
      std::log(kEven * std::max(share, 1e-300));
  return std::isfinite(evidence) ? evidence : -std::numeric_limits<double>::infinity();
}

Touch touch_then(const ReachBelief& hand, std::span<const Sighting> newest_first, double noise,
                 const Vec2& carried) noexcept {
  const Touch unknown;
  const auto pictures = usable(newest_first, noise);
  if (pictures.empty()) return unknown;
  const Vec3 way = pictures.front().at - pictures.back().at;
  if (!(way.z() < 0.0)) return unknown;
  const TurnedSightings coarse(hand, pictures, noise, kLength * way.normalized());
  Mean few;
  try_reaches(hand, coarse, kFew, few);
  const Vec3 turned = few.first();
  Vec3 first;
  first << coarse.given(turned.head<2>()), turned.z();
  if (!(first.norm() > kShortest && first.norm() < kWide)) first = kLength * way.normalized();
  const TurnedSightings seen(hand, pictures, noise, first);
  Mean mean;
  Fit steady = fit_even(seen);
  steady.evidence += std::log(kEven);
  if (carried.allFinite()) steady.place = {seen.x.dot(carried), seen.y.dot(carried)};
  mean.add(steady);
  try_reaches(hand, seen, kAll, mean);
  return {seen.given(mean.place()), mean.evidence()};
}

}  // namespace enc
