#include "models/identify/tracker/tracker_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "models/tables/csv_reader.h"

namespace enc::models {
namespace {

constexpr std::size_t kFewestRows = 10;  // rows, and packets
constexpr double kFarthest = 10.0;       // m: larger positions are in another unit
constexpr double kLongestPeriod = 0.1;   // s between rows, in which the tip is interpolated
constexpr double kMilliseconds = 0.5;    // s between rows: only a time in another unit is that long
constexpr double kLongestGap = 0.1;      // s of lost cycles
constexpr double kRounding = 1e-6;       // s
constexpr double kWhole = 0.25;          // share of a period: a gap is a whole number of them within this
constexpr double kFarStamp = 1.0;        // s between a machine's stamp and its row: beyond, the clocks differ
constexpr double kUneven = 0.5;          // share of a period: a step that differs by more has another rate
constexpr double kSilence = 0.5;         // s without a packet: a gap, and not a lost packet
constexpr double kWindow = 2.0;          // s over which packets are counted
constexpr double kRateChange = 0.3;      // a window's count may differ by this share

enum : std::size_t { kRowTime, kTip, kTool = kTip + 3, kStamp = kTool + 3, kTipStamp };

double median_step(const std::vector<double>& times) {
  std::vector<double> steps;
  steps.reserve(times.size());
  for (std::size_t i = 1; i < times.size(); ++i) steps.push_back(times[i] - times[i - 1]);
  std::nth_element(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2), steps.end());
  return steps[steps.size() / 2];
}

class LogReader {
 public:
  LogReader(const std::string& text, const std::string& name) : row_(text, name) {}

  TrackerLog read(double rate) {
    row_.header({"time_s", "tip_x_mm", "tip_y_mm", "tip_z_mm", "tool_x_mm", "tool_y_mm", "tool_z_mm"},
                {"tool_time_s", "tip_time_s"});
    while (row_.next()) {
      take_time();
      lines_.push_back(row_.line());
      log_.tip.push_back(position(kTip));
      take_tip_stamp();
      take_packet();
    }
    log_.repeated = filled_ > 0 && !holes_;
    check_tip_stamps();
    check_rate(rate);
    check_rows();
    check_packets();
    check_tool_stamps();
    return std::move(log_);
  }

 private:
  Vec3 position(std::size_t column) const {
    Vec3 p;
    for (std::size_t i = 0; i < 3; ++i) {
      p(static_cast<Eigen::Index>(i)) = row_.number(column + i) * 1e-3;
      if (std::abs(p(static_cast<Eigen::Index>(i))) > kFarthest)
        row_.fail(column + i, fmt::format("{} mm is farther than {:g} m; expected a position in mm; correct "
                                          "or remove the row",
                                          row_.text(column + i), kFarthest));
    }
    return p;
  }

  void take_time() {
    const double time = row_.number(kRowTime);
    if (!log_.time.empty() && !(time > log_.time.back()))
      row_.fail(kRowTime,
                fmt::format("the time {} s {} {} s; expected increasing times; {}", row_.text(kRowTime),
                            time == log_.time.back() ? "repeats" : "does not come after", log_.time.back(),
                            "sort the rows, or keep one of each time"));
    log_.time.push_back(time);
  }

  void take_tip_stamp() {
    if (!row_.has(kTipStamp)) return;
    const double before = log_.tip_time.empty() ? kUnset : log_.tip_time.back();
    const double stamp = row_.text(kTipStamp).empty() ? kUnset : row_.number(kTipStamp);
    // The last stamp repeats while the machine does not report.
    const double time = log_.time.back();
    if (!(stamp <= before) && std::abs(stamp - time) > kFarStamp) {
      const bool other_unit = stamp > time && is_unit(stamp / time);
      row_.fail(
          kTipStamp,
          fmt::format("the tip's stamp {} is {:.3g} s from the row's time; expected one clock; {}",
                      row_.text(kTipStamp), std::abs(stamp - time),
                      other_unit ? "is tip_time_s in milliseconds? give seconds" : "leave the column out"));
    }
    log_.tip_time.push_back(stamp);
  }

  // True for a thousand, a million or a billion: another unit of time.
  static bool is_unit(double factor) {
    constexpr std::array<double, 3> kUnits{1e3, 1e6, 1e9};
    return std::any_of(kUnits.begin(), kUnits.end(),
                       [&](double unit) { return std::abs(factor / unit - 1.0) < 0.05; });
  }

  // Stamps may come from another clock, but not in another unit.
  void check_tool_stamps() const {
    const TrackerPacket *first = nullptr, *last = nullptr;
    for (const TrackerPacket& packet : log_.packets) {
      if (std::isnan(packet.stamp)) continue;
      if (first == nullptr) first = &packet;
      last = &packet;
    }
    if (first == last) return;
    const double factor = (last->stamp - first->stamp) / (last->time - first->time);
    if (is_unit(factor))
      row_.fail_line(lines_[1], fmt::format("tool_time_s runs {:.4g} times as fast as time_s; expected "
                                            "seconds in both; is tool_time_s in {}? divide it by that number",
                                            factor,
                                            factor < 1e4   ? "milliseconds"
                                            : factor < 1e7 ? "microseconds"
                                                           : "nanoseconds"));
  }

