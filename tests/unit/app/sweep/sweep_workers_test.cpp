// Worker processes: every run is answered once, whatever kills the processes.
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/sweep/figures.h"
#include "app/sweep/workers.h"
#include "core/base/error.h"
#include "tests/support/error_of.h"
#include "tests/support/files.h"

namespace enc::app {
namespace {

constexpr std::int64_t kRuns = 500;

// Answers of a pool whose runs are these.
std::map<std::int64_t, std::vector<std::string>> answers(const WorkerJob& job) {
  std::map<std::int64_t, std::vector<std::string>> all;
  std::int64_t next = 0, done = 0;
  const WorkerQueue queue{[&](std::size_t most) {
                            std::vector<std::int64_t> runs;
                            while (next < kRuns && runs.size() < most) runs.push_back(next++);
                            return runs;
                          },
                          [&] { return kRuns - done; },
                          [&](const std::string& line) {
                            all[std::stoll(line)].push_back(line);
                            ++done;
                          },
                          [] { return false; }};
  WorkerPool pool(3, job, queue);
  pool.check();
  EXPECT_TRUE(pool.run());
  return all;
}

TEST(SweepWorkers, EveryRunIsAnsweredOnceThoughProcessesAreKilled) {
  const test::TemporaryFolder folder;
  const WorkerJob job{[] {},
                      [&](std::int64_t run) {
                        const std::string mark = folder.file(std::to_string(run));
                        if (run % 50 == 7 && !std::filesystem::exists(mark)) {  // once
                          std::ofstream(mark) << "killed";
                          raise(SIGKILL);
                        }
                        if (run == 300) std::abort();  // always
                        return std::to_string(run) + " good";
                      },
                      [](std::int64_t run, int signal, int times) {
                        return std::to_string(run) + " killed by " + std::to_string(signal) + ", " +
                               std::to_string(times) + " times";
                      }};
  const auto all = answers(job);
  ASSERT_EQ(all.size(), static_cast<std::size_t>(kRuns));
  for (const auto& [run, lines] : all) {
    ASSERT_EQ(lines.size(), 1U) << run;
    EXPECT_EQ(lines[0], run == 300 ? "300 killed by 6, 3 times" : std::to_string(run) + " good");
  }
}

TEST(SweepWorkers, ARefusalOfTheCheckIsAnError) {
  const WorkerJob job{[] { throw Error("no such measure"); }, [](std::int64_t) { return std::string(); },
                      [](std::int64_t, int, int) { return std::string(); }};
  EXPECT_EQ(test::error_of([&] { static_cast<void>(answers(job)); }), "no such measure");
}

TEST(SweepFigures, APathLeadsToANumberOrToTheMisspeltWord) {
  const auto json = nlohmann::ordered_json::parse(
      R"({"contacts":2,"modes_s":{"hold":0.5},"presses":[{"miss_mm":1},{"miss_mm":4},{"miss_mm":null}],"none":[]})");
  EXPECT_EQ(figure_at(json, "contacts"), 2.0);
  EXPECT_EQ(figure_at(json, "modes_s.hold"), 0.5);
  EXPECT_EQ(figure_at(json, "presses.miss_mm"), 2.5);
  EXPECT_EQ(figure_at(json, "presses.miss_mm.max"), 4.0);
  EXPECT_EQ(figure_at(json, "presses.miss_mm.min"), 1.0);
  EXPECT_EQ(figure_at(json, "presses.miss_mm.sum"), 5.0);
  EXPECT_EQ(figure_at(json, "presses.miss_mm.count"), 2.0);
  EXPECT_EQ(figure_at(json, "presses.count"), 3.0);
  EXPECT_EQ(figure_at(json, "presses.1.miss_mm"), 4.0);
  EXPECT_TRUE(std::isnan(figure_at(json, "presses.7.miss_mm")));
  EXPECT_TRUE(std::isnan(figure_at(json, "none.miss_mm")));
  EXPECT_EQ(figure_at(json, "none.count"), 0.0);
  const std::vector<std::pair<std::string, std::string>> wrong{{"contact", "contact"},
                                                               {"modes_s.rest", "rest"},
                                                               {"presses.mis_mm.max", "mis_mm"},
                                                               {"contacts.x", "x"},
                                                               {"modes_s", ""}};
  for (const auto& [path, word] : wrong) {
    UnknownWord misspelt;
    EXPECT_TRUE(std::isnan(figure_at(json, path, &misspelt))) << path;
    EXPECT_EQ(misspelt.word, word) << path;
    EXPECT_FALSE(misspelt.names.empty()) << path;
  }
}

}  // namespace
}  // namespace enc::app
