// Table 1 over the devices of a rig, real ones or fakes. What the twin of the same rig file says, without
// wires, with the same settings and seeds, stands beside it.
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/over_rig.h"
#include "benchmarks/tracking/table1.h"
#include "core/base/units.h"
#include "trial/assemble/prepare.h"

namespace enc::bench::tracking {
namespace {

// One column of the table.
struct RigTravel {
  int speed;  // mm/s
  OnRig on;
  double length = kUnset;  // s
  TravelErrors rig{}, twin{};
};

RigTravel planned_travel(const BenchContext& context, int speed) {
  std::vector<std::string> own{fmt::format("travel.dwell_s={}", context.full ? "5" : "0.6")};
  if (context.quick) own.emplace_back("travel.axes=\"x\"");
  RigTravel travel{speed, on_rig(context, "tracking", own,
                                 {fmt::format("travel.speed_mm_s={}", speed), "travel.ways=\"one_way\""})};
  travel.length = trial::prepare_setup(travel.on.setup).travel()->duration();
  return travel;
}

void run_travels(Bench& bench, std::vector<RigTravel>& travels) {
  constexpr double kSpare =
      3.0;  // s: a machine that does not stand at its zero has a longer way to the start
  const BenchContext& context = bench.context;
  const std::vector<std::uint64_t> seeds = bench.seeds(context.count(1, 1));
  double done = 0.0, all = 0.0;  // s
  for (const RigTravel& travel : travels) all += travel.length * static_cast<double>(seeds.size());
  for (RigTravel& travel : travels)
    for (const std::uint64_t seed : seeds) {
      const models::Setup& setup = travel.on.setup;
      trial::TrialOptions options = rig_options(context);
      options.watch = [&](const trial::Glance& glance) {
        if (glance.tick.index % 100 != 0) return;
        bench.progress((done + std::min(travel.length, seconds(glance.tick.t.time_since_epoch()))) / all);
      };
      if (attended(context, setup)) {
        options.seconds = travel.length + kSpare;
        tell(fmt::format("encounter: for {:.0f} s the machine travels {:g} mm along {}, at {} mm/s",
                         options.seconds, kMmPerM * setup.scene.travel->stops.back(),
                         setup.scene.travel->axes, travel.speed));
      }
      {
        const std::unique_ptr<Companion> fakes = fakes_of(context, travel.on, seed);
        travel.rig.add(run_travel(setup, seed, false, options));
        refuse_held(travel.rig.held);
      }
      travel.twin.add(run_travel(setup, seed, false, twin_options(context)));
      done += travel.length;
    }
  for (const RigTravel& travel : travels) bench.result.simulated += travel.twin.simulated;
}

// The axes that were travelled, and their norm where all were.
std::vector<std::size_t> table_rows(const std::string& axes) {
  std::vector<std::size_t> rows;
  for (std::size_t a = 0; a < 3; ++a)
    if (axes.find(kTableAxes[a]) != std::string::npos) rows.push_back(a);
  if (rows.size() == 3) rows.push_back(3);
  return rows;
}

// In lockstep two programs are one computation, and only rounding on the wires is between the rig and the
// twin. On the wall clock they take the processor from each other; and what real devices do was promised by
// nobody.
Bounds bounds_of(const BenchContext& context, double twin) {
  constexpr double kShare = 0.1, kStep = 0.01;  // mm
  if (!context.fakes || !context.lockstep) return {};
  return between((1.0 - kShare) * twin - kStep, (1.0 + kShare) * twin + kStep);
}

void add_column(Bench& bench, int speed, const std::vector<std::size_t>& rows, const TravelErrors& rig,
                const TravelErrors& twin, Table& table) {
  const Table1 paper = table1_of(Reference::load(bench.context.models, "table1.csv"));
  const auto s = static_cast<std::size_t>(std::find(kTableSpeeds.begin(), kTableSpeeds.end(), speed) -
                                          kTableSpeeds.begin());
  const Column measured = speed > 0 ? moving_column(rig) : resting_column(rig);
  const Column simulated = speed > 0 ? moving_column(twin) : resting_column(twin);
  // What the fakes stand for was chosen by this table; of a real rig nothing was.
  const Role role = bench.context.fakes ? Role::calibrated : Role::predicted;
  for (const std::size_t a : rows) {
    for (const auto& [name, id, what] : kStatistics)
      bench.figure(fmt::format("rig.{}.{}.{}", id, kTableAxes[a], speed), measured[a].*what * kMmPerM, "mm",
                   Paper{paper[s][a].*what * kMmPerM, role},
                   bounds_of(bench.context, simulated[a].*what * kMmPerM),
                   fmt::format("of the rig; twin without wires {:.4f} mm", simulated[a].*what * kMmPerM));
    table.add(kTableAxes[a], speed, fine_mm(paper[s][a].rmse), fine_mm(measured[a].rmse),
              fine_mm(simulated[a].rmse), fine_mm(paper[s][a].mae), fine_mm(measured[a].mae),
              fine_mm(simulated[a].mae));
  }
}

}  // namespace

void over_rig(Bench& bench) {
  const BenchContext& context = bench.context;
  std::vector<RigTravel> travels;
  for (const int speed : kTableSpeeds)
    if (speed > 0 && (!context.quick || speed == kTableSpeeds.back()))
      travels.push_back(planned_travel(context, speed));
  run_travels(bench, travels);

  Table table{"rig",
              "Table 1 over the devices of a rig",
              {"axis", "speed (mm/s)", "RMSE (mm), paper", "RMSE, rig", "RMSE, twin", "MAE (mm), paper",
               "MAE, rig", "MAE, twin"},
              {}};
  table.printed = true;
  const models::Setup& setup = travels.front().on.setup;
  const std::vector<std::size_t> rows = table_rows(setup.scene.travel->axes);
  TravelErrors rig, twin;
  for (const RigTravel& travel : travels) {
    rig.add(travel.rig);
    twin.add(travel.twin);
  }
  add_column(bench, 0, rows, rig, twin, table);
  for (const RigTravel& travel : travels)
    add_column(bench, travel.speed, rows, travel.rig, travel.twin, table);
  std::string lengths;
  for (const RigTravel& travel : travels)
    lengths += fmt::format("{}{:.1f} s at {} mm/s", lengths.empty() ? "" : ", ", travel.length, travel.speed);
  bench.result.note = fmt::format(
      "Measured over {}: figures are of the rig, not of the twin. A travel takes {}; stops last {:g} s.",
      rig_text(context, setup), lengths, setup.scene.travel->dwell);
  bench.table(std::move(table));
}

}  // namespace enc::bench::tracking
