#include "models/identify/camera/register.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <Eigen/Eigenvalues>

#include "core/base/error.h"

namespace enc::models {
namespace {

using Mat4 = Eigen::Matrix4d;

constexpr double kSmallest = 1e-6;  // m rms: no device tells places apart that are nearer

struct Cloud {
  Vec3 middle{0, 0, 0};
  double square = 0.0;  // mean squared distance from the middle, m^2
  double condition = kUnset;
};

// Turning about an axis moves the points by their distances from it, so their mean squares are what is known
// of that turn: the trace less the spread along the axis.
double condition_of(const Mat3& scatter) {
  const Vec3 along = Eigen::SelfAdjointEigenSolver<Mat3>(scatter, Eigen::EigenvaluesOnly).eigenvalues();
  const double least = std::max(0.0, along(0) + along(1));
  return least > 0.0 ? std::sqrt((along(1) + along(2)) / least) : std::numeric_limits<double>::infinity();
}

template <class Get>
Cloud cloud_of(std::span<const PointPair> pairs, Get get) {
  const double each = 1.0 / static_cast<double>(pairs.size());
  Cloud cloud;
  for (const PointPair& pair : pairs) cloud.middle += each * get(pair);
  Mat3 scatter = Mat3::Zero();
  for (const PointPair& pair : pairs) {
    const Vec3 arm = get(pair) - cloud.middle;
    scatter += each * arm * arm.transpose();
  }
  cloud.square = scatter.trace();
  cloud.condition = condition_of(scatter);
  return cloud;
}

void check(const Cloud& cloud, const char* whose) {
  const std::string points = std::string("the ") + whose + "'s points ";
  if (!(std::sqrt(cloud.square) > kSmallest))
    throw Error(points + "are all in one place; expected places well spread in all directions; move the tip");
  if (!(cloud.condition < kMostCondition))
    throw Error(points +
                "lie on one line: the turn about it is not known; expected places to its sides as well; "
                "move the tip aside");
}

// Horn's matrix: its eigenvector of the largest eigenvalue is the quaternion (w, x, y, z) that turns `from`
// best into `to`. M: mean of from * to^T.
Mat4 horn_matrix(const Mat3& M) {
  Mat4 N;
  N << M.trace(), M(1, 2) - M(2, 1), M(2, 0) - M(0, 2), M(0, 1) - M(1, 0),                   //
      M(1, 2) - M(2, 1), M(0, 0) - M(1, 1) - M(2, 2), M(0, 1) + M(1, 0), M(2, 0) + M(0, 2),  //
      M(2, 0) - M(0, 2), M(0, 1) + M(1, 0), M(1, 1) - M(0, 0) - M(2, 2), M(1, 2) + M(2, 1),  //
      M(0, 1) - M(1, 0), M(2, 0) + M(0, 2), M(1, 2) + M(2, 1), M(2, 2) - M(0, 0) - M(1, 1);
  return N;
}

void add_errors(std::span<const PointPair> pairs, Registration& found) {
  const double each = 1.0 / static_cast<double>(pairs.size());
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  for (const PointPair& pair : pairs) {
    const Vec3 error = (found.X_WC * pair.camera - pair.device).e();
    sum += each * error.cwiseAbs();
    squares += each * error.cwiseAbs2();
  }
  found.mean_error = sum;
  found.rms_error = squares.cwiseSqrt();
  found.rms = std::sqrt(squares.sum());
}

}  // namespace

Registration register_points(std::span<const PointPair> pairs, std::size_t fewest) {
  if (pairs.size() < fewest)
    throw Error("there are " + std::to_string(pairs.size()) + " pairs of points; expected at least " +
                std::to_string(fewest) + "; move the tip to more places");
  for (const PointPair& pair : pairs)
    if (!pair.camera.finite() || !pair.device.finite())
      throw Error("a coordinate is not a finite number; expected metres; leave the pair out");
  const Cloud camera = cloud_of(pairs, [](const PointPair& p) -> Vec3 { return p.camera.e(); });
  const Cloud device = cloud_of(pairs, [](const PointPair& p) -> Vec3 { return p.device.e(); });
  check(camera, "camera");
  check(device, "device");

  Mat3 M = Mat3::Zero();
  for (const PointPair& pair : pairs)
    M += (pair.camera.e() - camera.middle) * (pair.device.e() - device.middle).transpose();
  M /= static_cast<double>(pairs.size());
  const Eigen::SelfAdjointEigenSolver<Mat4> horn(horn_matrix(M));
  const Eigen::Vector4d best = horn.eigenvectors().col(3);
  const Quat turn = Quat(best(0), best(1), best(2), best(3)).normalized();

  Registration found;
  found.X_WC = {turn, Vec3(device.middle - turn * camera.middle)};
  found.condition = std::max(camera.condition, device.condition);
  found.scale = std::sqrt(camera.square / device.square);
  add_errors(pairs, found);
  // A mirror image through the middle turns M's sign: its best rotation belongs to the least eigenvalue.
  found.mirror_rms = std::sqrt(std::max(0.0, camera.square + device.square + 2.0 * horn.eigenvalues()(0)));
  return found;
}

}  // namespace enc::models
