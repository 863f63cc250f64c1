#include "core/vision/segmentation/light.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace enc::segmentation {
namespace {

constexpr int kEvery = 3;              // tiles between two samples, in both directions
constexpr std::uint32_t kDark = 16;    // out of 255: a darker pixel gives no reliable ratio
constexpr std::uint32_t kLight = 245;  // a brighter pixel may be clipped
constexpr int kFewest = 50;            // fewest samples that determine the light
constexpr double kMostGain = 8.0;
constexpr std::size_t kSteps = 16384;  // of a median
constexpr double kSpread = 1.4826;     // a Gaussian's standard deviation over its median of |x|
// Share of the brightness. A larger residual means that the measured light is a hand's and not the
// background's, for example if the background is clipped and the hand is not.
constexpr double kNonsense = 0.125;

}  // namespace

LightMeter::LightMeter(const Image& background, const Grid& grid) : grid_(grid), counts_(kSteps) {
  const auto n = static_cast<std::uint32_t>(grid.tile);
  for (int row = 0; row < grid.height / grid.tile; row += kEvery)
    for (int column = 0; column < grid.width / grid.tile; column += kEvery) {
      Sample sample{.x = column * grid.tile, .y = row * grid.tile + grid.tile / 2};
      const std::uint8_t* p = background.view().at(sample.x, sample.y);
      for (std::uint32_t i = 0; i < 3 * n; ++i) sample.was[i % 3] += p[i];
      const auto [least, most] = std::minmax_element(sample.was.begin(), sample.was.end());
      if (*least < kDark * n || *most > kLight * n) continue;
      for (std::size_t c = 0; c < 3; ++c) sample.inverse[c] = 1.0 / sample.was[c];
      sample.at_x = (sample.x + 0.5 * grid.tile) / grid.width - 0.5;
      sample.at_y = (sample.y + 0.5) / grid.height - 0.5;
      samples_.push_back(sample);
    }
  pair_up();
}

