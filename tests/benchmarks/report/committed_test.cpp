// Which figures of a run are not those that the repository keeps.
#include "benchmarks/commands/committed.h"

#include <gtest/gtest.h>

namespace enc::bench {
namespace {

const Committed& kept() {
  static const Committed kAll = Committed::parse(
      "# Figures.\nid,unit,value,least,most,low,high,commit\n"
      "x.median,N,2,1.5,2.5,,,1a2b3c4\n"
      "x.single,N,2,,,,,1a2b3c4\n"
      "x.rounding,px,8e-15,,,,0.5,1a2b3c4\n"
      "x.none,N,,,,,,1a2b3c4\n",
      "figures.csv");
  return kAll;
}
Figure figure_of(const std::string& id, double value) {
  Figure figure;
  figure.id = id;
  figure.twin = value;
  return figure;
}
bool differs(const std::string& id, double value, double least = kUnset, double most = kUnset,
             double high = kUnset) {
  Figure figure = figure_of(id, value);
  figure.high = high;
  figure.least = least;
  figure.most = most;
  return kept().differs(figure);
}

TEST(Committed, WithinTheSpreadOfEitherRunNothingDiffers) {
  EXPECT_FALSE(differs("x.median", 2.4)) << "of the file";
  EXPECT_TRUE(differs("x.median", 2.6));
  EXPECT_FALSE(differs("x.median", 2.6, 1.9, 3.0)) << "of this run";
  EXPECT_TRUE(differs("x.median", 2.6, 2.55, 2.65));
}

TEST(Committed, ASingleValueDiffersByMoreThanItsFourDigits) {
  EXPECT_FALSE(differs("x.single", 2.001));
  EXPECT_TRUE(differs("x.single", 2.01));
  EXPECT_FALSE(differs("x.rounding", 3e-15, kUnset, kUnset, 0.5)) << "far below its bound";
}

TEST(Committed, AValueThatIsNewlyThereOrGoneDiffers) {
  EXPECT_TRUE(differs("x.none", 1.0));
  EXPECT_FALSE(differs("x.none", kUnset));
  EXPECT_TRUE(differs("x.single", kUnset));
}

TEST(Committed, WhatHasNoCounterpartAndWhatHangsOnTheMachineNeverDiffers) {
  EXPECT_FALSE(differs("x.new", 1.0));
  Figure cost = figure_of("x.single", 20.0);
  cost.cost = true;
  EXPECT_FALSE(kept().differs(cost));
  Figure absent = figure_of("x.single", kUnset);
  absent.absent = true;
  EXPECT_FALSE(kept().differs(absent));
}

}  // namespace
}  // namespace enc::bench
