// What a record costs a tick of a loop that keeps to the wall clock, and whether it has every tick.
#include <array>
#include <chrono>
#include <cstring>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "benchmarks/kit/kit.h"
#include "benchmarks/kit/yardstick.h"
#include "benchmarks/recording/scratch_file.h"
#include "core/record/record.h"
#include "models/order_statistics.h"
#include "trial/assemble/prepare.h"
#include "trial/time/record_thread.h"

namespace enc::bench::recording {
namespace {

using Wall = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kPeriod{1};
constexpr double kWrite = 0.5;  // yardsticks: measured 0.14, on a busy machine

struct Costs {
  std::vector<double> write, copy;  // us, of each tick: of the record; of as many bytes, copied
  Yardstick yardstick;              // on the same ticks
  std::int64_t wrong = 0;           // ticks that are not in the file, or not in order
  double bytes = kUnset;            // of a tick
  std::string error;
};

double us_since(Wall::time_point begun) {
  return std::chrono::duration<double, std::micro>(Wall::now() - begun).count();
}

// As `encounter run` does it: the loop fills, another thread puts it into the file.
void run_loop(RecordWriter& record, std::int64_t ticks, Costs& costs) {
  const trial::RecordThread file(record);
  std::array<std::byte, 1024> from{}, to{};
  const Inputs in;
  const Outputs out;
  Wall::time_point due = Wall::now();
  for (std::int64_t i = 0; i < ticks; ++i) {
    due += kPeriod;
    std::this_thread::sleep_until(due);
    const Tick tick{i, Time(i * Duration(kPeriod)), kPeriod};
    Wall::time_point begun = Wall::now();
    record.write(tick, in, out, static_cast<std::uint64_t>(i));
    costs.write.push_back(us_since(begun));
    from[static_cast<std::size_t>(i) % from.size()] ^= std::byte{1};
    begun = Wall::now();
    std::memcpy(to.data(), from.data(), to.size());
    costs.copy.push_back(us_since(begun));
    if (i % 10 == 0) costs.yardstick.measure();
  }
}

Costs measured(const models::Setup& setup, std::int64_t ticks) {
  const ScratchFile aside("run.encrec");
  Costs costs;
  {
    RecordWriter record(aside.path(), {{"resolved", models::resolved(setup)}},
                        layout_hash(trial::prepare_setup(setup)), RecordWriter::kManyChunks);
    const auto header = std::filesystem::file_size(aside.path());
    run_loop(record, ticks, costs);
    record.close();
    costs.error = record.error();
    costs.bytes =
        static_cast<double>(std::filesystem::file_size(aside.path()) - header) / static_cast<double>(ticks);
  }
  RecordReader reader(aside.path());
  RecordedTick got;
  std::int64_t next = 0;
  while (reader.next(got)) costs.wrong += got.tick.index == next++ ? 0 : 1;
  costs.wrong += std::abs(ticks - next);
  return costs;
}

void run(Bench& bench) {
  const std::int64_t ticks = bench.context.quick ? 2'000 : bench.context.full ? 600'000 : 10'000;
  const Costs costs = measured(bench.setup(), ticks);
  const auto at = [](const std::vector<double>& of, double share) { return models::percentile(of, share); };
  const std::string of =
      fmt::format("of {} ticks at 1 kHz{}", ticks, costs.error.empty() ? "" : ": " + costs.error);
  bench.cost("write.p50.us", at(costs.write, 0.5), "us", of);
  bench.cost("write.p99.us", at(costs.write, 0.99), "us", of);
  bench.cost("write_over_yardstick.median", 1e-6 * at(costs.write, 0.5) / costs.yardstick.seconds(), "x",
             at_most(kWrite), "over a fixed piece of work on the same ticks (kit/yardstick.h)");
  bench.cost("write.max.us", at(costs.write, 1.0), "us", "whoever else runs here is in it");
  bench.cost("copy.p99.us", at(costs.copy, 0.99), "us", "of 1 KiB in memory, on the same ticks");
  bench.figure("missing.count", static_cast<double>(costs.wrong), "", exactly(0),
               "ticks that the file has not, or not in order");
  bench.figure("tick.bytes", costs.bytes, "B");
  bench.result.simulated = 1e-3 * static_cast<double>(ticks);
}

const Entry kEntry{"recording", "tennis_ball", "what a record costs a tick, and whether it has all of them",
                   run};

}  // namespace
}  // namespace enc::bench::recording