void LightMeter::pair_up() {
  const int columns = grid_.columns() / kEvery + 1, rows = grid_.rows() / kEvery + 1;
  std::vector<std::size_t> at(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  const auto place = [&](int x, int y) -> std::size_t& {
    return at[static_cast<std::size_t>(y / grid_.tile / kEvery) * static_cast<std::size_t>(columns) +
              static_cast<std::size_t>(x / grid_.tile / kEvery)];
  };
  const int step = kEvery * grid_.tile;
  const int far_x = std::max(1, columns / 8) * step, far_y = std::max(1, rows / 8) * step;
  for (std::size_t i = samples_.size(); i-- > 0;) {  // partners are behind in the list
    Sample& s = samples_[i];
    if (s.x + far_x < grid_.width) s.right = place(s.x + far_x, s.y);
    if (s.y + far_y < grid_.height) s.below = place(s.x, s.y + far_y);
    place(s.x, s.y) = i;
  }
}

// The median over pairs of samples. A hand spoils only the pairs with a sample on it.
void LightMeter::first_plane(Light& light) {
  constexpr double kSteepest = 2.0;
  const auto slope = [&](std::size_t Sample::*other, double Sample::*at) {
    return median(2.0 * kSteepest,
                  [&](const Sample& s) {
                    const Sample& o = samples_[s.*other];
                    if (s.*other == 0 || !o.clear) return -1.0;
                    return std::max(0.0, kSteepest + (o.ratio - s.ratio) / (o.*at - s.*at));
                  }) -
           kSteepest;
  };
  light.across = slope(&Sample::right, &Sample::at_x);
  light.down = slope(&Sample::below, &Sample::at_y);
  light.middle = median(4.0, [&](const Sample& s) {
    return std::max(0.0, s.ratio - light.across * s.at_x - light.down * s.at_y);
  });
}

void LightMeter::look(const ImageView& frame) {
  const auto n = static_cast<std::uint32_t>(grid_.tile);
  for (Sample& sample : samples_) {
    const std::uint8_t* p = frame.at(sample.x, sample.y);
    std::array<std::uint32_t, 3> sum{};
    for (std::uint32_t i = 0; i < n; ++i, p += 3) {
      sum[0] += p[0];
      sum[1] += p[1];
      sum[2] += p[2];
    }
    sample.seen = sum;
    sample.clear = std::max(sum[0], std::max(sum[1], sum[2])) <= kLight * n;
  }
}

template <class F>
double LightMeter::median(double most, const F& of) {
  std::fill(counts_.begin(), counts_.end(), 0U);
  const double scale = (kSteps - 1) / most;
  std::uint32_t all = 0;
  for (const Sample& sample : samples_) {
    const double value = sample.clear ? of(sample) : -1.0;
    if (value < 0.0) continue;
    ++counts_[static_cast<std::size_t>(scale * std::min(most, value) + 0.5)];
    ++all;
  }
  if (all == 0) return 0.5 * most;
  std::uint32_t below = 0;
  std::size_t i = 0;
  while (i + 1 < kSteps && 2 * (below + counts_[i]) < all) below += counts_[i++];
  return static_cast<double>(i) / scale;
}

// Three rounds; each uses the samples within three spreads of the previous plane.
void LightMeter::fit_plane(Light& light) {
  const auto plane = [&](const Sample& s) {
    return light.middle + light.across * s.at_x + light.down * s.at_y;
  };
  for (int round = 0; round < 3; ++round) {
    const double near =
        0.01 + 3.0 * kSpread * median(1.0, [&](const Sample& s) { return std::abs(s.ratio - plane(s)); });
    double n = 0, x = 0, y = 0, v = 0, xx = 0, xy = 0, yy = 0, xv = 0, yv = 0;
    for (const Sample& s : samples_) {
      if (!s.clear || std::abs(s.ratio - plane(s)) > near) continue;
      n += 1.0;
      x += s.at_x;
      y += s.at_y;
      v += s.ratio;
      xx += s.at_x * s.at_x;
      xy += s.at_x * s.at_y;
      yy += s.at_y * s.at_y;
      xv += s.at_x * s.ratio;
      yv += s.at_y * s.ratio;
    }
    if (n < kFewest) return;
    xx -= x * x / n;
    xy -= x * y / n;
    yy -= y * y / n;
    xv -= x * v / n;
    yv -= y * v / n;
    const double determinant = xx * yy - xy * xy;
    if (determinant < 1e-4 * n * n) return;  // samples in a line do not define a plane
    light.across = (xv * yy - yv * xy) / determinant;
    light.down = (yv * xx - xv * xy) / determinant;
    light.middle = (v - light.across * x - light.down * y) / n;
  }
}

Light LightMeter::measure(const ImageView& frame) {
  Light light;
  look(frame);
  const auto clear = std::count_if(samples_.begin(), samples_.end(), [](const Sample& s) { return s.clear; });
  if (clear < kFewest) return light;
  // Red and blue relative to green in each sample, so that a lamp at the side does not count as a colour.
  const auto times = [](const Sample& s, std::size_t c) { return s.seen[c] * s.inverse[c]; };
  const double green = median(kMostGain, [&](const Sample& s) { return times(s, 1); });
  const auto beside = [&](std::size_t c) {
    return median(kMostGain, [&](const Sample& s) { return times(s, c) / std::max(times(s, 1), 1e-3); });
  };
  light.gain = {green * beside(0), green, green * beside(2)};
  for (double& gain : light.gain) gain = std::clamp(gain, 1.0 / kMostGain, kMostGain);
  for (Sample& s : samples_)
    s.ratio = (s.seen[0] + s.seen[1] + s.seen[2]) /
              (light.gain[0] * s.was[0] + light.gain[1] * s.was[1] + light.gain[2] * s.was[2]);
  first_plane(light);
  fit_plane(light);
  light.bright = kSpread * median(1.0, [&](const Sample& s) {
                   return std::abs(s.ratio - (light.middle + light.across * s.at_x + light.down * s.at_y));
                 });
  if (light.bright > kNonsense) return {};
  light.colour =
      kSpread * median(1.0, [&](const Sample& s) {
        const double seen = s.seen[0] + s.seen[1] + s.seen[2], was = seen / std::max(s.ratio, 1e-3);
        const auto off = [&](std::size_t c) {
          return std::abs(s.seen[c] / std::max(seen, 1.0) - light.gain[c] * s.was[c] / std::max(was, 1.0));
        };
        return std::max(off(0), off(2));
      });
  return light;
}

}  // namespace enc::segmentation
