// The driver of a force-controlled arm whose device runs in a thread of its own.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/devices/driver.h"
#include "hw_drivers/arm/servo.h"

namespace enc::arm {

// Loop: the device and its thread. It has device(), servo(), and shut(), which ends the thread and returns
// false if the thread hangs in the vendor's library.
template <class Loop>
class ThreadedArm final : public HapticArm {
 public:
  explicit ThreadedArm(std::unique_ptr<Loop> loop) : loop_(std::move(loop)) {}
  ThreadedArm(const ThreadedArm&) = delete;
  ThreadedArm& operator=(const ThreadedArm&) = delete;
  ~ThreadedArm() override {
    loop_->servo().stop();
    // A thread that hangs in the vendor's library may come back, so its data must stay.
    if (!loop_->shut()) keep(std::move(loop_));
  }

  [[nodiscard]] std::string describe() const override { return loop_->device().describe(); }
  [[nodiscard]] bool is_fake() const override { return loop_->device().is_fake(); }
  [[nodiscard]] bool linked() const noexcept override { return loop_->servo().linked(); }
  [[nodiscard]] std::vector<std::string> remarks() const override {
    return loop_->servo().remarks(describe());
  }
  [[nodiscard]] ArmAbility ability() const override { return loop_->device().ability(); }
  Measurement<ArmSample> read(Time now) noexcept override { return loop_->servo().read(now); }
  void command(const Vec<'R'>& force) noexcept override { loop_->servo().command(force); }
  void stop() noexcept override { loop_->servo().stop(); }

 private:
  // Keeps a loop whose thread hangs until the process ends, and never destroys it.
  static void keep(std::unique_ptr<Loop> loop) {
    static auto* const kKept = new std::vector<std::unique_ptr<Loop>>;
    kKept->push_back(std::move(loop));
  }

  std::unique_ptr<Loop> loop_;
};

}  // namespace enc::arm
