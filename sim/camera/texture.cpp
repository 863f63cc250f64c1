#include "sim/camera/texture.h"

#include <algorithm>
#include <cmath>

namespace enc::sim {
namespace {

// Noise of several octaves on a torus, about -1 to 1.
class Clouds {
 public:
  explicit Clouds(Stream& random) : grid_(kGrid * kGrid) {
    for (float& g : grid_) g = static_cast<float>(2.0 * random.uniform() - 1.0);
  }
  // x and y in periods of the torus, `cells` of the coarsest noise along each.
  [[nodiscard]] double at(double x, double y, int cells, int octaves) const {
    double sum = 0.0, weight = 1.0;
    for (int i = 0; i < octaves; ++i, cells *= 2, weight *= 0.5) sum += weight * smooth(x, y, cells, 7 * i);
    return sum;
  }

 private:
  static constexpr int kGrid = 256;
  [[nodiscard]] double smooth(double x, double y, int cells, int offset) const {
    const double gx = x * cells, gy = y * cells;
    const int ix = static_cast<int>(std::floor(gx)), iy = static_cast<int>(std::floor(gy));
    const double fx = ease(gx - ix), fy = ease(gy - iy);
    const auto corner = [&](int i, int j) {
      const int cx = (((ix + i) % cells + cells) % cells + offset) % kGrid;
      const int cy = (((iy + j) % cells + cells) % cells + offset) % kGrid;
      return static_cast<double>(grid_[static_cast<std::size_t>(cy * kGrid + cx)]);
    };
    return (1 - fy) * ((1 - fx) * corner(0, 0) + fx * corner(1, 0)) +
           fy * ((1 - fx) * corner(0, 1) + fx * corner(1, 1));
  }
  static double ease(double t) { return t * t * (3.0 - 2.0 * t); }
  std::vector<float> grid_;
};

Rgb mixed(const Rgb& a, const Rgb& b, double share) {
  const auto s = static_cast<float>(share);
  return {a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1]), a[2] + s * (b[2] - a[2])};
}

template <class Colour>
Texture painted(int side, const Colour& colour) {
  Texture t(side);
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x) t.set(x, y, colour((x + 0.5) / side, (y + 0.5) / side));
  return t;
}

void fill(Texture& t, double x0, double y0, double x1, double y1, const Rgb& colour) {
  const auto px = [&](double v) { return std::clamp(static_cast<int>(v * t.side), 0, t.side); };
  for (int y = px(y0); y < px(y1); ++y)
    for (int x = px(x0); x < px(x1); ++x) t.set(x, y, colour);
}

void write_lines(Stream& random, Texture& t, double x0, double y0, double x1, double y1, double line,
                 const Rgb& ink) {
  const auto lines = static_cast<int>(std::ceil((y1 - line - y0) / (1.8 * line)));
  for (int i = 0; i < lines; ++i) {
    const double y = y0 + 1.8 * line * i;
    const double end = x1 - 0.4 * random.uniform() * (x1 - x0);
    double x = x0;
    while (x < end) {
      const double word = line * (1.0 + 4.0 * random.uniform());
      fill(t, x, y, std::min(x + word, end), y + 0.8 * line, ink);
      x += word + 0.8 * line;
    }
  }
}

bool within(double x, double y, double cx, double cy, double rx, double ry) {
  return (x - cx) * (x - cx) / (rx * rx) + (y - cy) * (y - cy) / (ry * ry) < 1.0;
}

}  // namespace

void Texture::set(int x, int y, const Rgb& colour) {
  std::uint8_t* to = rgb.data() + 3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(side) +
                                       static_cast<std::size_t>(x));
  for (std::size_t c = 0; c < 3; ++c)
    to[c] = static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(colour[c], 0.0F, 1.0F)));
}

Rgb of_hue(double hue, double saturation, double value) {
  const auto channel = [&](double n) {
    const double k = std::fmod(n + hue / 60.0, 6.0);
    return static_cast<float>(value * (1.0 - saturation * std::clamp(std::min(k, 4.0 - k), 0.0, 1.0)));
  };
  return {channel(5), channel(3), channel(1)};
}

Rgb cool_colour(Stream& random, double saturation, double value) {
  return of_hue(70.0 + 255.0 * random.uniform(), saturation, value);
}

Rgb shaded(const Rgb& colour, double by) {
  const auto b = static_cast<float>(by);
  return {b * colour[0], b * colour[1], b * colour[2]};
}

Texture plaster(Stream& random, const Rgb& colour, double grain, int side) {
  const Clouds clouds(random);
  return painted(side, [&](double x, double y) {
    return shaded(colour, 1.0 + 0.05 * clouds.at(x, y, 2, 3) + grain * clouds.at(y, x, 128, 2));
  });
}

