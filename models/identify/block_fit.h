// Linear least squares with a row for each tick, and with intervals from sums over blocks of time, because
// neighbouring errors are alike.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "models/identify/block_error.h"

namespace enc::models {

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
