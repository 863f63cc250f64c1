#include "benchmarks/bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>

#include <fmt/format.h>
#include <unistd.h>

#include "app/modules.h"
#include "app/options.h"
#include "core/error.h"
#include "models/scene_file.h"
#include "models/wording.h"

namespace enc::app {
namespace {

std::vector<const bench::Benchmark*> chosen(const std::vector<std::string>& names) {
  std::vector<const bench::Benchmark*> list;
  for (const bench::Benchmark& b : bench::benchmarks())
    if (names.empty()) list.push_back(&b);
  for (const std::string& name : names) {
    const auto all = bench::benchmarks();
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const bench::Benchmark& b) { return name == b.name; });
    if (found == all.end()) {
      std::string known;
      for (const bench::Benchmark& b : all) known += (known.empty() ? "" : ", ") + std::string(b.name);
      throw Error("unknown benchmark '" + name + "'; there are: " + known);
    }
    list.push_back(&*found);
  }
  return list;
}

const ModuleInfo* module_if_there(const std::string& name) {
  const std::vector<std::string> there = modules_there();
  return std::find(there.begin(), there.end(), name) == there.end() ? nullptr : &load_module(name);
}

std::string bounds(const bench::Figure& f) {
  if (std::isfinite(f.low) && std::isfinite(f.high))
    return fmt::format(" within {:.4g}..{:.4g}", f.low, f.high);
  if (std::isfinite(f.high)) return fmt::format(" at most {:.4g}", f.high);
  return std::isfinite(f.low) ? fmt::format(" at least {:.4g}", f.low) : "";
}

}  // namespace

int bench(const BenchOptions& options) {
  const std::vector<const bench::Benchmark*> list = chosen(options.names);
  if (options.repeats < 0) throw Error("--repeats: expected a positive number");
  bench::BenchContext context;
  context.models = models::models_dir("");
  context.seed = options.seed;
  context.repeats = options.repeats;
  context.quick = options.quick;
  context.set = options.set;
  context.module = module_if_there;
  std::vector<bench::BenchResult> results;
  if (!options.out.empty())
    bench::write_results(options.out, results, options.seed);  // refused before hours of work
  bool all_ok = true;
  for (const bench::Benchmark* benchmark : list) {
    if (isatty(STDERR_FILENO) != 0)
      context.progress = [&](double share) {
        fmt::print(stderr, "\r  {} {:3d} %", benchmark->name, static_cast<int>(std::lround(share * 100.0)));
        std::fflush(stderr);
      };
    const auto start = std::chrono::steady_clock::now();
    results.push_back(benchmark->run(context));
    results.back().run_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r{:40}\r", "");
    fmt::print("{} ({}): {:.1f} s simulated in {:.2f} s\n", benchmark->name, benchmark->what,
               results.back().simulated, results.back().run_time);
    for (const bench::Figure& f : results.back().figures) {
      all_ok = all_ok && f.ok();
      fmt::print("  {:34} {:10.4g} {:5}{}{}\n", f.id, f.twin, f.unit, bounds(f),
                 f.ok() ? "" : "  OUT OF BOUNDS");
    }
    if (!results.back().note.empty()) fmt::print("  {}\n", results.back().note);
    if (!options.out.empty()) bench::write_results(options.out, results, options.seed);
  }
  return all_ok ? 0 : 1;
}

}  // namespace enc::app
