// The limits that a run exceeded, one line each, and its exit code.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include <fmt/format.h>

#include "app/built.h"
#include "app/run/run_report.h"
#include "core/base/words.h"

namespace enc::app {
namespace {

using Lines = std::vector<std::string>;

std::string name_of(const RunReport& r, std::int32_t object) {
  return object < 0 ? "an object"
                    : "object '" + r.setup.scene.objects[static_cast<std::size_t>(object)].name + "'";
}

void add_swings(const RunReport& r, Lines& lines) {
  const auto& swings = r.measured.touches.swings();
  if (swings.empty()) return;
  const auto widest = std::max_element(swings.begin(), swings.end(),
                                       [](const auto& a, const auto& b) { return a.way < b.way; });
  lines.push_back(
      fmt::format("{} swung against what pushed it, {}: from {:.2f} s to {:.2f} s by {:.2g} mm at "
                  "{:.1f} Hz; it is softer than this machine holds still (check names the softest), or add "
                  "admittance.damping "
                  "= \"observed\"",
                  name_of(r, widest->object), counted(swings.size(), "time"), widest->from, widest->until,
                  widest->way * 1e3, widest->frequency));
}

// A user as in the paper feels each contact of the core. If ground truth exists, it decides.
void add_empty(const RunReport& r, Lines& lines) {
  const auto& empty = r.measured.touches.empty();
  if (empty.empty()) return;
  lines.push_back(fmt::format(
      "nothing was {} in {} of {}, first at {:.2f} s: the tool is not where the tracker "
      "says, or the machine did not get there",
      words_of(r.setup.scene).met, empty.size(), counted(r.result.contacts, "contact"), empty.front()));
}

// Counts a part of the plan's presses, and gives the start of the first of them.
template <class F>
void add_tried(const RunReport& r, const F& is, const char* text, Lines& lines) {
  const auto& tried = r.measured.touches.plan().tried();
  const auto n = std::count_if(tried.begin(), tried.end(), is);
  if (n == 0) return;
  const auto first = std::find_if(tried.begin(), tried.end(), is);
  lines.push_back(fmt::format("{} of {} {}, first the one from {:.2f} s on{}", n,
                              counted(tried.size(), "press"), text, first->began,
                              r.result.contacts == 0 ? "; " + last_notice(r.result) : ""));
}

// An arm at 20 Hz loses a finger and finds it again within one press (docs/reference/reaching.md).
void add_repeated(const RunReport& r, Lines& lines) {
  const auto n = static_cast<std::int64_t>(r.measured.touches.plan().tried().size());
  if (r.steered || n == 0 || r.result.contacts <= n) return;
  lines.push_back(
      fmt::format("{} of {}: force was felt where nothing pushed, or the tip lost what "
                  "pushed it",
                  counted(r.result.contacts, "contact"), counted(n, "press")));
}

// Uses ground truth if there is one.
void add_untouched(const RunReport& r, Lines& lines) {
  using trial::PressAttempt;
  if (r.steered) return;
  const auto& tried = r.measured.touches.plan().tried();
  const auto missed = [](const PressAttempt& t) { return t.missed(); };
  const bool never = tried.empty() ? r.result.contacts == 0 && r.setup.scene.user && r.whole
                                   : std::all_of(tried.begin(), tried.end(), missed);
  if (never)
    lines.push_back("the user never touched anything; " + last_notice(r.result));
  else
    add_tried(r, missed, "touched nothing", lines);
  add_tried(
      r, [](const PressAttempt& t) { return t.unnoticed(); },
      "touched the prop and were no contact to the core", lines);
}

// A finger beside its prop feels an edge, or nothing.
void add_beside(const RunReport& r, Lines& lines) {
  if (r.steered) return;
  const Vec3 size = r.setup.scene.prop.value_or(PropSpec{}).size;
  const double half = 0.5 * std::min(size.x(), size.y());
  const auto& meetings = r.measured.fingers.meetings();
  const auto beside = [&](const trial::FingerEncounter& m) { return m.miss > half; };
  const auto n = std::count_if(meetings.begin(), meetings.end(), beside);
  if (n == 0) return;
  const auto touched =
      std::count_if(meetings.begin(), meetings.end(), [](const auto& m) { return !std::isnan(m.touched); });
  const auto first = std::find_if(meetings.begin(), meetings.end(), beside);
  lines.push_back(fmt::format(
      "{} of {} {} beside the prop, the first at {:.2f} s by {:.2f} mm, where its front ends at {:.2f} mm", n,
      counted(touched, "touch"), n == 1 ? "was" : "were", first->touched, first->miss * 1e3, half * 1e3));
}

void add_misses(const RunReport& r, Lines& lines) {
  if (r.steered) return;  // the bound assumes the plan's speed
  const auto& presses = r.measured.presses.presses();
  const auto missed = [](const trial::PressFigures& p) { return p.miss > p.miss_bound; };
  const auto n = std::count_if(presses.begin(), presses.end(), missed);
  if (n == 0) return;
  const auto first = std::find_if(presses.begin(), presses.end(), missed);
  lines.push_back(
      fmt::format("{} of {} missed by more than rig and hand allow, the first by {:.2f} mm of {:.2f} mm", n,
                  counted(presses.size(), "touch"), first->miss * 1e3, first->miss_bound * 1e3));
}

// A hard object pushes back with newtons already at the inset, where the tip is at the touch.
std::string departure_cause(const RunReport& r, const trial::Departure& worst) {
  const double inset = r.setup.scene.follow.inset;
  const auto steep = std::max_element(
      r.scene.objects.begin(), r.scene.objects.end(),
      [&](const auto& a, const auto& b) { return a.response.press(inset) < b.response.press(inset); });
  const double waits_at = steep->response.press(inset);
  if (worst.lasted < trial::PressMeasure::kLasting)
    return fmt::format(
        "the tip came out of its inset of {:g} mm, where '{}' pushes back with {:.1f} N; make "
        "follow.inset_mm smaller",
        std::round(inset * 1e9) * 1e-6,
        r.setup.scene.objects[static_cast<std::size_t>(steep - r.scene.objects.begin())].name, waits_at);
  // Find the contact of that moment.
  const auto& contacts = r.measured.passivity.contacts();
  const auto after = std::find_if(contacts.begin(), contacts.end(),
                                  [&](const auto& one) { return one.began > worst.from + worst.lasted; });
  const bool held = after != contacts.begin() && std::prev(after)->acted > 0.0;
  return fmt::format("{}the sensor does not measure what pushes, or the machine does not follow it",
                     held ? "the passivity controller held the tip back (line 'passivity'), or " : "");
}

void add_departures(const RunReport& r, Lines& lines) {
  const auto& off = r.measured.presses.departures();
  if (off.empty()) return;
  const auto& worst =
      *std::max_element(off.begin(), off.end(), [](const auto& a, const auto& b) { return a.away < b.away; });
  lines.push_back(fmt::format(
      "the true force was none of the object's for {:.2f} s, from {:.2f} s on: at most {:.2f} N at {:.3f} "
      "mm, {:.2f} N from its response; {}",
      worst.lasted, worst.from, worst.force, worst.deflection * 1e3, worst.away, departure_cause(r, worst)));
}

void add_motors(const RunReport& r, Lines& lines) {
  const auto add = [&](const trial::TouchMeasure::LimitAction& limit, const char* what) {
    if (limit.total > 0.0)
      lines.push_back(
          fmt::format("{}: from {:.2f} s on, for {:.2f} s in all; check names what this pose can hold", what,
                      limit.first, limit.total));
  };
  add(r.measured.touches.peak(), "a motor was asked for more than its peak, and the arm pushed less");
  add(r.measured.touches.heat(), "the motors were warm, and the arm pushed less");
}

// Uses inputs only, so it also detects that a real camera was pushed.
void add_moved(const RunReport& r, Lines& lines) {
  const trial::SeenShift found = r.measured.seen.moved();
  if (found.presses == 0) return;
  const Vec3 mm = -1e3 * found.shift;  // motion of the camera, opposite to the shift of what it sees
  const auto rounded = [](double x) { return std::round(x * 10.0) * 0.1 + 0.0; };  // avoids -0
  constexpr std::array kUnknown{"across their normal the presses do not tell",
                                "along the line across both of their normals the presses do not tell", ""};
  const double known =
      r.setup.scene.camera ? std::hypot(found.error, trial::SeenMeasure::kThroughImages) : found.error;  // m
  const std::string unknown =
      found.ways < 3 ? fmt::format("; {}", kUnknown.at(static_cast<std::size_t>(found.ways - 1))) : "";
  lines.push_back(fmt::format(
      "the {} is not where it was registered: {} from {:.2f} s on {} that it has moved by [{:.1f}, {:.1f}, "
      "{:.1f}] mm in W, +- {:.1f} mm{}; register it again by encounter calibrate camera",
      r.setup.scene.camera ? "camera" : "tracker", counted(found.presses, "press"), found.since,
      found.presses == 1 ? "says" : "say", rounded(mm.x()), rounded(mm.y()), rounded(mm.z()), 1e3 * known,
      unknown));
}

// A certificate beyond its bound counts if it was rendered: after any contact, since the touched object is
// not known. A free tip counts without a contact.
void add_unstable(const RunReport& r, Lines& lines) {
  for (const trial::ObjectCertificate& one : r.certificates)
    if (one.beyond() && (one.free_tip() || r.result.contacts > 0) &&
        (std::isnan(one.ramp) || one.certificate.verdict == certificate::Class::unstable))
      lines.push_back("rendered beyond what is stable: " + trial::refusal_text(r.setup, one));
}

// The forces of an unsolved step are not the contact's.
void add_unsolved(const RunReport& r, Lines& lines) {
  if (r.unsolved == 0) return;
  lines.push_back(
      fmt::format("the contact solver stopped at its {} iterations, short of its tolerance, in {} of {} "
                  "steps of the physics: "
                  "their forces are not those of the contact; raise truth.solver.iterations",
                  r.setup.twin.solver.iterations, r.unsolved, r.steps));
}

// The checks in the order of their lines.
using Check = void (*)(const RunReport& r, Lines& lines);
constexpr std::array<Check, 10> kOfHexapod{add_motors,   add_unstable,   add_swings, add_empty, add_untouched,
                                           add_repeated, add_departures, add_misses, add_moved, add_unsolved};
constexpr std::array<Check, 9> kOfArm{add_motors,     add_unstable, add_swings, add_empty,   add_untouched,
                                      add_departures, add_beside,   add_moved,  add_unsolved};
constexpr std::array<std::span<const Check>, 2> kChecks{kOfHexapod, kOfArm};

}  // namespace

std::vector<std::string> crossed(const RunReport& report) {
  Lines lines;
  for (const Check check : kChecks.at(words_of(report.setup.scene).row)) check(report, lines);
  return lines;
}

void complete(trial::Trial& trial, RunReport& report) {
  if (trial.has_world()) {
    report.steps = trial.world().physics().steps();
    report.unsolved = trial.world().physics().unsolved();
    report.elements = trial.world().physics().elements();
  }
  const trial::TrialResult& result = report.result;
  report.whole = !report.asked.seconds && !result.interrupted && !result.stopped && result.diverged_at < 0;
  report.crossed = crossed(report);
}

int exit_code(const RunReport& report) {
  if (report.result.diverged_at >= 0 || report.result.last_mode == Mode::hold) return 4;
  return report.crossed.empty() ? 0 : 1;
}

}  // namespace enc::app
