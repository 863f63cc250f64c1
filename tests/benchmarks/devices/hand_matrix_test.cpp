// The safety matrix of the hand tracker: whatever its line does, the run is the same to the bit, its link is
// lost in time, and no false hand is believed. In virtual time.
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "benchmarks/kit/parallel.h"
#include "hw_drivers/hand/drive/line_tracker.h"
#include "hw_drivers/hand/fake/server.h"
#include "models/setup/scene_file.h"
#include "tests/benchmarks/devices/driver_values.h"
#include "tests/benchmarks/devices/reaction.h"
#include "tests/support/built.h"
#include "tests/support/devices.h"
#include "trial/trial.h"

namespace enc::bench::devices {
namespace {

using Kind = Trouble::Kind;

// A hand that stands, 60 times a second.
struct StillHand final : HandTracker {
  bool poll(Time now, Measurement<HandSample>& newest) noexcept override {
    constexpr Duration kFrame{16'666'667};
    if (last != Time{} && now - last < kFrame) return false;
    last = now;
    newest = {hand(), now, Health::ok};
    return true;
  }
  static HandSample hand() {
    HandSample at;
    at.wrist = {Quat::Identity(), Vec3(0.1, -0.2, 0.3)};
    for (std::size_t i = 0; i < kHandJoints; ++i)
      at.joints[i] = at.wrist * Point<'K'>(0.01 * static_cast<double>(i), 0.02, -0.03);
    return at;
  }
  Time last{};
};

class HandLine {
 public:
  explicit HandLine(std::string transport) : transport_(std::move(transport)) {}
  void fit_out(Rig& rig) {
    hand::HandSettings settings;
    settings.address = "127.0.0.1";
    settings.transport = transport_;
    settings.port = settings.streams() ? 0 : net::bind_udp("127.0.0.1", 0).port();
    server_ = std::make_unique<hand::Server>(tracker_, settings);
    DriverValues table;
    table.numbers = {{"timeout_ms", 20.0}};  // s: a busy machine is slow
    table.wholes = {{"port", settings.streams() ? server_->port() : settings.port}};
    table.texts = {{"address", "127.0.0.1"}, {"transport", transport_}};
    std::atomic<bool> made = false;
    std::thread first([&] {  // the driver waits for its first hand
      for (Time now{}; !made; now += Duration(17'000'000)) {
        server_->serve(now);
        server_->publish(now);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
      }
    });
    test::DefaultOffer offer;
    rig.hand_tracker =
        hand::listening({table, offer.rig, offer.reach, Duration(1'000'000), offer.log, true, false});
    made = true;
    first.join();
    tracker_.last = {};
    rig.clock = std::make_unique<HandClock>(*this, std::move(rig.clock));
  }
  [[nodiscard]] hand::Server& server() { return *server_; }

 private:
  class HandClock final : public Clock {
   public:
    HandClock(HandLine& of, std::unique_ptr<Clock> clock) : of_(of), clock_(std::move(clock)) {}
    Tick next() override {
      const Tick tick = clock_->next();
      of_.server_->serve(tick.t);
      of_.server_->publish(tick.t);
      return tick;
    }

