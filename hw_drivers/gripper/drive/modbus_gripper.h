// The drivers of a gripper on a Modbus TCP coupler.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/latest.h"
#include "core/devices/driver.h"
#include "hw_drivers/gripper/drive/conversation.h"
#include "hw_drivers/gripper/drive/coupler.h"
#include "hw_drivers/gripper/drive/settings.h"

namespace enc::gripper {

// The constructor inspects the coupler. From then on a thread owns the link; the loop gives it the newest
// command and takes the newest report. In lockstep with a fake there is no thread, and each reading waits for
// the answers.
class ModbusGripper final : public Gripper {
 public:
  // Throws Error (kind device) as inspect() does.
  ModbusGripper(const Offer& offer, const GripperSettings& settings);
  ModbusGripper(const ModbusGripper&) = delete;
  ModbusGripper& operator=(const ModbusGripper&) = delete;
  ~ModbusGripper() override;

  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool is_fake() const override { return found_.fake; }
  [[nodiscard]] bool linked() const noexcept override { return linked_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  Measurement<GripSample> read(Time now) noexcept override;
  void command(const Grip& grip) noexcept override;
  void stop() noexcept override;  // moving jaws come to rest, a grip stays

 private:
  void talk() noexcept;
  void turn() noexcept;

  GripperSettings settings_;
  Coupler coupler_;
  Inspection found_;
  Log& log_;
  bool lockstep_;

  // Used by the loop.
  Order order_;
  Report report_;
  Health said_ = Health::ok;  // of the last command
  Time stamp_{};
  Duration tick_{};  // of the last reading, in the run's time
  bool read_ = false;

  // Used by the thread; in lockstep by the loop.
  Conversation conversation_;
  Trap told_ = Trap::none;  // the last one that a person was told of

  // Shared by both.
  LatestValue<Order> orders_;
  LatestValue<Report> reports_;
  std::atomic<std::int64_t> stops_ = 0, turns_ = 0, traps_ = 0;
  std::atomic<Duration::rep> longest_ = 0;
  std::atomic<bool> linked_ = true, end_ = false;
  std::thread thread_;
};

[[nodiscard]] std::unique_ptr<Gripper> connected(const Offer& offer);

}  // namespace enc::gripper
