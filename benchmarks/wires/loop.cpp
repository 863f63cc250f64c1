// How even the loop's periods are through real sockets on the wall clock, beside a loop of this machine that
// does nothing but wait. Both share it with whatever else runs here: reported, and never a bound.
#include <array>
#include <cstdint>
#include <ctime>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "benchmarks/kit/over_rig.h"
#include "benchmarks/wires/parts.h"
#include "hw_drivers/wires/free_ports.h"
#include "models/order_statistics.h"
#include "trial/time/real_time.h"

namespace enc::bench::wires {
namespace {

constexpr double kTime = 6.0;  // s

// From each waking to the next, us. `real_time`: how it came before other work.
std::vector<double> bare_periods(std::string& real_time, std::int64_t& missed) {
  constexpr std::int64_t kPeriod = 1'000'000, kSecond = 1'000'000'000;  // ns
  const trial::RealTime first(true);
  real_time = first.words();
  const auto ns = [](const timespec& t) { return t.tv_sec * kSecond + t.tv_nsec; };
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  std::int64_t due = ns(now), before = due;
  std::vector<double> periods;
  for (const std::int64_t end = due + std::llround(kTime * 1e9); due < end;) {
    due += kPeriod;
    clock_gettime(CLOCK_MONOTONIC, &now);
    for (; due < ns(now); due += kPeriod) ++missed;  // none is made up for
    const timespec until{due / kSecond, due % kSecond};
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
    clock_gettime(CLOCK_MONOTONIC, &now);
    periods.push_back(1e-3 * static_cast<double>(ns(now) - before));
    before = ns(now);
  }
  return periods;
}

struct Periods {
  std::vector<double> bare;  // us
  std::string first;
  std::int64_t missed = 0;
  nlohmann::json ran;
};

// Both while the fakes keep their time on this machine.
Periods measured_periods(const BenchContext& context) {
  std::vector<std::string> fakes{"fakes"};
  std::vector<std::string> run{this_program(),
                               "run",
                               context.models + "/scenes/tennis_ball.toml",
                               "--rig",
                               "fakes",
                               "--armed",
                               "--yes",
                               "--json",
                               "--for-s",
                               fmt::format("{:g}", kTime)};
  for (const std::string& port : enc::wires::free_ports()) {
    fakes.insert(fakes.end(), {"--set", port});
    run.insert(run.end(), {"--set", port});
  }
  const std::unique_ptr<Companion> there = begun_fakes(std::move(fakes));
  Periods periods;
  periods.bare = bare_periods(periods.first, periods.missed);
  periods.ran = nlohmann::json::parse(run_child(std::move(run)).out, nullptr, false);
  return periods;
}

}  // namespace

void add_loop(Bench& bench) {
  const auto [bare, first, missed, ran] = measured_periods(bench.context);
  Table table{"loop",
              "From one period of the loop to the next",
              {"loop", "p50, us", "p99, us", "p99.9, us", "longest, us", "missed"},
              {},
              "On the wall clock, with a thread at: " + first + ".",
              true};
  const auto us = [](double x) { return fmt::format("{:.0f}", x); };
  table.add("waits and nothing else", us(models::percentile(bare, 0.5)), us(models::percentile(bare, 0.99)),
            us(models::percentile(bare, 0.999)), us(models::percentile(bare, 1.0)), missed);
  constexpr std::array kShares{"p50", "p99", "p99_9", "max"};
  if (!ran.is_object() || !ran.contains("period_ns")) {
    bench.cost("loop.p99.us", kUnset, "us", "the run through sockets did not come to its end");
    return bench.table(std::move(table));
  }
  std::array<double, kShares.size()> periods{};
  for (std::size_t i = 0; i < kShares.size(); ++i) {
    const nlohmann::json& period = ran["period_ns"].at(kShares[i]);
    periods[i] = period.is_number() ? 1e-3 * period.get<double>() : kUnset;  // null: too few for it
  }
  table.add("runs the ball through sockets, its fakes beside it", us(periods[0]), us(periods[1]),
            us(periods[2]), us(periods[3]), ran.value("missed_cycles", 0));
  bench.table(std::move(table));
  bench.cost("loop.p99.us", periods[1], "us", "through sockets, with the fakes on the same machine");
  bench.cost("loop.bare.p99.us", models::percentile(bare, 0.99), "us", "a loop that waits and does nothing");
  bench.cost("loop.missed.count", ran.value("missed_cycles", 0.0), "", fmt::format("in {:g} s", kTime));
}

}  // namespace enc::bench::wires
