// Distances and overlaps of contours of known shape.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "benchmarks/deformation/contour.h"

namespace enc::bench::deformation {
namespace {

constexpr double kRadius = 0.033;

Contour circle(double radius) {
  Contour contour;
  for (int i = 0; i <= 1800; ++i) {
    const double polar = std::numbers::pi * i / 1800;
    contour.emplace_back(radius * std::sin(polar), radius * std::cos(polar));
  }
  return contour;
}
// The ball with a slice of height `off` cut from its top.
Contour cut(double off) {
  const double z = kRadius - off;
  const double edge = std::acos(z / kRadius);
  Contour contour{{0.0, z}};
  for (int i = 0; i <= 1800; ++i) {
    const double polar = edge + (std::numbers::pi - edge) * i / 1800;
    contour.emplace_back(kRadius * std::sin(polar), kRadius * std::cos(polar));
  }
  return contour;
}
double slice_area(double off) {
  const double half = std::acos(1.0 - off / kRadius);
  return 0.5 * kRadius * kRadius * (half - std::sin(half) * std::cos(half));  // of half the section
}
double slice_volume(double off) { return std::numbers::pi * off * off * (kRadius - off / 3.0); }

TEST(Contour, TwoCirclesAreTheirRadiiApart) {
  const ContourGap gap = contour_gap(circle(kRadius), circle(kRadius - 0.5e-3), kRadius);
  EXPECT_NEAR(gap.rms, 0.5e-3, 1e-8);
  EXPECT_NEAR(gap.largest, 0.5e-3, 1e-7);
  EXPECT_NEAR(gap.half_rms, 0.5e-3, 1e-8);
  const GapAlong along = gap_along(circle(kRadius), circle(kRadius - 0.5e-3));
  EXPECT_NEAR(along.outside.front(), -0.5e-3, 1e-7);
  EXPECT_NEAR(along.outside.back(), -0.5e-3, 1e-7);
  EXPECT_NEAR(along.length.back(), 0.5 * std::numbers::pi * kRadius, 0.1e-3);
}

TEST(Contour, WhatIsNotDentedDoesNotCount) {
  // 50 um apart: under the threshold on both.
  const ContourGap gap = contour_gap(circle(kRadius), circle(kRadius - 0.05e-3), kRadius);
  EXPECT_EQ(gap.rms, 0.0);
  EXPECT_NEAR(gap.half_rms, 0.05e-3, 1e-8);
  // A slice of 2 mm off one of them: dented there only, so the rest does not thin it out.
  const ContourGap sliced = contour_gap(circle(kRadius), cut(2e-3), kRadius);
  EXPECT_GT(sliced.rms, 1.5 * sliced.half_rms);
  EXPECT_NEAR(sliced.largest, 2e-3, 1e-5);
}

TEST(Contour, OverlapOfTwoSlices) {
  const Overlap common = overlap(cut(2e-3), cut(3e-3), kRadius);
  EXPECT_NEAR(common.area, slice_area(2e-3) / slice_area(3e-3), 1e-4);
  EXPECT_NEAR(common.volume, slice_volume(2e-3) / slice_volume(3e-3), 1e-4);
  const Overlap same = overlap(cut(2e-3), cut(2e-3), kRadius);
  EXPECT_EQ(same.area, 1.0);
  EXPECT_EQ(same.volume, 1.0);
  EXPECT_LT(overlap(circle(kRadius), cut(2e-3), kRadius).area, 1e-3);
}

TEST(Contour, AHoleWithUprightWalls) {
  // 5 mm wide and 4 mm deep in a flat top 3 mm down: z is known in every column.
  Contour hole{{0.0, 0.026}, {0.0025, 0.026}};
  const Contour flat = cut(3e-3);
  hole.emplace_back(0.0025, 0.030);
  hole.insert(hole.end(), flat.begin() + 1, flat.end());
  const Overlap common = overlap(hole, flat, kRadius);
  const double extra = 0.0025 * 0.004;
  EXPECT_NEAR(common.area, slice_area(3e-3) / (slice_area(3e-3) + extra), 1e-4);
  EXPECT_NEAR(contour_gap(hole, flat, kRadius).largest, 4e-3, 1e-9);
}

}  // namespace
}  // namespace enc::bench::deformation
