// A case of `bench extremes`: a whole trial with an abnormal condition, and the criterion that it must meet.
// A small judge of both machines checks every tick, independent of the status of core and devices.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/kit/kit.h"
#include "trial/trial.h"

namespace enc::bench::extremes {

class Judge {
 public:
  bool unsound = false;  // mutant: one tick is infinite
  void see(const trial::Glance& glance);

  // Number of ticks with a violation, and the first violation.
  [[nodiscard]] std::int64_t broken() const { return broken_; }
  [[nodiscard]] const std::string& first() const { return first_; }

  // The commands of the run, measured.
  double fastest = 0.0, hardest = 0.0;  // hexapod only, m/s and m/s^2
  double force = 0.0;                   // arm only, in addition to its weight, N
  double touch = 0.0;                   // true contact force of tool and tip, N
  double condition = 0.0;               // hexapod only: condition of its Jacobian
  double dexterity = 1.0;               // arm only: its least dexterity in the run
  std::int64_t held = 0, ticks = 0;     // ticks
  std::uint32_t reasons = 0;            // of all holds

 private:
  void judge_time(const trial::Glance& glance);
  void judge_numbers(const trial::Glance& glance);
  void judge_machine(const trial::Glance& glance);
  void judge_arm(const trial::Glance& glance, const Impedance& law);
  void wrong(const trial::Glance& glance, const std::string& what);

  bool told_ = false;  // a machine has received a command
  Vec3 at_{0, 0, 0}, velocity_{0, 0, 0};
  std::int64_t index_ = -1, over_ = 0, broken_ = 0;
  Time truth_{};
  bool wrong_now_ = false;
  std::string first_;
};

inline constexpr double kInfinite = HUGE_VAL;

// A measured number with the bounds that are the criterion; without bounds it is informative only.
struct Number {
  std::string what;  // last tokens of its id, after those of the case
  double value = kUnset;
  const char* unit = "";
  Bounds bounds{};
  std::string note{};
  double wanted = kUnset;  // a criterion that physics does not allow: the difference is reported; no bound
  bool cost = false;       // Figure::cost
};

struct CaseResult {
  std::string did, criterion;  // the table's text: the action and the criterion
  std::vector<Number> numbers{};
  double simulated = 0.0;  // s
  std::string words{};     // beside the verdict, such as a physical limit
};

[[nodiscard]] inline double time_of(const trial::Glance& glance) {  // s
  return seconds(glance.tick.t.time_since_epoch());
}

struct Case {
  std::string id;  // tokens between the benchmark's name and those of a number
  std::function<CaseResult(const BenchContext&)> run;
};
using Cases = std::vector<Case>;

// A run with a judge, which takes the trial's hook `watch`; `also` is an additional observer.
struct Run {
  trial::TrialResult result;
  Judge judge;
};
[[nodiscard]] Run judged(const BenchContext& context, const models::Setup& setup, trial::TrialOptions options,
                         const std::function<void(const trial::Glance&)>& also = {});
// Adds the number that every case reports of its runs: ticks on which the judge found a violation, and one
// for a warning of the engine.
void add_soundness(const Run& run, CaseResult& found);

// The tables of cases, one for each file.
void add_walls(Cases& cases);
void add_touches(Cases& cases);
void add_inputs(Cases& cases, bool full);
void add_links(Cases& cases);
void add_places(Cases& cases);
void add_refusals(Cases& cases);
void add_soaks(Cases& cases, const BenchContext& with);
// Hours of both machines, one after the other because memory is measured for the whole program.
// Runs them immediately and adds them to `cases` and `found`.
void add_long(Bench& bench, Cases& cases, std::vector<CaseResult>& found);
// Force over the stiffness of the arm's walls.
void add_wall_plot(Bench& bench, const Cases& cases, const std::vector<CaseResult>& found);

}  // namespace enc::bench::extremes
