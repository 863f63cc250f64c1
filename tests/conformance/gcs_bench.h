// The driver of the C-887 with the fake controller at the other end of its link, on the wall clock. The
// driver's thread is also the fake's: what goes out is answered at once, and its time passes while that
// waits.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <string>
#include <thread>

#include "core/latest.h"
#include "hw_drivers/gcs/drive/gcs_manipulator.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "hw_drivers/net/steady.h"
#include "tests/support/default_offer.h"
#include "tests/support/devices/following_machine.h"
#include "trial/device_log.h"

namespace enc::test {

// As the loop does: a set-point follows the reading of its tick.
inline void tell(Manipulator& machine, const Pose<'R', 'H'>& to) {
  static_cast<void>(machine.read(Time{}));
  machine.command(to);
}

struct GcsBench {
  // What of the fake may be seen while the driver lives.
  struct Seen {
    double x = 0.0;  // m
    bool at_rest = true;
  };

  class FakeLink final : public gcs::Link {
   public:
    explicit FakeLink(GcsBench& bench) : bench_(bench) {}
    std::size_t send(std::string_view bytes) noexcept override {
      if (closed()) return 0;
      const std::string_view answers = bench_.controller.take(bytes);
      if (!bench_.silent) answers_.append(answers);
      return bytes.size();
    }
    std::size_t receive(std::span<char> into) noexcept override {
      const std::size_t size = std::min(into.size(), answers_.size());
      std::copy_n(answers_.begin(), size, into.begin());
      answers_.erase(0, size);
      return size;
    }
    [[nodiscard]] bool closed() const noexcept override { return bench_.hung_up; }
    void wait(Duration most) noexcept override {
      if (answers_.empty()) std::this_thread::sleep_for(most);
      bench_.pass(now());
    }
    [[nodiscard]] Duration now() const noexcept override { return net::steady_now(); }

   private:
    GcsBench& bench_;
    std::string answers_;
  };

  explicit GcsBench(const gcs::ControllerSettings& with = {}) : controller(machine, with) {
    settings.watchdog = 0.05;  // s: other tests take the processor, too
  }
  Offer offer() { return {defaults.table, defaults.rig, machine.can, Duration(1'000'000), log}; }
  std::unique_ptr<Manipulator> driver() {
    return std::make_unique<gcs::GcsManipulator>(offer(), settings, std::make_unique<FakeLink>(*this));
  }
  // Of the driver's thread while there is one.
  void pass(Duration now) noexcept {
    time = now;
    if (const int error = failure.exchange(gcs::kNoError); error != gcs::kNoError) controller.fail(error);
    controller.cycle(Time(now));
    latest.write({controller.measured()[0], controller.at_rest()});
  }
  Seen seen() noexcept {
    latest.read(seen_);
    return seen_;
  }

  DefaultOffer defaults;
  gcs::GcsSettings settings;
  trial::DeviceLog log;
  FollowingMachine machine;
  gcs::Controller controller;
  Duration time{};
  std::atomic<int> failure = gcs::kNoError;
  std::atomic<bool> silent = false, hung_up = false;

 private:
  Latest<Seen> latest;
  Seen seen_;
};

}  // namespace enc::test
