// Signals: a run that is stopped ends normally, with its report, its record and its own exit code.
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <thread>

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/record/record.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::tests {
namespace {

using testing::HasSubstr;
using testing::Not;

void after_ms(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

// The program in a process of its own, with its output in a file.
class ProgramProcess {
 public:
  explicit ProgramProcess(std::vector<std::string> args) : out_(folder_.path() / "out") {
    args.insert(args.begin(), program_file());
    child_ = fork();
    if (child_ != 0) return;
    const int file = open(out_.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0644);
    dup2(file, STDOUT_FILENO);
    dup2(file, STDERR_FILENO);
    setenv("ENCOUNTER_MODULES", module_folder().c_str(), 1);
    std::vector<char*> words;
    for (std::string& arg : args) words.push_back(arg.data());
    words.push_back(nullptr);
    execv(words[0], words.data());
    _exit(127);
  }
  // Waits until the program catches signals: a person does not press Ctrl-C in the first milliseconds.
  void ready() const {
    for (int i = 0; i < 500; ++i) {
      std::ifstream status("/proc/" + std::to_string(child_) + "/status");
      for (std::string line; std::getline(status, line);)
        if (line.starts_with("SigCgt:") &&
            (std::stoull(line.substr(8), nullptr, 16) >> (SIGTERM - 1) & 1U) != 0)
          return after_ms(300);
      after_ms(20);
    }
  }
  void send(int signal) const { kill(child_, signal); }
  // Returns the exit code, or 128 + signal, negated, after a fatal signal.
  int wait() const {
    int status = 0;
    waitpid(child_, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }
  [[nodiscard]] std::string text() const { return test::bytes_of(out_); }
  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }

 private:
  test::TemporaryFolder folder_;
  std::filesystem::path out_;
  pid_t child_ = -1;
};

TEST(Stop, ASignalEndsARunCleanlyWithItsOwnCode) {
  for (const auto& [signal, code] : {std::pair{SIGINT, 130}, {SIGTERM, 143}, {SIGHUP, 129}}) {
    const test::TemporaryFolder folder;
    const std::string record = (folder.path() / "r.encrec").string();
    const ProgramProcess run({"run", shipped_scene("tennis_ball"), "--pace", "wall", "--record", record});
    const std::string aside = record + ".part";  // exists until the record is sealed
    while (!std::filesystem::exists(aside) || std::filesystem::file_size(aside) < 4096) after_ms(20);
    after_ms(300);
    run.send(signal);
    EXPECT_EQ(run.wait(), code);
    EXPECT_THAT(run.text(), HasSubstr("stopped     by a signal"));
    EXPECT_THAT(run.text(), HasSubstr("state hash"));
    const Result replayed = run_program({"replay", record});  // the record is sealed
    EXPECT_EQ(replayed.code, 0) << replayed.err;
  }
}

// The run has not begun, so a long start-up ends at once and leaves nothing.
TEST(Stop, AStartUpThatTakesLongEndsAtOnce) {
  const test::TemporaryFolder folder;
  const std::string scene = folder.file("many.toml"), record = folder.file("r.encrec");
  {
    std::ofstream file(scene);
    file << "format = 1\ntitle = \"Many\"\n";
    for (int i = 0; i < 20'000; ++i)
      file << "[[object]]\nname = \"wall" << i << "\"\nshape = \"plane\"\nposition_mm = [0, 0, "
           << 10 + 1e-4 * i << "]\nnormal = [0, 0, 1]\nbehaviour = \"wall\"\n";
    file << "[[tool]]\nname = \"stylus\"\nmarkers_mm = [[0, 0, 0], [52, 0, 0], [0, 41, 0], [-17, -30, 12]]\n"
            "tip_mm = [0, 0, -120]\n[manipulator]\n[force]\n[tracker]\n";
  }
  for (const auto& [signal, code] : {std::pair{SIGTERM, 143}, {SIGINT, 130}, {SIGQUIT, 131}, {SIGHUP, 129}}) {
    const ProgramProcess run({"run", scene, "--record", record});
    run.ready();
    const auto sent = std::chrono::steady_clock::now();
    run.send(signal);
    EXPECT_EQ(run.wait(), code) << run.text();
    EXPECT_LT(std::chrono::steady_clock::now() - sent, std::chrono::seconds(1));
    EXPECT_FALSE(std::filesystem::exists(record) || std::filesystem::exists(record + ".part"));
  }
}

// The sender may be a supervisor, a timer or a limit.
TEST(Stop, EachSignalThatWouldKillEndsTheRunCleanly) {
  std::vector<int> signals{SIGQUIT, SIGABRT, SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU,
                           SIGIO,   SIGPWR,  SIGSEGV, SIGBUS,    SIGFPE,  SIGRTMIN + 3};
  for (const int signal : signals) {
    SCOPED_TRACE(signal);
    const test::TemporaryFolder folder;
    const std::string record = folder.file("r.encrec");
    const ProgramProcess run({"run", shipped_scene("plane"), "--pace", "wall", "--record", record});
    const std::string aside = record + ".part";
    while (!std::filesystem::exists(aside) || std::filesystem::file_size(aside) < 4096) after_ms(5);
    after_ms(50);
    for (int i = 0; i < 3; ++i) run.send(signal);
    EXPECT_EQ(run.wait(), 128 + signal) << run.text();
    EXPECT_TRUE(RecordReader(record).sealed());
  }
}

// Half a table is useless, and readers of MCAP look for the end that half a file lacks.
TEST(Stop, AnExportThatIsStoppedLeavesNothing) {
  const test::TemporaryFolder folder;
  const std::string record = folder.file("r.encrec");
  ASSERT_EQ(run_program({"run", shipped_scene("tennis_ball"), "--for-s", "60", "--record", record}).code, 0);
  for (const char* option : {"--csv", "--mcap"}) {
    const std::string out = folder.file("out"), aside = out + ".part";
    const ProgramProcess table({"export", record, option, out});
    while (!std::filesystem::exists(aside) || std::filesystem::file_size(aside) == 0) after_ms(1);
    table.send(SIGINT);
    EXPECT_EQ(table.wait(), 130) << option;
    EXPECT_FALSE(std::filesystem::exists(out) || std::filesystem::exists(aside)) << option;
  }
}

// Also while the clock waits for hours, and with real, armed devices.
TEST(Stop, AlsoWhileTheClockWaits) {
  const ProgramProcess slow({"run", shipped_scene("tennis_ball"), "--pace", "1e-6"});
  slow.ready();
  slow.send(SIGTERM);
  EXPECT_EQ(slow.wait(), 143);
  const ProgramProcess armed({"run", shipped_scene("rig_A"), "--set", "rig.manipulator.driver=\"sample\"",
                              "--set", "rig.force.driver=\"sample\"", "--set",
                              "rig.calibration.date=\"2026-11-27\"", "--set",
                              "rig.calibration.valid_days=36500", "--armed", "--yes", "--not-real-time"});
  armed.ready();
  armed.send(SIGINT);
  EXPECT_EQ(armed.wait(), 130);
  EXPECT_THAT(armed.text(), HasSubstr("stopped     by a signal"));
}

// Ctrl-C ends the reader, too: the program still returns the code of the signal, and is not killed.
TEST(Stop, AlsoWhereNobodyReadsTheReport) {
  const Result r = tests::run(
      {"bash", "-c",
       "set -m; exec 3> >(exec 0<&-; exec sleep 3); \"$1\" run \"$2\" --pace wall >&3 & p=$!; sleep 1.5; "
       "kill -INT $p; wait $p",
       "bash", program_file(), shipped_scene("tennis_ball")});
  EXPECT_EQ(r.code, 130) << r.err;
  const Result full = tests::run({"bash", "-c", "\"$1\" run \"$2\" --for-s 0.1 > /dev/full", "bash",
                                  program_file(), shipped_scene("plane")});
  EXPECT_EQ(full.code, 2);
  EXPECT_THAT(full.err, HasSubstr("standard output"));
}

TEST(Stop, WhatIsIgnoredStaysIgnored) {
  std::signal(SIGHUP, SIG_IGN);  // like nohup; the child inherits it
  const ProgramProcess run({"run", shipped_scene("plane"), "--pace", "wall", "--for-s", "1"});
  std::signal(SIGHUP, SIG_DFL);
  run.ready();
  run.send(SIGHUP);
  EXPECT_EQ(run.wait(), 0) << run.text();
}

// A process that was stopped for a second: an armed run loses the cycles and reports them; a simulated run
// loses none.
TEST(Stop, AStoppedProcessMakesNothingUp) {
  const std::vector<std::string> sample{"--set",          "rig.manipulator.driver=\"sample\"",
                                        "--set",          "rig.force.driver=\"sample\"",
                                        "--set",          "rig.calibration.date=\"2026-11-27\"",
                                        "--set",          "rig.calibration.valid_days=36500",
                                        "--armed",        "--yes",
                                        "--not-real-time"};
  std::vector<std::string> args{"run", shipped_scene("rig_A"), "--for-s", "2.5", "--json"};
  args.insert(args.end(), sample.begin(), sample.end());
  const ProgramProcess armed(args);
  armed.ready();
  armed.send(SIGSTOP);
  after_ms(1000);
  armed.send(SIGCONT);
  armed.wait();
  const std::string text = armed.text();
  const auto number = [&](const std::string& key) {
    const std::size_t at = text.find("\"" + key + "\": ");
    return at == std::string::npos ? -1.0 : std::stod(text.substr(at + key.size() + 4));
  };
  EXPECT_GE(number("missed_cycles"), 950.0);
  EXPECT_LE(number("ticks"), 2501.0 - 950.0);
  EXPECT_THAT(text, HasSubstr("clock late"));

  const Result free = run_program({"run", shipped_scene("plane"), "--for-s", "1"});
  const ProgramProcess paced({"run", shipped_scene("plane"), "--for-s", "1", "--pace", "wall"});
  paced.ready();
  paced.send(SIGSTOP);
  after_ms(700);
  paced.send(SIGCONT);
  EXPECT_EQ(paced.wait(), 0);
  EXPECT_THAT(paced.text(), HasSubstr("nothing was lost"));
  const auto hash = [](const std::string& all) { return all.substr(all.find("state hash")); };
  EXPECT_EQ(hash(paced.text()), hash(free.out));
}

TEST(Stop, ADryRunSaysWhatWasWithheld) {
  const Result dry =
      run_program({"run", shipped_scene("rig_A"), "--for-s", "0.2", "--set",
                   "rig.manipulator.driver=\"sample\"", "--set", "rig.force.driver=\"sample\""},
                  {{"ENCOUNTER_MODULES", module_folder()}});
  const std::size_t after =
      dry.out.find(" ticks", dry.out.find("state hash"));  // a busy machine loses some ticks
  const std::size_t before = dry.out.rfind(' ', after - 1);
  EXPECT_THAT(dry.out, HasSubstr(dry.out.substr(before + 1, after - before - 1) + " commands were withheld"));
  EXPECT_THAT(dry.out, HasSubstr("--armed sends them"));
}

}  // namespace
}  // namespace enc::tests
