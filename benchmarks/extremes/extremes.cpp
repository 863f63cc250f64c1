// Extreme cases: each done to a whole trial, with the criterion that it has to meet
// (docs/reference/extremes.md).
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "benchmarks/extremes/case.h"

namespace enc::bench::extremes {
namespace {

bool holds(const Number& n) {
  Figure figure;
  figure.twin = n.value;
  figure.low = n.bounds.low;
  figure.high = n.bounds.high;
  return figure.ok();
}

// What has bounds, but what must be nothing.
std::string measured(const Found& found) {
  std::string text;
  for (const Number& n : found.numbers) {
    const bool none = n.bounds.low == 0.0 && n.bounds.high == 0.0;
    if (none || (std::isnan(n.bounds.low) && std::isnan(n.bounds.high))) continue;
    const std::string what = n.what.substr(0, n.what.find_last_of('.'));
    text += fmt::format("{}{} {:.3g}{}{}", text.empty() ? ": " : ", ", what, n.value,
                        *n.unit == '\0' ? "" : " ", n.unit);
  }
  return text;
}

// "holds", or each number that misses its bounds; STATED where that cannot be otherwise.
std::string verdict_of(const Found& found) {
  std::string missed, stated;
  const auto add = [](std::string& text, const std::string& more) {
    text += (text.empty() ? "" : ", ") + more;
  };
  for (const Number& n : found.numbers) {
    if (!holds(n)) add(missed, fmt::format("{} {:.4g} {}", n.what, n.value, n.unit));
    if (!(n.value > n.wanted)) continue;
    const std::string times = n.wanted > 0.0 ? fmt::format(" ({:.3g} times)", n.value / n.wanted) : "";
    add(stated, fmt::format("{} {:.3g} {} instead of {:g}{}", n.what, n.value, n.unit, n.wanted, times));
  }
  const std::string verdict = !missed.empty()   ? "MISSED: " + missed
                              : !stated.empty() ? "STATED: " + stated
                                                : "holds" + measured(found);
  return found.words.empty() ? verdict : verdict + "; " + found.words;
}

void run(Bench& bench) {
  const bool quick = bench.context.quick;
  Cases cases;
  add_walls(cases, quick);
  add_touches(cases, quick);
  add_inputs(cases, quick);
  add_links(cases, quick);
  add_places(cases, quick);
  add_refusals(cases, quick);
  add_soaks(cases, quick, bench.context.full);
  std::vector<Found> all = bench.each(cases, [&](const Case& one) { return one.run(bench.context); });
  if (!quick) add_long(bench, cases, all);
  Table table{"cases", "Extreme cases", {"case", "what is done", "criterion", "verdict"}};
  double missed = 0.0, stated = 0.0;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    for (const Number& n : all[i].numbers) {
      bench.figure(cases[i].id + "." + n.what, n.value, n.unit, n.bounds, n.note);
      bench.result.figures.back().cost = n.cost;
    }
    const std::string verdict = verdict_of(all[i]);
    missed += verdict.starts_with("MISSED") ? 1.0 : 0.0;
    stated += verdict.starts_with("STATED") ? 1.0 : 0.0;
    table.add(cases[i].id, all[i].did, all[i].criterion, verdict);
  }
  bench.figure("all.missed.value", missed, "", exactly(0.0), "cases that miss their criterion");
  bench.figure("all.stated.value", stated, "", "cases that miss it and say by how much and why");
  bench.figure("all.cases.value", static_cast<double>(cases.size()), "", "cases");
  table.printed = true;
  bench.table(std::move(table));
  if (quick) return;
  add_wall_plot(bench, cases, all);
  add_error_over_time(bench);
}

const Entry kEntry{"extremes", "wall", "what should not happen: extreme cases, each with its criterion", run};

}  // namespace

Run judged(const models::Setup& setup, trial::TrialOptions options,
           const std::function<void(const trial::Glance&)>& also) {
  Run run;
  options.watch = [&](const trial::Glance& glance) {
    run.judge.see(glance);
    if (also) also(glance);
  };
  run.result = trial::Trial(setup, std::move(options)).run();
  return run;
}

void add_soundness(const Run& run, Found& found) {
  found.numbers.push_back(
      {"broken.value", static_cast<double>(run.judge.broken()), "", exactly(0.0),
       run.judge.first().empty() ? "ticks that the judge objects to" : run.judge.first()});
  found.numbers.push_back({"warned.value", run.result.diverged_at < 0 ? 0.0 : 1.0, "", exactly(0.0),
                           run.result.divergence.empty() ? "by the engine" : run.result.divergence});
  found.simulated += run.result.simulated;
}

}  // namespace enc::bench::extremes
