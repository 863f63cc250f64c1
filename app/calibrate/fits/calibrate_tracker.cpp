// `encounter calibrate tracker LOG.csv`: offset, noise and latency of a tracker, from any log of a tool that
// the machine carries in its view.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/common/words.h"
#include "app/fit/commands.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "models/identify/tracker/latency_fit.h"
#include "trial/measure/record_table.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;  // prints NaN as null
using models::AxisLatency;
using models::Interval;
using models::LatencyFit;
using models::TrackerLog;

std::string text(const Interval& i, double unit, int digits) {
  if (std::isnan(i.value)) return "not known";
  if (std::isnan(i.half)) return fmt::format("{:.{}f} +- ?", i.value * unit, digits);
  return fmt::format("{:.{}f} +- {:.{}f}", i.value * unit, digits, i.half * unit, digits);
}
std::string text(double x, double unit, int digits) {
  return std::isnan(x) ? "not known" : fmt::format("{:.{}f}", x * unit, digits);
}
// A tracker's scale is much more accurate than this, and a length in wrong units is far beyond it.
bool scaled(const AxisLatency& x) { return std::abs(x.scale - 1.0) > 0.02; }
bool scaled(const LatencyFit& fit) {
  return std::any_of(fit.axes.begin(), fit.axes.end(), [](const AxisLatency& x) { return scaled(x); });
}
// The tracker reports the motion before the machine makes it.
bool early(const LatencyFit& fit) {
  return fit.latency.known() && fit.latency.value + fit.latency.half < 0.0;
}
bool differs_from_zero(const Interval& i) { return i.known() && std::abs(i.value) > i.half; }

double mean_packet_period(const TrackerLog& log) {
  return (log.packets.back().time - log.packets.front().time) / static_cast<double>(log.packets.size() - 1);
}

std::string table_text(const TrackerLog& log, const LatencyFit& fit) {
  std::string out = fmt::format(
      "{:.1f} s, {} rows at {:.4g} Hz, {} packets at {:.4g} Hz{}\n", log.time.back() - log.time.front(),
      log.time.size(), 1.0 / log.period, log.packets.size(), 1.0 / mean_packet_period(log),
      fit.outliers > 0 ? fmt::format("; {} left out, farther than 6 standard deviations", fit.outliers) : "");
  out += fmt::format("{:6}{:>20}{:>22}{:>12}{:>12}{:>10}\n", "axis", "latency, ms", "bias, mm", "noise, mm",
                     "travel, mm", "stops");
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisLatency& x = fit.axes[a];
    out += fmt::format("{:<6}{:>20}{:>22}{:>12}{:>12.1f}{:>10}\n", kNames[a], text(x.latency, kMsPerS, 2),
                       text(x.bias, kMmPerM, 4), text(x.noise, kMmPerM, 4), x.travel * kMmPerM, x.stops);
  }
  return out + fmt::format("{:6}{:>20}\n", "all", text(fit.latency, kMsPerS, 2));
}

std::string scatter_text(const TrackerLog& log, const LatencyFit& fit) {
  if (!fit.scatter.known()) return "";
  const double slot = mean_packet_period(log) / std::sqrt(12.0);
  return fmt::format(
      "scatter     of the age {} ms; waiting for a slot of {:.3g} ms explains up to {:.2f} ms of it\n",
      text(fit.scatter, kMsPerS, 2), mean_packet_period(log) * kMsPerS, slot * kMsPerS);
}

std::string stamps_text(const LatencyFit& fit) {
  if (std::isnan(fit.stamp_age.value))
    return "stamps      none (no tool_time_s): all times are those of arrival\n";
  if (!fit.stamp_error.known())
    return fmt::format(
        "stamps      tell a mean age of {:.4g} ms: {}\n", fit.stamp_age.value * kMsPerS,
        fit.latency.known() ? "they are of another clock" : "nothing moved to compare them with");
  return fmt::format("stamps      tell a mean age of {:.2f} ms; packets are older than that by {} ms\n",
                     fit.stamp_age.value * kMsPerS, text(fit.stamp_error, kMsPerS, 2));
}

