// Does the energy of every contact add up, in every scene that ships?
#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/kit/kit.h"
#include "trial/ledger/ledger_measure.h"

namespace enc::bench::ledger {
namespace {

// Those in which something is rendered.
constexpr std::array kScenes{"reaching",    "wall",       "session",     "training",     "stiffness",
                             "tennis_ball", "button",     "hit_ball",    "drum",         "keypad",
                             "room",        "tiles",      "indentation", "offset_press", "hare",
                             "plane",       "push_limit", "synchrony",   "two_objects"};
constexpr double kSmallest = 0.05e-3;  // J: what a tenth of a newton does over half a millimetre

struct Sums {
  std::string scene;
  std::size_t contacts = 0, small = 0;
  double closure = 0.0, small_closure = 0.0;  // shares: of those above kSmallest, and of the others
  // J: what sampling, delay, counts and limits gave out beyond what the law's damper took; of an arm, the
  // worst of the contacts on which something pushed.
  double net = kUnset;
  trial::ContactLedger all;
  double simulated = 0.0;
};

Sums sums_of(const models::Setup& setup, std::uint64_t seed, const std::string& scene) {
  Sums sums;
  sums.scene = scene;
  trial::TrialOptions options;
  trial::LedgerMeasure measure(setup, options);
  options.seed = seed;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  trial::Trial trial(setup, options);
  sums.simulated = trial.run().simulated;
  for (const trial::ContactLedger& one : measure.contacts()) {
    ++sums.contacts;
    const bool small = one.largest() < kSmallest;
    sums.small += small ? 1 : 0;
    double& worst = small ? sums.small_closure : sums.closure;
    worst = std::max(worst, one.closure());
    if (setup.scene.arm && one.hand != 0.0) sums.net = std::fmax(sums.net, one.generated() - one.law);
    using C = trial::ContactLedger;
    for (double C::*term : {&C::hand, &C::carried, &C::kinetic, &C::spring, &C::weight, &C::joints, &C::law,
                            &C::sampling, &C::delay, &C::quantisation, &C::limits})
      sums.all.*term += one.*term;
  }
  return sums;
}

std::string mj(double joules) { return fmt::format("{:.3f}", joules * 1e3); }

void run(Bench& bench) {
  std::vector<std::string> scenes(kScenes.begin(), kScenes.end());
  if (bench.context.quick) scenes = {"button", "tennis_ball"};
  const std::vector<Sums> all = bench.each(scenes, [&](const std::string& scene) {
    return sums_of(load_scene(bench.context, scene), bench.context.seed, scene);
  });
  Table table{"scenes",
              "Energy of all contacts of a scene, mJ",
              {"scene", "contacts", "hand", "carried", "sampling", "delay", "quantisation", "limits",
               "stored", "dissipated", "closes, %", "small ones", "close, %"},
              {}};
  double worst = 0.0, small = 0.0;
  for (const Sums& s : all) {
    const trial::ContactLedger& c = s.all;
    table.rows.push_back({s.scene, fmt::format("{}", s.contacts), mj(c.hand), mj(c.carried), mj(c.sampling),
                          mj(c.delay), mj(c.quantisation), mj(c.limits), mj(c.stored()), mj(c.dissipated()),
                          fmt::format("{:.3f}", 100.0 * s.closure), fmt::format("{}", s.small),
                          fmt::format("{:.3f}", 100.0 * s.small_closure)});
    bench.figure("closure." + s.scene + ".worst", 100.0 * s.closure, "%", at_most(1.0),
                 fmt::format("of the largest term, {} contacts above 0.05 mJ", s.contacts - s.small));
    if (std::isfinite(s.net))
      bench.figure(
          "net." + s.scene + ".worst", 1e3 * s.net, "mJ", at_most(0.1),
          "what sampling, delay and counts gave out, less what the law's damper took, in any contact on "
          "which a finger pushed, across the surface and along its normal");
    worst = std::max(worst, s.closure);
    small = std::max(small, s.small_closure);
  }
  bench.figure("closure.worst", 100.0 * worst, "%", at_most(1.0));
  bench.figure(
      "closure.small.worst", 100.0 * small, "%", at_most(1.0),
      "contacts whose largest term is below 0.05 mJ: where a tip rests, friction turns within a step");
  bench.table(std::move(table));
}

const Entry kEntry{"ledger", "wall", "the energy of each contact adds up, in every scene", run};

}  // namespace
}  // namespace enc::bench::ledger
