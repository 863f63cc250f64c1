// Closure of the energy balance of every contact in every scene that ships; and the surplus of energy out
// over energy in, with the passivity controller and without.
#include "trial/ledger/ledger.h"

#include <algorithm>
#include <array>
#include <optional>

#include <fmt/format.h>

#include "benchmarks/kit/entry.h"
#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/precision.h"
#include "core/base/error.h"
#include "trial/family.h"

namespace enc::bench::ledger {
namespace {

// J: the work of 0.1 N over 0.5 mm. Contacts whose largest term is smaller are judged by themselves.
constexpr double kSmallest = 0.05e-3;

using C = trial::ContactLedger;

// Error against run time: the energies of a press, each term summed over the contacts.

constexpr double C::*kTerms[] = {&C::hand,   &C::carried,      &C::kinetic, &C::spring,
                                 &C::weight, &C::joints,       &C::law,     &C::sampling,
                                 &C::delay,  &C::quantisation, &C::limits};
constexpr double kAccuracy = 0.005;  // share of the largest term, chosen: half of the closure's bound

// Adds the terms of a contact to those of others.
void add_terms(const C& one, C& all) {
  for (double C::*term : kTerms) all.*term += one.*term;
}

class Energies final : public trial::Quantities {
 public:
  Energies(const models::Setup& setup, trial::TrialOptions& options) : measure_(setup, options) {}
  void see(const trial::Glance& glance) override { measure_.see(glance); }
  [[nodiscard]] std::vector<double> all() const override {
    C sums;
    for (const C& one : measure_.contacts()) add_terms(one, sums);
    std::vector<double> terms;
    for (double C::*term : kTerms) terms.push_back(sums.*term);
    return terms;
  }

