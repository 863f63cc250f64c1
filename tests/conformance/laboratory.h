// The laboratory in two programs: the fakes on one side of real sockets, in this process, where a test can
// see their machine; `encounter run` on the other.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "app/laboratory/fakes.h"
#include "app/modules/modules.h"
#include "core/record/record.h"
#include "hw_drivers/wires/fake_settings.h"
#include "tests/support/built.h"
#include "tests/support/run_program.h"

namespace enc::test {

inline const std::string kBall = tests::source_dir() + "/models/scenes/tennis_ball.toml";

// The fakes in this process, where a test can see their machine.
struct Laboratory {
  // `set` is for both sides; `faults` as for --fault.
  explicit Laboratory(bool lockstep, const std::vector<std::string>& set = {},
                      const std::vector<std::string>& faults = {}, const std::string& scene = kBall) {
    app::FakesOptions options{app::load_module, 1, lockstep};
    for (const std::string& fault : faults) options.faults.push_back(app::fault_of(fault, "the test"));
    const std::vector<std::string> all = lockstep ? wires::tight_times(set) : set;
    ports.insert(ports.end(), all.begin(), all.end());
    setenv("ENCOUNTER_MODULES", tests::module_folder().c_str(), 1);
    fakes = std::make_unique<app::Fakes>(models::load(scene, "fakes", ports), std::move(options));
    serve();
  }
  ~Laboratory() { pause(); }
  void serve() {
    end = false;
    thread = std::thread([this] {
      while (!end) {
        fakes->turn();
        now = time();
        moves = !stands();
        if (moves) moved = now;
      }
    });
  }
  void pause() {
    end = true;
    if (thread.joinable()) thread.join();
  }
  [[nodiscard]] std::vector<std::string> words(std::vector<std::string> more) const {
    std::vector<std::string> all{"run", kBall, "--rig", "fakes"};
    for (const std::string& set : ports) all.insert(all.end(), {"--set", set});
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  [[nodiscard]] std::string log() {
    pause();
    std::string all;
    for (const std::string& line : fakes->log()) all.append(line).push_back('\n');
    return all;
  }
  // State of the machine; call these while no thread serves it.
  [[nodiscard]] bool stands() const { return fakes->world().machine->state().velocity.norm() < 1e-4; }
  [[nodiscard]] double time() const {  // s, world time
    return seconds(fakes->world().truth().t.time_since_epoch());
  }
  [[nodiscard]] double away() const {  // m, distance from its zero
    const auto& machine = *fakes->world().machine;
    return (machine.state().pose.p() - machine.machine().zero().p()).norm();
  }
  std::vector<std::string> ports = wires::free_ports();
  std::unique_ptr<app::Fakes> fakes;
  std::atomic<bool> end = false, moves = false;  // `moves`: the machine moves now
  std::atomic<double> now = 0.0;                 // s, world time
  std::thread thread;
  double moved = 0.0;  // s, world time of the last motion
};

inline nlohmann::json json_of(const tests::Result& result) {
  EXPECT_EQ(result.code, 0) << result.out << result.err;
  return nlohmann::json::parse(result.out, nullptr, false);
}

// Compares each command of one run with that of the same tick in the other.
inline void expect_same_commands(const std::string& one, const std::string& other) {
  RecordReader a(one), b(other);
  EXPECT_EQ(a.ticks(), b.ticks());
  double farthest = 0.0, turned = 0.0;
  std::int64_t sent = 0;
  RecordedTick x, y;
  while (a.next(x) && b.next(y)) {
    ASSERT_EQ(x.out.mode, y.out.mode) << x.tick.index;
    ASSERT_EQ(x.out.manipulator.tip.valid(), y.out.manipulator.tip.valid()) << x.tick.index;
    if (!x.out.manipulator.tip.valid()) continue;
    ++sent;
    farthest = std::max(farthest, (x.out.manipulator.tip.p() - y.out.manipulator.tip.p()).norm());
    turned = std::max(turned, x.out.manipulator.tip.q().angularDistance(y.out.manipulator.tip.q()));
  }
  EXPECT_GT(sent, a.ticks() / 2);
  EXPECT_LT(farthest, 1e-12) << "the wire carries twelve digits of a millimetre";
  EXPECT_LT(turned, 1e-12);
}

}  // namespace enc::test
