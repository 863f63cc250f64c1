#include "benchmarks/fingertip/outline.h"

#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/vision/finger/tangent.h"

namespace enc::bench::fingertip {
namespace {

// What a pixel near the rim shows. Of the hand only the finger comes within two diameters of its tip. So skin
// that is nearer or farther than cap and finger can be there, however large they are drawn, is another part.
enum class Seen : std::uint8_t { cap, behind, before };

Seen seen(const Tangent& tangent, const staged::Shot& shot, const sim::PixelTruth& truth, const Pixel& at) {
  const auto x = static_cast<int>(std::lround(at.column)), y = static_cast<int>(std::lround(at.row));
  if (!truth.skin.whole().contains(x, y) || !truth.skin.at(x, y)) return Seen::behind;
  const double z = static_cast<double>(
      truth.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(truth.skin.width) +
                  static_cast<std::size_t>(x)]);
  const double radius = 0.5 * shot.look.finger_width;
  const double beyond =  // m, than the cap's middle
      z * tangent.ray({static_cast<double>(x), static_cast<double>(y)}).dot(tangent.view()) -
      shot.pose.tip.e().norm();
  if (beyond < -2.0 * radius) return Seen::before;
  return beyond > 0.5 * radius ? Seen::behind : Seen::cap;
}

}  // namespace

// As seen straight on the outline is a circle, within 60 degrees of where the finger points: there rays go
// from its middle to where it ends. Those on which another part of the hand is before the rim are left out.
Outline outline(const RectifiedPair& pair, const staged::Shot& shot, const sim::PixelTruth& truth) {
  constexpr double kStep = 0.05;  // px
  constexpr int kRays = 30;       // on either side, two degrees apart
  const Tangent tangent(pair, {truth.column, truth.row});
  const Vec3 along = shot.pose.along.e();
  const double ahead = std::atan2(along.dot(tangent.down()), along.dot(tangent.right()));
  const double radius = 0.5 * shot.look.finger_width, z = shot.pose.tip.xyz[2];
  const double share = radius / shot.pose.tip.e().norm();
  const double round = tangent.focal() * share / std::sqrt(1.0 - share * share);  // px, as it ought to be
  double sum = 0.0;
  int rays = 0;
  for (int i = -kRays; i <= kRays; ++i) {
    const double angle = ahead + std::numbers::pi / 90.0 * i;
    double far = 0.5 * round;  // farther in a finger that points away is before its cap
    Seen what = Seen::cap;
    for (; what == Seen::cap && far < 2.0 * round; far += kStep)
      what = seen(tangent, shot, truth, tangent.image({far * std::cos(angle), far * std::sin(angle)}));
    if (what == Seen::before) continue;
    sum += far - 1.5 * kStep;  // between the last step on it and the first beyond
    ++rays;
  }
  if (rays < kRays) return {};
  const double size = sum / rays / round;
  return {size * pair.focal * radius / std::sqrt(z * z - radius * radius), size * truth.radius};
}

}  // namespace enc::bench::fingertip
