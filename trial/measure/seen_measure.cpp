#include "trial/measure/seen_measure.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "core/control/stages/step_context.h"

namespace enc::trial {
namespace {

constexpr double kPause = 0.3;     // s without a push between two presses
constexpr double kSameWay = 0.99;  // cosine between normals of one press

// The surface normal at the arm's target.
Vec<'W'> normal_at(const Object& object, const Point<'W'>& target) {
  if (object.met_in_its_middle()) return object.X_WO * Vec<'O'>(0, 0, 1);
  return stages::nearest(object, target).normal;
}

// True if the prop is pushed down from its held position, which only a finger does. Objects that the finger
// moves give no information.
bool pushed(const Glance& glance, const Object& object, const Point<'W'>& prop, const Vec<'W'>& normal) {
  constexpr double kDeep = 1e-3;    // m: larger than the offset by friction and a wrong weight
  constexpr double kForce = 0.3;    // N, force of the law: twice what dry friction hides
  constexpr double kBeside = 8e-3;  // m: farther, it is on its way elsewhere (kLeap in aim.cpp is 10 mm)
  if (object.interaction.kind != Interaction::slide && object.interaction.kind != Interaction::click)
    return false;
  const Vec<'W'> way = prop - glance.out.arm.target;
  const double depth = -dot(way, normal);
  return depth > kDeep && (way + depth * normal).norm() < kBeside && -glance.out.force.xyz[2] > kForce;
}

// Least squares of shift . normal = seen, in the directions that the normals cover well enough.
SeenShift fit(const SeenPress* first, std::size_t n) {
  constexpr double kEnough = 0.1;  // share of the mean square
  SeenShift found;
  found.presses = n;
  if (n == 0) return found;
  found.since = first->began;
  Mat3 normals = Mat3::Zero();
  Vec3 seen = Vec3::Zero();
  const auto count = static_cast<double>(n);
  for (const SeenPress* p = first; p != first + n; ++p) {
    normals += p->normal * p->normal.transpose() / count;
    seen += p->normal * p->mean / count;
  }
  const Eigen::SelfAdjointEigenSolver<Mat3> ways(normals);
  double weakest = 1.0;
  for (int i = 0; i < 3; ++i) {
    const double share = ways.eigenvalues()[i];
    if (share < kEnough) continue;
    const Vec3 way = ways.eigenvectors().col(i);
    found.shift += way * (way.dot(seen) / share);
    weakest = std::min(weakest, share);
    ++found.ways;
  }
  double left_over = 0.0, within = 0.0, poses = 0.0;
  for (const SeenPress* p = first; p != first + n; ++p) {
    left_over += std::pow(p->mean - p->normal.dot(found.shift), 2);
    within += p->squares;
    poses += static_cast<double>(p->n);
  }
  const double free = count - static_cast<double>(found.ways);
  if (!(free > 0.0)) return found;
  const double between = left_over / free / count, least = within / poses / poses;
  found.error = std::sqrt(std::max(between, least) / weakest);
  return found;
}

}  // namespace

void SeenMeasure::see(const Glance& glance) {
  if (!glance.scene.has_tracker) return;
  remember(glance);
  const Measurement<TrackedTool>& seen = glance.in.tool;
  if (seen.health != Health::ok || seen.t == newest_) return;
  newest_ = seen.t;
  if (seen.value.tool < 0 || !seen.value.X_CT.valid()) return;
  const auto then = std::find_if(moments_.begin(), moments_.end(), [&](const Moment& m) {
    return m.push >= 0 && std::abs(age(seen.t, m.t)) < 0.6 * glance.scene.dt;
  });
  if (then != moments_.end()) compare(glance, *then);
}

void SeenMeasure::remember(const Glance& glance) {
  constexpr double kSteady = 0.1;   // s, shortest push
  constexpr double kStill = 2e-3;   // m in that time: vision may lag behind a faster motion
  constexpr double kLongest = 1.0;  // s
  if (moments_.empty()) moments_.resize(static_cast<std::size_t>(std::lround(kLongest / glance.scene.dt)));
  Moment& now = moments_[next_];
  next_ = (next_ + 1) % moments_.size();
  now = Moment{};
  now.t = glance.tick.t;
  const std::int32_t index = glance.out.object;
  const bool known = index >= 0 && glance.out.mode != Mode::hold && glance.in.arm.health == Health::ok &&
                     glance.out.arm.target.finite() && glance.out.force.finite();
  bool pushes = false;
  if (known) {
    const Object& object = glance.scene.objects[static_cast<std::size_t>(index)];
    now.prop = glance.scene.X_WR * glance.in.arm.value.tip;
    now.normal = normal_at(object, glance.out.arm.target);
    pushes = index == object_ && pushed(glance, object, now.prop, now.normal);
  }
  object_ = index;
  if (pushes && pause_ > kPause) ++push_;
  pushed_ = pushes ? pushed_ + glance.scene.dt : 0.0;
  pause_ = pushes ? 0.0 : pause_ + glance.scene.dt;
  const auto ago = static_cast<std::size_t>(std::lround(kSteady / glance.scene.dt));
  const Moment& before = moments_[(next_ + moments_.size() - 1 - ago) % moments_.size()];
  if (pushed_ > kSteady && (now.prop - before.prop).norm() < kStill) now.push = push_;
}

void SeenMeasure::compare(const Glance& glance, const Moment& then) {
  const Measurement<TrackedTool>& seen = glance.in.tool;
  const Tool& tool = glance.scene.tools[static_cast<std::size_t>(seen.value.tool)];
  const Point<'W'> tip = glance.scene.X_WC * (seen.value.X_CT * tool.tip.centre);
  const double above = dot(tip - then.prop, then.normal) - tool.tip.radius;
  const double t = seconds(then.t.time_since_epoch());
  const bool same = then.push == told_ && presses_.back().normal.dot(then.normal.e()) > kSameWay;
  if (!same) presses_.push_back({t, Vec3(then.normal.e())});
  told_ = then.push;
  SeenPress& press = presses_.back();
  ++press.n;
  const double off = above - press.mean;
  press.mean += off / static_cast<double>(press.n);
  press.squares += off * (above - press.mean);
}

std::vector<SeenPress> SeenMeasure::presses() const {
  std::vector<SeenPress> count;
  for (const SeenPress& press : presses_)
    if (press.n >= kPoses) count.push_back(press);
  return count;
}

SeenShift SeenMeasure::shift() const {
  const std::vector<SeenPress> all = presses();
  return fit(all.data(), all.size());
}

SeenShift SeenMeasure::moved() const {
  const std::vector<SeenPress> all = presses();
  for (std::size_t first = 0; first + 1 < all.size(); ++first) {
    const SeenShift found = fit(all.data() + first, all.size() - first);
    const double far = found.shift.norm();
    if (far > kLeast && far > kSigmas * found.error) return found;
  }
  return {};
}

}  // namespace enc::trial