Texture wood(Stream& random, const Rgb& light, const Rgb& dark) {
  const Clouds clouds(random);
  return painted(512, [&](double x, double y) {
    const double ring = 9.0 * y + 1.6 * clouds.at(x, y, 2, 3) + 0.15 * clouds.at(0.1 * x, y, 64, 2);
    const double grain = ring - std::floor(ring);
    return shaded(mixed(light, dark, grain * grain), 1.0 + 0.08 * clouds.at(0.2 * x, y, 128, 1));
  });
}

Texture weave(Stream& random, const Rgb& colour) {
  const Clouds clouds(random);
  return painted(128, [&](double x, double y) {
    const int thread = static_cast<int>(64 * x) + static_cast<int>(64 * y);
    return shaded(colour, (thread % 2 == 0 ? 1.0 : 0.82) * (1.0 + 0.12 * clouds.at(x, y, 4, 3)));
  });
}

Texture text(Stream& random, const Rgb& paper, const Rgb& ink) {
  Texture t(256);
  fill(t, 0, 0, 1, 1, paper);
  write_lines(random, t, 0.10, 0.08, 0.62, 0.13, 0.035, ink);
  write_lines(random, t, 0.10, 0.19, 0.92, 0.93, 0.018, ink);
  return t;
}

Texture screen(Stream& random) {
  Texture t(256);
  fill(t, 0, 0, 1, 1, {0.03F, 0.03F, 0.035F});
  fill(t, 0.03, 0.04, 0.97, 0.96, cool_colour(random, 0.6, 0.35));
  for (int i = 0; i < 3; ++i) {
    const double x = 0.07 + 0.4 * random.uniform(), y = 0.08 + 0.35 * random.uniform();
    const double wide = 0.3 + 0.15 * random.uniform(), high = 0.3 + 0.15 * random.uniform();
    fill(t, x, y, x + wide, y + high, {0.85F, 0.88F, 0.90F});
    fill(t, x, y, x + wide, y + 0.035, cool_colour(random, 0.7, 0.5));
    write_lines(random, t, x + 0.02, y + 0.06, x + wide - 0.02, y + high - 0.01, 0.016, {0.1F, 0.12F, 0.15F});
  }
  return t;
}

// Green to blue alone: seen from afar colours mix, and yellow with purple would make the hue of skin.
Texture patches(Stream& random, double saturation) {
  const auto colour = [&](double share, double value) {
    return of_hue(90.0 + 160.0 * random.uniform(), share, value);
  };
  Texture t(256);
  fill(t, 0, 0, 1, 1, colour(0.5 * saturation, 0.8));
  for (int i = 0; i < 60; ++i) {
    const double x = random.uniform(), y = random.uniform();
    const double wide = 0.02 + 0.2 * random.uniform(), high = 0.02 + 0.2 * random.uniform();
    const double value = 0.15 + 0.7 * random.uniform();
    fill(t, x, y, x + wide, y + high, colour(saturation * random.uniform(), value));
  }
  return t;
}

Texture face(Stream& random) {
  const Clouds clouds(random);
  const Rgb complexion = of_hue(14.0 + 8.0 * random.uniform(), 0.55, 0.62);
  const Rgb wall = of_hue(30.0, 0.35, 0.75);
  return painted(256, [&](double x, double y) -> Rgb {
    const double shade = 1.0 + 0.10 * clouds.at(x, y, 3, 2);
    if (within(x, y, 0.40, 0.45, 0.045, 0.022) || within(x, y, 0.60, 0.45, 0.045, 0.022))
      return {0.06F, 0.04F, 0.03F};
    if (within(x, y, 0.50, 0.67, 0.085, 0.025)) return {0.45F, 0.12F, 0.10F};
    if (within(x, y, 0.50, 0.50, 0.22, 0.31))
      return shaded(complexion, shade * (1.15 - 0.5 * std::abs(x - 0.45)));
    if (within(x, y, 0.50, 0.42, 0.27, 0.36)) return {0.10F, 0.06F, 0.03F};
    if (within(x, y, 0.50, 1.00, 0.42, 0.22)) return shaded({0.16F, 0.22F, 0.42F}, shade);
    if (within(x, y, 0.50, 0.80, 0.09, 0.16)) return shaded(complexion, 0.85 * shade);
    return shaded(wall, shade);
  });
}

// Blood is under some places more than under others: red varies less than green and blue.
Texture skin(Stream& random) {
  const Clouds clouds(random);
  return painted(128, [&](double x, double y) -> Rgb {
    const double blotch = clouds.at(x, y, 4, 3), fine = clouds.at(y, x, 48, 2);
    const double lightness = 0.93 + 0.035 * blotch + 0.03 * fine, redness = 0.030 * clouds.at(y, x, 6, 2);
    return {static_cast<float>(lightness + redness), static_cast<float>(lightness - redness),
            static_cast<float>(lightness - 1.3 * redness)};
  });
}

}  // namespace enc::sim
