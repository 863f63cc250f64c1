#include "models/identify/block_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>

#include <Eigen/Cholesky>

namespace enc::models {
namespace {

// Least share of a column's square that the columns before it must leave; below it, the column is redundant.
constexpr double kApart = 1e-8;

// Degrees of freedom: the scatter of fewer blocks is unknown.
constexpr double kFewestFree = 2.0;

// Columns that can be separated, in order, and their scales.
struct Columns {
  std::vector<Eigen::Index> kept;
  Eigen::VectorXd scale;
};

Columns told_apart(const Eigen::MatrixXd& gram) {
  Columns out;
  out.scale = gram.diagonal().cwiseSqrt();
  const auto n = static_cast<Eigen::Index>(gram.rows());
  for (Eigen::Index c = 0; c < n; ++c) {
    if (!(out.scale(c) > 0.0)) continue;
    std::vector<Eigen::Index> with = out.kept;
    with.push_back(c);
    const auto m = static_cast<Eigen::Index>(with.size());
    Eigen::MatrixXd part(m, m);
    for (Eigen::Index i = 0; i < m; ++i)
      for (Eigen::Index j = 0; j < m; ++j) {
        const Eigen::Index a = with[static_cast<std::size_t>(i)], b = with[static_cast<std::size_t>(j)];
        part(i, j) = gram(a, b) / (out.scale(a) * out.scale(b));
      }
    const Eigen::LLT<Eigen::MatrixXd> factor(part);
    const double left = factor.matrixL()(m - 1, m - 1);
    if (factor.info() == Eigen::Success && left * left > kApart) out.kept = with;
  }
  return out;
}

// Takes the mean of each group off its rows. first: first row of each group.
void remove_offsets(const std::vector<std::size_t>& first, Eigen::MatrixXd& x, Eigen::VectorXd& y) {
  for (std::size_t g = 0; g < first.size(); ++g) {
    const auto from = static_cast<Eigen::Index>(first[g]);
    const Eigen::Index to = g + 1 < first.size() ? static_cast<Eigen::Index>(first[g + 1]) : y.size();
    const Eigen::VectorXd mean = x.middleCols(from, to - from).rowwise().mean();
    x.middleCols(from, to - from).colwise() -= mean;
    y.segment(from, to - from).array() -= y.segment(from, to - from).mean();
  }
}

// The rows of the columns that are kept, scaled.
Eigen::MatrixXd kept_of(const Eigen::MatrixXd& x, const Columns& columns) {
  const auto m = static_cast<Eigen::Index>(columns.kept.size());
  Eigen::MatrixXd z(m, x.cols());
  for (Eigen::Index i = 0; i < m; ++i) {
    const Eigen::Index c = columns.kept[static_cast<std::size_t>(i)];
    z.row(i) = x.row(c) / columns.scale(c);
  }
  return z;
}

// The rows of a fit in blocks of time.
struct TimedRows {
  const std::vector<double>& t;  // s, of each row
  double block;                  // s

  [[nodiscard]] std::int64_t block_of(double at) const {
    return static_cast<std::int64_t>(std::floor(at / block));
  }
};

// Influence of the blocks on each number that is found. left: residual of each row.
std::vector<Blocks> influences(const TimedRows& rows, const Eigen::MatrixXd& z,
                               const Eigen::MatrixXd& covariance, const Eigen::VectorXd& left) {
  std::map<std::int64_t, std::size_t> number;  // index of a block that has rows
  for (const double t : rows.t) number.try_emplace(rows.block_of(t), number.size());
  const Blocks none{std::vector<double>(number.size(), 0.0), std::vector<double>(number.size(), 0.0)};
  std::vector<Blocks> blocks(static_cast<std::size_t>(z.rows()), none);
  for (Eigen::Index r = 0; r < z.cols(); ++r) {
    const Eigen::VectorXd lever = covariance * z.col(r);
    const std::size_t b = number.at(rows.block_of(rows.t[static_cast<std::size_t>(r)]));
    for (Eigen::Index i = 0; i < z.rows(); ++i) {
      blocks[static_cast<std::size_t>(i)].influence[b] += lever(i) * left(r);
      blocks[static_cast<std::size_t>(i)].weight[b] += lever(i) * lever(i);
    }
  }
  return blocks;
}

}  // namespace

void BlockFit::add(double t, const Eigen::VectorXd& row, double y) {
  t_.push_back(t);
  y_.push_back(y);
  x_.insert(x_.end(), row.data(), row.data() + row.size());
}

void BlockFit::add(double t, const Eigen::VectorXd& row, double y, std::ptrdiff_t group) {
  if (group != group_) groups_.push_back(y_.size());
  group_ = group;
  add(t, row, y);
}

BlockFit::Result BlockFit::solve() const {
  Result result{std::vector<Interval>(columns_), kUnset};
  if (y_.empty()) return result;
  const auto n = static_cast<Eigen::Index>(columns_), rows = static_cast<Eigen::Index>(y_.size());
  Eigen::MatrixXd x = Eigen::Map<const Eigen::MatrixXd>(x_.data(), n, rows);
  Eigen::VectorXd y = Eigen::Map<const Eigen::VectorXd>(y_.data(), rows);
  remove_offsets(groups_, x, y);
  const Columns columns = told_apart(x * x.transpose());
  const auto m = static_cast<Eigen::Index>(columns.kept.size());
  if (m == 0 || rows <= m) return result;
  const Eigen::MatrixXd z = kept_of(x, columns);
  const Eigen::MatrixXd covariance = (z * z.transpose()).inverse();
  const Eigen::VectorXd found = covariance * (z * y);
  const Eigen::VectorXd left = y - z.transpose() * found;
  result.rms = std::sqrt(left.squaredNorm() / static_cast<double>(rows));
  const std::vector<Blocks> blocks = influences({t_, block_}, z, covariance, left);
  for (Eigen::Index i = 0; i < m; ++i) {
    const auto c = static_cast<std::size_t>(columns.kept[static_cast<std::size_t>(i)]);
    const double scale = columns.scale(static_cast<Eigen::Index>(c));
    const Blocks& of = blocks[static_cast<std::size_t>(i)];
    const Interval value = of.around(found(i));
    result.values[c] = {value.value / scale, of.freedom() < kFewestFree - 1e-9 ? kUnset : value.half / scale};
  }
  return result;
}

}  // namespace enc::models
