#include "tests/hygiene/tick_run.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <memory>
#include <type_traits>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/record/record.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"
#include "trial/measure/run_measures.h"

namespace enc::test {
namespace {

namespace fs = std::filesystem;

static_assert(std::is_trivially_copyable_v<Tally>);
// The data that the child sends through the pipe.
struct Parcel {
  Tally tally;
  double extra = 0.0;
  std::array<char, 512> error{};
};

[[noreturn]] void be_child(const std::function<void(ChildTally&)>& work, int to) {
  ChildTally told;
  try {
    touch_all_pages();
    work(told);
  } catch (const std::exception& e) {
    told.error = e.what();
    if (told.error.empty()) told.error = "an exception without words";
  }
  Parcel parcel{told.tally, told.extra, {}};
  std::copy_n(told.error.begin(), std::min(told.error.size(), parcel.error.size() - 1), parcel.error.begin());
  const auto* bytes = reinterpret_cast<const char*>(&parcel);
  std::size_t sent = 0;
  while (sent < sizeof(parcel)) {
    const ssize_t n = ::write(to, bytes + sent, sizeof(parcel) - sent);
    if (n <= 0) break;
    sent += static_cast<std::size_t>(n);
  }
  ::_exit(0);
}

// "file.cpp:12 function", if the program has line information and addr2line is installed.
std::string place_of(void* caller) {
  Dl_info info{};
  if (dladdr(caller, &info) == 0 || info.dli_fname == nullptr) return "?";
  const auto at = reinterpret_cast<std::uintptr_t>(caller) - 1;
  const auto offset = at - reinterpret_cast<std::uintptr_t>(info.dli_fbase);
  // A program without address randomisation has the addresses of its file.
  for (const std::uintptr_t address : {offset, at}) {
    const std::string found =
        tests::run({"addr2line", "-Cfpse", info.dli_fname, fmt::format("{:#x}", address)}).out;
    if (!found.empty() && found.find("??") == std::string::npos)
      return found.substr(0, std::min<std::size_t>(found.find('\n'), 100));
  }
  return fmt::format("{} in {}", info.dli_sname != nullptr ? info.dli_sname : "?", info.dli_fname);
}

}  // namespace

ChildTally in_child(const std::function<void(ChildTally&)>& work) {
  ChildTally told;
  std::array<int, 2> ends{};
  std::fflush(nullptr);
  if (::pipe(ends.data()) != 0) return {{}, 0.0, "no pipe"};
  const pid_t child = ::fork();
  if (child == 0) be_child(work, ends[1]);
  ::close(ends[1]);
  Parcel parcel;
  auto* bytes = reinterpret_cast<char*>(&parcel);
  std::size_t got = 0;
  for (ssize_t n = 1; n > 0 && got < sizeof(parcel); got += static_cast<std::size_t>(std::max<ssize_t>(n, 0)))
    n = ::read(ends[0], bytes + got, sizeof(parcel) - got);
  ::close(ends[0]);
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0 || got != sizeof(parcel))
    return {{}, 0.0, fmt::format("the child ended with status {:#x}", status)};
  return {parcel.tally, parcel.extra, parcel.error.data()};
}

std::string words(const Tally& run_tally) {
  constexpr std::array<const char*, kOffences> kNames{"heap call", "lock", "system call", "minor page fault",
                                                      "major page fault"};
  std::string text;
  for (std::size_t i = 0; i < kOffences; ++i)
    if (run_tally.count[i] != 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", run_tally.count[i], kNames[i]);
  text = (text.empty() ? "nothing" : text) + fmt::format(" in {} ticks", run_tally.ticks);
  for (std::size_t i = 0; i < run_tally.offenders; ++i) {
    const Offender& one = run_tally.first[i];
    text += fmt::format("\n  tick {}: {} {}", one.tick, kNames[static_cast<std::size_t>(one.kind)],
                        one.name.data());
    for (std::size_t d = 2; d < one.depth && d < 14; ++d) text += "\n    " + place_of(one.callers[d]);
  }
  return text;
}

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

ChildTally counted_run(const Case& asked) {
  return in_child([&](ChildTally& told) {
    static std::atomic<int> caught{0};  // like the program's signal handlers
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

ChildTally without_chance(const Case& asked) {
  ChildTally told = counted_run(asked);
  const auto only_faults = [&] {
    return told.error.empty() && told.tally.faults() > 0 && told.tally.faults() == told.tally.all();
  };
  for (int again = 0; again < 2 && only_faults(); ++again) told = counted_run(asked);
  return told;
}

void count_scene(const Case& asked, const std::function<void(const ChildTally&)>& good) {
  Case next = asked;
  std::int64_t ticks = 0;
  bool filtered = true;
  for (next.options.seed = 1; ticks < kTicks; ++next.options.seed) {
    if (ticks > 0) next.most = kTicks - ticks;
    const ChildTally told = without_chance(next);
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
