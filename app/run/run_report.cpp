#include "app/run/run_report.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "app/built.h"
#include "app/process.h"
#include "app/run/percentiles.h"
#include "app/run/press_text.h"
#include "app/stability_text.h"
#include "core/base/counted.h"
#include "models/schema/wording.h"

namespace enc::app {
namespace {

std::string modes_line(const trial::TrialResult& result) {
  std::string text;
  for (int i = 0; i < kModes; ++i) {
    const double time = result.mode_time[static_cast<std::size_t>(i)];
    if (time > 0.0)
      text += fmt::format("{}{} {:.2f} s", text.empty() ? "" : ", ", mode_name(static_cast<Mode>(i)), time);
  }
  return text;
}

// One entry for each push of the test rig.
template <class F>
std::string each_push(const std::vector<trial::PushFigures>& pushes, const F& figure) {
  std::string text;
  for (const trial::PushFigures& push : pushes) text += (text.empty() ? "" : " / ") + figure(push);
  return text;
}

std::string push_lines(const RunReport& r) {
  if (!r.scene.probe()) return "";
  const auto& pushes = r.measured.pushes.pushes();
  std::string text =
      fmt::format("pushes      {} of {}; {:g} mm deep at {:g} mm/s\n", pushes.size(),
                  r.scene.probe()->repeats, r.scene.probe()->depth * 1e3, r.scene.probe()->speed * 1e3);
  if (pushes.empty())
    return text + fmt::format("note        the machine never pushed; last notice of the core: {}\n",
                              r.result.last_why == 0 ? "none" : why_text(r.result.last_why));
  text += fmt::format("  peak      {} N (measured)\n",
                      each_push(pushes, [](const auto& p) { return fmt::format("{:.2f}", p.peak_force); }));
  text += fmt::format("  reached   {} mm\n", each_push(pushes, [](const auto& p) {
                        return fmt::format("{:.3f}", p.peak_deflection * 1e3);
                      }));
  text +=
      fmt::format("  loss      {} % of the work\n",
                  each_push(pushes, [](const auto& p) { return fmt::format("{:.1f}", p.loss() * 100.0); }));
  if (pushes.size() > 1)
    text += fmt::format("repeats     within {:.3f} N at equal deflection\n", r.measured.pushes.spread());
  text += fmt::format("error       at most {:.3f} N (measured force against the true one)\n",
                      r.measured.pushes.force_error());
  return text;
}

// One entry for each time that the arm was told to prepare.
template <class F>
std::string each_meeting(const std::vector<trial::Meeting>& meetings, const F& figure) {
  std::string text;
  for (const trial::Meeting& meeting : meetings) {
    if (std::isnan(meeting.touched)) continue;
    text += (text.empty() ? "" : " / ") + figure(meeting);
  }
  return text;
}

// The spring that a wall is, where the user presses one.
std::string spring_line(const RunReport& r) {
  const std::optional<UserSpec>& user = r.setup.scene.user;
  if (!user || user->kind != UserKind::press_release) return "";
  const Object& pressed = r.scene.objects[pressed_object(r.setup.scene.objects, user->object, "user")];
  if (pressed.interaction.kind != Interaction::slide) return "";
  if (!std::isfinite(r.measured.fingers.fit().r2()))
    return "spring      not measured: the finger was never 2 to 10 mm deep\n";
  return fmt::format(
      "spring      {:.1f} N/m, R2 {:.5f} (true contact force over true depth, 2 to 10 mm); wanted {:.1f} "
      "N/m; R2 {:.5f} over the depth that the core believed\n",
      r.measured.fingers.fit().slope(), r.measured.fingers.fit().r2(), pressed.stiffness,
      r.measured.fingers.believed().r2());
}

// A press tells where vision puts a finger that the prop feels.
std::string seen_line(const RunReport& r) {
  const std::vector<trial::SeenPress> presses = r.measured.seen.presses();
  if (presses.empty()) return "";
  std::string each;
  for (const trial::SeenPress& press : presses)
    each += fmt::format("{}{:+.2f}", each.empty() ? "" : " / ", press.mean * 1e3);
  const bool all = r.measured.seen.shift().ways == 3;
  return fmt::format(
      "seen        {} mm above the prop that it pushed (by vision and encoders, a press each){}\n", each,
      all ? ""
          : fmt::format("; a {} that has moved along the surface would not show in it",
                        r.setup.scene.camera ? "camera" : "tracker"));
}

// What the controller of energy saw and did, where it is on.
std::string passivity_line(const RunReport& r) {
  const bool arm = r.scene.impedance() != nullptr;
  if (!trial::controlled(r.scene)) return "";
  const auto& contacts = r.measured.passivity.contacts();
  if (contacts.empty()) return "passivity   controlled; there was no contact to control\n";
  const trial::PassivityFigures all = r.measured.passivity.worst();
  const auto acted =
      std::count_if(contacts.begin(), contacts.end(), [](const auto& c) { return c.acted > 0.0; });
  const std::string of = counted(contacts.size(), "contact");
  std::string text =
      acted == 0 ? fmt::format("passivity   the controller left the law's {} as it is, in all of {}",
                               arm ? "force" : "way", of)
      : !arm ? fmt::format("passivity   the controller held the tip back in {} of {}: for {:.0f} ms in all",
                           acted, of, all.acted * 1e3)
             : fmt::format(
                   "passivity   the controller held the law's force back in {} of {}: for {:.0f} ms in "
                   "all, by at "
                   "most {:.2f} N, which kept {:.3f} mJ from coming out",
                   acted, of, all.acted * 1e3, all.most, all.dissipated * 1e3);
  text +=
      fmt::format("; of one contact at most {:.3f} mJ more came out than went in along the normal (by {})\n",
                  all.given * 1e3, arm ? "encoders" : "the machine's own force and pose");
  // It counts what each force did, and nobody did anything with these.
  if (arm && r.result.withheld > 0)
    text +=
        "  dry       no force was sent, and the controller takes each for sent: armed it holds back other "
        "ones\n";
  return text;
}

// An arm that meets a bare finger [VisHap 3].
std::string finger_lines(const RunReport& r) {
  if (!r.scene.impedance()) return "";
  const auto& meetings = r.measured.fingers.meetings();
  std::string text =
      fmt::format("far         tip speed at most {:.3f} mm/s\n", r.measured.fingers.far_speed() * 1e3);
  const auto touched =
      std::count_if(meetings.begin(), meetings.end(), [](const auto& m) { return !std::isnan(m.touched); });
  text += fmt::format("prepare     {}, {} followed by a touch\n", counted(meetings.size(), "time"), touched);
  if (touched == 0) return text;
  using trial::Meeting;
  text += fmt::format(
      "approach    {} mm/s (planned, of the first touch after each prepare)\n",
      each_meeting(meetings, [](const Meeting& m) { return fmt::format("{:.0f}", m.approach_speed * 1e3); }));
  text += fmt::format("  there     {} ms before the touch\n", each_meeting(meetings, [](const Meeting& m) {
                        return std::isnan(m.arrived) ? "not"
                                                     : fmt::format("{:.0f}", (m.touched - m.arrived) * 1e3);
                      }));
  text += fmt::format(
      "  miss      {} mm (along the surface, true finger to the middle of the prop, at the touch)\n",
      each_meeting(meetings, [](const Meeting& m) { return fmt::format("{:.2f}", m.miss * 1e3); }));
  text += fmt::format(
      "  peak      {} N (greatest until the next prepare, as the next two)\n",
      each_meeting(meetings, [](const Meeting& m) { return fmt::format("{:.2f}", m.peak_force); }));
  if (std::any_of(meetings.begin(), meetings.end(), [](const Meeting& m) { return m.peak_depth > 0.0; }))
    text += fmt::format("  depth     {} mm (true)\n", each_meeting(meetings, [](const Meeting& m) {
                          return std::isnan(m.peak_depth) ? "not known"
                                                          : fmt::format("{:.2f}", m.peak_depth * 1e3);
                        }));
  text += fmt::format(
      "  step      {} N, greatest from one cycle to the next\n",
      each_meeting(meetings, [](const Meeting& m) { return fmt::format("{:.2f}", m.greatest_step); }));
  const double sideways = r.measured.fingers.tangential_share();
  return text + spring_line(r) + seen_line(r) + passivity_line(r) +
         (std::isfinite(sideways)
              ? fmt::format("sideways    {:.1f} % of the normal force, where that is more than 1 N\n",
                            100.0 * sideways)
              : "sideways    not measured: never more than 1 N along the normal\n");
}

// The contact with the largest term, and how well all of them close (docs/reference/ledger.md).
std::string ledger_line(const RunReport& r) {
  const std::vector<trial::ContactLedger> all = r.measured.ledger.contacts();
  if (all.empty())
    return r.result.contacts > 0 && r.scene.probe()
               ? "ledger      nothing rendered: a real object is pressed\n"
               : "";
  const auto most = std::max_element(all.begin(), all.end(),
                                     [](const auto& a, const auto& b) { return a.largest() < b.largest(); });
  const auto up = [](double x, double parts) { return std::ceil(x * parts) / parts; };
  double worst = 0.0;
  for (const trial::ContactLedger& one : all) worst = std::max(worst, one.closure());
  return fmt::format(
      "ledger      contact {}{}: hand {:.2f} + carried {:.2f} + generated {:.2f} = stored {:.2f} + "
      "dissipated "
      "{:.2f} mJ; {} close{} within {:.2f} %; at most {:.3f} mJ out beyond what was put in\n",
      most->contact, most->rendered ? "" : " (nothing rendered)", most->hand * 1e3, most->carried * 1e3,
      most->generated() * 1e3, most->stored() * 1e3, most->dissipated() * 1e3, all.size(),
      all.size() == 1 ? "s" : "", up(worst * 100.0, 1e2), up(trial::worst_surplus(all) * 1e3, 1e3));
}

// Who repeats this gets the same report.
std::string made_line(const RunReport& r) {
  const bool wall = r.result.keeps_wall_time;
  std::string text =
      fmt::format("made by     {}, {} {}: {}, rig {}, seed {}", trial::program_words(),
                  wall ? "started" : "on", wall ? trial::time_text(r.begun) : trial::day_text(r.begun),
                  r.setup.scene_path, r.setup.rig_path, r.asked.seed);
  if (!r.asked.hand.empty()) text += ", --hand " + r.asked.hand;
  if (r.steered && r.asked.hand.empty()) text += ", steered by hand";
  if (r.asked.armed) text += ", --armed";
  if (r.asked.lockstep) text += ", --lockstep";
  if (r.asked.seconds) text += fmt::format(", --for-s {}", *r.asked.seconds);
  for (const std::string& set : r.asked.set) text += ", --set " + set;
  return models::printable(text) + "\n";
}

// The first three, and how many more there were.
std::string hold_lines(const trial::TrialResult& result) {
  constexpr std::size_t kShown = 3;
  std::string text;
  const std::size_t shown = std::min(kShown, result.holds.size());
  for (std::size_t i = 0; i < shown; ++i)
    text += fmt::format("hold        at {:.3f} s: {}\n", seconds(result.holds[i].first.time_since_epoch()),
                        why_text(result.holds[i].second));
  const std::int64_t more = result.times_held - static_cast<std::int64_t>(shown);
  if (more <= 0) return text;
  return text + fmt::format("hold        and {} more; {:.3f} s in all\n", counted(more, "time"),
                            result.mode_time[static_cast<std::size_t>(Mode::hold)]);
}

// What pushes from outside has no tool: it cannot miss, and has no speed at the touch.
std::string pushed_lines(const RunReport& r) {
  if (!r.setup.scene.pusher || !r.measured.felt.truth) return "";
  const auto& pushes = r.measured.presses.presses();
  return fmt::format("pushed      {} of {} from outside; at most {:.2f} N and {:.3f} mm deep (true)\n",
                     pushes.size(), counted(r.setup.scene.pusher->repeats, "time"),
                     peak_of(pushes, &trial::PressFigures::peak_force),
                     peak_of(pushes, &trial::PressFigures::peak_deflection) * 1e3);
}

// Of a run that keeps the wall clock.
std::string loop_line(const trial::TrialResult& result) {
  std::string text;
  if (!result.real_time.empty()) text += "real time   " + result.real_time + "\n";
  if (result.period_ns.empty()) return text;
  return text + fmt::format("loop        from tick to tick {} ms\n",
                            text_of(percentiles_of(result.period_ns), 1e-6, 3, 3));
}

std::string late_line(const trial::TrialResult& result) {
  if (result.missed > 0)
    return fmt::format("late        cycles lost to the wall clock: {}; stalls: {}, the longest {:.3f} s\n",
                       result.missed, result.lateness.times, result.lateness.longest);
  if (result.lateness.times == 0) return "";
  return fmt::format("late        {:.3f} s behind the wall clock; stalls: {}; nothing was lost\n",
                     result.lateness.total, result.lateness.times);
}

// Rates and jitter of the two loops; of the haptic one by the wall clock, where it keeps that.
std::string vision_lines(const trial::TrialResult& result) {
  const trial::FrameTimes& vision = result.vision;
  if (vision.frames == 0) return "";
  if (vision.intervals.empty()) return "vision      1 frame: too few for a rate\n";
  const auto ms = [](const std::vector<double>& s) { return text_of(percentiles_of(s), 1e3, 1, 1); };
  return fmt::format("vision      {:.2f} frames/s {}; from frame to frame {} ms; old when told {} ms\n",
                     vision.rate(), vision.threaded ? "in a thread of its own" : "within the loop",
                     ms(vision.intervals), ms(vision.ages));
}

}  // namespace

std::string speed_text(double simulated, double wall) {
  const double speed = wall > 0.0 ? simulated / wall : 0.0;
  return speed < 10.0 ? fmt::format("{:.2g}", speed) : fmt::format("{:.0f}", speed);
}

std::string run_text(const RunReport& r) {
  std::string text =
      r.setup.scene.title + "\n" + made_line(r) + parts_text(r.setup) + devices_text(r.result.devices);
  text += fmt::format("modes       {}; {}\n", modes_line(r.result), counted(r.result.contacts, "contact"));
  text += hold_lines(r.result);
  if (r.result.withheld > 0)
    text += fmt::format("dry         {} {} withheld from the machine; --armed sends them\n",
                        counted(r.result.withheld, "command"), r.result.withheld == 1 ? "was" : "were");
  for (const trial::LostLink& link : r.result.links)
    text += fmt::format("link        {} {} at {:.3f} s\n", link.role,
                        link.by_hand ? "stopped by hand" : "lost", seconds(link.t.time_since_epoch()));
  for (const std::string& line : r.result.log) text += "log         " + line + "\n";
  text += loop_line(r.result);
  text += late_line(r.result);
  if (r.result.interrupted) text += "stopped     by a signal or by q, before its end\n";
  text += weak_text(r.setup, r.scene);
  text += stability_lines(r.certificates);
  for (const trial::Certified& one : r.certificates)
    if (one.beyond()) text += "beyond      " + trial::refusal_text(r.setup, one) + "\n";
  for (const trial::ArmStrength& at : r.strengths)
    if (const std::string beyond = trial::beyond_text(at); !beyond.empty())
      text += "beyond      " + beyond + "\n";
  text += press_lines(r) + push_lines(r) + pushed_lines(r) + travel_lines(r);
  text += finger_lines(r);
  if (!r.scene.impedance()) text += passivity_line(r);
  text += ledger_line(r);
  if (r.result.contacts == 0 && r.setup.scene.user && !r.whole)
    text += fmt::format("note        the user has not touched anything yet; last notice of the core: {}\n",
                        r.result.last_why == 0 ? "none" : why_text(r.result.last_why));
  for (const std::string& line : r.crossed) text += "LIMIT       " + line + "\n";
  text += questionnaire_text(r.setup);
  text += vision_lines(r.result);
  text += fmt::format("tick        step() {} us\n", text_of(percentiles_of(r.result.step_ns), 1e-3, 2, 1));
  text += fmt::format(
      "time        {:.2f} s simulated in {:.3f} s: {} x real time; started in {:.0f} ms, {:.0f} MiB\n",
      r.result.simulated, r.result.wall, speed_text(r.result.simulated, r.result.wall), r.started * 1e3,
      peak_memory_mb());
  text += fmt::format("state hash  {:016x} after {}\n", r.result.hash, counted(r.result.ticks, "tick"));
  return text;
}

}  // namespace enc::app
