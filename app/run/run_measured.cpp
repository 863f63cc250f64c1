// A run's measurements of its task: the lines of the report and the keys of the JSON.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/built.h"
#include "app/run/run_report.h"
#include "core/base/units.h"
#include "core/base/words.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;  // prints NaN as null
using trial::FingerEncounter;
using trial::PassivityFigures;
using trial::PressFigures;
using trial::PushFigures;

template <class T, class Is>
std::vector<T> those_of(const std::vector<T>& all, const Is& is) {
  std::vector<T> some;
  std::copy_if(all.begin(), all.end(), std::back_inserter(some), is);
  return some;
}

template <class T>
Json list_of(const std::vector<T>& things, Json (*json_of)(const T&)) {
  Json list = Json::array();
  for (const T& thing : things) list.push_back(json_of(thing));
  return list;
}

// Joins one number of each entry of a JSON list for the report: "0.53 / 0.55".
std::string each(const Json& list, const char* key, int digits, const char* unknown = "nan") {
  std::string text;
  for (const Json& one : list) {
    const auto number = one.at(key).get<double>();
    text += text.empty() ? "" : " / ";
    text += std::isnan(number) ? unknown : fmt::format("{:.{}f}", number, digits);
  }
  return text;
}

// ---- the passivity controller and the energy balance

Json passivity_json(const PassivityFigures& c) {
  return {{"contact", c.contact},
          {"began_s", c.began},
          {"given_mJ", c.given * 1e3},
          {"taken_mJ", c.dissipated * 1e3},  // null: the controller holds back the tip, not a force
          {"taken_N", c.most},
          {"acted_ms", c.acted * kMsPerS}};
}

std::string passivity_line(const RunReport& r) {
  if (!trial::controlled(r.scene)) return "";
  const auto& contacts = r.measured.passivity.contacts();
  if (contacts.empty()) return "passivity   controlled; there was no contact to control\n";
  const MachineWords& words = words_of(r.setup.scene);
  const PassivityFigures all = r.measured.passivity.worst();
  const bool reduced = !std::isnan(all.dissipated);  // the controller reduces forces, not the tip's motion
  const auto acted =
      std::count_if(contacts.begin(), contacts.end(), [](const auto& c) { return c.acted > 0.0; });
  const std::string of = counted(contacts.size(), "contact");
  std::string text =
      acted == 0
          ? fmt::format("passivity   the controller left the law's {} as it is, in all of {}", words.law, of)
          : fmt::format("passivity   the controller held the {} back in {} of {}: for {:.0f} ms in all",
                        words.held_back, acted, of, all.acted * kMsPerS);
  if (acted > 0 && reduced)
    text += fmt::format(", by at most {:.2f} N, which kept {:.3f} mJ from coming out", all.most,
                        all.dissipated * 1e3);
  text +=
      fmt::format("; of one contact at most {:.3f} mJ more came out than went in along the normal (by {})\n",
                  all.given * 1e3, words.energy_by);
  // The controller counts the work of each commanded force, but a withheld force does no work.
  if (reduced && r.result.withheld > 0)
    text +=
        "  dry       no force was sent, and the controller takes each for sent: armed it holds back other "
        "ones\n";
  return text;
}

Json ledger_json(const trial::ContactLedger& c) {
  Json one{{"contact", c.contact}, {"object", c.object}, {"rendered", c.rendered}};
  for (const trial::LedgerTerm& term : trial::ledger_terms()) one[term.name] = term.of(c);
  return one;
}

// The contact with the largest term, and how well the balances of all contacts close
// (docs/reference/ledger.md).
std::string ledger_line(const RunReport& r) {
  const std::vector<trial::ContactLedger> all = r.measured.ledger.contacts();
  if (all.empty())
    return r.result.contacts > 0 && r.scene.indentation()
               ? "ledger      nothing rendered: a real object is pressed\n"
               : "";
  const auto most = std::max_element(all.begin(), all.end(),
                                     [](const auto& a, const auto& b) { return a.largest() < b.largest(); });
  const auto up = [](double x, double parts) { return std::ceil(x * parts) / parts; };
  double worst = 0.0;
  for (const trial::ContactLedger& one : all) worst = std::max(worst, one.closure());
  return fmt::format(
      "ledger      contact {}{}: hand {:.2f} + carried {:.2f} + generated {:.2f} = stored {:.2f} + "
      "dissipated {:.2f} mJ; {} close{} within {:.2f} %; at most {:.3f} mJ out beyond what was put in\n",
      most->contact, most->rendered ? "" : " (nothing rendered)", most->hand * 1e3, most->carried * 1e3,
      most->generated() * 1e3, most->stored() * 1e3, most->dissipated() * 1e3, all.size(),
      all.size() == 1 ? "s" : "", up(worst * 100.0, 1e2), up(trial::worst_surplus(all) * 1e3, 1e3));
}

