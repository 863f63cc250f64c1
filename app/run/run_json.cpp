#include <encounter_version.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "app/built.h"
#include "app/process.h"
#include "app/run/percentiles.h"
#include "app/run/run_report.h"

namespace enc::app {
namespace {

using Json = nlohmann::ordered_json;

Json number(double x) { return std::isfinite(x) ? Json(x) : Json(nullptr); }

Json meetings_json(const trial::FingerMeasure& measure) {
  Json all = Json::array();
  for (const trial::Meeting& m : measure.meetings())
    all.push_back({{"object", m.object},
                   {"prepared_s", number(m.prepared)},
                   {"arrived_s", number(m.arrived)},
                   {"touched_s", number(m.touched)},
                   {"approach_mm_s", number(m.approach_speed * 1e3)},
                   {"miss_mm", number(m.miss * 1e3)},
                   {"peak_N", m.peak_force},
                   {"depth_mm", number(m.peak_depth * 1e3)},
                   {"step_N", m.greatest_step}});
  return all;
}

Json seen_json(const trial::SeenMeasure& measure) {
  Json all = Json::array();
  for (const trial::SeenPress& press : measure.presses())
    all.push_back({{"from_s", press.began}, {"poses", press.n}, {"above_mm", press.mean * 1e3}});
  return all;
}

Json passivity_json(const trial::PassivityMeasure& measure) {
  Json all = Json::array();
  for (const trial::PassivityFigures& c : measure.contacts())
    all.push_back({{"contact", c.contact},
                   {"began_s", c.began},
                   {"given_mJ", c.given * 1e3},
                   {"taken_mJ", c.dissipated * 1e3},  // NaN is null: of a tip that is held back
                   {"taken_N", c.most},
                   {"acted_ms", c.acted * 1e3}});
  return all;
}

Json ledger_json(const trial::LedgerMeasure& measure) {
  Json all = Json::array();
  for (const trial::ContactLedger& c : measure.contacts()) {
    Json one{{"contact", c.contact}, {"object", c.object}, {"rendered", c.rendered}};
    for (const trial::LedgerTerm& term : trial::ledger_terms()) one[term.name] = term.of(c);
    all.push_back(std::move(one));
  }
  return all;
}

Json presses_json(const trial::PressMeasure& measure) {
  Json list = Json::array();
  for (const trial::PressFigures& p : measure.presses()) {
    if (std::isnan(p.miss)) continue;
    list.push_back({{"approach_mm_s", number(p.approach_speed * 1e3)},
                    {"miss_mm", number(p.miss * 1e3)},
                    {"miss_bound_mm", number(p.miss_bound * 1e3)},
                    {"first_force_delay_ms", number(p.first_force_delay * 1e3)},
                    {"contacts", p.contacts},
                    {"peak_force_N", number(p.peak_force)},
                    {"force_at_limit_N", number(p.force_at_limit)},
                    {"limit_mm", number(p.limit * 1e3)},
                    {"object", p.object},
                    {"peak_deflection_mm", number(p.peak_deflection * 1e3)}});
  }
  return list;
}

Json pushes_json(const trial::ProbeMeasure& measure) {
  Json list = Json::array();
  for (const trial::PushFigures& p : measure.pushes())
    list.push_back({{"peak_force_N", number(p.peak_force)},
                    {"peak_deflection_mm", number(p.peak_deflection * 1e3)},
                    {"work_in_mJ", number(p.work_in * 1e3)},
                    {"work_out_mJ", number(p.work_out * 1e3)},
                    {"loss_percent", number(p.loss() * 100.0)}});
  return list;
}

Json travel_json(const trial::TravelSums& sums) {
  Json all = Json::array();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    trial::ErrorSum moving = sums.forward[axis];
    moving.add(sums.back[axis]);
    if (moving.size() + sums.stopped[axis].size() == 0) continue;
    all.push_back({{"axis", std::string(1, "xyz"[axis])},
                   {"stops_rms_mm", number(sums.stopped[axis].errors().rmse * 1e3)},
                   {"moving_rms_mm", number(moving.errors().rmse * 1e3)},
                   {"packets", sums.stopped[axis].size() + moving.size()}});
  }
  return all;
}

Json rows_json(const std::vector<certificate::Row>& rows) {
  Json all = Json::array();
  for (const certificate::Row& row : rows)
    all.push_back({{"name", row.name},
                   {"from_N_per_m", number(row.low)},
                   {"to_N_per_m", number(row.bound)},
                   {"from_is", word_of(row.side)},
                   {"margin", number(row.margin)},
                   {"applies", row.applies}});
  return all;
}

Json stability_json(const std::vector<trial::Certified>& certificates) {
  Json all = Json::array();
  for (const trial::Certified& one : certificates) {
    const certificate::Certificate& of = one.certificate;
    Json json{{"object", one.object},
              {"class", word_of(of.verdict)},
              {"beyond", one.beyond()},
              {"asked_N_per_m", number(one.asked)},
              {"rows", rows_json(of.rows)}};
    if (one.unknown()) json["missing"] = of.missing;
    if (one.place.finite())
      json["place_mm"] = {one.place.xyz[0] * 1e3, one.place.xyz[1] * 1e3, one.place.xyz[2] * 1e3};
    if (!one.like.empty()) json["bounds_of"] = one.like;
    if (std::isnan(one.ramp)) {
      json["let_go_0.1_mm"] = word_of(of.small.rest);
      json["let_go_1_mm"] = word_of(of.large.rest);
    } else {
      json["swings_mm"] = one.swing * 1e3;
    }
    all.push_back(std::move(json));
  }
  return all;
}

// A percentile that there are too few values for is null.
template <class T>
Json times_json(const std::vector<T>& times, double scale) {
  const Percentiles of = percentiles_of(times);
  return {{"p50", number(of.p50 * scale)},
          {"p99", number(of.p99 * scale)},
          {"p99_9", number(of.p99_9 * scale)},
          {"max", number(of.most * scale)}};
}

Json vision_json(const trial::FrameTimes& vision) {
  return {{"threaded", vision.threaded},
          {"frames", vision.frames},
          {"rate_hz", number(vision.rate())},
          {"interval_ms", times_json(vision.intervals, 1e3)},
          {"age_ms", times_json(vision.ages, 1e3)}};
}

// Of a machine that holds a deflection against a force.
void press_figures(Json& json, const trial::PressMeasure& presses) {
  json["rmse_press_N"] = number(presses.rmse_press());
  json["rmse_release_N"] = number(presses.rmse_release());
  json["energy_in_mJ"] = presses.energy_in() * 1e3;
  json["energy_out_mJ"] = presses.energy_out() * 1e3;
  json["tip_outside_um"] = number(presses.greatest_outside() * 1e6);
  json["tension_N"] = presses.greatest_tension();
}

}  // namespace

