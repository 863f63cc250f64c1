// The laboratory in two programs: `encounter fake` on one side of real sockets, a run or a calibration on the
// other.
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <random>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "core/devices/mode.h"
#include "hw_drivers/net/clocks.h"
#include "tests/conformance/laboratory.h"
#include "tests/support/built.h"
#include "tests/support/files.h"
#include "tests/support/run_program.h"

namespace enc::test {
namespace {

using ::testing::HasSubstr;
using tests::Result;
using tests::run_program;

// ---- The laboratory in two programs: `encounter fake` on one side of real sockets, `encounter run` on the
// other.

// Runs the program until it ends or this object is destroyed; its output goes into a file.
class ProgramProcess {
 public:
  ProgramProcess(const std::vector<std::string>& words, const std::string& output) {
    std::vector<std::string> all{tests::program_file()};
    all.insert(all.end(), words.begin(), words.end());
    static_cast<void>(fflush(nullptr));  // the child must not inherit buffered output
    child_ = fork();
    if (child_ != 0) return;
    std::vector<char*> arguments;
    for (std::string& word : all) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    static_cast<void>(freopen(output.c_str(), "w", stdout));
    execv(arguments[0], arguments.data());
    _exit(127);
  }
  ~ProgramProcess() {
    send(SIGKILL);
    wait();
  }
  ProgramProcess(const ProgramProcess&) = delete;
  ProgramProcess& operator=(const ProgramProcess&) = delete;
  void send(int signal) const {
    if (child_ > 0) kill(child_, signal);
  }
  void wait() {
    if (child_ > 0) waitpid(child_, nullptr, 0);
    child_ = -1;
  }