// ---- presses of a hand on a hexapod

std::vector<PressFigures> met_presses(const RunReport& r) {
  return those_of(r.measured.presses.presses(), [](const PressFigures& p) { return !std::isnan(p.miss); });
}

Json press_json(const PressFigures& p) {
  return {{"approach_mm_s", p.approach_speed * kMmPerM},
          {"miss_mm", p.miss * kMmPerM},
          {"miss_bound_mm", p.miss_bound * kMmPerM},
          {"first_force_delay_ms", p.first_force_delay * kMsPerS},
          {"contacts", p.contacts},
          {"peak_force_N", p.peak_force},
          {"force_at_limit_N", p.force_at_limit},
          {"limit_mm", p.limit * kMmPerM},
          {"object", p.object},
          {"peak_deflection_mm", p.peak_deflection * kMmPerM}};
}

// The force range of the presses that reached the limit, and their number.
std::string at_limit_text(const std::vector<PressFigures>& met) {
  const auto reached = those_of(met, [](const PressFigures& p) { return !std::isnan(p.force_at_limit); });
  if (reached.empty()) return "limit not reached";
  const auto [low, high] =
      std::minmax_element(reached.begin(), reached.end(),
                          [](const auto& a, const auto& b) { return a.force_at_limit < b.force_at_limit; });
  return (reached.size() == 1 ? fmt::format("{:.2f}", low->force_at_limit)
                              : fmt::format("{:.2f}..{:.2f}", low->force_at_limit, high->force_at_limit)) +
         " N at the limit" +
         (reached.size() < met.size()
              ? fmt::format(" in {} of {}", reached.size(), counted(met.size(), "press"))
              : "");
}

// Looks like "limit 6 mm"; if the presses had several limits, each with its object.
std::string limit_text(const RunReport& r) {
  std::vector<std::pair<std::int32_t, double>> limits;
  for (const PressFigures& press : r.measured.presses.presses())
    if (press.object >= 0 &&
        std::find(limits.begin(), limits.end(), std::pair(press.object, press.limit)) == limits.end())
      limits.emplace_back(press.object, press.limit);
  const auto millimetres = [](double limit) { return std::round(limit * 1e9) * 1e-6; };
  if (limits.empty()) return "no contact";
  if (limits.size() == 1) return fmt::format("limit {:g} mm", millimetres(limits.front().second));
  const bool one_object = std::all_of(limits.begin(), limits.end(),
                                      [&](const auto& l) { return l.first == limits.front().first; });
  std::string text = "limits";
  for (const auto& [object, limit] : limits)
    text += fmt::format(
        "{} {:g} mm{}", text == "limits" ? "" : ",", millimetres(limit),
        one_object ? ""
                   : fmt::format(" ('{}')", r.setup.scene.objects[static_cast<std::size_t>(object)].name));
  return text;
}

std::string outside_text(double outside) {
  if (std::isnan(outside)) return "tip         was never inside of an object";
  return fmt::format("tip         {} {:.1f} um",
                     outside <= 0.0 ? "inside of the undeformed object by at least"
                                    : "OUTSIDE of the undeformed object by up to",
                     std::abs(outside) * kUmPerM);
}

double peak_of(const std::vector<PressFigures>& presses, double PressFigures::*figure) {
  double most = 0.0;
  for (const PressFigures& press : presses) most = std::max(most, press.*figure);
  return most;
}

