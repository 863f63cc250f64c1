#include <algorithm>
#include <cmath>
#include <random>

#include <fmt/format.h>

#include "benchmarks/stability/stability.h"

namespace enc::bench::stability {

Device held_by(Device device, const Grip& grip) {
  device.hand_mass = grip.hand.mass;
  device.hand_damping = grip.hand.damping;
  device.hand_spring = grip.hand.stiffness;
  return device;
}

std::vector<double> stiffnesses(const BenchContext& context) {
  const double each = context.full ? 4.0 : context.quick ? 0.5 : 1.0, decades = 8.0;
  std::vector<double> all;
  for (int i = 0; i <= each * decades; ++i) all.push_back(kSoftest * std::pow(10.0, i / each));
  return all;
}

Map::Map(std::string id, std::string title, std::vector<std::string> panels, std::size_t columns) {
  plot_.id = std::move(id);
  plot_.title = std::move(title);
  plot_.x_label = "delay (ms)";
  plot_.y_label = "stiffness (N/m)";
  plot_.log_y = true;
  plot_.panels = std::move(panels);
  plot_.columns = columns;
  for (const double delay : kDelays) plot_.x_names.push_back(fmt::format("{:g}", delay * 1e3));
  for (std::size_t panel = 0; panel < plot_.panels.size(); ++panel)
    for (const char* name : kRestWords) series(name, panel, Mark::cells);
}

Series& Map::series(const std::string& name, std::size_t panel, Mark mark) {
  const auto at = std::find_if(plot_.series.begin(), plot_.series.end(),
                               [&](const Series& s) { return s.name == name && s.panel == panel; });
  if (at != plot_.series.end()) return *at;
  return plot_.series.emplace_back(Series{.name = name, .mark = mark, .panel = panel});
}

void Map::cell(std::size_t panel, std::size_t delay, double stiffness, certificate::Rest rest) {
  series(words_of(rest), panel, Mark::cells).add(static_cast<double>(delay), stiffness);
}

void Map::line(const std::string& name, std::size_t panel, std::size_t delay, double stiffness) {
  const bool inside = stiffness >= kSoftest && stiffness <= kHardest;
  series(name, panel, Mark::line).add(static_cast<double>(delay), inside ? stiffness : kUnset);
}

void Map::add_to(Bench& bench, std::string caption) {
  const auto unknown = [](const Series& s) { return s.name == words_of(certificate::Rest::unknown); };
  if (std::all_of(plot_.series.begin(), plot_.series.end(),
                  [&](const Series& s) { return !unknown(s) || s.x.empty(); }))
    std::erase_if(plot_.series, unknown);
  plot_.caption = std::move(caption);
  bench.plot(plot_);
}

std::vector<Place> random_places(const BenchContext& context, std::size_t panels, std::size_t count,
                                 std::uint64_t stream) {
  std::mt19937_64 random(context.seed + (stream << 32U));
  const auto share = [&] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  const auto index = [&](std::size_t of) { return static_cast<std::size_t>(random() % of); };
  std::vector<Place> all;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t panel = index(panels), delay = index(kDelays.size());
    all.push_back({panel, delay, share()});
  }
  return all;
}

double about(double boundary, double share) {
  constexpr double kTimes = 30.0;
  const double middle = std::isfinite(boundary) && boundary > 0.0 ? boundary : std::sqrt(kSoftest * kHardest);
  return std::clamp(middle * std::pow(kTimes, 2.0 * share - 1.0), kSoftest, kHardest);
}

}  // namespace enc::bench::stability
