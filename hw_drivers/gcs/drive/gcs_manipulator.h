// A hexapod on a PI C-887, over GCS 2.0. The constructor asks; from then on a thread of its own has the link,
// and the loop hands it the newest set-point and takes the newest position.
#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/devices/driver.h"
#include "core/latest.h"
#include "hw_drivers/gcs/drive/acceleration.h"
#include "hw_drivers/gcs/drive/conversation.h"
#include "hw_drivers/gcs/drive/inspect.h"
#include "hw_drivers/gcs/drive/link.h"

namespace enc::gcs {

class GcsManipulator final : public Manipulator {
 public:
  GcsManipulator(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link);
  GcsManipulator(const GcsManipulator&) = delete;
  GcsManipulator& operator=(const GcsManipulator&) = delete;
  ~GcsManipulator() override;  // stops what was told to move

  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool linked() const noexcept override { return linked_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] Reach reach() const override { return reach_; }
  Stamped<TipSample> read(Time now) noexcept override;
  void command(const Pose<'R', 'H'>& X_RH) noexcept override;
  // Waits until the stop was sent, or the link is gone, at most 100 ms.
  void stop() noexcept override;

 private:
  [[nodiscard]] std::string ask(std::string_view line);
  void talk() noexcept;  // the thread
  void publish(const Conversation& conversation, int& said) noexcept;
  void lose(Loss loss) noexcept;

  GcsSettings settings_;
  Log& log_;
  std::unique_ptr<Link> link_;
  Found found_;
  Reach reach_;

  // Of the loop.
  Pose<'R', 'H'> pose_;  // of the newest set-point
  Order order_;
  Report report_;
  Acceleration accelerations_;
  Vec<'R'> acceleration_ = Vec<'R'>::zero();
  Time stamp_{};
  bool read_ = false;
  Health health_ = Health::ok;  // of the newest set-point

  // Between the two.
  Latest<Order> orders_;
  Latest<Report> reports_;
  std::atomic<std::int64_t> stops_sent_ = 0, answers_ = 0, watchdogs_ = 0;
  std::atomic<Duration::rep> longest_ = 0;
  std::atomic<bool> linked_ = true, end_ = false, told_ = false;
  std::thread thread_;
};

}  // namespace enc::gcs