std::string press_text(const RunReport& r) {
  if (!r.measured.felt.truth)
    return fmt::format(
        "felt        peak {:.2f} N, {:.3f} mm deep, as the core knows them; what needs the truth is left "
        "out, because not every device is simulated\n",
        r.measured.felt.peak, kMmPerM * r.measured.felt.deepest);
  const trial::PressMeasure& all = r.measured.presses;
  const std::vector<PressFigures> met = met_presses(r);
  const Json list = list_of(met, press_json);
  if (met.empty()) return "";
  const auto newtons = [](double x) {
    return std::isnan(x) ? std::string("none") : fmt::format("{:.3f} N", x);
  };
  const bool exceeded =
      std::any_of(met.begin(), met.end(), [](const PressFigures& p) { return p.miss > p.miss_bound; });
  return fmt::format("force       peak {:.2f} N, {} (true); deflection peak {:.3f} mm (true), {}\n",
                     peak_of(all.presses(), &PressFigures::peak_force), at_limit_text(met),
                     peak_of(all.presses(), &PressFigures::peak_deflection) * kMmPerM, limit_text(r)) +
         fmt::format(
             "error       press {} RMSE, release {} RMSE (true force against the response at true "
             "deflection)\n",
             newtons(all.rmse_press()), newtons(all.rmse_release())) +
         fmt::format(
             "approach    {} mm/s\n"
             "  miss      {} mm (true tool tip to haptic-tip at first touch)\n"
             "  bound     {} mm{}\n"
             "  contacts  {}\n",
             each(list, "approach_mm_s", 0), each(list, "miss_mm", 2), each(list, "miss_bound_mm", 2),
             exceeded ? "  EXCEEDED" : "", each(list, "contacts", 0)) +
         fmt::format("energy      {:.2f} mJ in, {:.2f} mJ out\n", all.energy_in() * 1e3,
                     all.energy_out() * 1e3) +
         outside_text(all.greatest_outside()) +
         fmt::format("; pull on the tool at most {:.3f} N\n", all.greatest_tension());
}

Json press_totals(const RunReport& r) {
  const trial::PressMeasure& all = r.measured.presses;
  return {{"rmse_press_N", all.rmse_press()},
          {"rmse_release_N", all.rmse_release()},
          {"energy_in_mJ", all.energy_in() * 1e3},
          {"energy_out_mJ", all.energy_out() * 1e3},
          {"tip_outside_um", all.greatest_outside() * kUmPerM},
          {"tension_N", all.greatest_tension()}};
}

// A pusher has no tool: it cannot miss, and has no speed at the touch.
std::string pushed_line(const RunReport& r) {
  if (!r.setup.scene.pusher || !r.measured.felt.truth) return "";
  const auto& pushes = r.measured.presses.presses();
  return fmt::format("pushed      {} of {} from outside; at most {:.2f} N and {:.3f} mm deep (true)\n",
                     pushes.size(), counted(r.setup.scene.pusher->repeats, "time"),
                     peak_of(pushes, &PressFigures::peak_force),
                     peak_of(pushes, &PressFigures::peak_deflection) * kMmPerM);
}

// ---- pushes of the test rig

Json push_json(const PushFigures& p) {
  return {{"peak_force_N", p.peak_force},
          {"peak_deflection_mm", p.peak_deflection * kMmPerM},
          {"work_in_mJ", p.work_in * 1e3},
          {"work_out_mJ", p.work_out * 1e3},
          {"loss_percent", p.loss() * 100.0}};
}

std::string push_text(const RunReport& r) {
  if (!r.scene.indentation()) return "";
  const auto& pushes = r.measured.pushes.pushes();
  const std::string asked = fmt::format(
      "pushes      {} of {}; {:g} mm deep at {:g} mm/s\n", pushes.size(), r.scene.indentation()->repeats,
      r.scene.indentation()->depth * kMmPerM, r.scene.indentation()->speed * kMmPerM);
  if (pushes.empty())
    return asked + fmt::format("note        the machine never pushed; {}\n", last_notice(r.result));
  const Json list = list_of(pushes, push_json);
  return asked +
         fmt::format("  peak      {} N (measured)\n  reached   {} mm\n  loss      {} % of the work\n",
                     each(list, "peak_force_N", 2), each(list, "peak_deflection_mm", 3),
                     each(list, "loss_percent", 1)) +
         (pushes.size() > 1
              ? fmt::format("repeats     within {:.3f} N at equal deflection\n", r.measured.pushes.spread())
              : "") +
         fmt::format("error       at most {:.3f} N (measured force against the true one)\n",
                     r.measured.pushes.force_error());
}

// ---- tracking test: the machine carries a clamped tool [VHMR 4.1, Table 1]

struct TravelAxis {
  std::string axis;
  trial::ErrorSum stops, moving;
  [[nodiscard]] std::int64_t packets() const { return stops.size() + moving.size(); }
};
std::array<TravelAxis, 3> travel_axes(const trial::TravelSums& sums) {
  std::array<TravelAxis, 3> axes;
  for (std::size_t i = 0; i < 3; ++i) {
    axes[i] = {std::string(1, "xyz"[i]), sums.stopped[i], sums.forward[i]};
    axes[i].moving.add(sums.back[i]);
  }
  return axes;
}