 private:
  pid_t child_ = -1;
};

// One press, with its maximum depth at 13 s.
TEST(Fakes, InLockstepARunThroughSocketsIsTheSameEachTimeAndAsWithout) {
  const Laboratory there(true);
  const TemporaryFolder folder;
  const std::string wires = folder.file("wires.encrec"), none = folder.file("none.encrec");
  const std::vector<std::string> words = there.words({"--armed", "--lockstep", "--for-s", "14", "--json"});
  std::vector<std::string> recorded = words;
  recorded.insert(recorded.end(), {"--record", wires});
  const nlohmann::json first = json_of(run_program(recorded, {}, 400)),
                       again = json_of(run_program(words, {}, 400));
  EXPECT_EQ(first["state_hash"], again["state_hash"]);
  const nlohmann::json pure =
      json_of(run_program({"run", kBall, "--for-s", "14", "--json", "--record", none}));
  expect_same_commands(wires, none);
  EXPECT_EQ(first["contacts"], 1);
  EXPECT_EQ(pure["contacts"], 1);
  ASSERT_TRUE(first["felt_peak_N"].is_number()) << first.dump();
  EXPECT_FALSE(first.contains("presses") && !first["presses"].empty()) << "a truth that nobody knows";
  const double peak = pure["presses"][0]["peak_force_N"];
  EXPECT_NEAR(first["felt_peak_N"].get<double>(), peak, 0.2);
  for (const auto& [mode, time] : pure["modes_s"].items())
    EXPECT_NEAR(first["modes_s"].value(mode, 0.0), time.get<double>(), 0.1) << mode;
  EXPECT_EQ(there.fakes->begun(), 2);
}

TEST(Fakes, WhatDoesNotFitIsSaid) {
  {
    const Laboratory there(true);
    EXPECT_THAT(run_program(there.words({"--armed", "--yes", "--for-s", "1"})).err,
                HasSubstr("its time goes on with each set-point; begin the fake without --lockstep"));
    EXPECT_THAT(run_program(there.words({"--lockstep"})).err,
                HasSubstr("without --armed none is sent; add it"));
  }
  const Laboratory there(false);
  EXPECT_THAT(run_program(there.words({"--armed", "--lockstep"})).err,
              HasSubstr("its time goes on by itself; leave out --lockstep"));
  EXPECT_THAT(run_program({"run", kBall, "--armed", "--lockstep"}).err,
              HasSubstr("the rig's machine is simulated"));
  EXPECT_THAT(run_program({"fake", "sim"}).err, HasSubstr("every device that the scene names is simulated"));
  const Result taken = run_program({"fake", "fakes", "--set", there.ports[0]});
  EXPECT_EQ(taken.code, 3);
  EXPECT_THAT(taken.err, HasSubstr("is taken"));
}

// A fault of a missing fake, of another wire, or with an invalid value.
TEST(Fakes, AFaultThatCannotBeIsRefused) {
  for (const auto& [fault, why] :
       {std::pair{"netfd:loss", "there is no fake of 'netfd'; did you mean 'netft'?"},
        {"gcs:loss", "knows no 'loss=100%'"},
        {"gcs:error-code=0", "knows no 'error-code=0'"},
        {"igtl:error-code=0x10000", "knows no 'error-code=0x00010000'"},
        {"igtl:saturate", "knows no 'saturate'"},
        {"netft:loss=150%", "'150%' is no value of 'loss'"}}) {
    std::vector<std::string> words{"fake", "fakes", "--fault", fault};
    for (const std::string& set : wires::free_ports()) words.insert(words.end(), {"--set", set});
    const Result result = run_program(words);
    EXPECT_EQ(result.code, 2) << fault;
    EXPECT_EQ(result.out, "") << fault;
    EXPECT_THAT(result.err, testing::AllOf(testing::StartsWith("encounter: --fault: "), HasSubstr(why)));
  }
}

// The arrival time of the client does not matter: the fakes' time begins anew, and so do messages under way.
TEST(Fakes, AFaultOfTheirLineIsTheSameHoweverLongTheyWaited) {
  for (const char* fault : {"gcs:jitter=1ms", "gcs:slow-start=100ms"}) {
    Laboratory there(false, {}, {fault});
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    std::vector<std::string> words{"devices", "fakes"};
    for (const std::string& set : there.ports) words.insert(words.end(), {"--set", set});
    const Result result = run_program(words);
    EXPECT_EQ(result.code, 0) << fault << result.out << result.err;
  }
}

// The start time, the program and the machine are in the report, the record and the MCAP file.
TEST(Fakes, ARunOnTheWallClockSaysWhenItBegan) {
  Laboratory there(false);
  const TemporaryFolder folder;
  const std::string record = folder.file("r.encrec"), mcap = folder.file("r.mcap");
  const nlohmann::json report =
      json_of(run_program(there.words({"--for-s", "0.5", "--json", "--record", record})));
  const std::string started = report["started"];
  EXPECT_THAT(started,
              testing::MatchesRegex("[0-9]{4}-[0-9]{2}-[0-9]{2}T[0-9]{2}:[0-9]{2}:[0-9]{2}\\.[0-9]{3}Z"));
  EXPECT_EQ(report["date"], started.substr(0, 10));
  const RecordTexts texts = RecordReader(record).texts();
  EXPECT_EQ(texts.at("started"), started);
  EXPECT_EQ(texts.at("commit"), report["commit"]);
  EXPECT_THAT(texts.at("machine"), HasSubstr(" cores, "));
  ASSERT_EQ(run_program({"export", record, "--mcap", mcap}).code, 0);
  const std::string bytes = bytes_of(mcap);
  for (const char* name : {"started", "commit", "commit_date", "date", "machine"})
    EXPECT_THAT(bytes, testing::AllOf(HasSubstr(name), HasSubstr(texts.at(name))));
}

// Dry: the run reads and computes everything, and sends no set-point.
TEST(Fakes, WithoutArmedTheMachineHearsNoSetPoint) {
  Laboratory there(false);
  const nlohmann::json dry = json_of(run_program(there.words({"--for-s", "2", "--json"})));
  EXPECT_GT(dry["withheld_commands"].get<int>(), 1000);
  EXPECT_THAT(there.log(), HasSubstr("it commanded 0 moves and 0 stops"));
  EXPECT_EQ(there.fakes->world().machine->state().pose.p(),
            there.fakes->world().machine->machine().zero().p());
  there.serve();
  EXPECT_GT(json_of(run_program(there.words({"--armed", "--yes", "--for-s", "2", "--json"})))["ticks"], 100);
  EXPECT_THAT(there.log(), testing::ContainsRegex("it commanded [1-9][0-9]+ moves and [1-9][0-9]* stops"));
}

// The program stops for 2 s. The machine stands at its last point and the first tick afterwards holds. No
// point is farther than one cycle allows: the fake refuses a farther one with error 8, and the run reports
// that.
TEST(Fakes, ARunThatWasStoppedHoldsOnItsNextTickAndMakesNothingUp) {
  Laboratory there(false);
  const TemporaryFolder folder;
  const std::string record = folder.file("stopped.encrec"), report = folder.file("report");
  ProgramProcess run(there.words({"--armed", "--yes", "--for-s", "8", "--record", record}), report);
  std::this_thread::sleep_for(std::chrono::milliseconds(4000));
  run.send(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  there.pause();
  EXPECT_TRUE(there.stands());
  EXPECT_GT(there.away(), 1e-3);
  there.serve();
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  run.send(SIGCONT);
  run.wait();
  const Result table = run_program({"export", record, "--csv", "-"});
  ASSERT_EQ(table.code, 0) << table.err;
  std::istringstream lines(table.out);
  std::string line, mode;
  std::getline(lines, line);
  EXPECT_EQ(line.rfind("time_s,mode,", 0), 0U);
  double before = 0.0;
  while (mode.empty() && std::getline(lines, line)) {
    const double time = std::stod(line);
    if (time - before > 1.5) mode = line.substr(line.find(',') + 1);
    before = time;
  }
  EXPECT_EQ(mode.substr(0, mode.find(',')), "hold");
  const std::string text = bytes_of(report);
  EXPECT_THAT(text, HasSubstr("modes"));
  EXPECT_THAT(text, testing::Not(HasSubstr("error 8")));
}

// A typed fault that is over does not return with the next client, although the world begins anew. A fault
// that still lasts stays.
TEST(Fakes, AFaultThatWasTypedBelongsToNoRun) {
  Laboratory there(false);
  const auto times = [&](const std::string& what) {
    const std::string log = there.log();
    int n = 0;
    for (std::size_t at = log.find(what); at != std::string::npos; at = log.find(what, at + 1)) ++n;
    return n;
  };
  const auto devices = [&] {
    there.serve();
    std::vector<std::string> words{"devices", "fakes"};
    for (const std::string& set : there.ports) words.insert(words.end(), {"--set", set});
    const std::int64_t before = there.fakes->begun();
    static_cast<void>(run_program(words));
    there.pause();
    EXPECT_GT(there.fakes->begun(), before);
  };
  there.pause();
  there.fakes->suffer(app::fault_of("netft:saturate", "the test"), "the test");
  EXPECT_EQ(times("netft suffers saturate"), 1);
  there.fakes->heal();
  EXPECT_EQ(times("netft is healed of saturate"), 1);
  there.fakes->suffer(app::fault_of("igtl:loss=20%+1000s", "the test"), "the test");
  devices();
  EXPECT_EQ(times("netft suffers saturate"), 1);
  EXPECT_EQ(times("igtl suffers loss"), 1);
  EXPECT_EQ(times("igtl is healed of loss"), 0);
  there.fakes->heal();
  EXPECT_EQ(times("igtl is healed of loss"), 1);
}

// The machine comes to rest within this time after any kill, s of its own time (docs/reference/safety.md). It
// has 44 ms of points and dead time, then 604 ms until its servo has settled from 50 mm/s
// (tests/benchmarks/wires/wired_trial.h).
constexpr double kRunsDry = 0.65;

// Kills until `times` of them met a moving machine: on a busy computer many a run only holds.
void kill_at_random_moments(int times) {
  Laboratory there(false);
  std::mt19937_64 random(20261126);
  double longest = 0.0;
  int moving = 0;
  const auto until_it_moves = [&] {
    for (int wait = 0; wait < 5000 && !there.moves; ++wait)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  for (int i = 0; moving < times && i < 5 * times; ++i) {
    ProgramProcess run(there.words({"--armed", "--yes"}), "/dev/null");
    // Kills at any moment, start-up included; most often at the highest speed, just after the motion begins.
    const bool any = i % 4 == 0;
    if (!any) until_it_moves();
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % (any ? 2000 : 400)));
    if (!any) until_it_moves();
    moving += there.moves ? 1 : 0;
    run.send(i % 2 == 0 ? SIGKILL : SIGTERM);
    run.wait();
    there.pause();
    there.fakes->turn();  // bytes under way arrive
    const double killed = there.time();
    for (int wait = 0; wait < 100 && there.time() <= killed + 1.2 * kRunsDry; ++wait) {
      there.serve();
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
      there.pause();
    }
    EXPECT_TRUE(there.stands()) << i;
    EXPECT_GT(there.time(), killed + kRunsDry) << "seen for too short a time";
    EXPECT_LE(there.moved, killed + kRunsDry) << i;
    longest = std::max(longest, there.moved - killed);
    there.moved = 0.0;  // the next run's world begins anew
    there.serve();
  }
  EXPECT_EQ(moving, times) << "it moved when it was killed";
  testing::Test::RecordProperty("longest_s", std::to_string(longest));
}
TEST(Fakes, AKilledRunLeavesTheMachineAtRest) { kill_at_random_moments(4); }
TEST(FakesLong, AKilledRunLeavesTheMachineAtRest) { kill_at_random_moments(70); }

TEST(Fakes, DevicesSaysWhatAnswersAndHowOften) {
  const Laboratory there(false);
  std::vector<std::string> words{"devices", "fakes"};
  for (const std::string& set : there.ports) words.insert(words.end(), {"--set", set});
  const Result result = run_program(words);
  EXPECT_EQ(result.code, 0) << result.err;
  for (const char* part : {"manipulator  C-887", "force        Net F/T at 127.0.0.1",
                           "tracker      tool data of", " samples a second; "})
    EXPECT_THAT(result.out, HasSubstr(part));
  for (const char* said :
       {"referenced (a fake)\n", "its command interface agrees (a fake)\n", "answered (a fake)\n"})
    EXPECT_THAT(result.out, HasSubstr(said)) << "each on its own wire";
  const Result none = run_program({"devices", "fakes", "--set", "rig.driver.gcs.port=1"});
  EXPECT_EQ(none.code, 3);
  EXPECT_THAT(none.out, HasSubstr("manipulator  NOT THERE: 127.0.0.1:1: nobody listens there"));
}

// The rig of the fakes is the simulated one with two exceptions: its drivers, and ten times the tolerance for
// late samples, because fakes share the processor with the run.
TEST(Fakes, TheirRigIsTheSimulatedOne) {
  const auto text = [](models::Setup setup) {
    for (std::string* driver : {&setup.rig.manipulator.driver, &setup.rig.force.driver,
                                &setup.rig.tracker.driver, &setup.rig.gripper.driver})
      *driver = "sim";
    setup.rig.drivers.clear();
    setup.rig.title.clear();
    return models::resolved(setup);
  };
  models::Setup fakes = models::load(kBall, "fakes");
  const models::Setup sim = models::load(kBall, "sim");
  EXPECT_EQ(fakes.rig.loop.late_cycles, 10 * sim.rig.loop.late_cycles);
  EXPECT_DOUBLE_EQ(fakes.rig.force.stale, 10.0 * sim.rig.force.stale);
  fakes.rig.loop.late_cycles = sim.rig.loop.late_cycles;
  fakes.rig.force.stale = sim.rig.force.stale;
  EXPECT_EQ(text(fakes), text(sim));
}

// The rig of the VisHap fakes is vishap.toml with other drivers, longer limits on time, fewer pictures of the
// background, and a hand that enters after them.
TEST(Fakes, TheRigOfTheVisHapFakesIsTheSimulatedOne) {
  const std::string wall = tests::source_dir() + "/models/scenes/camera/wall.toml";
  models::Setup fakes = models::load(wall, "fakes_vishap");
  const models::Setup sim = models::load(wall, "vishap");
  EXPECT_LT(fakes.rig.vision.segmentation.background_frames, sim.rig.vision.segmentation.background_frames);
  EXPECT_GT(fakes.twin.camera.hand_from, sim.twin.camera.hand_from);
  EXPECT_EQ(fakes.rig.loop.late_cycles, 40 * sim.rig.loop.late_cycles);
  EXPECT_DOUBLE_EQ(fakes.rig.arm.stale, 40.0 * sim.rig.arm.stale);
  EXPECT_DOUBLE_EQ(fakes.twin.arm.watchdog, 40.0 * sim.twin.arm.watchdog);
  EXPECT_DOUBLE_EQ(fakes.rig.tracker.lost_age, 2.0 * sim.rig.tracker.lost_age);
  fakes.rig.title = sim.rig.title;
  fakes.rig.drivers.clear();
  fakes.rig.arm.driver = sim.rig.arm.driver;
  fakes.rig.camera.driver = sim.rig.camera.driver;
  fakes.rig.hand_tracker.driver = sim.rig.hand_tracker.driver;
  fakes.rig.loop.late_cycles = sim.rig.loop.late_cycles;
  fakes.rig.arm.stale = sim.rig.arm.stale;
  fakes.rig.tracker.lost_age = sim.rig.tracker.lost_age;
  fakes.rig.vision.segmentation.background_frames = sim.rig.vision.segmentation.background_frames;
  fakes.twin.camera.hand_from = sim.twin.camera.hand_from;
  fakes.twin.arm.watchdog = sim.twin.arm.watchdog;
  EXPECT_EQ(models::resolved(fakes), models::resolved(sim));
}

// ---- Runs of the ball with poses from a tracker's own server, over TCP.

// The first touch, with poses from a tracker's own server over TCP in each of the two forms of request.
TEST(TrackerRun, InLockstepATrackersOwnServerGivesTheSameCommands) {
  const TemporaryFolder folder;
  const std::string none = folder.file("none.encrec");
  const std::vector<std::string> how{"--for-s", "9", "--json", "--record"};
  std::vector<std::string> pure{"run", kBall};
  pure.insert(pure.end(), how.begin(), how.end());
  pure.push_back(none);
  EXPECT_EQ(json_of(run_program(pure))["contacts"], 1);
  for (const std::string message : {"TRANSFORM", "TDATA"}) {
    const Laboratory there(true, {"rig.driver.igtl.transport=tcp", "rig.driver.igtl.message=" + message});
    std::vector<std::string> words = how;
    words.insert(words.end(), {folder.file(message), "--armed", "--lockstep"});
    EXPECT_EQ(json_of(run_program(there.words(words), {}, 400))["contacts"], 1) << message;
    expect_same_commands(folder.file(message), none);
  }
}

// The tracker's server hangs up in the middle of a run: the run holds and gives the reason, and the record
// has every tick to the last.
TEST(TrackerRun, ARecordOfARunWithAFaultIsWhole) {
  const Laboratory there(false, {"rig.driver.igtl.transport=tcp"}, {"igtl:disconnect@1500ms"});
  const TemporaryFolder folder;
  const std::string record = folder.file("fault.encrec");
  const Result run =
      run_program(there.words({"--armed", "--yes", "--for-s", "3", "--json", "--record", record}));
  EXPECT_EQ(run.code, 4) << run.err;
  const nlohmann::json report = nlohmann::json::parse(run.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << run.out;
  EXPECT_THAT(run.out, HasSubstr("then it hung up"));
  RecordReader reader(record);
  EXPECT_TRUE(reader.sealed());
  EXPECT_EQ(reader.ticks(), report["ticks"].get<std::int64_t>());
  RecordedTick last;
  std::int64_t before = -1;
  while (reader.next(last)) {
    ASSERT_GT(last.tick.index, before);
    before = last.tick.index;
  }
  EXPECT_EQ(last.out.mode, Mode::hold);
  EXPECT_NE(last.out.why & kTrackerFault, 0U);
}

// ---- `encounter calibrate rig` over the wires of the laboratory: the machine that moves from pose to pose
// has a wire of its own, and so have force sensor and tracker.

const std::string kClamped = tests::source_dir() + "/models/scenes/clamped_tool.toml";
const std::vector<std::string> kWrong{
    "truth.frames.W_C.position_mm=[3, -896, 600]", "truth.frames.W_C.rotation_deg=[1, -1, 1.4]",
    "truth.force.turned_deg=[1, 1, -1.4]", "truth.hexapod.mass_kg=1.11", "truth.tracker.bias_mm=[0, 0, 0]"};

std::vector<std::string> calibrating(const Laboratory& there, const std::vector<std::string>& more) {
  std::vector<std::string> all{"calibrate", "rig", "fakes", "--armed", "--lockstep"};
  for (const std::string& set : there.ports) all.insert(all.end(), {"--set", set});
  all.insert(all.end(), more.begin(), more.end());
  return all;
}

TEST(CalibrateRig, FindsBehindItsWiresWhatTheRigDoesNotKnow) {
  const Laboratory there(true, kWrong, {}, kClamped);
  const TemporaryFolder folder;
  const std::string file = folder.file("measured.toml");
  const Result r = run_program(
      calibrating(there, {"--poses", "12", "--json", "--scene", kClamped, "--out", file}), {}, 400);
  ASSERT_EQ(r.code, 0) << r.err;
  const auto told = nlohmann::json::parse(r.out);
  const auto force = told["force"], tracker = told["tracker"];
  EXPECT_NEAR(force["mass_kg"].get<double>(), 1.11, 3 * force["mass_half_kg"].get<double>());
  EXPECT_LT(force["mass_half_kg"].get<double>(), 0.05);
  const std::vector<double> place{3, -896, 600};
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_NEAR(tracker["position_mm"][a].get<double>(), place[a],
                3 * tracker["position_half_mm"][a].get<double>());
  EXPECT_LT(tracker["origin_half_mm"][0].get<double>(), 0.05);
  EXPECT_EQ(told["unseen"], 0);
  EXPECT_TRUE(std::filesystem::exists(file));
}

// The force sensor falls silent: the command ends at once and writes no file.
TEST(CalibrateRig, WhatFailsOnTheWayEndsItAndLeavesNoFile) {
  const Laboratory there(true, {}, {"netft:stall@4s"}, kClamped);
  const TemporaryFolder folder;
  const std::string file = folder.file("measured.toml");
  const Result r =
      run_program(calibrating(there, {"--poses", "12", "--scene", kClamped, "--out", file}), {}, 400);
  EXPECT_EQ(r.code, 3) << r.out << r.err;
  EXPECT_THAT(r.err, HasSubstr("the machine is in hold"));
  EXPECT_FALSE(std::filesystem::exists(file));
  EXPECT_FALSE(std::filesystem::exists(file + ".part"));
}

}  // namespace
}  // namespace enc::test