 private:
  trial::LedgerMeasure measure_;
};

// Error against run time: the effect of time step and integrator on the energies of a scene's contacts.
void add_error_over_time(Bench& bench) {
  PrecisionNorm norm{"a contact's energies", "%", 100.0, kAccuracy, {}};
  norm.quantities = [](const models::Setup& setup, trial::TrialOptions& options) {
    return std::make_unique<Energies>(setup, options);
  };
  add_force_precision(bench,
                      {"user.approach_mm_s=[50]", "user.approach_from_mm=20", "user.press_s=0.8",
                       "user.hold_s=0.2", "user.release_s=0.4", "user.rest_s=0.3"},
                      norm);
}

// The scenes that render an object.
constexpr std::array kScenes{"reaching",    "wall",       "session",     "training",     "stiffness",
                             "tennis_ball", "button",     "hit_ball",    "drum",         "keypad",
                             "room",        "tiles",      "indentation", "offset_press", "hare",
                             "plane",       "push_limit", "synchrony",   "two_objects"};
constexpr int kSeeds = 4;

struct Sums {
  std::size_t contacts = 0, small = 0;
  double closure = 0.0, small_closure = 0.0;  // shares: contacts above kSmallest, and the others
  double surplus = 0.0;                       // J, of contacts with a push
  trial::ContactLedger all;                   // the ledger of the first seed
};
// Runs without the passivity controller, and with it; unset if a scene has nothing to control.
struct Pair {
  std::string scene;
  Sums without;
  std::optional<Sums> controlled;
  double simulated = 0.0;  // s
  bool arm = false;
};

void add(const models::Setup& setup, const BenchContext& context, std::uint64_t seed, bool first, Sums& sums,
         double& simulated) {
  trial::TrialOptions options;
  trial::LedgerMeasure measure(setup, options);
  options.seed = seed;
  options.watch = [&](const trial::Glance& glance) { measure.see(glance); };
  trial::Trial trial(setup, options);
  simulated += trial.run().simulated;
  std::vector<trial::ContactLedger> contacts = measure.contacts();
  if (context.mutated("turned_hand"))
    for (trial::ContactLedger& one : contacts) {
      one.surplus += std::max(0.0, one.hand);
      one.hand = -one.hand;
    }
  sums.surplus = std::max(sums.surplus, trial::worst_surplus(contacts));
  for (const trial::ContactLedger& one : contacts) {
    const bool small = one.largest() < kSmallest;
    double& worst = small ? sums.small_closure : sums.closure;
    worst = std::max(worst, one.closure());
    if (!first) continue;
    ++sums.contacts;
    sums.small += small ? 1 : 0;
    add_terms(one, sums.all);
  }
}

// A scene with nothing to control is refused by the key of the controller.
std::optional<models::Setup> with_controller(const BenchContext& context, const std::string& scene,
                                             bool arm) {
  const std::string key = arm ? "rig.arm.passivity" : "rig.admittance.passivity";
  try {
    return load_scene(context, scene, {}, {key + "=controlled"});
  } catch (const Error& e) {
    if (e.key().find("passivity") == std::string::npos) throw;
    return std::nullopt;
  }
}

Pair pair_of(const BenchContext& context, const std::string& scene) {
  Pair pair{scene, {}, {}, 0.0, false};
  const models::Setup without = load_scene(context, scene);
  pair.arm = trial::family_of(without).takes_force;
  const std::optional<models::Setup> controlled = with_controller(context, scene, pair.arm);
  if (controlled) pair.controlled.emplace();
  for (int i = 0; i < (context.quick ? 1 : kSeeds); ++i) {
    const std::uint64_t seed = context.seed + static_cast<std::uint64_t>(i);
    add(without, context, seed, i == 0, pair.without, pair.simulated);
    if (controlled) add(*controlled, context, seed, i == 0, *pair.controlled, pair.simulated);
  }
  return pair;
}

std::string mj(double joules) { return fixed(joules * 1e3, 3); }

std::vector<std::string> row_of(const Pair& pair) {
  const Sums& s = pair.without;
  const trial::ContactLedger& c = s.all;
  return {pair.scene,
          fmt::format("{}", s.contacts),
          mj(c.hand),
          mj(c.carried),
          mj(c.sampling),
          mj(c.delay),
          mj(c.quantisation),
          mj(c.limits),
          mj(c.stored()),
          mj(c.dissipated()),
          fixed(100.0 * s.closure, 3),
          fmt::format("{}", s.small),
          fixed(100.0 * s.small_closure, 3),
          mj(s.surplus),
          pair.controlled ? mj(pair.controlled->surplus) : "nothing"};
}

void judge_scene(Bench& bench, const Pair& pair) {
  bench.figure("closure." + pair.scene + ".worst", 100.0 * pair.without.closure, "%", at_most(1.0),
               "of the largest term, of contacts above 0.05 mJ");
  // In 3 of 1,784 contacts a leaping prop under the finger gives out more: at most 0.22
  // (docs/reference/ledger.md).
  const double most = pair.scene == "reaching" ? 0.25 : 0.1;
  if (pair.controlled)
    bench.figure("surplus." + pair.scene + ".controlled.worst", 1e3 * pair.controlled->surplus, "mJ",
                 at_most(most),
                 "that came out of a contact on which something pushed, at any moment, beyond what went in "
                 "and the law's spring still held");
  bench.figure("surplus." + pair.scene + ".none.worst", 1e3 * pair.without.surplus, "mJ",
               pair.arm ? at_most(0.1) : Bounds{},
               "the same without the passivity controller, which is the default");
}

void run(Bench& bench) {
  std::vector<std::string> scenes(kScenes.begin(), kScenes.end());
  if (bench.context.quick) scenes = {"button", "tennis_ball", "training"};
  const std::vector<Pair> all =
      bench.each(scenes, [&](const std::string& scene) { return pair_of(bench.context, scene); });
  Table table{"scenes",
              "Energy of all contacts of a scene, mJ",
              {"scene", "contacts", "hand", "carried", "sampling", "delay", "quantisation", "limits",
               "stored", "dissipated", "closes, %", "small ones", "close, %", "surplus", "controlled"}};
  double worst = 0.0, small = 0.0, controlled = 0.0;
  for (const Pair& pair : all) {
    table.rows.push_back(row_of(pair));
    judge_scene(bench, pair);
    if (pair.controlled) controlled = std::max(controlled, pair.controlled->closure);
    worst = std::max(worst, pair.without.closure);
    small = std::max(small, pair.without.small_closure);
  }
  bench.figure("closure.worst", 100.0 * worst, "%", at_most(1.0));
  bench.figure(
      "closure.small.worst", 100.0 * small, "%", at_most(1.0),
      "contacts whose largest term is below 0.05 mJ: where a tip rests, friction turns within a step");
  bench.figure("closure.controlled.worst", 100.0 * controlled, "%", at_most(1.5),
               "with the passivity controller, of contacts above 0.05 mJ");
  bench.table(std::move(table));
  add_error_over_time(bench);
}

const Reads kReads{"ledger", {.scenes = {"*"}}};
const Entry kEntry{"ledger", "wall", "the energy of each contact adds up, in every scene", run};

}  // namespace
}  // namespace enc::bench::ledger
