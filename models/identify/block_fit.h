// Errors of an estimate from sums over blocks of time: neighbouring readings have similar errors, blocks
// hardly. And linear least squares with such intervals.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "core/base/frames.h"
#include "models/student.h"

namespace enc::models {

// A value and half of the width of its 95 % interval. Unset if unknown.
struct Interval {
  double value = kUnset, half = kUnset;
  [[nodiscard]] bool known() const { return !std::isnan(value) && !std::isnan(half); }
  [[nodiscard]] bool holds(double x) const { return x >= value - half && x <= value + half; }
};

// Influence of each block of time on one number: the sum of the influences is its error.
struct Blocks {
  std::vector<double> influence, weight;  // weight: information of the block about the number

  [[nodiscard]] double variance() const {
    double sum = 0.0, count = 0.0;
    for (std::size_t b = 0; b < influence.size(); ++b) {
      sum += influence[b] * influence[b];
      count += weight[b] > 0.0 ? 1.0 : 0.0;
    }
    return count > 1.0 ? sum * count / (count - 1.0) : kUnset;
  }
  // Degrees of freedom: the number of equal blocks with as much information, minus one.
  [[nodiscard]] double freedom() const {
    double sum = 0.0, squares = 0.0;
    for (const double w : weight) sum += w, squares += w * w;
    return squares > 0.0 ? sum * sum / squares - 1.0 : 0.0;
  }
  [[nodiscard]] Interval around(double value) const {
    return {value, student(freedom()) * std::sqrt(variance())};
  }
};

// Linear least squares with a row for each tick, and with intervals from sums over blocks of time, because
// neighbouring errors are alike.
class BlockFit {
 public:
  // block: length of a block of time, s.
  BlockFit(std::size_t columns, double block) : columns_(columns), block_(block) {}

  // row: one number for each column.
  void add(double t, const Eigen::VectorXd& row, double y);
  // Adds a row of a group that has its own, unwanted offset: the mean of the group is subtracted from its
  // rows, which gives the same least squares [Frisch and Waugh 1933]. Add the rows of a group together.
  void add(double t, const Eigen::VectorXd& row, double y, std::ptrdiff_t group);
  [[nodiscard]] std::size_t rows() const { return y_.size(); }

  struct Result {
    // Unset value: the rows do not determine it, or not separately from the columns before it. Unset
    // interval: fewer than three blocks of time determine it alike.
    std::vector<Interval> values;
    double rms = kUnset;  // rms of the residual
  };
  [[nodiscard]] Result solve() const;

 private:
  std::size_t columns_;
  double block_;
  std::vector<double> t_, y_, x_;
  std::vector<std::size_t> groups_;  // first row of each group
  std::ptrdiff_t group_ = -1;        // group of the last row; -1: no group
};

}  // namespace enc::models
