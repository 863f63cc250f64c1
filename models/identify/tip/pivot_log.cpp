#include "models/identify/tip/pivot_log.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "models/schema/wording.h"
#include "models/tables/csv_reader.h"

namespace enc::models {
namespace {

constexpr double kFarthestMarkers = 10.0;  // m: no tracker sees farther, so a larger value is in another unit
constexpr double kUnit = 1e-3;             // deviation of a quaternion's length: four digits are enough

constexpr double kNearTip = 5e-3, kNearPlaces = 20e-3;  // m: metres that were read as mm

// Well-formed by Unicode's table 3-7: no overlong forms, no surrogates.
bool is_utf8(std::string_view text) {
  const auto byte = [&](std::size_t i) { return i < text.size() ? static_cast<unsigned char>(text[i]) : 0U; };
  for (std::size_t i = 0; i < text.size();) {
    const unsigned first = byte(i);
    const std::size_t more = first < 0x80 ? 0 : first < 0xC2 ? 4 : first < 0xE0 ? 1 : first < 0xF0 ? 2 : 3;
    if (more == 4 || first > 0xF4) return false;
    const unsigned low = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
    const unsigned high = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
    for (std::size_t k = 1; k <= more; ++k)
      if (byte(i + k) < (k == 1 ? low : 0x80U) || byte(i + k) > (k == 1 ? high : 0xBFU)) return false;
    i += more + 1;
  }
  return true;
}

enum : std::size_t { kPoseTime, kPlace, kTurn = kPlace + 3, kToolName = kTurn + 4 };

class PivotReader {
 public:
  PivotReader(const std::string& text, const std::string& name) : row_(text, name) {
    if (csv_header(text).find("markers_") != std::string_view::npos)
      row_.header({"time_s", "markers_x_mm", "markers_y_mm", "markers_z_mm", "markers_qx", "markers_qy",
                   "markers_qz", "markers_qw"},
                  {"tool"});
    else
      row_.header(
          {"time_s", "tool_x_mm", "tool_y_mm", "tool_z_mm", "tool_qx", "tool_qy", "tool_qz", "tool_qw"},
          {"tool"});
    log_.line = row_.line();
  }

  PivotLog read() {
    while (row_.next()) {
      const double time = row_time();
      if (empty()) continue;
      take_name();
      const PivotPose pose{time, Pose<'C', 'T'>(rotation(), place())};
      const bool repeats = !log_.poses.empty() && log_.poses.back().X_CT.xyz == pose.X_CT.xyz &&
                           log_.poses.back().X_CT.xyzw == pose.X_CT.xyzw;
      if (!repeats) log_.poses.push_back(pose);  // an unchanged pose is no new pose
    }
    return std::move(log_);
  }

 private:
  bool empty() const {
    for (std::size_t k = kPlace; k < kToolName; ++k)
      if (!row_.text(k).empty()) return false;
    return true;
  }

  double row_time() {
    const double time = row_.number(kPoseTime);
    if (!(time > time_))
      row_.fail(kPoseTime,
                fmt::format("the time {} s {} {} s; expected increasing times; sort the rows, or keep "
                            "one of each time",
                            row_.text(kPoseTime), time == time_ ? "repeats" : "does not come after", time_));
    return time_ = time;
  }

  void take_name() {
    const std::string tool(row_.text(kToolName));
    if (!is_utf8(tool))
      row_.fail(kToolName,
                "the tool's name is not UTF-8; expected UTF-8; save the log as UTF-8, or rename it");
    if (!log_.poses.empty() && tool != log_.tool)
      row_.fail(
          kToolName,
          fmt::format("this row is of the tool {} and those before are of {}; expected one tool in a log; "
                      "keep the rows of one",
                      models::quoted(tool), models::quoted(log_.tool)));
    log_.tool = tool;
  }

  Vec3 place() const {
    Vec3 p;
    for (std::size_t a = 0; a < 3; ++a) {
      const double x = row_.number(kPlace + a) * 1e-3;
      if (std::abs(x) > kFarthestMarkers)
        row_.fail(kPlace + a,
                  fmt::format("{} mm is farther than {:g} m; expected a position in mm; correct or "
                              "remove the row",
                              row_.text(kPlace + a), kFarthestMarkers));
      p(static_cast<Eigen::Index>(a)) = x;
    }
    return p;
  }

  Quat rotation() const {
    Quat q;
    for (std::size_t k = 0; k < 4; ++k) q.coeffs()(static_cast<Eigen::Index>(k)) = row_.number(kTurn + k);
    if (!(std::abs(q.norm() - 1.0) <= kUnit))
      row_.fail(kTurn,
                fmt::format("the quaternion {}, {}, {}, {} has the length {:.4g}; expected 1; correct or "
                            "remove the row",
                            row_.text(kTurn), row_.text(kTurn + 1), row_.text(kTurn + 2),
                            row_.text(kTurn + 3), q.norm()));
    return q.normalized();
  }

  CsvReader row_;
  PivotLog log_;
  double time_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

bool is_pivot_log(std::string_view text) {
  const std::string_view header = csv_header(text);
  const auto has = [&](std::string_view part) { return header.find(part) != std::string_view::npos; };
  // even with a misspelt column it counts as such a log
  return (has("tool_q") || has("markers_")) && !has("tip_x_mm");
}

PivotLog parse_pivot_log(const std::string& text, const std::string& name) {
  return PivotReader(text, name).read();
}

bool looks_like_metres(const PivotLog& log, const PivotFit& fit) {
  const auto near = [](const PivotPose& pose) { return pose.X_CT.p().norm() <= kNearPlaces; };
  return fit.point().e().norm() < kNearTip && std::all_of(log.poses.begin(), log.poses.end(), near);
}

}  // namespace enc::models