namespace {

// What ran: program, scene, rig, and what is asked of them.
void add_origin(Json& json, const RunReport& r) {
  json["encounter"] = ENCOUNTER_VERSION;
  json["commit"] = trial::built_commit().name;
  json["commit_date"] = trial::built_commit().day;
  json["date"] = trial::day_text(r.begun);
  if (r.result.keeps_wall_time) json["started"] = trial::time_text(r.begun);
  json["scene"] = r.setup.scene_path;
  json["rig"] = r.setup.rig_path;
  json["seed"] = r.asked.seed;
  json["set"] = r.asked.set;
  json["for_s"] = r.asked.seconds ? Json(*r.asked.seconds) : Json(nullptr);
  json["title"] = r.setup.scene.title;
}

// What was built, and how the run went.
void add_course(Json& json, const RunReport& r) {
  json["built"] = Json::object();
  json["left_out"] = Json::object();
  for (const Part& part : parts_of(r.setup)) json[part.built ? "built" : "left_out"][part.name] = part.what;
  for (const trial::DeviceWords& device : r.result.devices) json["devices"][device.role] = device.words;
  for (int i = 0; i < kModes; ++i)
    json["modes_s"][std::string(mode_name(static_cast<Mode>(i)))] =
        r.result.mode_time[static_cast<std::size_t>(i)];
  json["contacts"] = r.result.contacts;
  json["holds"] = Json::array();
  for (const auto& [t, why] : r.result.holds)
    json["holds"].push_back({{"time_s", seconds(t.time_since_epoch())}, {"why", why_text(why)}});
  for (const trial::LostLink& link : r.result.links)
    json["lost_links"].push_back(
        {{"role", link.role}, {"time_s", seconds(link.t.time_since_epoch())}, {"by_hand", link.by_hand}});
  if (!r.result.log.empty()) json["log"] = r.result.log;
}

// What its task measured.
void add_measures(Json& json, const RunReport& r) {
  if (r.scene.impedance()) {
    json["meetings"] = meetings_json(r.measured.fingers);
    json["seen"] = seen_json(r.measured.seen);
  } else {
    json["presses"] = presses_json(r.measured.presses);
  }
  if (trial::controlled(r.scene)) json["passivity"] = passivity_json(r.measured.passivity);
  json["ledger"] = ledger_json(r.measured.ledger);
  if (r.scene.probe()) {
    json["pushes"] = pushes_json(r.measured.pushes);
    json["repeats_within_N"] = number(r.measured.pushes.spread());
    json["force_error_N"] = number(r.measured.pushes.force_error());
  }
  if (r.scene.travel() != nullptr) json["tracking"] = travel_json(r.measured.travel.sums());
  if (!r.scene.impedance()) press_figures(json, r.measured.presses);
}

// What it cost, and what of it is to be trusted.
void add_cost(Json& json, const RunReport& r) {
  json["step_ns"] = times_json(r.result.step_ns, 1.0);
  if (!r.result.period_ns.empty()) json["period_ns"] = times_json(r.result.period_ns, 1.0);
  if (r.result.vision.frames > 0) json["vision"] = vision_json(r.result.vision);
  json["stability"] = stability_json(r.certificates);
  if (!r.measured.felt.truth) {
    json["felt_peak_N"] = number(r.measured.felt.peak);
    json["felt_depth_mm"] = number(1e3 * r.measured.felt.deepest);
  }
  if (!r.result.real_time.empty()) json["real_time"] = r.result.real_time;
  json["simulated_s"] = r.result.simulated;
  json["wall_s"] = r.result.wall;
  json["times_real_time"] = number(r.result.simulated / r.result.wall);
  json["withheld_commands"] = r.result.withheld;
  json["missed_cycles"] = r.result.missed;
  json["late_s"] = r.result.lateness.total;
  json["limits_crossed"] = r.crossed;
  json["stopped"] = r.result.interrupted;
  json["ticks"] = r.result.ticks;
  json["diverged_at_tick"] = r.result.diverged_at;
  json["started_cpu_ms"] = r.started * 1e3;
  json["peak_memory_MiB"] = peak_memory_mb();
  json["threads"] = thread_count();
  json["mujoco_elements"] = r.elements;
  json["mujoco_steps"] = r.steps;
  json["unsolved_steps"] = r.unsolved;
  json["libraries"] = mapped_libraries();
  json["state_hash"] = fmt::format("{:016x}", r.result.hash);
}

}  // namespace

std::string run_json(const RunReport& r) {
  Json json;
  add_origin(json, r);
  add_course(json, r);
  add_measures(json, r);
  add_cost(json, r);
  return json.dump(2) + "\n";
}

}  // namespace enc::app