   private:
    HandLine& of_;
    std::unique_ptr<Clock> clock_;
  };
  std::string transport_;
  StillHand tracker_;
  std::unique_ptr<hand::Server> server_;
};

struct HandFault {
  const char* name;
  const char* transport;
  Kind kind;
  double value;
  double lost;        // ms until the link is lost, at most; kNever: it stays
  bool back = false;  // by itself, after the fault
};

// silent_ms (500) after the last hand, which is a frame old at most.
const std::vector<HandFault> kHandFaults{{"silent", "udp", Kind::stall, 1.0, 501, true},
                                         {"all noise", "udp", Kind::garbage, 1.0, 501, true},
                                         {"half messages", "udp", Kind::half_message, 1.0, 501, true},
                                         {"30 % lost", "udp", Kind::loss, 0.3, kNever},
                                         {"30 % behind the next", "udp", Kind::reorder, 0.3, kNever},
                                         {"half come twice", "udp", Kind::duplicate, 0.5, kNever},
                                         {"silent", "tcp", Kind::stall, 1.0, 501, true},
                                         {"closed", "tcp", Kind::disconnect, 1.0, 2},
                                         {"all noise", "tcp", Kind::garbage, 1.0, 501, true}};

constexpr Mode kHandModes[] = {Mode::away, Mode::follow, Mode::contact, Mode::hold};
constexpr int kFaulty = 600, kAfter = 100;  // ticks

struct HandCell {
  const HandFault* fault = nullptr;  // null: a run without it
  Mode mode = Mode::away;
  double lost = kNever;  // ms
  bool linked = false, wrong = false;
  std::uint64_t hash = 0;
  bool falsely = false;  // the driver hides a lost link, or feigns one
};

// What the link of a cell was or became against its row; empty: as stated.
std::string wrong_with(const HandCell& cell) {
  const HandFault& fault = *cell.fault;
  if (cell.linked != (fault.lost == kNever || fault.back)) return "link at the end";
  if ((cell.lost < kNever) != (fault.lost < kNever)) return "link lost or not";
  return cell.lost <= fault.lost ? "" : fmt::format("link lost after {} ms", cell.lost);
}

// The fault begins 20 ticks after the run has come into the mode.
void run(HandCell& cell) {
  HandLine line(cell.fault != nullptr ? cell.fault->transport : "udp");
  models::Setup setup = models::load(tests::source_dir() + "/models/scenes/wall.toml", "vishap",
                                     {"user.depth_mm=5", "user.press_s=0.5", "user.hold_s=1",
                                      "user.release_s=0.5", "user.rest_s=1", "user.approach_mm_s=[100]"});
  int since = -1;  // ticks since the mode was entered; -1: it was not
  trial::TrialOptions options;
  options.fit_out = [&](Rig& rig) { line.fit_out(rig); };
  options.disturb = [&](Inputs& in) {
    if (cell.mode == Mode::hold && since >= 0) in.tool.health = Health::fault;
  };
  std::unique_ptr<trial::Trial> trial;
  options.stop = [&] {
    if (since == 20 && cell.fault != nullptr) line.server().suffer({cell.fault->kind, cell.fault->value});
    if (since == 20 + kFaulty && cell.fault != nullptr) line.server().heal(cell.fault->kind);
    return since > 20 + kFaulty + kAfter;
  };
  options.watch = [&](const trial::Glance& glance) {
    const Mode first = cell.mode == Mode::hold ? Mode::follow : cell.mode;
    if (since >= 0 || glance.out.mode == first) ++since;
    cell.linked = trial->rig().hand_tracker->linked();
    if (cell.falsely && since > 20) cell.linked = cell.fault->lost < kNever;
    if (since > 20 && !cell.linked && cell.lost == kNever) cell.lost = since - 20;
    const auto& hand = trial->hand();
    cell.wrong = cell.wrong || (hand.health == Health::ok &&
                                (hand.value.joints[20] - StillHand::hand().joints[20]).norm() > 1e-9);
  };
  trial = std::make_unique<trial::Trial>(std::move(setup), options);
  cell.hash = trial->run().hash;
}

TEST(HandMatrix, EachFaultEndsAsStatedAndTheCoreNeverNotices) {
  std::vector<HandCell> cells;
  for (const Mode mode : kHandModes) cells.push_back({nullptr, mode});
  for (const HandFault& fault : kHandFaults)
    for (const Mode mode : kHandModes) cells.push_back({&fault, mode});
  in_parallel(cells.size(), [&](std::size_t i) { run(cells[i]); });
  for (std::size_t i = std::size(kHandModes); i < cells.size(); ++i) {
    const HandCell& cell = cells[i];
    const std::string name =
        fmt::format("{} ({}), in {}", cell.fault->name, cell.fault->transport, mode_name(cell.mode));
    EXPECT_EQ(cell.hash, cells[i % std::size(kHandModes)].hash) << name;
    EXPECT_FALSE(cell.wrong) << name;
    EXPECT_EQ(wrong_with(cell), "") << name;
    testing::Test::RecordProperty(name, fmt::format("link lost after {} ms", cell.lost));
  }
}

TEST(HandMatrixLong, EachRowFailsForAFalseLink) {
  std::vector<HandCell> cells;
  for (const HandFault& fault : kHandFaults) cells.push_back({.fault = &fault, .falsely = true});
  in_parallel(cells.size(), [&](std::size_t i) { run(cells[i]); });
  for (const HandCell& cell : cells) {
    EXPECT_NE(wrong_with(cell), "") << cell.fault->name;
    testing::Test::RecordProperty(fmt::format("{} ({})", cell.fault->name, cell.fault->transport),
                                  wrong_with(cell));
  }
}

}  // namespace
}  // namespace enc::bench::devices
