#include "tests/hygiene/tick_run.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "core/record/record.h"
#include "tests/support/built.h"
#include "trial/run/run_measures.h"

namespace enc::test {
namespace {

namespace fs = std::filesystem;

}  // namespace

std::vector<std::string> scenes(bool camera) {
  const fs::path root = tests::source_dir() + "/models/scenes";
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    const std::string name = fs::relative(entry.path(), root).replace_extension().generic_string();
    if (entry.path().extension() == ".toml" && (name.rfind("camera/", 0) == 0) == camera)
      names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

Told counted_run(const Case& asked) {
  return in_child([&](Told& told) {
    static std::atomic<int> caught{0};  // as the program's signals are
    trial::TrialOptions options = asked.options;
    const models::Setup setup =
        models::load(tests::source_dir() + "/models/scenes/" + asked.scene + ".toml", "", {});
    const auto also = options.watch;
    trial::RunMeasures measures(setup, options);
    options.watch = [&](const trial::Glance& glance) {
      measures.see(glance);
      if (also) also(glance);
    };
    options.stop = [] { return caught != 0; };
    trial::Trial trial(setup, options);
    std::unique_ptr<RecordWriter> record;
    if (!asked.record.empty())
      record = std::make_unique<RecordWriter>(asked.record, RecordTexts{}, layout_hash(trial.scene()));
    trial.record_to(record.get());
    for (std::int64_t i = 0; i < kWarmUp; ++i) (void)trial.tick();
    const std::int64_t frames = trial.result().vision.frames;
    (void)filter_system_calls();
    begin_tally();
    for (std::int64_t i = 0; i < asked.most && trial.tick(); ++i) end_tick();
    told.tally = end_tally();
    told.extra = static_cast<double>(trial.result().vision.frames - frames);
    if (record) {
      record->close();
      told.extra = static_cast<double>(fs::file_size(asked.record));
    }
  });
}

Told without_chance(const Case& asked) {
  Told told = counted_run(asked);
  const auto only_faults = [&] {
    return told.error.empty() && told.tally.faults() > 0 && told.tally.faults() == told.tally.all();
  };
  for (int again = 0; again < 2 && only_faults(); ++again) told = counted_run(asked);
  return told;
}

void count_scene(const Case& asked, const std::function<void(const Told&)>& good) {
  Case next = asked;
  std::int64_t ticks = 0;
  bool filtered = true;
  for (next.options.seed = 1; ticks < kTicks; ++next.options.seed) {
    if (ticks > 0) next.most = kTicks - ticks;
    const Told told = without_chance(next);
    ASSERT_EQ(told.error, "") << "seed " << next.options.seed;
    ASSERT_GT(told.tally.ticks, 0) << "seed " << next.options.seed;
    ticks += told.tally.ticks;
    filtered = filtered && told.tally.filtered;
    good(told);
    if (testing::Test::HasFailure()) return;
  }
  if (!filtered) GTEST_SKIP() << kNoFilter;
}

void Tick::SetUp() {
  if (!kCanTally) GTEST_SKIP() << "sanitizers have a heap of their own, and the filter is for x86-64";
  ::setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
}

}  // namespace enc::test
