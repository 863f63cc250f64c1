#include "models/identify/camera/point_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <string_view>

#include <fmt/format.h>

#include "core/base/error.h"
#include "models/schema/wording.h"
#include "models/tables/csv_reader.h"

namespace enc::models {
namespace {

constexpr double kFarthest = 10.0;      // m: nothing of this kind is larger; what is, is in mm
constexpr double kStandstill = 0.5e-3;  // m: between frames of one place the device moves less
constexpr double kMostScale = 2.0;    // rigid frames are of one size; what differs so much is in another unit
constexpr double kMirror = 0.1;       // a mirror image that leaves a tenth of the error is what was measured
constexpr double kSmallError = 1e-4;  // m rms: where even the rotation leaves less, nothing is reversed

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
  std::map<std::int64_t, std::size_t> by_number_;  // place of a number among these
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
  return has("camera_") || has("device_");  // one of them misspelt is still meant to be one
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
