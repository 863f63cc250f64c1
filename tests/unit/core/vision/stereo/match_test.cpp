// Matching: random dots of a known disparity, unmatched pixels and their reasons, the kernels bit by bit, the
// error of depth by Z^2 sigma / (f B).
#include "core/vision/stereo/match.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/vision/stereo/rectify.h"
#include "tests/unit/core/vision/finger/drawn_hand.h"

namespace enc {
namespace {

const RectifiedPair kPair{721.0, 159.5, 59.5, 0.09};
constexpr int kWidth = 480, kHeight = 60;

// Smooth dots of 3 px, in the right image `disparity` further to the left; noise of the sensor.
double dots(double x, int y, double seed) { return 40 + 170 * drawn::noise({x / 2.5, y / 2.5, seed}); }
void draw_dots(double disparity, double noise, int seed, Grey& left, Grey& right) {
  const auto sensor = [&](int x, int y, int side) {
    double n = 0.0;
    for (int k = 0; k < 12; ++k) n += drawn::hashed(x * 12 + k, y, 2 * seed + side);
    return noise * (n - 6.0);
  };
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      *left.at(x, y) = static_cast<std::uint8_t>(dots(x, y, 0.5) + sensor(x, y, 0) + 0.5);
      *right.at(x, y) = static_cast<std::uint8_t>(dots(x + disparity, y, 0.5) + sensor(x, y, 1) + 0.5);
    }
}

struct Errors {
  double mean = 0, rms = 0, worst = 0;
  int matched = 0, asked = 0;
};
Errors errors_at(double disparity, double noise, int seed) {
  Grey left(kWidth, kHeight), right(kWidth, kHeight);
  draw_dots(disparity, noise, seed, left, right);
  Matcher matcher({}, kPair);
  Errors all;
  for (int y = 8; y < kHeight - 8; y += 4)
    for (int x = 270; x < kWidth - 8; x += 4) {
      const Disparity found = matcher.at(left, right, x, y);
      ++all.asked;
      if (found.matched != MatchOutcome::yes) continue;
      const double off = static_cast<double>(found.pixels) - disparity;
      ++all.matched;
      all.mean += off;
      all.rms += off * off;
      all.worst = std::max(all.worst, std::abs(off));
    }
  all.mean /= all.matched;
  all.rms = std::sqrt(all.rms / all.matched);
  return all;
}

// A sum of absolute differences grows as a V: a parabola through three points of it is up to 0.086 px off.
TEST(Match, FindsDisparitiesBetweenPixels) {
  double worst = 0.0;
  for (const double disparity : {72.0, 90.25, 108.5, 131.7, 216.4}) {
    const Errors found = errors_at(disparity, 1.5, 3);
    EXPECT_GE(found.matched, 0.98 * found.asked) << disparity;
    EXPECT_LT(found.rms, 0.12) << disparity;
    EXPECT_LT(std::abs(found.mean), 0.11) << disparity;
    worst = std::max(worst, found.rms);
  }
  RecordProperty("worst_rms_px", std::to_string(worst));
  std::printf("disparity error: worst %.3f px rms of 5 disparities\n", worst);
}

// The sigma of disparity does not depend on depth, so the scatter of depth grows with its square.
TEST(Match, DepthScattersAsItsSquare) {
  for (const double z : {0.3, 0.6, 0.9}) {
    const double d = 721.0 * 0.09 / z;
    Grey left(kWidth, kHeight), right(kWidth, kHeight);
    Matcher matcher({}, kPair);
    double dd = 0, zz = 0, md = 0, mz = 0;
    int n = 0;
    for (int seed = 0; seed < 12; ++seed) {
      draw_dots(d, 3.0, seed, left, right);
      for (int y = 12; y < kHeight - 8; y += 12)
        for (int x = 270; x < kWidth - 8; x += 12) {
          const Disparity found = matcher.at(left, right, x, y);
          if (found.matched != MatchOutcome::yes) continue;
          const Triplet at{x * 1.0, y * 1.0, static_cast<double>(found.pixels)};
          const double depth = triangulate(kPair, at).e().z();
          md += at.disparity, dd += at.disparity * at.disparity, mz += depth, zz += depth * depth, ++n;
        }
    }
    const double sigma_d = std::sqrt(dd / n - md / n * md / n), sigma_z = std::sqrt(zz / n - mz / n * mz / n);
    const double law = z * z * sigma_d / (721.0 * 0.09);
    EXPECT_NEAR(sigma_z / law, 1.0, 0.05) << z;
    EXPECT_NEAR(-slope_of(kPair, {0, 0, d})(2, 2) * sigma_d / law, 1.0, 1e-9);
    // Block and noise are equal at all depths.
    EXPECT_LT(sigma_d, 0.12) << z;
    std::printf("z %.1f m: sigma_d %.3f px, sigma_z %.2f mm\n", z, sigma_d, 1e3 * sigma_z);
  }
}

TEST(Match, SaysWhyThereIsNone) {
  Grey left(kWidth, kHeight), right(kWidth, kHeight);
  Matcher matcher({}, kPair);
  const auto why = [&](int x, int y) { return matcher.at(left, right, x, y).matched; };
  EXPECT_NE(why(300, 30), MatchOutcome::yes);  // black
  std::fill(left.level.begin(), left.level.end(), std::uint8_t{255});
  right = left;
  EXPECT_NE(why(300, 30), MatchOutcome::yes);  // saturated
  draw_dots(100.0, 0.0, 1, left, right);
  EXPECT_EQ(why(300, 30), MatchOutcome::yes);
  EXPECT_EQ(why(3, 30), MatchOutcome::outside);
  EXPECT_EQ(why(300, 2), MatchOutcome::outside);
  EXPECT_EQ(why(300, kHeight - 2), MatchOutcome::outside);
  EXPECT_EQ(why(40, 30), MatchOutcome::outside);  // all of its places are outside the right image
  draw_dots(0.0, 0.0, 1, left, right);            // at infinity
  EXPECT_NE(why(300, 30), MatchOutcome::yes);
}

// A finger of 4 px before something farther: most of a block shows the background.
TEST(Match, WithAMaskWhatIsBehindDoesNotCount) {
  Grey left(kWidth, kHeight), right(kWidth, kHeight), front(kWidth, kHeight), there(kWidth, kHeight);
  draw_dots(70.0, 0.0, 1, left, right);
  draw_dots(110.0, 0.0, 2, front, there);
  Mask mask(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 300; x < 304; ++x) {
      mask.row(y)[x] = 255;
      *left.at(x, y) = static_cast<std::uint8_t>(255 - *front.at(x, y));
      *right.at(x - 110, y) = static_cast<std::uint8_t>(255 - *there.at(x - 110, y));
    }
  Matcher matcher({}, kPair);
  const bool seen_without = std::abs(matcher.at(left, right, 301, 30).pixels - 110.0F) < 1.0F;
  EXPECT_FALSE(seen_without);
  const Disparity found = matcher.at(left, right, 301, 30, &mask);
  ASSERT_EQ(found.matched, MatchOutcome::yes);
  EXPECT_NEAR(found.pixels, 110.0F, 0.2F);
  std::fill(mask.on.begin(), mask.on.end(), std::uint8_t{255});
  EXPECT_EQ(matcher.at(left, right, 350, 30, &mask).pixels, matcher.at(left, right, 350, 30).pixels);
}

// A pattern that repeats every 23 px fits at many places.
TEST(Match, ARepeatingPatternIsNotUnique) {
  Grey left(kWidth, kHeight), right(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x)
      *left.at(x, y) = *right.at(x, y) =
          static_cast<std::uint8_t>(128 + 100 * std::sin(2 * std::numbers::pi * x / 23));
  Matcher strict({}, kPair);
  EXPECT_EQ(strict.at(left, right, 300, 30).matched, MatchOutcome::not_unique);
}

// A patch that only the left camera sees: the right image shows another patch there, which fits elsewhere
// better.
TEST(Match, WhatTheRightImageDoesNotHaveIsNotMutual) {
  Grey left(kWidth, kHeight), right(kWidth, kHeight), other(kWidth, kHeight), unused(kWidth, kHeight);
  draw_dots(100.0, 0.0, 1, left, right);
  for (int y = 20; y < 40; ++y)  // a slightly changed copy of the patch at 300
    for (int x = 0; x < 24; ++x)
      *left.at(340 + x, y) = static_cast<std::uint8_t>(0.9 * *left.at(290 + x, y) + (x * y) % 7);
  MatchSpec spec{.uniqueness = 0.0};
  Matcher asks(spec, kPair);
  spec.agreement = -1.0;
  Matcher trusts(spec, kPair);
  EXPECT_EQ(trusts.at(left, right, 352, 30).matched, MatchOutcome::yes);  // wrongly matched at 150 px
  EXPECT_EQ(asks.at(left, right, 352, 30).matched, MatchOutcome::not_mutual);
  EXPECT_EQ(asks.at(left, right, 302, 30).matched, MatchOutcome::yes);
}

TEST(Match, KernelsAreEqualToTheBit) {
  if (!match_kernel::has_avx2() || match_kernel::avx2().compare == nullptr) GTEST_SKIP() << "no AVX2";
  const match_kernel::Kernel plain = match_kernel::plain(), fast = match_kernel::avx2();
  Grey a(kWidth, kHeight), b(kWidth, kHeight);
  std::uint64_t n = 0;
  for (Grey* g : {&a, &b})
    for (auto& level : g->level)
      level = static_cast<std::uint8_t>(256 * drawn::hashed(static_cast<int>(n++), 1, 2));
  for (int x = 0; x < 40; x += 3) *b.at(x, 9) = 0;  // the mask's rows begin at 5
  for (int i = 0; i < 16; ++i) *a.at(20 + i, 20) = 255, *b.at(200 + i, 20) = 0;
  for (const int columns : {8, 12, 16})
    for (const int rows : {3, 11, 15})
      for (const int count : {1, 15, 16, 17, 200}) {
        std::vector<std::uint16_t> p(528), f(528);
        plain.compare(a.at(20, 20), a.stride, b.at(190, 20), b.stride, columns, rows, count, p.data());
        fast.compare(a.at(20, 20), a.stride, b.at(190, 20), b.stride, columns, rows, count, f.data());
        for (int k = 0; k < count; ++k)
          ASSERT_EQ(p[static_cast<std::size_t>(k)], f[static_cast<std::size_t>(k)])
              << columns << " " << rows << " " << k;
        plain.compare_masked(a.at(20, 20), a.stride, b.at(20, 5), b.stride, b.at(190, 20), b.stride, columns,
                             rows, count, p.data());
        fast.compare_masked(a.at(20, 20), a.stride, b.at(20, 5), b.stride, b.at(190, 20), b.stride, columns,
                            rows, count, f.data());
        EXPECT_TRUE(std::equal(p.begin(), p.begin() + count, f.begin())) << columns << " " << rows;
        if (count > 16) p[5] = f[5] = p[9] = f[9] = 1;  // the first of equal ones
        EXPECT_EQ(plain.least(p.data(), count), fast.least(f.data(), count));
      }
}

// The least block sums fit 16 bits.
TEST(Match, TheLargestSumDoesNotOverflow) {
  Grey white(64, 32), black(64, 32);
  std::fill(white.level.begin(), white.level.end(), std::uint8_t{255});
  std::vector<std::uint16_t> cost(32);
  match_kernel::best().compare(white.at(0, 0), white.stride, black.at(0, 0), black.stride, 16, 15, 16,
                               cost.data());
  EXPECT_EQ(cost[3], 16 * 15 * 255);
}

TEST(Match, ImpossibleSpecsAreRefused) {
  const auto refused = [](const auto& spoil) {
    MatchSpec spec;
    spoil(spec);
    EXPECT_THROW(Matcher(spec, kPair), Error);
  };
  refused([](MatchSpec& spec) { spec.columns = 11; });
  refused([](MatchSpec& spec) { spec.rows = 10; });
  refused([](MatchSpec& spec) { spec.nearest = 0.0; });
  refused([](MatchSpec& spec) { spec.nearest = 0.01; });
  refused([](MatchSpec& spec) { spec.farthest = 0.2; });
  refused([](MatchSpec& spec) { spec.farthest = kUnset; });
}

TEST(Triangulate, HasNoPointWithoutDisparity) {
  EXPECT_FALSE(triangulate(kPair, {1, 1, 0}).finite());
  EXPECT_FALSE(triangulate(kPair, {1, 1, -3}).finite());
  EXPECT_FALSE(triangulate(kPair, {1, 1, kUnset}).finite());
  EXPECT_FALSE(slope_of(kPair, {1, 1, 0}).allFinite());
}

TEST(Triangulate, ItsSlopeIsTheDifferenceQuotient) {
  const Triplet at{400, 20, 108};
  const Mat3 slope = slope_of(kPair, at);
  const double h = 1e-4;
  const Vec3 here = triangulate(kPair, at).e();
  EXPECT_LT((slope.col(0) - (triangulate(kPair, {400 + h, 20, 108}).e() - here) / h).norm(), 1e-7);
  EXPECT_LT((slope.col(1) - (triangulate(kPair, {400, 20 + h, 108}).e() - here) / h).norm(), 1e-7);
  EXPECT_LT((slope.col(2) - (triangulate(kPair, {400, 20, 108 + h}).e() - here) / h).norm(), 1e-7);
}

// A pixel takes the median of its nine cells: one wrong cell does not count.
TEST(DisparityMap, AWindowHasWhatTheFrameHasThere) {
  Grey left(kWidth, kHeight), right(kWidth, kHeight);
  draw_dots(100.3, 1.5, 1, left, right);
  Mask mask(kWidth, kHeight);
  for (int y = 10; y < 50; ++y)
    for (int x = 280; x < 400; ++x) mask.row(y)[x] = 255;
  Matcher matcher({}, kPair);
  DisparityMap all(kWidth, kHeight), part(kWidth, kHeight);
  all.match(matcher, left, right, mask, mask.whole());
  const Region window{301, 21, 362, 43};
  part.match(matcher, left, right, mask, window);
  EXPECT_LT(part.sought(), all.sought());
  for (int y = window.y0; y < window.y1; ++y)
    for (int x = window.x0; x < window.x1; ++x) {
      ASSERT_EQ(part.at(x, y), all.at(x, y));
      ASSERT_NEAR(part.at(x, y), 100.3F, 0.3F);
    }
  EXPECT_FALSE(std::isfinite(all.at(10, 30)));
}

}  // namespace
}  // namespace enc