// Remarks on one axis, in order.
std::vector<std::string> remarks_on(char name, const AxisLatency& x) {
  std::vector<std::string> out;
  const auto say = [&](std::string what) { out.push_back(std::move(what)); };
  if (x.moving == 0)
    say(fmt::format("{} did not move: its latency is not in this log; move it, there and back", name));
  else if (x.one_way)
    say(
        fmt::format("{} moved one way only: what of its bias changes in motion counts as latency, {:.2g} ms "
                    "for each 0.1 mm; move it back, too",
                    name, 0.1e-3 / x.fastest * kMsPerS));
  if (x.adrift)
    say(fmt::format(
        "{} of the tip stood still and {} of the tool moved by {:.1f} mm: its bias is not in this log", name,
        name, x.wander * kMmPerM));
  if (scaled(x))
    say(
        fmt::format("{} of the tool moved {:.3g} times as far as {} of the tip: no number here is to be "
                    "believed; see to scale, units and axes",
                    name, x.scale, name));
  if (x.at_rest < 10 && !std::isnan(x.bias.value))
    say(fmt::format("{} never stopped: its bias is from motion both ways, its noise is not known", name));
  else if (x.at_rest < 10)
    say(fmt::format("{} never stopped and moved one way: its bias is not in this log; stop sometimes", name));
  if (differs_from_zero(x.change) && std::abs(x.change.value) > 5e-6)
    say(fmt::format("the bias of {} differs in motion by {} mm", name, text(x.change, kMmPerM, 4)));
  if (differs_from_zero(x.step) && std::abs(x.step.value) > 0.02e-3)
    say(fmt::format("{} has a lag that does not grow with speed: {} mm", name, text(x.step, kMmPerM, 4)));
  if (x.places > std::max(0.03e-3, 3.0 * x.noise))
    say(fmt::format("the bias of {} depends on the place: stops differ by up to {:.3f} mm", name,
                    x.places * kMmPerM));
  return out;
}

// Remarks on the log's limits and on findings besides the numbers.
std::string remarks_text(const TrackerLog& log, const LatencyFit& fit) {
  std::string out;
  const auto say = [&](const std::string& what) { out += "note        " + what + "\n"; };
  for (const std::string& note : log.notes) say(note);
  for (std::size_t a = 0; a < 3; ++a)
    for (const std::string& remark : remarks_on(kNames[a], fit.axes[a])) say(remark);
  if (early(fit))
    say("the tool was seen where the tip was not yet: the times of the two are not of one clock, or the sign "
        "of the motion is wrong");
  if (!fit.axes_agree)
    say("the axes' latencies differ by more than chance: something turns with the direction, or speeds "
        "differ");
  return out;
}

std::string advice_text(const LatencyFit& fit) {
  if (scaled(fit)) return "";
  std::string out;
  const auto& axes = fit.axes;
  const bool off =
      std::any_of(axes.begin(), axes.end(), [](const AxisLatency& x) { return differs_from_zero(x.bias); });
  if (off) {
    out += "set         rig.frames.W_C.position_mm: take away [";
    for (std::size_t a = 0; a < 3; ++a)
      out += fmt::format("{}{:.4f}", a > 0 ? ", " : "",
                         std::isnan(axes[a].bias.value) ? 0.0 : axes[a].bias.value * kMmPerM);
    out += "] (or from the tool's tip_mm, if the bias turns with the tool)\n";
  }
  if (fit.latency.known() && !early(fit)) {
    const double usual = fit.latency.value + 3.0 * (fit.scatter.known() ? fit.scatter.value : 0.0);
    out += fmt::format("set         rig.tracker.usual_age_ms: above {:.0f}, three scatters over the mean\n",
                       std::ceil(usual * kMsPerS));
  }
  if (differs_from_zero(fit.stamp_error))
    out += fmt::format("set         rig.tracker.stamp_late_ms = {:.2f}\n", fit.stamp_error.value * kMsPerS);
  return out;
}

