#include "models/identify/camera/register.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <string>
#include <string_view>

#include <Eigen/Eigenvalues>
#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/tables/csv_reader.h"

namespace enc::models {
namespace {

using Mat4 = Eigen::Matrix4d;

constexpr double kSmallest = 1e-6;  // m rms: no device resolves smaller distances

struct Cloud {
  Vec3 middle{0, 0, 0};
  double square = 0.0;  // mean squared distance from the middle, m^2
  double condition = kUnset;
};

// A rotation about an axis moves the points in proportion to their distance from it. So the mean square of
// these distances determines the accuracy of that rotation: the trace less the spread along the axis.
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

namespace {

constexpr double kFarthest = 10.0;      // m: larger positions are in mm
constexpr double kStandstill = 0.5e-3;  // m: largest motion of the device between frames of one position
constexpr double kMostScale = 2.0;      // rigid frames have equal scale; such a ratio means another unit
constexpr double kMirror = 0.1;         // share of the error: a mirror image below it is the right reading
constexpr double kSmallError = 1e-4;    // m rms: if the plain rotation leaves less, no axis is reversed

enum : std::size_t { kCamera, kDevice = kCamera + 3, kPair = kDevice + 3 };
constexpr std::array<std::string_view, 6> kColumns{"camera_x_m", "camera_y_m", "camera_z_m",
                                                   "device_x_m", "device_y_m", "device_z_m"};

class PointReader {
 public:
  PointReader(const std::string& text, const std::string& name) : row_(text, name) {}

  PointSet read() {
    row_.header({kColumns.begin(), kColumns.end()}, {"pair"});
    header_ = std::max<std::size_t>(row_.line(), 1);
    while (row_.next()) {
      SeenPlace& place = place_of_row();
      const PointPair frame{Point<'C'>(position(kCamera)), Point<'W'>(position(kDevice))};
      if (!place.frames.empty()) check_standstill(place, frame);
      place.frames.push_back(frame);
    }
    check_set();
    return std::move(places_);
  }

 private:
  SeenPlace& place_of_row() {
    if (!row_.has(kPair))
      return places_.emplace_back(SeenPlace{static_cast<std::int64_t>(places_.size()) + 1, {}});
    const double number = row_.number(kPair);
    if (number != std::round(number) || std::abs(number) > 1e9)
      row_.fail(kPair,
                fmt::format("'pair' is {}; expected a whole number, the same in all frames of a place; "
                            "number the places",
                            quoted(std::string(row_.text(kPair)))));
    const auto wanted = static_cast<std::int64_t>(number);
    const auto [at, first] = by_number_.try_emplace(wanted, places_.size());
    return first ? places_.emplace_back(SeenPlace{wanted, {}}) : places_[at->second];
  }

  Vec3 position(std::size_t column) const {
    Vec3 p;
    for (std::size_t i = 0; i < 3; ++i) {
      const double value = row_.number(column + i);
      if (std::abs(value) > kFarthest)
        row_.fail(column + i,
                  fmt::format("{} m is farther than {:g} m; expected a position in metres; convert "
                              "it, or remove the row",
                              row_.text(column + i), kFarthest));
      p(static_cast<Eigen::Index>(i)) = value;
    }
    return p;
  }

  void check_standstill(const SeenPlace& place, const PointPair& frame) const {
    const double moved = (frame.device - place.frames.front().device).norm();
    if (moved > kStandstill)
      row_.fail(kDevice,
                fmt::format("the device is {:.3g} mm from where it was in the first frame of pair {}; "
                            "expected it to stand still; give each place a number of its own",
                            moved * 1e3, place.number));
  }

  void check_set() const {
    Registration found;
    try {
      found = register_points(averages(places_));
    } catch (const Error& error) {
      row_.fail_line(places_.size() < kFewestPairs ? row_.line() : header_, error.what());
    }
    if (found.scale > kMostScale || found.scale < 1.0 / kMostScale)
      row_.fail_line(header_,
                     fmt::format("the camera's points are {:.4g} times as far apart as the device's; "
                                 "expected one size; give both in metres",
                                 found.scale));
    if (found.rms > kSmallError && found.mirror_rms < kMirror * found.rms)
      row_.fail_line(
          header_,
          fmt::format("the points are mirror images: a rotation leaves {:.3g} mm rms, a mirror {:.3g} mm; "
                      "expected two right-handed frames; reverse one axis of one of them",
                      found.rms * 1e3, found.mirror_rms * 1e3));
  }

  CsvReader row_;
  PointSet places_;
  std::map<std::int64_t, std::size_t> by_number_;  // index of a number in places_
  std::size_t header_ = 1;
};

}  // namespace

PointPair SeenPlace::average(std::size_t count) const {
  Vec3 camera = Vec3::Zero(), device = Vec3::Zero();
  const std::size_t n = std::min(count, frames.size());
  for (std::size_t i = 0; i < n; ++i) {
    camera += frames[i].camera.e();
    device += frames[i].device.e();
  }
  const double each = 1.0 / static_cast<double>(n);
  return {Point<'C'>(Vec3(each * camera)), Point<'W'>(Vec3(each * device))};
}

std::vector<PointPair> averages(const PointSet& places, std::size_t frames) {
  std::vector<PointPair> pairs;
  pairs.reserve(places.size());
  std::transform(places.begin(), places.end(), std::back_inserter(pairs),
                 [&](const SeenPlace& place) { return place.average(frames); });
  return pairs;
}

bool is_point_set(const std::string& text) {
  const std::string_view header = csv_header(text);
  const auto has = [&](std::string_view part) { return header.find(part) != std::string_view::npos; };
  return has("camera_") || has("device_");  // even with a misspelt column it counts as such a file
}

PointSet parse_points(const std::string& text, const std::string& name) {
  return PointReader(text, name).read();
}

std::string points_text(const PointSet& places) {
  std::string out = fmt::format("pair,{}\n", fmt::join(kColumns, ","));
  for (const SeenPlace& place : places)
    for (const PointPair& frame : place.frames)
      out += fmt::format("{},{:.7f},{:.7f},{:.7f},{:.7f},{:.7f},{:.7f}\n", place.number, frame.camera.xyz[0],
                         frame.camera.xyz[1], frame.camera.xyz[2], frame.device.xyz[0], frame.device.xyz[1],
                         frame.device.xyz[2]);
  return out;
}

}  // namespace enc::models
