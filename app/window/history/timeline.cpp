#include "app/window/history/timeline.h"

#include <algorithm>
#include <cmath>

namespace enc::app {
namespace {

constexpr sim::Colour kContact{0.90F, 0.55F, 0.20F, 1.0F};
constexpr sim::Colour kHold{0.85F, 0.10F, 0.15F, 1.0F};

}  // namespace

void Timeline::add(const Still& still) {
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