Json travel_json(const RunReport& r) {
  Json all = Json::array();
  for (const TravelAxis& one : travel_axes(r.measured.travel.sums()))
    if (one.packets() > 0)
      all.push_back({{"axis", one.axis},
                     {"stops_rms_mm", one.stops.errors().rmse * kMmPerM},
                     {"moving_rms_mm", one.moving.errors().rmse * kMmPerM},
                     {"packets", one.packets()}});
  return all;
}

// Root mean square for each axis of W with motion: "0.107 / 0.094 / 0.083 mm, norm 0.165 mm".
std::string axes_text(const std::array<TravelAxis, 3>& axes, trial::ErrorSum TravelAxis::*of) {
  std::string text;
  double square = 0.0;
  for (const TravelAxis& axis : axes) {
    const double rmse = (axis.*of).errors().rmse;
    square += rmse * rmse;
    text += (text.empty() ? "" : " / ") +
            ((axis.*of).size() == 0 ? std::string("-") : fmt::format("{:.3f}", rmse * kMmPerM));
  }
  return text +
         (std::isnan(square) ? " mm" : fmt::format(" mm, norm {:.3f} mm", std::sqrt(square) * kMmPerM));
}

std::string travel_text(const RunReport& r) {
  if (r.scene.tracking() == nullptr) return "";
  const trial::TravelSums& sums = r.measured.travel.sums();
  if (sums.size() == 0) return "tracking    not measured: the tracker reported no tool on the way\n";
  const std::array<TravelAxis, 3> axes = travel_axes(sums);
  return fmt::format(
      "tracking    error along each travelled axis of W, rms, x / y / z: tracked tool tip less where the "
      "machine says it is; {}\n"
      "  stops     {}\n"
      "  moving    {}, at {:g} mm/s\n"
      "  largest   {:.3f} mm, of any packet and direction\n",
      counted(sums.size(), "packet"), axes_text(axes, &TravelAxis::stops),
      axes_text(axes, &TravelAxis::moving), std::round(r.setup.scene.travel->speed * 1e6) * 1e-3,
      sums.largest * kMmPerM);
}

// ---- a bare finger that touches an arm [VisHap 3]

Json meeting_json(const FingerEncounter& m) {
  return {{"object", m.object},
          {"prepared_s", m.prepared},
          {"arrived_s", m.arrived},
          {"touched_s", m.touched},
          {"approach_mm_s", m.approach_speed * kMmPerM},
          {"miss_mm", m.miss * kMmPerM},
          {"peak_N", m.peak_force},
          {"depth_mm", m.peak_depth * kMmPerM},
          {"step_N", m.greatest_step}};
}

// The wall's measured spring, if the user presses one.
std::string spring_line(const RunReport& r) {
  const std::optional<UserSpec>& user = r.setup.scene.user;
  if (!user || user->kind != UserKind::press_release) return "";
  const Object& pressed = r.scene.objects[pressed_object(r.setup.scene.objects, user->object, "user")];
  if (pressed.interaction.kind != Interaction::slide) return "";
  const trial::LineFit &fit = r.measured.fingers.fit(), &believed = r.measured.fingers.believed();
  if (!std::isfinite(fit.r2())) return "spring      not measured: the finger was never 2 to 10 mm deep\n";
  return fmt::format(
      "spring      {:.1f} N/m, R2 {:.5f} (true contact force over true depth, 2 to 10 mm); wanted {:.1f} "
      "N/m; R2 {:.5f} over the depth that the core believed\n",
      fit.slope(), fit.r2(), pressed.stiffness, believed.r2());
}

Json seen_json(const trial::SeenPress& press) {
  return {{"from_s", press.began}, {"poses", press.n}, {"above_mm", press.mean * kMmPerM}};
}

// The finger's offset from the prop during a press, as vision sees it.
std::string seen_line(const RunReport& r) {
  const std::vector<trial::SeenPress> presses = r.measured.seen.presses();
  if (presses.empty()) return "";
  std::string each;
  for (const trial::SeenPress& press : presses)
    each += fmt::format("{}{:+.2f}", each.empty() ? "" : " / ", press.mean * kMmPerM);
  const bool all = r.measured.seen.shift().ways == 3;
  return fmt::format(
      "seen        {} mm above the prop that it pushed (by vision and encoders, a press each){}\n", each,
      all ? ""
          : fmt::format("; a {} that has moved along the surface would not show in it",
                        r.setup.scene.camera ? "camera" : "tracker"));
}

