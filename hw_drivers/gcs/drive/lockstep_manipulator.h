// Driver for a fake controller whose time advances by a cycle with each set-point. It has no parallel
// activity: each reading is the result of the last set-point, however long the answer takes. So a run over
// this protocol is the same each time.
#pragma once

#include <memory>
#include <string>

#include "hw_drivers/gcs/drive/controlled.h"
#include "hw_drivers/gcs/wire/answer.h"

namespace enc::gcs {

class LockstepManipulator final : public Manipulator {
 public:
  // Throws Error (kind device) as inspect() does, and if the controller has its own time.
  LockstepManipulator(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link);

  [[nodiscard]] std::string describe() const override { return machine_.describe(); }
  [[nodiscard]] bool is_fake() const override { return machine_.found().fake; }
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] Reach reach() const override { return machine_.reach(); }
  // Both wait for the answer, at most timeout_ms.
  Stamped<TipSample> read(Time now) noexcept override;
  void command(const Pose<'R', 'H'>& X_RH) noexcept override;
  void stop() noexcept override;

 private:
  void send(std::string_view bytes) noexcept;
  [[nodiscard]] std::string_view
  hear() noexcept;  // the next answer, valid until the next call; empty: link lost
  void lose(const std::string& why) noexcept;

  Controlled machine_;
  double period_;  // s
  AnswerReader reader_;
  std::array<char, kMostText> bytes_{};
  std::string_view heard_;  // unread part of bytes_
  TipSample sample_;
  Health said_ = Health::ok;  // health of the last set-point
  bool linked_ = true, told_ = false;
};

}  // namespace enc::gcs
