// Linear least squares of a row for each tick, with intervals from sums over blocks of time: neighbouring
// errors are alike.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "models/fit/block_error.h"

namespace enc::trial {

class BlockFit {
 public:
  // block: s of a block of time.
  BlockFit(std::size_t columns, double block) : columns_(columns), block_(block) {}

  // row: as many numbers as there are columns.
  void add(double t, const Eigen::VectorXd& row, double y);
  [[nodiscard]] std::size_t rows() const { return y_.size(); }

  struct Result {
    // Unset, both: the rows do not tell it, or not apart from the columns before it.
    std::vector<models::Interval> values;
    double rms = kUnset;  // of what is left
  };
  [[nodiscard]] Result solve() const;

 private:
  std::size_t columns_;
  double block_;
  std::vector<double> t_, y_, x_;
};

}  // namespace enc::trial
