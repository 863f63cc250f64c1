#include "core/vision/ball/outline.h"

#include <cmath>
#include <numbers>

#include "core/vision/segmentation/kernels/hue.h"

namespace enc {
namespace {

using segmentation::kHues;
constexpr int kFullScale = 254;
constexpr std::uint8_t kOpen = 255, kCounted = 1;

int of_circle(double angle) {
  return static_cast<int>(std::lround(angle * kHues / (2.0 * std::numbers::pi)));
}

}  // namespace

BlobFinder::BlobFinder(const BallSpec& spec)
    : hue_(of_circle(spec.hue)),
      within_(of_circle(spec.hue_within)),
      saturation_(static_cast<int>(std::lround(256.0 * spec.least_saturation))) {}

void BlobFinder::colour(const ImageView& image) {
  if (mask_.width != image.width || mask_.height != image.height) mask_ = Mask(image.width, image.height);
  const segmentation::HueRule rule;
  const std::uint8_t* p = image.rgb;
  for (std::uint8_t& on : mask_.on) {
    const int r = p[0], g = p[1], b = p[2];
    p += 3;
    const int most = std::max(r, std::max(g, b)), least = std::min(r, std::min(g, b));
    on = 0;
    // This test rejects most pixels of a room.
    if (256 * (most - least) < saturation_ * most || !segmentation::has_hue(most, least, rule)) continue;
    const int off = segmentation::hue_of_any(r, g, b, most, least) - hue_;
    const int round = ((off + kHues / 2) % kHues + kHues) % kHues - kHues / 2;
    if (std::abs(round) <= within_) on = kOpen;
  }
}

Blob BlobFinder::flood(const ImageView& image, int at) {
  Blob blob;
  const int width = mask_.width, height = mask_.height;
  Vec3 sum = Vec3::Zero();
  double columns = 0.0, rows = 0.0;
  int clipped = 0;
  blob.box = {width, height, 0, 0};
  const auto enter = [&](int i) {
    if (mask_.on[static_cast<std::size_t>(i)] != kOpen) return;
    mask_.on[static_cast<std::size_t>(i)] = kCounted;
    waiting_.push_back(i);
  };
  waiting_.clear();
  enter(at);
  while (!waiting_.empty()) {
    const int i = waiting_.back(), x = i % width, y = i / width;
    waiting_.pop_back();
    const std::uint8_t* p = image.at(x, y);
    sum += Vec3(p[0], p[1], p[2]);
    clipped += p[0] >= kFullScale || p[1] >= kFullScale || p[2] >= kFullScale ? 1 : 0;
    columns += x;
    rows += y;
    ++blob.pixels;
    blob.box = {std::min(blob.box.x0, x), std::min(blob.box.y0, y), std::max(blob.box.x1, x + 1),
                std::max(blob.box.y1, y + 1)};
    if (x > 0) enter(i - 1);
    if (x + 1 < width) enter(i + 1);
    if (y > 0) enter(i - width);
    if (y + 1 < height) enter(i + width);
  }
  blob.colour = sum / blob.pixels;
  blob.column = columns / blob.pixels;
  blob.row = rows / blob.pixels;
  blob.clipped = static_cast<double>(clipped) / blob.pixels;
  return blob;
}

Blobs BlobFinder::largest(const ImageView& image, int least) {
  colour(image);
  Blobs all;
  for (std::size_t i = 0; i < mask_.on.size(); ++i) {
    if (mask_.on[i] != kOpen) continue;
    const Blob blob = flood(image, static_cast<int>(i));
    if (blob.pixels < least) continue;
    std::size_t at = all.count < kMostBlobs ? all.count++ : kMostBlobs;
    for (; at > 0 && all.blob[at - 1].pixels < blob.pixels; --at)
      if (at < kMostBlobs) all.blob[at] = all.blob[at - 1];
    if (at < kMostBlobs) all.blob[at] = blob;
  }
  return all;
}

namespace {

constexpr double kStep = 0.25;  // px along a direction
// px: farthest edge that counts as on the outline
constexpr double kOn = 0.6;
constexpr std::size_t kThird = kBallRays / 3, kFewestEdges = 12;  // edges

// Colour between pixels; zero outside.
Vec3 colour_at(const ImageView& image, double x, double y) {
  const int left = static_cast<int>(std::floor(x)), top = static_cast<int>(std::floor(y));
  if (left < 0 || top < 0 || left + 1 >= image.width || top + 1 >= image.height) return Vec3::Zero();
  const double right = x - left, down = y - top;
  const std::uint8_t *a = image.at(left, top), *b = image.at(left, top + 1);
  Vec3 colour;
  for (int c = 0; c < 3; ++c)
    colour(c) = (a[c] * (1.0 - right) + a[c + 3] * right) * (1.0 - down) +
                (b[c] * (1.0 - right) + b[c + 3] * right) * down;
  return colour;
}

// Direction of the ball's colour: grey has no share of it, and a mixture a part.
Vec3 measure_of(const Vec3& colour) {
  const Vec3 chroma = colour - Vec3::Constant(colour.mean());
  return chroma / chroma.norm();
}

// Levels along a direction, in steps from a point within the ball to the outside.
struct Profile {
  std::array<double, 400> level{};
  std::size_t count = 0;
};

// Steps to the edge: the steepest fall of the level, and there the half-way point from inside to outside, so
// that the ball's shade does not matter. NaN if there is no edge.
double fall_of(const Profile& profile) {
  constexpr std::size_t kHalf = 4, kInside = 5, kOutside = 6;  // steps: an edge is 2 px wide
  const auto& level = profile.level;
  constexpr double kAlike = 0.5;  // a background with more of the ball's colour hides its edge
  std::size_t best = 0;
  double most = 0.0;
  for (std::size_t k = kOutside; k + kOutside < profile.count; ++k) {
    const double fall = level[k - kHalf] - level[k + kHalf];
    if (fall > most) most = fall, best = k;
  }
  if (best == 0) return kUnset;
  const double inside = level[best - kInside], outside = level[best + kOutside];
  if (outside > kAlike * inside) return kUnset;
  const double half = 0.5 * (inside + outside);
  for (std::size_t k = best - kInside; k < best + kOutside; ++k)
    if (level[k] >= half && level[k + 1] < half)
      return static_cast<double>(k) + (level[k] - half) / (level[k] - level[k + 1]);
  return kUnset;
}

}  // namespace

BallEdges ball_edges(const ImageView& image, const Blob& blob) {
  const Vec3 measure = measure_of(blob.colour);
  const double radius = std::sqrt(blob.pixels / std::numbers::pi);
  const double from = 0.5 * radius, to = 1.4 * radius + 3.0;
  BallEdges edges{};
  Profile profile;
  profile.count = std::min(profile.level.size(), static_cast<std::size_t>((to - from) / kStep));
  for (std::size_t i = 0; i < kBallRays; ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / kBallRays;
    const double dx = std::cos(angle), dy = std::sin(angle);
    const auto at = [&](double steps) {
      const double t = from + kStep * steps;
      return Pixel{blob.column + t * dx, blob.row + t * dy};
    };
    for (std::size_t k = 0; k < profile.count; ++k) {
      const Pixel p = at(static_cast<double>(k));
      profile.level[k] = measure.dot(colour_at(image, p.column, p.row));
    }
    edges[i] = at(fall_of(profile));
  }
  return edges;
}

namespace {

// Unit rays to the edges, and a mark for those that count.
struct Rays {
  std::array<Vec3, kBallRays> ray;
  std::array<bool, kBallRays> there{};
};

Rays rays_of(const BallEdges& edges, const Rectifier& rectifier, Side side) {
  const RectifiedPair& pair = rectifier.pair();
  Rays rays;
  for (std::size_t i = 0; i < kBallRays; ++i) {
    if (std::isnan(edges[i].column)) continue;
    const Pixel p = rectifier.rectified(side, edges[i]);
    rays.ray[i] =
        Vec3((p.column - pair.centre_x) / pair.focal, (p.row - pair.centre_y) / pair.focal, 1.0).normalized();
    rays.there[i] = rays.ray[i].allFinite();
  }
  return rays;
}

// Distance of a ray outside of the cone, px, to first order in the angle between.
struct Distance {
  double scale = kUnset;
  Vec3 m;
  Distance(const Vec3& axis, double focal) : m(axis) {
    const double n = m.norm();
    scale = n > 1.0 ? -focal / std::sqrt(n * n - 1.0) : kUnset;  // (m . ray - 1) cos / sin
  }
  double operator()(const Vec3& ray) const { return scale * (m.dot(ray) - 1.0); }
};

std::size_t on_it(const Rays& rays, const Distance& distance) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < kBallRays; ++i)
    count += rays.there[i] && std::abs(distance(rays.ray[i])) <= kOn ? 1U : 0U;
  return count;
}

