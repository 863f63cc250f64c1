// A fake controller whose time goes on by a cycle with each set-point. Nothing runs beside the loop: what is
// read is what the last set-point led to, however long the answer takes, so that a run over the wire is the
// same each time.
#pragma once

#include <memory>
#include <string>

#include "hw_drivers/gcs/drive/controlled.h"
#include "hw_drivers/gcs/wire/answer.h"

namespace enc::gcs {

class LockstepManipulator final : public Manipulator {
 public:
  // Throws Error (kind device) as inspect() does, and where the controller keeps a time of its own.
  LockstepManipulator(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link);

  [[nodiscard]] std::string describe() const override { return machine_.describe(); }
  [[nodiscard]] bool is_fake() const override { return machine_.found().fake; }
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] Reach reach() const override { return machine_.reach(); }
  // Both wait for the answer, timeout_ms at most.
  Stamped<TipSample> read(Time now) noexcept override;
  void command(const Pose<'R', 'H'>& X_RH) noexcept override;
  void stop() noexcept override;

 private:
  void send(std::string_view bytes) noexcept;
  [[nodiscard]] std::string_view hear() noexcept;  // the next answer, until the next call; empty: lost
  void lose(const std::string& why) noexcept;

  Controlled machine_;
  double period_;  // s
  AnswerReader reader_;
  std::array<char, kMostText> bytes_{};
  std::string_view heard_;  // of these, what was not read yet
  TipSample sample_;
  Health said_ = Health::ok;  // of the last set-point
  bool linked_ = true, told_ = false;
};

}  // namespace enc::gcs
