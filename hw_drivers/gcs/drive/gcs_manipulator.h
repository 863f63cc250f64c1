// A hexapod on a PI C-887, over GCS 2.0. The constructor asks; from then on a thread of its own has the link,
// and the loop hands it the newest set-point and takes the newest position.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "core/base/latest.h"
#include "hw_drivers/gcs/drive/controlled.h"
#include "hw_drivers/gcs/drive/conversation.h"
#include "hw_drivers/gcs/wire/error_text.h"

namespace enc::gcs {

// Whose the turns are: a thread's, on the wall clock; or the caller's, in whatever time the link has.
enum class Turns : std::uint8_t { thread, called };

class GcsManipulator final : public Manipulator {
 public:
  GcsManipulator(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link,
                 Turns turns = Turns::thread);
  GcsManipulator(const GcsManipulator&) = delete;
  GcsManipulator& operator=(const GcsManipulator&) = delete;
  ~GcsManipulator() override;  // stops what was told to move

  [[nodiscard]] std::string describe() const override { return machine_.describe(); }
  [[nodiscard]] bool is_fake() const override { return machine_.found().fake; }
  [[nodiscard]] bool linked() const noexcept override { return linked_.load(std::memory_order_relaxed); }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] Reach reach() const override { return machine_.reach(); }
  Stamped<TipSample> read(Time now) noexcept override;
  void command(const Pose<'R', 'H'>& X_RH) noexcept override;
  // Waits until the stop was sent and nothing can come behind it, or the link is gone, at most 100 ms.
  void stop() noexcept override;
  // Takes what came and sends what is due; false: the link is lost. Each read() and command() makes one where
  // turns are called.
  bool turn() noexcept;

 private:
  void talk() noexcept;  // the thread
  void publish() noexcept;
  void lose(Loss loss, bool told) noexcept;  // told: it may be on its way

  Controlled machine_;

  // Of the loop.
  Order order_;
  Report report_;
  Time stamp_{};
  bool read_ = false;
  Duration tick_{};  // of the link's clock, when the tick began: a set-point is as old as what it was made of

  // Of who makes the turns.
  Conversation conversation_;
  Order newest_;
  std::array<char, kMostText> bytes_{};
  std::string_view unsent_;
  int said_ = kNoError;  // the last error that a person was told of

  // Between the two.
  Latest<Order> orders_;
  Latest<Report> reports_;
  std::atomic<std::int64_t> stops_sent_ = 0, answers_ = 0, watchdogs_ = 0;
  std::atomic<Duration::rep> longest_ = 0;
  std::atomic<bool> linked_ = true, end_ = false;
  std::thread thread_;
};

}  // namespace enc::gcs