// The best cone through three edges a third of a turn apart. Something that covers the ball spoils only the
// cones through its edges.
Vec3 agreed(const Rays& rays, double focal) {
  Vec3 best = Vec3::Constant(kUnset);
  std::size_t most = 0;
  for (std::size_t i = 0; i < kThird; ++i) {
    if (!rays.there[i] || !rays.there[i + kThird] || !rays.there[i + 2 * kThird]) continue;
    Mat3 three;
    three << rays.ray[i].transpose(), rays.ray[i + kThird].transpose(), rays.ray[i + 2 * kThird].transpose();
    const Vec3 m = three.inverse() * Vec3::Ones();
    const std::size_t count = on_it(rays, Distance(m, focal));
    if (count > most) best = m, most = count;
  }
  return best;
}

}  // namespace

BallOutline ball_outline(const BallEdges& edges, const Rectifier& rectifier, Side side) {
  const RectifiedPair& pair = rectifier.pair();
  const Rays rays = rays_of(edges, rectifier, side);
  Vec3 m = agreed(rays, pair.focal);
  BallOutline outline;
  std::size_t count = 0;
  double squares = 0.0;
  for (int round = 0; round < 3 && m.allFinite(); ++round) {
    const Distance distance(m, pair.focal);
    Mat3 normal = Mat3::Zero();
    Vec3 right = Vec3::Zero();
    count = 0;
    squares = 0.0;
    for (std::size_t i = 0; i < kBallRays; ++i) {
      if (!rays.there[i] || !(std::abs(distance(rays.ray[i])) <= kOn)) continue;
      normal += rays.ray[i] * rays.ray[i].transpose();
      right += rays.ray[i];
      squares += distance(rays.ray[i]) * distance(rays.ray[i]);
      ++count;
    }
    if (count < kFewestEdges) return outline;
    m = normal.inverse() * right;
  }
  const double n = m.norm();
  if (!(n > 1.0) || !(m.z() > 0.0)) return outline;
  outline.centre = {pair.centre_x + pair.focal * m.x() / m.z(), pair.centre_y + pair.focal * m.y() / m.z()};
  outline.sine = std::sqrt(1.0 - 1.0 / (n * n));
  outline.radius = pair.focal * std::sqrt(n * n - 1.0);
  outline.share = static_cast<double>(count) / kBallRays;
  outline.misfit = std::sqrt(squares / static_cast<double>(count));
  return outline;
}

}  // namespace enc
