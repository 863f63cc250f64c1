#include "benchmarks/reaching/ideal.h"

#include <algorithm>
#include <cmath>

#include "core/control/safety/inside.h"
#include "core/control/track/reach.h"

namespace enc::bench::reaching {
namespace {

using Vec2 = Eigen::Vector2d;
using Vec9 = Eigen::Matrix<double, 9, 1>;
using Mat9 = Eigen::Matrix<double, 9, 9>;

constexpr double kCrosses = 0.7, kOverlap = 0.8;      // as in sim/hand/session_plan.cpp
constexpr int kFirst = 24, kSecond = 10, kBegin = 8;  // numbers of timings to try
constexpr std::size_t kPictures = 8;
constexpr double kWithin = 2e-3;   // m
constexpr double kExactly = 1e-4;  // m

double below(double x) { return 0.5 * (1.0 + std::erf(x * M_SQRT1_2)); }

// A timing of a reach that touches now, and the part of its weight that is not the pictures'.
struct Timing {
  double begins, first, corrects, second;
  bool falls_short;
  double crossed = 1.0, weight = 0.0, width = 0.0;
};

std::vector<Timing> timings(const IdealSpec& spec, double length, double fall) {
  std::vector<Timing> all;
  for (int i = 0; i < kFirst; ++i)
    for (int j = 0; j < kBegin; ++j)
      for (int k = 0; k < kSecond; ++k)
        for (const bool falls_short : {true, false}) {
          Timing t{};
          t.falls_short = falls_short;
          const double wide = 0.05 * (spec.fastest - spec.slowest);  // the length is not known exactly
          const double peak =
              spec.slowest - wide + (spec.fastest - spec.slowest + 2.0 * wide) * (i + 0.5) / kFirst;
          t.first = 1.875 * length / peak;
          const double begin = (kOverlap + (1.0 - kOverlap) * (j + 0.5) / kBegin) * t.first;
          if (falls_short) {
            const double each = std::log(3.0) / (kSecond - 1);
            t.second = spec.hand.shortest * (k == 0 ? 1.0 : std::exp((k - 0.5) * each));
            t.width = t.second * each;
            t.corrects = -kCrosses * t.second;
            t.begins = t.corrects - begin;
          } else {
            t.width = 0.4 / kSecond;
            const double at = 0.6 + (k + 0.5) * t.width;
            t.begins = -at * t.first;
            t.second = spec.hand.shortest;
            t.corrects = t.begins + begin;
            t.crossed = MinimumJerk(at).x;
            t.weight = std::log(MinimumJerk(at).v * fall * t.width);
          }
          all.push_back(t);
        }
  return all;
}

// Probability of this duration of a second movement for a hand that has `down`, m, left to go.
double takes(const IdealSpec& spec, const Timing& t, double down) {
  if (!t.falls_short) return down <= 0.0 ? 1.0 : 0.0;
  if (down <= 0.0) return 0.0;
  const double speed = down * MinimumJerk(kCrosses).v / t.second,
               range = spec.touch_fastest - spec.touch_slowest;
  if (t.second <= spec.hand.shortest)
    return std::clamp((spec.touch_fastest - std::max(spec.touch_slowest, speed)) / range, 0.0, 1.0);
  return speed >= spec.touch_slowest && speed <= spec.touch_fastest ? speed / t.second * t.width / range
                                                                    : 0.0;
}

struct Part {
  double weight = 0.0;  // logarithm, then share
  Vec2 mean;
  Eigen::Matrix2d covariance;
  Vec3 first;  // movement
};

struct Task {
  const IdealSpec& spec;
  std::vector<SeenReach::Picture> pictures;
  double now;
};

// The equations of nine unknowns: the start of the hand, its first movement, and the part of its way that is
// not predicted.
struct Equations {
  Mat9 information;
  Vec9 right = Vec9::Zero();
  double squares = 0.0;

