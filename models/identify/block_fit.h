// Linear least squares of a row for each tick, with intervals from sums over blocks of time: neighbouring
// errors are alike.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "models/identify/block_error.h"

namespace enc::models {

class BlockFit {
 public:
  // block: s of a block of time.
  BlockFit(std::size_t columns, double block) : columns_(columns), block_(block) {}

  // row: as many numbers as there are columns.
  void add(double t, const Eigen::VectorXd& row, double y);
  // The same, of a group that has an offset of its own, which nobody asks for: the mean of the group is taken
  // off its rows, which is the same least squares [Frisch and Waugh 1933]. The rows of a group together.
  void add(double t, const Eigen::VectorXd& row, double y, std::ptrdiff_t group);
  [[nodiscard]] std::size_t rows() const { return y_.size(); }

  struct Result {
    // Unset, both: the rows do not tell it, or not apart from the columns before it. Without an interval:
    // fewer than three blocks of time tell it alike.
    std::vector<Interval> values;
    double rms = kUnset;  // of what is left
  };
  [[nodiscard]] Result solve() const;

 private:
  std::size_t columns_;
  double block_;
  std::vector<double> t_, y_, x_;
  std::vector<std::size_t> groups_;  // first row of each
  std::ptrdiff_t group_ = -1;        // of the last row; -1: none
};

}  // namespace enc::models
