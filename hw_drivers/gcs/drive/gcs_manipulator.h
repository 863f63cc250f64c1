// The drivers of a hexapod on a PI C-887, over GCS 2.0.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/latest.h"
#include "hw_drivers/gcs/drive/controller_driver.h"
#include "hw_drivers/gcs/drive/conversation.h"
#include "hw_drivers/gcs/wire/error_text.h"
#include "hw_drivers/gcs/wire/text.h"

namespace enc::gcs {

// The caller of GcsManipulator::turn(): a thread, on the wall clock; or the loop, in the link's time.
enum class Turns : std::uint8_t { thread, called };

// The constructor queries the controller. From then on a separate thread owns the link; the loop gives it the
// newest set-point and takes the newest position.
class GcsManipulator final : public Manipulator {
 public:
  GcsManipulator(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link,
                 Turns turns = Turns::thread);
  GcsManipulator(const GcsManipulator&) = delete;
  GcsManipulator& operator=(const GcsManipulator&) = delete;
  ~GcsManipulator() override;  // stops the machine if it was commanded

  [[nodiscard]] std::string describe() const override { return machine_.describe(); }
  [[nodiscard]] bool is_fake() const override { return machine_.found().fake; }
  [[nodiscard]] bool linked() const noexcept override { return linked_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] Reach reach() const override { return machine_.reach(); }
  Measurement<TipSample> read(Time now) noexcept override;
  void command(const Pose<'R', 'H'>& X_RH) noexcept override;
  // Waits until the stop is sent and no later command can follow it, or the link is gone; at most 100 ms.
  void stop() noexcept override;
  // Takes received data and sends what is due; returns false if the link is lost. With Turns::called, each
  // read() and command() calls it once.
  bool turn() noexcept;

 private:
  void talk() noexcept;  // the thread's function
  void publish() noexcept;
  // The second parameter is true if a set-point was sent: the machine may be moving and gets a stop.
  void lose(Loss loss, bool told) noexcept;

  ControllerDriver machine_;

  // Data of the loop.
  Order order_;
  Report report_;
  Time stamp_{};
  bool read_ = false;
  Duration tick_{};  // link's clock at the start of the tick: a set-point is as old as its inputs

  // Data of the caller of turn().
  Conversation conversation_;
  Order newest_;
  std::array<char, kMostText> bytes_{};
  std::string_view unsent_;
  int said_ = kNoError;  // last error reported to the user

  // Shared by both.
  LatestValue<Order> orders_;
  LatestValue<Report> reports_;
  std::atomic<std::int64_t> stops_sent_ = 0, answers_ = 0, watchdogs_ = 0;
  std::atomic<Duration::rep> longest_ = 0;
  std::atomic<bool> linked_ = true, end_ = false;
  std::thread thread_;
};

// Driver for a fake controller whose time advances by a cycle with each set-point. It has no parallel
// activity: each reading is the result of the last set-point, however long the answer takes. So a run over
// this protocol is the same each time.
class LockstepManipulator final : public Manipulator {
 public:
  // Throws Error (kind device) as inspect() does, and if the controller has its own time.
  LockstepManipulator(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link);

  [[nodiscard]] std::string describe() const override { return machine_.describe(); }
  [[nodiscard]] bool is_fake() const override { return machine_.found().fake; }
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] Reach reach() const override { return machine_.reach(); }
  // Both wait for the answer, at most timeout_ms.
  Measurement<TipSample> read(Time now) noexcept override;
  void command(const Pose<'R', 'H'>& X_RH) noexcept override;
  void stop() noexcept override;

 private:
  void send(std::string_view bytes) noexcept;
  [[nodiscard]] std::string_view
  hear() noexcept;  // the next answer, valid until the next call; empty: link lost
  void lose(const std::string& why) noexcept;

  ControllerDriver machine_;
  double period_;  // s
  AnswerReader reader_;
  std::array<char, kMostText> bytes_{};
  std::string_view heard_;  // unread part of bytes_
  TipSample sample_;
  Health said_ = Health::ok;  // health of the last set-point
  bool linked_ = true, told_ = false;
};

// The driver, connected over TCP by its table.
[[nodiscard]] std::unique_ptr<Manipulator> connected(const Offer& offer);

}  // namespace enc::gcs