void put(Json& to, const std::string& name, const char* label, const Interval& i, double unit) {
  to[fmt::format("{}_{}", name, label)] = i.value * unit;
  to[fmt::format("{}_half_{}", name, label)] = i.half * unit;
}

std::string json_text(const TrackerLog& log, const LatencyFit& fit) {
  Json json;
  json["rows"] = log.time.size();
  json["rate_Hz"] = 1.0 / log.period;
  json["packets"] = log.packets.size();
  json["packet_rate_Hz"] = 1.0 / mean_packet_period(log);
  json["outliers"] = fit.outliers;
  for (std::size_t a = 0; a < 3; ++a) {
    const AxisLatency& x = fit.axes[a];
    Json axis;
    put(axis, "latency", "ms", x.latency, kMsPerS);
    put(axis, "bias", "mm", x.bias, kMmPerM);
    axis["noise_mm"] = x.noise * kMmPerM;
    put(axis, "bias_change", "mm", x.change, kMmPerM);
    put(axis, "lag_step", "mm", x.step, kMmPerM);
    axis["places_mm"] = x.places * kMmPerM;
    axis["travel_mm"] = x.travel * kMmPerM;
    axis["stops"] = x.stops;
    axis["moving"] = x.moving;
    axis["one_way"] = x.one_way;
    axis["adrift"] = x.adrift;
    axis["scale"] = x.scale;
    json["axes"][std::string(1, kNames[a])] = axis;
  }
  put(json, "latency", "ms", fit.latency, kMsPerS);
  put(json, "scatter", "ms", fit.scatter, kMsPerS);
  json["axes_agree"] = fit.axes_agree;
  json["stamp_age_ms"] = fit.stamp_age.value * kMsPerS;
  put(json, "stamp_late", "ms", fit.stamp_error, kMsPerS);
  json["notes"] = log.notes;
  return json.dump(2);
}

// A tool that the machine does not carry shows nothing about the tracker, whatever the numbers are.
void check_carried(const LatencyFit& fit, const std::string& name) {
  constexpr double kMost = 0.5;  // share of the tool's motion
  if (!fit.carried)
    throw Error(
        fmt::format("{}:1:1: the tip stood still and the tool moved; expected a tool that the machine "
                    "carries; clamp the tool and move the machine",
                    name));
  if (fit.in_range && !(fit.unexplained > kMost)) return;
  throw Error(
      fmt::format("{}:1:1: the tip explains {:.0f} % of the tool's motion{}; expected a tool that the "
                  "machine carries; clamp "
                  "the tool and move the machine, or see to the order of the rows",
                  name, 100.0 * std::max(0.0, 1.0 - fit.unexplained),
                  fit.in_range ? "" : ", with an age outside of -100 to 600 ms"));
}

}  // namespace

int calibrate_tracker(const TrackerOptions& options) {
  if (options.rate && !(*options.rate > 0.0))
    throw Error("--rate-Hz: expected a positive number of rows a second");
  const std::string wanted =
      "a CSV file with time_s, tip_x_mm, ..., tool_x_mm, ... as `encounter export` writes";
  const std::string csv = trial::read_table(options.log, "log", wanted);
  refuse_pairs(csv, options.log, "a tracker's log");
  refuse_poses(csv, options.log, "a tracker's log, which has the machine's tip");
  const TrackerLog log = models::parse_tracker_log(csv, options.log, options.rate.value_or(kUnset));
  const LatencyFit fit = models::fit_latency(log);
  check_carried(fit, options.log);
  const int code = scaled(fit) || early(fit) ? 1 : 0;  // such a result is unfit for a rig
  if (options.json) {
    fmt::print("{}\n", json_text(log, fit));
    return code;
  }
  fmt::print("{}{}{}{}{}intervals   95 %, from blocks of 0.25 s: neighbouring errors are alike\n",
             table_text(log, fit), scatter_text(log, fit), stamps_text(fit), remarks_text(log, fit),
             advice_text(fit));
  return code;
}

}  // namespace enc::app