std::string finger_text(const RunReport& r) {
  const auto& meetings = r.measured.fingers.meetings();
  const auto touched = those_of(meetings, [](const FingerEncounter& m) { return !std::isnan(m.touched); });
  const std::string prepared =
      fmt::format("far         tip speed at most {:.3f} mm/s\nprepare     {}, {} followed by a touch\n",
                  r.measured.fingers.far_speed() * kMmPerM, counted(meetings.size(), "time"), touched.size());
  if (touched.empty()) return prepared;
  const Json list = list_of(touched, meeting_json);
  std::string there;
  for (const FingerEncounter& m : touched)
    there += (there.empty() ? "" : " / ") +
             (std::isnan(m.arrived) ? "not" : fmt::format("{:.0f}", (m.touched - m.arrived) * kMsPerS));
  const bool deep = std::any_of(meetings.begin(), meetings.end(),
                                [](const FingerEncounter& m) { return m.peak_depth > 0.0; });
  const double sideways = r.measured.fingers.tangential_share();
  return prepared +
         fmt::format(
             "approach    {} mm/s (planned, of the first touch after each prepare)\n"
             "  there     {} ms before the touch\n"
             "  miss      {} mm (along the surface, true finger to the middle of the prop, at the touch)\n"
             "  peak      {} N (greatest until the next prepare, as the next two)\n"
             "{}  step      {} N, greatest from one cycle to the next\n",
             each(list, "approach_mm_s", 0), there, each(list, "miss_mm", 2), each(list, "peak_N", 2),
             deep ? fmt::format("  depth     {} mm (true)\n", each(list, "depth_mm", 2, "not known")) : "",
             each(list, "step_N", 2)) +
         spring_line(r) + seen_line(r) + passivity_line(r) +
         (std::isfinite(sideways)
              ? fmt::format("sideways    {:.1f} % of the normal force, where that is more than 1 N\n",
                            100.0 * sideways)
              : "sideways    not measured: never more than 1 N along the normal\n");
}

// ---- both machines

// The parts of the report that one machine alone has; indexed by MachineWords::row.
struct MachineReport {
  std::string (*first)(const RunReport&);
  std::string (*last)(const RunReport&);
  Json (*touches)(const RunReport&);
  Json (*totals)(const RunReport&);
};
constexpr std::array<MachineReport, 2> kReports{
    {{press_text, passivity_line,
      [](const RunReport& r) {
        return Json::object({{"presses", list_of(met_presses(r), press_json)}});
      },
      press_totals},
     {[](const RunReport&) { return std::string(); }, finger_text,
      [](const RunReport& r) {
        return Json::object({{"meetings", list_of(r.measured.fingers.meetings(), meeting_json)},
                             {"seen", list_of(r.measured.seen.presses(), seen_json)}});
      },
      [](const RunReport&) { return Json::object(); }}}};

const MachineReport& machine_of(const RunReport& r) { return kReports.at(words_of(r.setup.scene).row); }

}  // namespace

std::string measured_text(const RunReport& r) {
  return machine_of(r).first(r) + push_text(r) + pushed_line(r) + travel_text(r) + machine_of(r).last(r) +
         ledger_line(r);
}

Json measured_json(const RunReport& r) {
  Json json = machine_of(r).touches(r);
  if (trial::controlled(r.scene))
    json["passivity"] = list_of(r.measured.passivity.contacts(), passivity_json);
  json["ledger"] = list_of(r.measured.ledger.contacts(), ledger_json);
  if (r.scene.indentation()) {
    json["pushes"] = list_of(r.measured.pushes.pushes(), push_json);
    json["repeats_within_N"] = r.measured.pushes.spread();
    json["force_error_N"] = r.measured.pushes.force_error();
  }
  if (r.scene.tracking() != nullptr) json["tracking"] = travel_json(r);
  json.update(machine_of(r).totals(r));
  return json;
}

Json list_forms() {
  const auto one = [](Json form) { return Json::array({std::move(form)}); };
  return {{"presses", one(press_json({}))},
          {"meetings", one(meeting_json({}))},
          {"seen", one(seen_json({}))},
          {"passivity", one(passivity_json({}))},
          {"ledger", one(ledger_json({}))},
          {"pushes", one(push_json({}))},
          {"tracking", one({{"axis", "x"}, {"stops_rms_mm", 0}, {"moving_rms_mm", 0}, {"packets", 0}})}};
}

}  // namespace enc::app
