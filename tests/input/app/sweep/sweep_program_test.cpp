// `encounter sweep` as a person calls it: killed and started again, in any number of shards, and refused.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <random>
#include <sstream>
#include <string>
#include <thread>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/input/app/program.h"
#include "tests/support/built.h"

namespace enc::tests {
namespace {

namespace fs = std::filesystem;
using test::bytes_of;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

constexpr int kRuns = 40;

class Sweep : public Program {
 protected:
  [[nodiscard]] std::string spec(const std::string& more = "") const {
    return fmt::format(
        "format = 1\nscene = \"{}\"\nfor_s = 0.2\nseeds = 20\nkeep = \"contacts presses.count "
        "modes_s.follow ledger.hand_mJ.max\"\n{}"
        "[[vary]]\nname = \"truth.tracker.latency_ms\"\nvalues = [3, 5]\n",
        plane(), more);
  }
  [[nodiscard]] std::string written(const std::string& text) const {
    write("s.toml", text);
    return path("s.toml");
  }
  [[nodiscard]] Words words(const std::string& out, const Words& more = {}) const {
    Words all{"sweep", path("s.toml"), "--out", path(out)};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  [[nodiscard]] std::string sweep_refused(const std::string& text, const Words& more = {}) const {
    static_cast<void>(written(text));
    return refused(words("never", more));
  }
  [[nodiscard]] std::string results(const std::string& out) const {
    return bytes_of(path(out + "/results.ndjson")) + bytes_of(path(out + "/results.csv"));
  }
  void kill_once(const Words& args, const std::string& part, std::mt19937& random) const;
};

// Starts the program and kills it when it has done something, at a moment that is not chosen.
void Sweep::kill_once(const Words& args, const std::string& part, std::mt19937& random) const {
  Words command{program_file()};
  command.insert(command.end(), args.begin(), args.end());
  std::vector<char*> pointers;
  for (std::string& word : command) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const auto size = [&] {
    std::error_code none;
    const auto bytes = fs::file_size(part, none);
    return none ? 0 : bytes;
  };
  const auto before = size();
  pid_t child = -1;
  ASSERT_EQ(posix_spawn(&child, pointers[0], nullptr, nullptr, pointers.data(), environ), 0);
  int status = 0;
  while (size() <= before && waitpid(child, &status, WNOHANG) == 0)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::microseconds(random() % 40'000));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
}

TEST_F(Sweep, KilledAtRandomItsResultsAreThoseOfAnUndisturbedOne) {
  static_cast<void>(written(spec()));
  const Result whole = run_program(words("whole"));
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_THAT(whole.out, StartsWith("sweep       40 runs of "));
  const std::string expected = results("whole");
  std::mt19937 random(7);
  for (const int count : {1, 2, 7}) {
    const std::string out = fmt::format("shards{}", count);
    for (int i = 0; i < count; ++i) {
      const Words args = words(out, {"--shard", fmt::format("{}/{}", i, count)});
      const std::string part = path(fmt::format("{}/shard-{}.ndjson.part", out, i));
      for (int kills = 0; kills < (count == 7 ? 1 : 3); ++kills) kill_once(args, part, random);
      const Result end = run_program(args);
      ASSERT_EQ(end.code, 0) << end.err;
    }
    ASSERT_EQ(run_program(words(out, {"--merge"})).code, 0);
    EXPECT_EQ(results(out), expected) << count;
  }
}

TEST_F(Sweep, ARunIsTheRunOfTheSameSettings) {
  static_cast<void>(written(spec()));
  ASSERT_EQ(run_program(words("out")).code, 0);
  std::istringstream lines(bytes_of(path("out/results.ndjson")));
  std::string line;
  for (int i = 0; i <= 23; ++i) std::getline(lines, line);
  const auto json = nlohmann::json::parse(line);
  EXPECT_EQ(json["id"], 23);
  const Result alone = run_program({"run", plane(), "--for-s", "0.2", "--set", "truth.tracker.latency_ms=5",
                                    "--seed", std::to_string(json["seed"].get<std::uint64_t>()), "--json"});
  EXPECT_EQ(nlohmann::json::parse(alone.out)["state_hash"], json["state_hash"]);
  EXPECT_THAT(bytes_of(path("out/report.html")), AllOf(HasSubstr("95 % interval"), HasSubstr("<svg")));
}

TEST_F(Sweep, AParameterWithOneValueHasNoPicture) {
  static_cast<void>(written(test::replaced(spec(), "seeds = 20", "seeds = 2") +
                            "[[vary]]\nname = \"follow.resume_mm\"\nvalues = [40]\n"));
  ASSERT_EQ(run_program(words("out")).code, 0);
  const std::string page = bytes_of(path("out/report.html"));
  EXPECT_THAT(page, AllOf(HasSubstr("<p>In every run: follow.resume_mm = 40.</p>"),
                          HasSubstr(">truth.tracker.latency_ms</")));
  EXPECT_THAT(page, Not(HasSubstr(">follow.resume_mm</")));
}

TEST_F(Sweep, RunsThatTheSceneRefusesAreNamedAndTheOthersAreDone) {
  static_cast<void>(written(test::replaced(spec(), "seeds = 20", "seeds = 2") +
                            "[[vary]]\nname = \"follow.resume_mm\"\nvalues = [5000, 40]\n"));
  const Result r = run_program(words("out"));
  EXPECT_EQ(r.code, 1);
  EXPECT_THAT(r.out, AllOf(HasSubstr("8 runs of "), HasSubstr("; 4 failed"), HasSubstr("failed      run 0: "),
                           HasSubstr("expected at most 'pause_mm'")));
  const Result status = run_program(words("out", {"--status"}));
  EXPECT_EQ(status.code, 1);
  EXPECT_THAT(status.out, HasSubstr("sweep       8 of 8 runs, 4 failed; 1 of 1 shard whole"));
  const std::string before = results("out");
  EXPECT_EQ(run_program(words("out", {"--only", "failed"})).code, 1);
  EXPECT_EQ(results("out"), before);
}

TEST_F(Sweep, EachMistakeIsRefusedInOneLine) {
  EXPECT_THAT(sweep_refused("format = 1\n"), HasSubstr("has no 'scene'"));
  EXPECT_THAT(sweep_refused(spec() + "[[vary]]\nname = \"object.wall.radius_mm\"\nvalues = [1]\n"),
              AllOf(HasSubstr("s.toml:"), HasSubstr("unknown parameter")));
  EXPECT_THAT(sweep_refused(spec() + "[[vary]]\nname = \"truth.tracker.rate_hz\"\nvalues = [-1]\n"),
              AllOf(HasSubstr("s.toml:"), HasSubstr("-1")));
  EXPECT_THAT(
      sweep_refused("format = 1\nscene = \"reaching\"\ndesign = \"random\"\npoints = 5\nkeep = \"contacts\"\n"
                    "[[vary]]\nname = \"user.reaches.count\"\nfrom = 1\nto = 10\n"),
      AllOf(HasSubstr("s.toml:6:1: "), HasSubstr("expected a whole number")));
  EXPECT_THAT(sweep_refused(test::replaced(spec(), "contacts", "contact")),
              AllOf(HasSubstr("s.toml:5:1"), HasSubstr("did you mean 'contacts'")));
  EXPECT_THAT(sweep_refused(test::replaced(spec(), "presses.count", "presses.miss")), HasSubstr("miss_mm"));
  EXPECT_THAT(sweep_refused(test::replaced(spec(), "seeds = 20", "seeds = 1000000000")),
              HasSubstr("2e+09 runs"));
  EXPECT_THAT(sweep_refused(test::replaced(spec(), "for_s = 0.2", "rig = \"fakes\"")), HasSubstr("real"));
  EXPECT_THAT(sweep_refused(spec(), {"--shard", "7/7"}), HasSubstr("expected a number from 0 to 6"));
  EXPECT_THAT(sweep_refused(spec(), {"--shard", "x"}), HasSubstr("expected I/N"));
  EXPECT_THAT(sweep_refused(spec(), {"--shard", "auto"}), HasSubstr("in no Slurm array"));
  EXPECT_THAT(sweep_refused(spec(), {"--submit", "slurm"}), HasSubstr("--shard auto/N"));
  EXPECT_THAT(sweep_refused(spec(), {"--merge"}), HasSubstr("not whole: 0"));
}

TEST_F(Sweep, AChangedSpecAndAForeignFileAreRefused) {
  static_cast<void>(written(spec()));
  ASSERT_EQ(run_program(words("out", {"--shard", "0/2"})).code, 0);
  static_cast<void>(written(test::replaced(spec(), "[3, 5]", "[3, 6]")));
  EXPECT_THAT(refused(words("out", {"--shard", "1/2"})), HasSubstr("the design was another one"));
  static_cast<void>(written(spec()));
  edit("models/scenes/plane.toml", "format = 1", "format = 1\n");
  EXPECT_THAT(refused(words("out")), HasSubstr("begun in 2 shards"));
  write("out/notes.txt", "mine");
  EXPECT_THAT(refused(words("out", {"--shard", "1/2"})), HasSubstr("notes.txt: is no file of a sweep"));
}

TEST_F(Sweep, ASceneThatChangesDuringTheSweepIsRefused) {
  static_cast<void>(written(test::replaced(spec(), "for_s = 0.2", "for_s = 5")));
  std::thread change([&] {
    while (!fs::exists(path("out/shard-0.ndjson.part"))) std::this_thread::yield();
    edit("models/scenes/plane.toml", "[user]", "[user]\napproach_from_mm = 41");
  });
  const Result r = run_program(words("out"));
  change.join();
  EXPECT_EQ(r.code, 2) << r.out;
  EXPECT_THAT(r.err, HasSubstr("changed while this sweep ran"));
}

TEST_F(Sweep, AFullDiskIsRefusedAndTheSameCommandGoesOn) {
  static_cast<void>(written(spec()));
  Words command{"sh", "-c", "ulimit -f 4; exec \"$@\"", "sh", program_file()};  // blocks of 512 bytes
  const Words args = words("out");
  command.insert(command.end(), args.begin(), args.end());
  const Result full = run(command);
  EXPECT_EQ(full.code, 2) << full.out;
  EXPECT_THAT(full.err, HasSubstr("cannot be written: "));
  const Result again = run_program(args);
  EXPECT_EQ(again.code, 0) << again.err;
  EXPECT_THAT(again.out, StartsWith("sweep       40 runs of "));
}

TEST_F(Sweep, LaunchersNumberTheirShards) {
  static_cast<void>(written(spec()));
  const auto number = [&](const Environment& environment, const std::string& shard) {
    const Result r = run_program(
        words("o" + std::to_string(environment.size()) + environment[0].first, {"--shard", shard}),
        environment);
    return r.out.substr(0, r.out.find(':')) + r.err;
  };
  EXPECT_EQ(number({{"SLURM_ARRAY_TASK_ID", "13"},
                    {"SLURM_ARRAY_TASK_MIN", "11"},
                    {"SLURM_ARRAY_TASK_STEP", "2"},
                    {"SLURM_ARRAY_TASK_COUNT", "20"}},
                   "auto"),
            "shard       1 of 20");
  EXPECT_EQ(number({{"OMPI_COMM_WORLD_RANK", "3"}, {"OMPI_COMM_WORLD_SIZE", "20"}}, "auto"),
            "shard       3 of 20");
  EXPECT_EQ(number({{"PMI_RANK", "0"}, {"PMI_SIZE", "20"}}, "auto/20"), "shard       0 of 20");
  EXPECT_EQ(number({{"PARALLEL_SEQ", "20"}}, "auto/20"), "shard       19 of 20");
  write("job.ad", "ClusterId = 4\nProcId = 5\nTotalSubmitProcs = 20\n");
  EXPECT_EQ(number({{"_CONDOR_JOB_AD", path("job.ad")}}, "auto"), "shard       5 of 20");
  const Result script = run_program(words("out", {"--shard", "auto/20", "--submit", "slurm"}));
  EXPECT_THAT(script.out, AllOf(StartsWith("#!/bin/sh\n#SBATCH"), HasSubstr("--array=0-19\n"),
                                HasSubstr("--shard \"$SLURM_ARRAY_TASK_ID/20\"\n")));
  const Result blank = run_program(words("50 % of it/", {"--shard", "auto/20", "--submit", "slurm"}));
  EXPECT_THAT(blank.out, AllOf(HasSubstr("#SBATCH --output='"), HasSubstr("/50 %% of it-%a.log'\n")));
  EXPECT_THAT(refused(words("two\nlines", {"--shard", "auto/20", "--submit", "slurm"})),
              HasSubstr("expected printable text on one line"));
}

}  // namespace
}  // namespace enc::tests