  void check_tip_stamps() {
    std::size_t news = 0;
    double newest = kUnset;
    for (const double stamp : log_.tip_time)
      if (std::isfinite(stamp) && !(stamp <= newest)) newest = stamp, ++news;
    if (news == 0) return log_.tip_time.clear();
    if (news < kFewestRows)
      row_.fail_line(
          fmt::format("the tip has {} stamps; expected at least {}; see that the machine answers, or leave "
                      "the column out",
                      news, kFewestRows));
  }

  // Empty cells, or the same three numbers as before: no new packet.
  void take_packet() {
    if (row_.text(kTool).empty() && row_.text(kTool + 1).empty() && row_.text(kTool + 2).empty()) {
      holes_ = holes_ || filled_ > 0;
      return;
    }
    TrackerPacket packet{log_.time.back(), kUnset, position(kTool)};
    if (!row_.text(kStamp).empty()) packet.stamp = row_.number(kStamp);
    ++filled_;
    const bool same = !log_.packets.empty() && packet.tool == log_.packets.back().tool &&
                      (std::isnan(packet.stamp) || packet.stamp == log_.packets.back().stamp);
    if (same) return;
    log_.packets.push_back(packet);
    packet_rows_.push_back(lines_.size() - 1);
  }

  double step_to(std::size_t i) const { return log_.time[i] - log_.time[i - 1]; }

  void check_rate(double rate) {
    if (log_.time.size() < kFewestRows)
      row_.fail_line(fmt::format("there are {} rows; expected at least {}; record longer", log_.time.size(),
                                 kFewestRows));
    log_.period = median_step(log_.time);
    if (!std::isnan(rate) && std::abs(log_.period * rate - 1.0) > 0.01)
      row_.fail_line(lines_[1], fmt::format("the rows come at {:.4g} Hz; expected {:.4g} Hz; give the log's "
                                            "own rate with --rate-Hz",
                                            1.0 / log_.period, rate));
    if (log_.period >= kMilliseconds)
      row_.fail_line(lines_[1], fmt::format("rows are {:.3g} s apart: milliseconds? expected at least {:g} "
                                            "rows a second; give time_s in seconds",
                                            log_.period, 1.0 / kLongestPeriod));
    if (log_.period > kLongestPeriod)
      row_.fail_line(lines_[1], fmt::format("the rows come every {:.3g} s; expected at least {:g} rows a "
                                            "second; record each cycle of the loop",
                                            log_.period, 1.0 / kLongestPeriod));
  }

  void check_rows() {
    std::vector<std::size_t> odd;
    for (std::size_t i = 1; i < log_.time.size(); ++i)
      if (std::abs(step_to(i) - log_.period) > kUneven * log_.period) odd.push_back(i);
    if (odd.empty()) return;
    if (odd.size() > std::max<std::size_t>(3, log_.time.size() / 50))
      row_.fail_line(lines_[odd.front()],
                     fmt::format("here the rows come every {:.4g} ms and mostly every {:.4g} ms ({} such "
                                 "steps); expected one rate; cut the log where the rate changes",
                                 step_to(odd.front()) * 1e3, log_.period * 1e3, odd.size()));
    std::size_t missing = 0;
    double longest = 0.0;
    for (const std::size_t i : odd) {
      const double rows = step_to(i) / log_.period;
      const bool lost =
          rows > 1.5 && std::abs(rows - std::round(rows)) <= kWhole && step_to(i) <= kLongestGap + kRounding;
      if (!lost)
        row_.fail_line(
            lines_[i],
            fmt::format("rows are missing from {:.6g} to {:.6g} s (a step of {:.4g} ms among steps "
                        "of {:.4g} ms); expected no gap of more than {:g} ms; cut the log there, or "
                        "record it again",
                        log_.time[i - 1], log_.time[i], step_to(i) * 1e3, log_.period * 1e3,
                        kLongestGap * 1e3));
      missing += static_cast<std::size_t>(std::lround(rows)) - 1;
      longest = std::max(longest, step_to(i));
    }
    log_.notes.push_back(
        fmt::format("{} rows are missing, at {} places of up to {:.3g} ms: there the tip is interpolated",
                    missing, odd.size(), longest * 1e3));
  }

  // If a log repeats the last value, a lost packet looks like a tool at rest without noise.
  bool still(std::size_t from, std::size_t to) const {
    if (!log_.repeated) return false;
    for (std::size_t i = from; i <= to; ++i)
      if ((log_.tip[i] - log_.tip[from]).norm() > 0.1e-3) return false;
    return true;
  }

