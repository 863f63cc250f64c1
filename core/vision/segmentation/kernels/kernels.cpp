#include "core/vision/segmentation/kernels/kernels.h"

#include <algorithm>
#include <cstdlib>

#include "core/vision/segmentation/kernels/hue.h"

namespace enc::segmentation {
namespace {

std::uint8_t mask(bool on) { return on ? 255 : 0; }

void read_rows(const Rows& rows, int n, int bins, const Cut& cut, std::uint32_t* columns,
               std::uint8_t* skin) {
  const HueRule rule{cut.least_chroma, cut.least_value};
  std::fill_n(columns, n, 0U);
  for (int y = 0; y < rows.count; ++y, skin += rows.width) {
    const std::uint8_t* rgb = rows.rgb + 3 * rows.width * y;
    for (int x = 0; x < n; ++x, rgb += 3) {
      const int hue = hue_of(rgb[0], rgb[1], rgb[2], rule);
      if (hue != kNoHue) columns[x] += 1U << (4 * (hue * bins / kHues));
      skin[x] = mask(in_cut(hue, cut));
    }
  }
}

void match_row(const std::uint64_t* seen, const std::uint64_t* model, int n, int pixels, int need,
               std::uint8_t* found) {
  for (int i = 0; i < n; ++i) {
    int common = 0, with_hue = 0, model_with_hue = 0;
    for (int shift = 0; shift < 64; shift += 8) {
      const auto a = static_cast<int>((seen[i] >> shift) & 255U);
      const auto b = static_cast<int>((model[i] >> shift) & 255U);
      common += std::min(a, b);
      with_hue += a;
      model_with_hue += b;
    }
    found[i] = mask(common + pixels - std::max(with_hue, model_with_hue) < need);
  }
}

struct Pixel {
  int r = 0, g = 0, b = 0;
  [[nodiscard]] int sum() const { return r + g + b; }
};

// True if brightness has changed, or the colour at equal brightness.
bool changed(const Pixel& seen, const Pixel& expected, int noise, int side, const FrameLight& light) {
  const int s = seen.sum(), e = expected.sum();
  const int most = std::max(s, e);
  const int unclear = std::min(noise * light.noise >> 8, 0x1fff);
  const int limit = (unclear + (most * light.colour >> 16)) * most;
  if (std::abs(seen.r * e - expected.r * s) > limit || std::abs(seen.b * e - expected.b * s) > limit)
    return true;
  const int lit = std::min((4 * e * side) >> 16, 3 * 1020);
  return std::abs(s - lit) > 2 * unclear + (lit * light.bright >> 16);
}

void change_row(const ChangeRow& row, int n, const FrameLight& light, const Cut& cut, std::uint8_t* strong,
                std::uint8_t* skin, std::uint8_t* hueless) {
  const HueRule rule{cut.least_chroma, cut.least_value};
  const auto expected = [&](int channel, std::uint8_t mean) {
    return std::min(mean * light.gain[channel] >> 8, 1020);
  };
  const auto white = [&](int channel, std::uint8_t value) {
    return (value * light.white[channel] + 128) >> 8;
  };
  for (int x = 0; x < n; ++x) {
    const std::uint8_t* p = row.rgb + 3 * x;
    const Pixel seen{4 * p[0], 4 * p[1], 4 * p[2]};
    const Pixel was{expected(0, row.red[x]), expected(1, row.green[x]), expected(2, row.blue[x])};
    const int hue = hue_of(white(0, p[0]), white(1, p[1]), white(2, p[2]), rule);
    skin[x] = mask(in_cut(hue, cut));
    const std::uint8_t unlike = mask(changed(seen, was, row.noise[x], row.side[x], light));
    strong[x] = skin[x] & unlike;
    hueless[x] = hue == kNoHue ? unlike : 0;
  }
}

void and_row(const std::uint8_t* with, int n, std::uint8_t* row) {
  for (int x = 0; x < n; ++x) row[x] &= with[x];
}

void join_row(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, int n, std::uint8_t* out) {
  for (int x = 0; x < n; ++x) out[x] = static_cast<std::uint8_t>(a[x] | (b[x] & c[x]));
}

void slide(const std::uint8_t* add, const std::uint8_t* drop, int n, std::uint8_t* sums) {
  for (int x = 0; x < n; ++x)
    sums[x] = static_cast<std::uint8_t>(sums[x] + (add != nullptr && add[x] != 0 ? 1 : 0) -
                                        (drop != nullptr && drop[x] != 0 ? 1 : 0));
}

void majority_row(const std::uint8_t* sums, int n, int side, std::uint8_t* out) {
  for (int x = 0; x < n; ++x) {
    int count = 0;
    for (int k = 0; k < side; ++k) count += sums[x + k];
    out[x] = mask(2 * count > side * side);
  }
}

}  // namespace

const Kernels& plain_kernels() {
  static const Kernels kPlain{read_rows, match_row, change_row, and_row, join_row, slide, majority_row};
  return kPlain;
}

const Kernels& kernels() {
  const Kernels* fast = avx2_kernels();
  return fast != nullptr ? *fast : plain_kernels();
}

}  // namespace enc::segmentation
