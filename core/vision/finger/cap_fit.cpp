#include "core/vision/finger/cap_fit.h"

#include <array>
#include <cmath>
#include <numbers>

#include "core/vision/finger/tangent.h"

namespace enc {
namespace {

constexpr std::size_t kRays = 48;
constexpr int kFitRounds = 6;

struct Direction {
  double x, y;
};
const std::array<Direction, kRays>& directions() {
  static const std::array<Direction, kRays> kAll = [] {
    std::array<Direction, kRays> all{};
    for (std::size_t i = 0; i < kRays; ++i) {
      const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kRays;
      all[i] = {std::cos(angle), std::sin(angle)};
    }
    return all;
  }();
  return kAll;
}

// The mask as far as the fit may look, so that it finds the same whatever was segmented beyond.
struct Around {
  const Mask& skin;
  Region part;
};

// Share of skin at a place between pixels; none outside.
double skin_at(const Around& around, double x, double y) {
  const Mask& skin = around.skin;
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  if (!around.part.contains(left, top) || !around.part.contains(left + 1, top + 1)) return 0.0;
  const double right = x - left, down = y - top;
  const std::uint8_t *a = skin.row(top) + left, *b = skin.row(top + 1) + left;
  return ((a[0] * (1.0 - right) + a[1] * right) * (1.0 - down) +
          (b[0] * (1.0 - right) + b[1] * right) * down) /
         255.0;
}

// How far it is to the edge; NaN where the start is not in the mask or the edge is farther than `most`.
double edge_along(const Around& skin, const Pixel& from, const Direction& to, double least, double most) {
  constexpr double kStep = 0.5;
  double before = skin_at(skin, from.column + least * to.x, from.row + least * to.y);
  if (before < 0.5) return kUnset;
  const auto steps = static_cast<int>((most - least) / kStep);
  for (int i = 1; i <= steps; ++i) {
    const double t = least + kStep * i;
    const double now = skin_at(skin, from.column + t * to.x, from.row + t * to.y);
    if (now < 0.5) return t - kStep * (0.5 - now) / (before - now);
    before = now;
  }
  return kUnset;
}

// As bright between pixels; 0 outside.
double level_at(const Grey& image, double x, double y) {
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  if (left < 0 || top < 0 || left + 1 >= image.width || top + 1 >= image.height) return 0.0;
  const double right = x - left, down = y - top;
  const std::uint8_t *a = image.at(left, top), *b = image.at(left, top + 1);
  return (a[0] * (1.0 - right) + a[1] * right) * (1.0 - down) + (b[0] * (1.0 - right) + b[1] * right) * down;
}

// Where brightness changes most, from a little within the mask's edge to what hue may have missed; the mask's
// edge where there is no change to speak of.
double sharpest(const Grey& image, const Pixel& from, const Direction& to, double edge) {
  constexpr double kStep = 0.5, kHalf = 0.75, kLeast = 6.0;  // px, px, levels
  constexpr std::size_t kInside = 2, kSteps = 9;
  std::array<double, kSteps> change{};
  std::size_t best = 0;
  for (std::size_t i = 0; i < kSteps; ++i) {
    const double t = edge + kStep * (static_cast<double>(i) - kInside), in = t - kHalf, out = t + kHalf;
    change[i] = std::abs(level_at(image, from.column + out * to.x, from.row + out * to.y) -
                         level_at(image, from.column + in * to.x, from.row + in * to.y));
    if (change[i] > change[best]) best = i;
  }
  if (best == 0 || best == kSteps - 1 || change[best] < kLeast) return edge;
  const double bend = change[best - 1] - 2.0 * change[best] + change[best + 1];
  const double aside = bend < 0.0 ? 0.5 * (change[best - 1] - change[best + 1]) / bend : 0.0;
  return edge + kStep * (static_cast<double>(best) - kInside + aside);
}

// Towards what is left of the finger on a circle round the tip; zero where it is nowhere or on all sides.
Direction knuckle(const Around& skin, const Tangent& tangent, double radius) {
  Direction sum{0.0, 0.0};
  for (const Direction& d : directions()) {
    const Pixel at = tangent.image({radius * d.x, radius * d.y});
    if (skin_at(skin, at.column, at.row) < 0.5) continue;
    sum.x += d.x;
    sum.y += d.y;
  }
  const double norm = std::sqrt(sum.x * sum.x + sum.y * sum.y);
  return norm < 1.0 ? Direction{0.0, 0.0} : Direction{sum.x / norm, sum.y / norm};
}

struct Round {
  Mat3 normal = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  double squares = 0.0;
  int edges = 0;
};

// One edge: its distance from the outline, and how that depends on middle and radius.
void take(double x, double y, const Direction& along, double radius, double most, Round& round) {
  const double back = x * along.x + y * along.y;
  double far = std::sqrt(x * x + y * y), nx = x / far, ny = y / far;  // the cap
  if (back > 0.0) {                                                   // a side
    const double across = x * -along.y + y * along.x;
    far = std::abs(across);
    nx = across < 0.0 ? along.y : -along.y;
    ny = across < 0.0 ? -along.x : along.x;
  }
  const double off = far - radius;
  if (std::abs(off) > most) return;
  const Vec3 slope(nx, ny, 1.0);
  round.normal += slope * slope.transpose();
  round.right += slope * off;
  round.squares += off * off;
  ++round.edges;
}

// Edges are sought along straight lines of the image and judged where they are circles.
Round look(const Around& skin, const Grey* image, const Tangent& tangent, const CapFit& now, double most) {
  Round round;
  const Direction along{now.along_x, now.along_y};
  for (const Direction& d : directions()) {
    if (d.x * along.x + d.y * along.y > 0.5) continue;  // down the finger
    const Pixel rim = tangent.image({now.radius * d.x, now.radius * d.y});
    const double x = rim.column - now.centre.column, y = rim.row - now.centre.row;
    const double length = std::sqrt(x * x + y * y);
    const Direction to{x / length, y / length};
    double far = edge_along(skin, now.centre, to, 0.2 * length, 2.5 * length);
    if (!(far > 0.0)) continue;
    if (image != nullptr) far = sharpest(*image, now.centre, to, far);
    const Pixel edge = tangent.of({now.centre.column + far * to.x, now.centre.row + far * to.y});
    take(edge.column, edge.row, along, now.radius, most, round);
  }
  return round;
}

constexpr int kFewestEdges = 12;  // edges

Around around(const Mask& mask, const Pixel& start, double radius) {
  const int x = static_cast<int>(start.column), y = static_cast<int>(start.row);
  const int far = static_cast<int>(kFarthest * radius);
  return {mask, Region{x - far, y - far, x + far + 1, y + far + 1}.cut(mask.whole())};
}

// False where there is too little to fit.
bool improve(const Around& skin, const Grey* image, const RectifiedPair& pair, double knuckle_at, double most,
             CapFit& fit) {
  const Tangent tangent(pair, fit.centre);
  const Direction along = knuckle(skin, tangent, knuckle_at * fit.radius);
  if (along.x == 0.0 && along.y == 0.0) return false;
  fit.along_x = along.x;
  fit.along_y = along.y;
  const Round round = look(skin, image, tangent, fit, most);
  if (round.edges < kFewestEdges) return false;
  const Vec3 step = Mat3(round.normal + 1e-6 * Mat3::Identity()).inverse() * round.right;
  fit.centre = tangent.image({step.x(), step.y()});
  fit.radius += step.z();
  fit.misfit = std::sqrt(round.squares / round.edges);
  return true;
}

}  // namespace

CapFit fit_cap(const Mask& mask, const RectifiedPair& pair, const Pixel& start, double radius) {
  const Around skin = around(mask, start, radius);
  CapFit fit{false, start, radius};
  for (int i = 0; i < kFitRounds; ++i) {
    // At first beyond the square's corner, through which a finger may be seen from far behind its tip; not
    // where the image ends before that.
    const double most = (i < 2 ? 1.5 : 0.35) * fit.radius;
    const bool begun = i == 0 && improve(skin, nullptr, pair, 2.4, most, fit);
    if (!begun && !improve(skin, nullptr, pair, 1.6, most, fit)) return fit;
    const double off = std::hypot(fit.centre.column - start.column, fit.centre.row - start.row);
    if (!(off < 2.0 * radius && fit.radius > 0.4 * radius && fit.radius < 2.0 * radius)) return fit;
  }
  fit.good = fit.misfit < 0.15 * fit.radius + 0.3;
  return fit;
}

CapFit sharpen_cap(const Mask& mask, const Grey& image, const RectifiedPair& pair, const CapFit& fit) {
  const Around skin = around(mask, fit.centre, fit.radius);
  CapFit sharp = fit;
  for (int i = 0; i < 4; ++i) {
    // In the end an edge of something else does not count.
    const double most = i < 2 ? 0.35 * fit.radius : std::max(1.0, 0.1 * fit.radius);
    if (!improve(skin, &image, pair, 1.6, most, sharp)) return fit;
  }
  const double off = std::hypot(sharp.centre.column - fit.centre.column, sharp.centre.row - fit.centre.row);
  return off < 3.0 && std::abs(sharp.radius - fit.radius) < 3.0 ? sharp : fit;
}

}  // namespace enc
