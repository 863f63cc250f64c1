#include "app/window/history/history.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace enc::app {
namespace {

constexpr std::size_t kPoints = 300;  // most points of a line

// The first sample at or after t.
std::deque<ChartSample>::const_iterator from(const std::deque<ChartSample>& samples, float t) {
  return std::lower_bound(samples.begin(), samples.end(), t,
                          [](const ChartSample& sample, float at) { return sample.t < at; });
}

// The component along the outward normal of the contact; 0 without a contact.
double along_normal(const State& state, const Vec<'W'>& force) {
  const Contact& contact = contact_of(state);
  return contact.X_WN.valid() ? -dot(force, contact.X_WN * Vec<'N'>(0, 0, 1)) : 0.0;
}

float or_zero(double x) { return std::isfinite(x) ? static_cast<float>(x) : 0.0F; }

}  // namespace

ChartSample Sampler::sample(const trial::Glance& glance) {
  const bool touched = glance.out.mode == Mode::contact;
  const double power = dot(glance.truth.contact_force, glance.truth.tip_velocity);
  if (std::isfinite(power)) energy_ += power * seconds(glance.tick.dt);
  ChartSample s;
  s.t = static_cast<float>(seconds(glance.tick.t.time_since_epoch()));
  s.true_force = or_zero(along_normal(*glance.state, glance.truth.contact_force));
  s.gap = static_cast<float>(1e3 * glance.out.gap);
  s.energy = static_cast<float>(1e3 * energy_);
  if (!touched) return s;
  s.measured = or_zero(glance.out.force_unfiltered.norm());
  s.filtered = or_zero(-glance.out.force.xyz[2]);
  s.deflection = or_zero(1e3 * glance.out.deflection);
  return s;
}

void Charts::add(const ChartSample& sample) {
  if (samples_.size() == most_) samples_.pop_front();
  samples_.push_back(sample);
}

std::vector<sim::ViewChart> Charts::until(double end_time, std::optional<double> cursor, bool truth) const {
  if (samples_.empty()) return {};
  const auto end = static_cast<float>(end_time);
  const auto first = from(samples_, end - kSpan), last = from(samples_, end + 1e-4F);
  if (first == last) return {};
  const auto count = static_cast<std::size_t>(last - first);
  const auto each = static_cast<std::ptrdiff_t>(count / kPoints + 1);
  const auto read = std::min(from(samples_, end + static_cast<float>(cursor.value_or(0.0))), last - 1);
  const auto line = [&](const char* name, float ChartSample::*what, int decimals) {
    const float value = (*read).*what;
    sim::ViewLine drawn{
        std::isfinite(value) ? fmt::format("{} {:.{}f}", name, value, decimals) : fmt::format("{} -", name),
        {}};
    for (auto i = first; last - i > 0; i += std::min(each, last - i)) {
      if (!std::isfinite((*i).*what)) continue;
      drawn.xy.push_back(i->t - end);
      drawn.xy.push_back((*i).*what);
    }
    return drawn;
  };
  const auto chart = [&](const char* title, std::vector<sim::ViewLine> lines, float most) {
    sim::ViewChart drawn{title, std::move(lines), {-kSpan, 0}, {0, most}, {}};
    if (cursor) drawn.cursor = read->t - end;
    return drawn;
  };
  std::vector<sim::ViewLine> forces{line("measured", &ChartSample::measured, 2),
                                    line("filtered", &ChartSample::filtered, 2)};
  if (truth) forces.push_back(line("true", &ChartSample::true_force, 2));
  std::vector<sim::ViewChart> charts;
  if (truth)
    charts.push_back(chart("energy into the surface, mJ", {line("energy", &ChartSample::energy, 1)}, 5));
  charts.push_back(chart("deflection and gap, mm",
                         {line("deflection", &ChartSample::deflection, 2), line("gap", &ChartSample::gap, 2)},
                         10));
  charts.push_back(chart("force, N", std::move(forces), 5));
  return charts;
}

namespace {

constexpr sim::Colour kContact{0.90F, 0.55F, 0.20F, 1.0F};
constexpr sim::Colour kHold{0.85F, 0.10F, 0.15F, 1.0F};

}  // namespace

void Timeline::add(const RunSnapshot& still) {
  const bool newest = !past();
  if (stills_.size() < most_) {
    stills_.push_back(still);
  } else {
    stills_[static_cast<std::size_t>(end()) % most_] = still;
    ++dropped_;
  }
  show(newest ? end() - 1 : shown_);
}

void Timeline::show(Number n) { shown_ = std::clamp(n, begin(), end() - 1); }

void Timeline::seek(double share) {
  rest_ = 0.0;
  if (!stills_.empty())
    show(begin() + std::llround(std::clamp(share, 0.0, 1.0) * static_cast<double>(stills_.size() - 1)));
}

void Timeline::step(int stills) {
  rest_ = 0.0;
  if (!stills_.empty()) show(shown_ + stills);
}

void Timeline::go_on(double seconds) {
  if (!past()) return;
  rest_ += seconds;
  Number n = shown_;
  while (n + 1 < end() && seconds_of(at(n + 1)) - seconds_of(at(shown_)) <= rest_) ++n;
  rest_ -= seconds_of(at(n)) - seconds_of(at(shown_));
  show(n);
}

void Timeline::to_change() {
  rest_ = 0.0;
  if (stills_.empty()) return;
  Number n = shown_;
  while (n + 1 < end() && at(n).out.mode == at(n + 1).out.mode) ++n;
  show(n + 1);
}

sim::ViewBar Timeline::bar() const {
  sim::ViewBar bar;
  if (stills_.size() < 2) return bar;
  const auto share = [&](Number n) {
    return static_cast<float>(n - begin()) / static_cast<float>(end() - 1 - begin());
  };
  bar.shown = true;
  bar.at = share(shown_);
  for (Number n = begin(); n < end(); ++n) {
    const Mode mode = at(n).out.mode;
    if (mode != Mode::contact && mode != Mode::hold) continue;
    const sim::Colour& colour = mode == Mode::hold ? kHold : kContact;
    const float from = share(n), to = share(std::min(n + 1, end() - 1));
    if (!bar.marks.empty() && bar.marks.back().to >= from && bar.marks.back().colour == colour)
      bar.marks.back().to = to;
    else
      bar.marks.push_back({from, to, colour});
  }
  return bar;
}

}  // namespace enc::app