  void see(const Vec9& share, double value, double sigma) {
    const double w = 1.0 / (sigma * sigma);
    information += w * share * share.transpose();
    right += w * value * share;
    squares += w * value * value;
  }
};

// The way that is left after the first movement, over that movement.
double rest_of(const Task& task) { return 1.0 / task.spec.hand.primary_share - 1.0; }

void see_pictures(const Task& task, const Timing& t, Equations& equations) {
  const double rest = rest_of(task);
  const double beyond = t.falls_short ? 1.0 / MinimumJerk(kCrosses).x : 0.0;
  for (const SeenReach::Picture& picture : task.pictures) {
    const double age = task.now - picture.exposed;
    const double p = MinimumJerk((-age - t.begins) / t.first).x;
    const double s = MinimumJerk((-age - t.corrects) / t.second).x;
    for (int axis = 0; axis < 3; ++axis) {
      const double f = axis < 2 ? 1.0 : beyond;
      Vec9 share = Vec9::Zero();
      share[axis] = 1.0;
      share[3 + axis] = p + f * s * rest;
      share[6 + axis] = f * s;
      equations.see(share, picture.at[axis], task.spec.noise);
    }
  }
}

// The whole way ends at the surface, and a first movement that does not fall short crosses it now. Returns
// what that adds to the weight of the timing.
double see_touch(const Task& task, const Timing& t, Equations& equations) {
  Vec9 whole = Vec9::Zero();
  whole[2] = whole[8] = 1.0;
  whole[5] = 1.0 + rest_of(task);
  equations.see(whole, 0.0, kExactly);
  if (t.falls_short) return 0.0;
  Vec9 crosses = Vec9::Zero();
  crosses[2] = 1.0;
  crosses[5] = t.crossed;
  equations.see(crosses, 0.0, kExactly);
  return -std::log(kExactly) - 0.5 * std::log(2.0 * M_PI);
}

using Factors = Eigen::LLT<Mat9>;

// Probability that a person makes the movements that were found.
double probability(const Task& task, const Timing& t, const Vec9& mean, const Factors& factors) {
  const double rest = rest_of(task);
  Vec9 down = Vec9::Zero();
  down[5] = -rest / MinimumJerk(kCrosses).x;
  down[8] = -1.0 / MinimumJerk(kCrosses).x;
  const double middle = down.dot(mean), spread = std::sqrt(std::max(0.0, down.dot(factors.solve(down))));
  double share = 0.0;  // five points of a normal distribution
  constexpr double kAt[5]{-2.857, -1.3556, 0.0, 1.3556, 2.857},
      kWeight[5]{.01126, .2221, .5333, .2221, .01126};
  for (int i = 0; i < 5; ++i) share += kWeight[i] * takes(task.spec, t, middle + spread * kAt[i]);
  const Vec3 first = mean.segment<3>(3);
  const double peak = 1.875 * first.norm() / t.first;
  share *=
      std::max(1e-12, below((task.spec.fastest - peak) / 0.01) - below((task.spec.slowest - peak) / 0.01));
  const double way = ((1.0 + rest) * first + mean.tail<3>()).norm();
  share *= std::max(
      1e-12, below((task.spec.longest_way - way) / 0.003) - below((task.spec.shortest_way - way) / 0.003));
  return share;
}

// The share of each unknown in the place of the hand now, along the surface.
Eigen::Matrix<double, 9, 2> place_now(const Task& task, const Timing& t) {
  const double p = MinimumJerk(-t.begins / t.first).x, s = MinimumJerk(-t.corrects / t.second).x;
  Eigen::Matrix<double, 9, 2> place = Eigen::Matrix<double, 9, 2>::Zero();
  for (int axis = 0; axis < 2; ++axis) {
    place(axis, axis) = 1.0;
    place(3 + axis, axis) = p + s * rest_of(task);
    place(6 + axis, axis) = s;
  }
  return place;
}

Part solved(const Task& task, const Timing& t, const Mat9& prior) {
  Equations equations{prior};
  see_pictures(task, t, equations);
  const double more = see_touch(task, t, equations);
  const Factors factors(equations.information);
  const Vec9 mean = factors.solve(equations.right);
  Part part;
  part.weight = -0.5 * (equations.squares - equations.right.dot(mean)) -
                std::log(factors.matrixLLT().diagonal().prod()) + t.weight + more;
  part.weight += std::log(std::max(probability(task, t, mean, factors), 1e-300));
  part.first = mean.segment<3>(3);
  const Eigen::Matrix<double, 9, 2> place = place_now(task, t);
  part.mean = place.transpose() * mean;
  part.covariance = place.transpose() * factors.solve(place);
  return part;
}

Mat9 prior_of(const IdealSpec& spec, const Vec3& first) {
  const double length = first.norm(), share = spec.hand.primary_share;
  const Vec3 d = first / length;
  // A normal distribution that is cut at two standard deviations keeps 0.88 of them.
  const double far = 0.88 * spec.hand.primary_scatter / (share * share) * length;
  const double aside = 0.88 * spec.hand.aside_scatter / (share * share) * length;
  const Mat3 left = aside * aside * Mat3::Identity() + (far * far - aside * aside) * d * d.transpose();
  Mat9 prior = Mat9::Zero();
  prior.diagonal().head<6>().setConstant(1.0);
  prior.bottomRightCorner<3, 3>() = left.inverse();
  return prior;
}

struct Parts {
  std::vector<Part> all;
  double evidence = -HUGE_VAL;
};

Parts parts_of(const Task& task) {
  Vec3 first = 0.17 * (task.pictures.back().at - task.pictures.front().at).normalized();
  Parts found;
  std::vector<Part>& parts = found.all;
  for (int pass = 0; pass < 2; ++pass) {  // the second pass uses the length of the first movement
    const Mat9 prior = prior_of(task.spec, first);
    const double whole = std::log(prior.bottomRightCorner<3, 3>().determinant());
    parts.clear();
    for (const Timing& t : timings(task.spec, first.norm(), std::abs(first.z()))) {
      parts.push_back(solved(task, t, prior));
      parts.back().weight += 0.5 * whole;
    }
    const auto best = std::max_element(parts.begin(), parts.end(),
                                       [](const Part& a, const Part& b) { return a.weight < b.weight; });
    const double most = best->weight;
    first = best->first;
    double sum = 0.0;
    for (Part& part : parts) sum += part.weight = std::exp(part.weight - most);
    for (Part& part : parts) part.weight /= sum;
    found.evidence = most + std::log(sum);
  }
  return found;
}

Task task_of(const IdealSpec& spec, const SeenReach& reach, double told, double touches) {
  Task task{spec, {}, touches};
  for (const SeenReach::Picture& picture : reach.pictures)
    if (picture.told <= told) task.pictures.push_back(picture);
  if (task.pictures.size() > kPictures)
    task.pictures.erase(task.pictures.begin(), task.pictures.end() - kPictures);
  return task;
}

// Without `within`, which takes longer.
IdealPrediction ideal_of(const Parts& parts) {
  IdealPrediction ideal;
  ideal.place = Vec2::Zero();
  for (const Part& part : parts.all) ideal.place += part.weight * part.mean;
  ideal.evidence = parts.evidence;
  return ideal;
}

// Arrival times of the last pictures before the touch: the arm has long reached the places of earlier ones.
std::vector<double> last_told(const SeenReach& reach) {
  constexpr std::size_t kLast = 4;
  std::vector<double> told;
  for (const SeenReach::Picture& picture : reach.pictures)
    if (picture.told <= reach.met) told.push_back(picture.told);
  if (told.size() > kLast) told.erase(told.begin(), told.end() - kLast);
  return told;
}

}  // namespace

IdealPrediction ideal_place(const IdealSpec& spec, const SeenReach& reach, double told, double touches) {
  const Task task = task_of(spec, reach, told, touches);
  if (task.pictures.size() < 3) return {};
  const Parts parts = parts_of(task);
  IdealPrediction ideal = ideal_of(parts);
  // Probability of each part within the circle: its normal distribution, over rings about the place.
  for (const Part& part : parts.all) {
    if (part.weight < 1e-5) continue;
    const Eigen::Matrix2d root = part.covariance.llt().matrixL();
    int in = 0;
    constexpr int kRings = 12, kTurns = 12;
    for (int i = 0; i < kRings; ++i)
      for (int j = 0; j < kTurns; ++j) {
        const double r = std::sqrt(-2.0 * std::log((i + 0.5) / kRings)),
                     a = 2.0 * M_PI * (j + 0.5 * (i % 2)) / kTurns;
        const Vec2 at = part.mean + root * (r * Vec2(std::cos(a), std::sin(a)));
        in += (at - ideal.place).norm() < kWithin ? 1 : 0;
      }
    ideal.within += part.weight * in / (kRings * kTurns);
  }
  return ideal;
}

Eigen::Vector2d ideal_carried(const IdealSpec& spec, const SeenReach& reach, double acceleration) {
  const std::vector<double> told = last_told(reach);
  Eigen::Vector2d at{kUnset, kUnset};
  for (std::size_t i = 0; i < told.size(); ++i) {
    const Eigen::Vector2d best = ideal_place(spec, reach, told[i], reach.met).place;
    const double time = (i + 1 < told.size() ? told[i + 1] : reach.met) - told[i];
    const Eigen::Vector2d way = best - at;
    if (!best.allFinite()) continue;
    at = at.allFinite() ? Eigen::Vector2d(at + way * std::min(1.0, 0.5 * acceleration * time * time /
                                                                       std::max(way.norm(), 1e-9)))
                        : best;
  }
  return at;
}

std::vector<IdealCourse> ideal_courses(const IdealSpec& spec, const SeenReach& reach) {
  constexpr int kTimes = 25;
  std::vector<IdealCourse> courses;
  for (const double told : last_told(reach)) {
    IdealCourse course{told, {}};
    for (int i = 0; i < kTimes; ++i) {
      const Task task = task_of(spec, reach, told, told + i * IdealCourse::kEach);
      if (task.pictures.size() < 3) break;
      course.then.push_back(ideal_of(parts_of(task)));
    }
    if (!course.then.empty()) courses.push_back(std::move(course));
  }
  return courses;
}

Eigen::Vector2d IdealCourse::mean(double now, double soon) const {
  constexpr int kFine = 4;  // times between two
  double most = -HUGE_VAL;
  std::vector<std::pair<double, Vec2>> come;
  for (std::size_t i = 0; i + 1 < then.size(); ++i)
    for (int k = 0; k < kFine; ++k) {
      const double share = (k + 0.5) / kFine, after = (static_cast<double>(i) + share) * kEach;
      if (told + after < now) continue;
      come.emplace_back(
          then[i].evidence + share * (then[i + 1].evidence - then[i].evidence) - (told + after - now) / soon,
          then[i].place + share * (then[i + 1].place - then[i].place));
      most = std::max(most, come.back().first);
    }
  Vec2 sum = Vec2::Zero();
  double weight = 0.0;
  for (const auto& [evidence, place] : come) {
    const double w = std::exp(evidence - most);
    weight += w;
    sum += w * place;
  }
  return weight > 0.0 ? Vec2(sum / weight) : then.back().place;
}

Eigen::Vector2d ideal_followed(const std::vector<IdealCourse>& courses, double met, double acceleration,
                               double soon) {
  constexpr double kTick = 1e-3;  // s
  Vec2 at{kUnset, kUnset}, velocity = Vec2::Zero();
  for (std::size_t i = 0; i < courses.size(); ++i) {
    const double until = i + 1 < courses.size() ? courses[i + 1].told : met;
    Vec2 goal = courses[i].mean(courses[i].told, soon);
    if (!at.allFinite()) at = goal;
    const int ticks = static_cast<int>(std::ceil((until - courses[i].told) / kTick));
    for (int k = 1; k <= ticks; ++k) {
      const Vec2 next = courses[i].mean(courses[i].told + k * kTick, soon), way = goal - at;
      const double far = way.norm();
      Vec2 wanted = (next - goal) / kTick;
      if (far > 0.0) wanted += way / far * std::min(braking_speed(far, acceleration, kTick), far / kTick);
      const Vec2 change = wanted - velocity;
      velocity += change * std::min(1.0, acceleration * kTick / std::max(change.norm(), 1e-12));
      at += kTick * velocity;
      goal = next;
    }
  }
  return at;
}

}  // namespace enc::bench::reaching
