#include "app/verdict.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace enc::app {
namespace {

using Lines = std::vector<std::string>;

std::string name_of(const RunReport& r, std::int32_t object) {
  return object < 0 ? "an object"
                    : "object '" + r.setup.scene.objects[static_cast<std::size_t>(object)].name + "'";
}

void add_swings(const RunReport& r, Lines& lines) {
  const auto& swings = r.touches.swings();
  if (swings.empty()) return;
  const auto widest = std::max_element(swings.begin(), swings.end(),
                                       [](const auto& a, const auto& b) { return a.way < b.way; });
  lines.push_back(
      fmt::format("{} swung against what pushed it, {} time{}: from {:.2f} s to {:.2f} s by {:.2g} mm at "
                  "{:.1f} Hz; it is softer than this machine holds still (check names the softest), or add "
                  "admittance.damping "
                  "= \"observed\"",
                  name_of(r, widest->object), swings.size(), swings.size() == 1 ? "" : "s", widest->from,
                  widest->until, widest->way * 1e3, widest->frequency));
}

// The paper's user feels what the core calls a contact.
void add_empty(const RunReport& r, Lines& lines) {
  const auto& empty = r.touches.empty();
  if (empty.empty()) return;
  lines.push_back(fmt::format(
      "nothing was felt in {} of {} contacts, first at {:.2f} s: the tool is not where the tracker "
      "says, or the machine did not get there",
      empty.size(), r.result.contacts, empty.front()));
}

void add_untouched(const RunReport& r, Lines& lines) {
  if (r.result.contacts > 0 || !r.setup.scene.user || !r.whole) return;
  lines.push_back(fmt::format("the user never touched anything; last notice of the core: {}",
                              r.result.last_why == 0 ? "none" : why_text(r.result.last_why)));
}

void add_misses(const RunReport& r, Lines& lines) {
  if (r.scene.impedance) return;  // a finger slides where it likes
  const auto& presses = r.presses.presses();
  const auto missed = [](const trial::PressFigures& p) { return p.miss > p.miss_bound; };
  const auto n = std::count_if(presses.begin(), presses.end(), missed);
  if (n == 0) return;
  const auto first = std::find_if(presses.begin(), presses.end(), missed);
  lines.push_back(fmt::format(
      "{} of {} touches missed by more than rig and hand allow, the first by {:.2f} mm of {:.2f} mm", n,
      presses.size(), first->miss * 1e3, first->miss_bound * 1e3));
}

void add_motors(const RunReport& r, Lines& lines) {
  const auto add = [&](const trial::TouchMeasure::Acted& limit, const char* what) {
    if (limit.total > 0.0)
      lines.push_back(
          fmt::format("{}: from {:.2f} s on, for {:.2f} s in all; check names what this pose can hold", what,
                      limit.first, limit.total));
  };
  add(r.touches.peak(), "a motor was asked for more than its peak, and the arm pushed less");
  add(r.touches.heat(), "the motors were warm, and the arm pushed less");
}

void add_ringing(const RunReport& r, Lines& lines) {
  if (r.result.contacts == 0) return;
  for (const trial::ArmStrength& at : r.limits.strengths)
    if (at.stiffness > at.stiffest) lines.push_back(trial::beyond_text(at));
}

}  // namespace

std::vector<std::string> crossed(const RunReport& report) {
  Lines lines;
  add_motors(report, lines);
  add_ringing(report, lines);
  add_swings(report, lines);
  add_empty(report, lines);
  add_untouched(report, lines);
  add_misses(report, lines);
  return lines;
}

}  // namespace enc::app
