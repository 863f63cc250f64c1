#include "benchmarks/commands/mutation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "benchmarks/kit/entry.h"
#include "core/base/error.h"
#include "models/schema/wording.h"

namespace enc::bench {
namespace {

bool has_bounds(const Figure& f) { return !f.absent && (std::isfinite(f.low) || std::isfinite(f.high)); }

// The figure of a mutated run is out of its bounds. A figure without a value is red as well, but its bound
// has judged nothing.
bool turned_red(const Figure& f) { return has_bounds(f) && std::isfinite(f.twin) && !f.ok(); }

std::string without_benchmark(const Benchmark& benchmark, const std::string& id) {
  return id.substr(std::string(benchmark.name).size() + 1);
}

// "x.p95" for "x.max": a form with fewer seeds has another statistic of the same figure.
std::string without_statistic(const std::string& id) { return id.substr(0, id.rfind('.')); }

const Figure* figure_of(const BenchResult& result, const std::string& id) {
  const auto at =
      std::find_if(result.figures.begin(), result.figures.end(), [&](const Figure& f) { return f.id == id; });
  return at == result.figures.end() ? nullptr : &*at;
}

class Mutation {
 public:
  Mutation(const Benchmark& benchmark, std::span<const Mutant> mutants, const BenchContext& context,
           const MutationOptions& options)
      : benchmark_(benchmark), mutants_(mutants), context_(context), options_(options) {
    result_.benchmark = benchmark.name;
  }

  MutationResult run() {
    const auto start = std::chrono::steady_clock::now();
    run_clean(Form::quick);
    for (const Mutant& mutant : mutants_)
      if (!clean_.contains(mutant.form)) run_clean(mutant.form);
    for (const Mutant& mutant : mutants_) check(mutant);
    for (const Mutant& mutant : mutants_)
      if (claims_any(mutant)) carry_out(mutant);
    find_unjudged();
    result_.run_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return std::move(result_);
  }

 private:
  [[nodiscard]] BenchContext in_form(Form form) const {
    BenchContext context = context_;
    context.quick = form == Form::quick;
    context.full = form == Form::full;
    return context;
  }

  void say(const std::string& what) const {
    if (options_.say) options_.say(fmt::format("{}: {}", benchmark_.name, what));
  }

  void run_clean(Form form) {
    say("clean");
    const BenchResult& result = clean_[form] = result_of(benchmark_, in_form(form));
    for (const Figure& f : result.figures) {
      if (!has_bounds(f)) continue;
      known_.push_back(without_benchmark(benchmark_, f.id));
      const bool there = std::any_of(result_.bounds.begin(), result_.bounds.end(),
                                     [&](const MutatedBound& b) { return b.clean.id == f.id; });
      if (there || (options_.wanted && !options_.wanted(f))) continue;
      result_.bounds.push_back({f});
      if (!f.ok()) result_.faults.push_back(fmt::format("{} is out of bounds without a mutant", f.id));
    }
  }

  void check(const Mutant& mutant) const {
    const auto refuse = [&](const std::string& why) {
      throw Error(fmt::format("mutant '{}' of {}: {}", mutant.what, benchmark_.name, why));
    };
    if (mutant.set.empty() && mutant.changes.empty())
      refuse("it changes nothing; expected 'set' or 'changes'; add one");
    check_settings(benchmark_, context_.models, mutant.set);
    if (mutant.kills.empty()) refuse("it claims no bound; expected ids in 'kills'; add one");
    for (const std::string& pattern : mutant.kills)
      if (std::none_of(known_.begin(), known_.end(),
                       [&](const std::string& id) { return fits_id(pattern, id); }))
        refuse(fmt::format("unknown bound {}; {}", models::quoted(pattern), models::advice(pattern, known_)));
  }

  [[nodiscard]] bool claims(const Mutant& mutant, const Figure& figure) const {
    const std::string id = without_benchmark(benchmark_, figure.id);
    return std::any_of(mutant.kills.begin(), mutant.kills.end(),
                       [&](const std::string& pattern) { return fits_id(pattern, id); });
  }
  [[nodiscard]] bool claims_any(const Mutant& mutant) const {
    return std::any_of(result_.bounds.begin(), result_.bounds.end(),
                       [&](const MutatedBound& b) { return claims(mutant, b.clean); });
  }

  [[nodiscard]] BenchResult mutated_result(const Mutant& mutant) const {
    BenchContext context = in_form(mutant.form);
    context.set = UserSettings(mutant.set);
    std::set<std::string, std::less<>> unasked(mutant.changes.begin(), mutant.changes.end());
    std::mutex turn;  // any thread of the benchmark may ask
    context.mutation = [&](std::string_view change) {
      const std::lock_guard lock(turn);
      if (const auto at = unasked.find(change); at != unasked.end()) unasked.erase(at);
      return std::find(mutant.changes.begin(), mutant.changes.end(), change) != mutant.changes.end();
    };
    BenchResult result;
    try {
      result = result_of(benchmark_, context);
    } catch (const Error& e) {
      throw Error(fmt::format("mutant '{}' of {} ended it: {}", mutant.what, benchmark_.name, e.what()));
    }
    if (!unasked.empty())
      throw Error(fmt::format("mutant '{}' of {}: the benchmark does not ask for the change {}", mutant.what,
                              benchmark_.name, fmt::join(unasked, ", ")));
    return result;
  }

  void carry_out(const Mutant& mutant) {
    result_.mutants.push_back(mutant.what);
    say(mutant.what);
    const BenchResult mutated = mutated_result(mutant);
    for (MutatedBound& bound : result_.bounds) {
      const Figure* figure = figure_of(mutated, bound.clean.id);
      const bool red = figure != nullptr && turned_red(*figure) && bound.clean.ok();
      if (red && bound.mutant.empty()) {
        bound.mutant = mutant.what;
        bound.value = figure->twin;
      }
      const bool judged = figure_of(clean_.at(mutant.form), bound.clean.id) != nullptr;
      if (!red && judged && claims(mutant, bound.clean))
        result_.faults.push_back(fmt::format(
            "mutant '{}' leaves {} green: {}", mutant.what, bound.clean.id,
            figure == nullptr ? std::string("not measured") : fmt::format("{:.4g}", figure->twin)));
    }
  }

  void find_unjudged() {
    for (const std::string& id : options_.expected)
      if (std::none_of(result_.bounds.begin(), result_.bounds.end(), [&](const MutatedBound& b) {
            return b.clean.id == id || without_statistic(b.clean.id) == without_statistic(id);
          }))
        result_.faults.push_back(fmt::format("{} was not judged: no mutant runs its form", id));
  }

  const Benchmark& benchmark_;
  const std::span<const Mutant> mutants_;
  const BenchContext& context_;
  const MutationOptions& options_;
  MutationResult result_;
  std::map<Form, BenchResult> clean_;
  std::vector<std::string> known_;  // bounds, without the benchmark's name
};

}  // namespace

std::size_t MutationResult::survivors() const {
  return static_cast<std::size_t>(
      std::count_if(bounds.begin(), bounds.end(), [](const MutatedBound& b) { return b.mutant.empty(); }));
}

MutationResult mutate(const Benchmark& benchmark, std::span<const Mutant> mutants,
                      const BenchContext& context, const MutationOptions& options) {
  return Mutation(benchmark, mutants, context, options).run();
}

}  // namespace enc::bench