  void check_packets() {
    std::vector<double> times;
    for (const TrackerPacket& packet : log_.packets) times.push_back(packet.time);
    if (times.size() < kFewestRows)
      row_.fail_line(
          fmt::format("there are {} packets of the tool; expected at least {}; see that the "
                      "tracker sees the tool",
                      times.size(), kFewestRows));
    log_.packet_period = median_step(times);
    std::size_t late = 0;
    for (std::size_t k = 1; k < times.size(); ++k) {
      const double step = times[k] - times[k - 1];
      if (step > 3.5 * log_.packet_period && !still(packet_rows_[k - 1], packet_rows_[k])) ++late;
      if (step <= std::max(kSilence, 5.0 * log_.packet_period)) continue;
      if (still(packet_rows_[k - 1], packet_rows_[k])) continue;
      row_.fail_line(lines_[packet_rows_[k]],
                     fmt::format("no packet of the tool came from {:.6g} to {:.6g} s; expected one about "
                                 "every {:.3g} ms; cut the log there, or record it again",
                                 times[k - 1], times[k], log_.packet_period * 1e3));
    }
    if (late > 0)
      log_.notes.push_back(fmt::format("{} times more than 3 packets in a row did not come", late));
    check_packet_rate(times);
  }

  // Two rates in one log mean two latencies.
  void check_packet_rate(const std::vector<double>& times) const {
    if (log_.repeated) return;
    const double mean = static_cast<double>(times.size() - 1) / (times.back() - times.front());
    std::size_t from = 0;
    for (std::size_t k = 0; k < times.size(); ++k) {
      if (times[k] - times[from] < kWindow) continue;
      const double rate = static_cast<double>(k - from) / (times[k] - times[from]);
      if (std::abs(rate / mean - 1.0) > kRateChange && times[k] - times[from] < 2.0 * kWindow)
        row_.fail_line(lines_[packet_rows_[from]],
                       fmt::format("from {:.6g} to {:.6g} s {:.3g} packets a second came and over the whole "
                                   "log {:.3g}; expected one rate; cut the log where the rate changes",
                                   times[from], times[k], rate, mean));
      from = k;
    }
  }

  CsvReader row_;
  TrackerLog log_;
  std::vector<std::size_t> lines_;        // of each row
  std::vector<std::size_t> packet_rows_;  // row of each packet
  std::size_t filled_ = 0;
  bool holes_ = false;
};

}  // namespace

TipPath::TipPath(const TrackerLog& log)
    : first_(log.time.front()), last_(log.time.back()), period_(log.period) {
  if (log.tip_time.empty()) {
    time_ = log.time;
    tip_ = log.tip;
  }
  for (std::size_t i = 0; i < log.tip_time.size(); ++i) {
    const double t = log.tip_time[i];  // skips NaN, too
    if (!(time_.empty() ? std::isfinite(t) : t > time_.back())) continue;
    time_.push_back(t);
    tip_.push_back(log.tip[i]);
  }
  if (time_.size() > 1 && !log.tip_time.empty()) period_ = median_step(time_);
  reach_ = std::max(5e-3, 2.0 * period_);
}

// Index of the first later row, or of the last row. Rows are even except for jitter and gaps, so the first
// guess is usually close.
std::size_t TipPath::after(double t) const {
  const std::size_t last = time_.size() - 1;
  const double share = (t - time_.front()) / (time_.back() - time_.front());
  auto i = static_cast<std::size_t>(
      std::clamp(std::ceil(share * static_cast<double>(last)), 1.0, static_cast<double>(last)));
  for (int step = 0; step < 4; ++step) {
    if (i > 1 && time_[i - 1] > t)
      --i;
    else if (i < last && time_[i] <= t)
      ++i;
    else
      return i;
  }
  return static_cast<std::size_t>(std::upper_bound(time_.begin() + 1, time_.end() - 1, t) - time_.begin());
}

bool TipPath::knows(double t) const {
  if (time_.size() < 2 || t - reach_ < time_.front() || t + reach_ > time_.back()) return false;
  if (t < first_ || t > last_) return false;
  const std::size_t i = after(t);
  return time_[i] - time_[i - 1] <= std::max(kLongestGap + kRounding, 1.5 * period_);
}

Vec3 TipPath::position(double t) const {
  const std::size_t i = after(t);
  const double share = (t - time_[i - 1]) / (time_[i] - time_[i - 1]);
  return tip_[i - 1] + share * (tip_[i] - tip_[i - 1]);
}

Vec3 TipPath::velocity(double t) const {
  return (position(t + reach_) - position(t - reach_)) / (2.0 * reach_);
}

TrackerLog parse_tracker_log(const std::string& text, const std::string& name, double rate) {
  return LogReader(text, name).read(rate);
}

}  // namespace enc::models
