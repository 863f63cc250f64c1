#include "tests/support/vision/painted_hand.h"

#include <array>
#include <cmath>

namespace enc::painted {
namespace {

constexpr double kCap = 7.6e-3;  // m

// The base of a finger in the hand's own axes: x from the wrist to the fingertips, y to the thumb, z out of
// the back of the hand. m, for a hand of size 1.
struct Root {
  Vec3 knuckle, wrist;
  std::array<double, 3> lengths;  // three bones, up to the centre of the cap
  double thick;                   // radius at the knuckle
  double spread;                  // rad, to the thumb's side, for an open hand
};
constexpr double kWrist = -0.048;
const std::array<Root, 4>& roots() {
  static const std::array<Root, 4> kAll{{
      {{0.044, 0.028, 0.0}, {kWrist, 0.014, -0.002}, {0.043, 0.025, 0.0195}, 9.6e-3, 0.16},
      {{0.048, 0.007, 0.002}, {kWrist, 0.005, -0.001}, {0.047, 0.029, 0.020}, 9.8e-3, 0.03},
      {{0.043, -0.014, 0.0}, {kWrist, -0.006, -0.001}, {0.043, 0.027, 0.020}, 9.2e-3, -0.12},
      {{0.034, -0.033, -0.004}, {kWrist, -0.016, -0.003}, {0.034, 0.019, 0.018}, 8.2e-3, -0.30},
  }};
  return kAll;
}

Vec3 turned(double from_x_to_y, double down) {
  return {std::cos(down) * std::cos(from_x_to_y), std::cos(down) * std::sin(from_x_to_y), -std::sin(down)};
}

// Joints of a finger whose bones have these angles to the palm's plane.
std::array<Vec3, 4> joints(const Root& root, double aside, const std::array<double, 3>& down) {
  std::array<Vec3, 4> at{root.knuckle};
  for (std::size_t i = 0; i < 3; ++i) at[i + 1] = at[i] + root.lengths[i] * turned(aside, down[i]);
  return at;
}

constexpr std::array<double, 3> kStraight{0.0, 0.0, 0.0}, kFolded{1.35, 3.05, 4.1};

std::array<Vec3, 4> finger_joints(const Hand& hand, std::size_t finger) {
  const Root& root = roots()[finger];
  if (hand.fingers == Fingers::open) return joints(root, root.spread, kStraight);
  const bool points = finger == 0 && hand.fingers == Fingers::pointing;
  std::array<double, 3> down = kFolded;
  for (double& angle : down) angle *= points ? hand.fold : 1.0;
  return joints(root, 0.0, down);
}

void add_finger(const Hand& hand, std::size_t finger, std::vector<Cone>& parts) {
  const Root& root = roots()[finger];
  const std::array<Vec3, 4> at = finger_joints(hand, finger);
  const double end = finger == 0 ? kCap : kCap * root.thick / 9.6e-3;
  const std::array<double, 4> radius{root.thick, 0.94 * root.thick, 0.87 * root.thick, end};
  for (std::size_t i = 0; i < 3; ++i)
    parts.push_back({at[i], at[i + 1], radius[i], radius[i + 1], Stuff::skin,
                     i == 2 && finger == 0 && hand.fingers != Fingers::fist});
  const Vec3 along = (at[3] - at[2]).normalized();
  const Vec3 back = Vec3(0, 1, 0).cross(along) * -1.0;  // z if the finger is straight
  parts.push_back({at[3] - 4.5e-3 * along + 3.6e-3 * back, at[3] + 1.5e-3 * along + 3.1e-3 * back, 0.60 * end,
                   0.56 * end, Stuff::nail, parts.back().tip});
}

void add_palm(std::vector<Cone>& parts) {
  for (const Root& root : roots()) parts.push_back({root.wrist, root.knuckle, 0.0115, 0.0118});
  parts.push_back({{-0.030, 0.022, -0.006}, {0.010, 0.026, -0.008}, 0.0165, 0.0120});  // ball of the thumb
  parts.push_back({{-0.030, -0.022, -0.006}, {0.016, -0.030, -0.006}, 0.0145, 0.0110});
}

void add_thumb(const Hand& hand, std::vector<Cone>& parts) {
  const Vec3 root(-0.026, 0.024, -0.008);
  const bool tucked = hand.thumb < 0.2;
  const Vec3 first = root + 0.040 * (tucked ? turned(0.30, 0.45) : turned(hand.thumb, 0.25));
  const Vec3 second = first + 0.030 * (tucked ? turned(-0.35, 0.35) : turned(hand.thumb - 0.1, 0.15));
  const Vec3 end = second + 0.021 * (tucked ? turned(-0.85, 0.15) : turned(hand.thumb - 0.2, 0.05));
  parts.push_back({root, first, 0.0145, 0.0115});
  parts.push_back({first, second, 0.0112, 0.0100});
  parts.push_back({second, end, 0.0100, 0.0092});
}

void add_arm(const Hand& hand, std::vector<Cone>& parts) {
  const auto beside = [&](double y, double x, double radius, double wide, Stuff stuff) {
    parts.push_back({{x, y, -0.004}, {kWrist - 0.42, 1.5 * y, -0.02}, radius, wide, stuff});
  };
  for (const double y : {-0.010, 0.010}) beside(y, kWrist, 0.0190, 0.0300, Stuff::skin);
  for (const double y : {-0.011, 0.011})
    beside(y, kWrist - 0.025 - hand.bare / hand.size, 0.0300, 0.0420, Stuff::sleeve);
}

// The hand's axes in C as columns, and its origin.
struct HandAxes {
  Mat3 axes;
  Vec3 origin;
  [[nodiscard]] Vec3 of(const Vec3& own) const { return origin + axes * own; }
};

HandAxes placed(const Hand& hand) {
  const Vec3 along = hand.along.normalized();
  const Vec3 to_camera = Vec3(0, 0, -1) + along * along.z();
  const Vec3 up = to_camera.norm() > 1e-3 ? Vec3(to_camera.normalized()) : Vec3(0, -1, 0);
  const Vec3 back = std::cos(hand.roll) * up + std::sin(hand.roll) * along.cross(up);
  HandAxes to;
  to.axes.col(0) = hand.size * along;
  to.axes.col(1) = (hand.left ? -hand.size : hand.size) * back.cross(along);
  to.axes.col(2) = hand.size * back;
  to.origin = hand.tip - to.axes * joints(roots()[0], hand.fingers == Fingers::open ? roots()[0].spread : 0.0,
                                          kStraight)[3];
  return to;
}

}  // namespace

bool meets(const Cone& cone, const Vec3& eye, const Vec3& ray, Hit& hit) {
  const Vec3 axis = cone.to - cone.from, a = eye - cone.from, b = eye - cone.to;
  const double ra = cone.from_radius, rb = cone.to_radius, less = ra - rb;
  const double m0 = axis.squaredNorm(), m1 = axis.dot(a), m2 = axis.dot(ray), m3 = ray.dot(a);
  const double m5 = a.squaredNorm(), m6 = b.dot(ray), m7 = b.squaredNorm(), d2 = m0 - less * less;
  const double k2 = d2 - m2 * m2, k1 = d2 * m3 - m1 * m2 + m2 * less * ra;
  const double k0 = d2 * m5 - m1 * m1 + 2.0 * m1 * less * ra - m0 * ra * ra, root = k1 * k1 - k0 * k2;
  if (root < 0.0) return false;
  hit.along = (-std::sqrt(root) - k1) / k2;
  const double y = m1 - ra * less + hit.along * m2;
  if (y > 0.0 && y < d2 && k2 > 0.0) {
    hit.normal = (d2 * (a + hit.along * ray) - axis * y).normalized();
    return hit.along > 0.0;
  }
  const double h1 = m3 * m3 - m5 + ra * ra, h2 = m6 * m6 - m7 + rb * rb;
  hit.along = 1e9;
  if (h1 > 0.0) {
    hit.along = -m3 - std::sqrt(h1);
    hit.normal = (a + hit.along * ray) / ra;
  }
  if (const double other = -m6 - std::sqrt(std::max(h2, 0.0)); h2 > 0.0 && other < hit.along) {
    hit.along = other;
    hit.normal = (b + other * ray) / rb;
  }
  return hit.along > 0.0 && hit.along < 1e8;
}

std::vector<Cone> parts_of(const Hand& hand) {
  std::vector<Cone> parts;
  for (std::size_t finger = 0; finger < roots().size(); ++finger) add_finger(hand, finger, parts);
  add_palm(parts);
  add_thumb(hand, parts);
  add_arm(hand, parts);
  const HandAxes to = placed(hand);
  for (Cone& cone : parts) {
    cone.from = to.of(cone.from);
    cone.to = to.of(cone.to);
    cone.from_radius *= hand.size;
    cone.to_radius *= hand.size;
  }
  return parts;
}

double cap_radius(const Hand& hand) { return hand.size * kCap; }

std::vector<Vec3> fingertips_of(const Hand& hand) {
  const HandAxes to = placed(hand);
  std::vector<Vec3> tips;
  if (hand.fingers == Fingers::fist) return tips;
  for (std::size_t finger = 0; finger < (hand.fingers == Fingers::open ? 4U : 1U); ++finger)
    tips.push_back(to.of(finger_joints(hand, finger)[3]));
  return tips;
}

}  // namespace enc::painted
