// The driver of a headset that streams hands in lines of text. It is read within the loop: received data are
// already in the socket, and it never waits.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/driver.h"
#include "hw_drivers/hand/drive/reception.h"
#include "hw_drivers/hand/drive/settings.h"
#include "hw_drivers/hand/wire/line.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"

namespace enc::hand {

class LineTracker final : public HandTracker {
 public:
  // Waits for the first hand. Throws Error (kind device) if none comes.
  LineTracker(const Offer& offer, const HandSettings& settings);

  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool is_fake() const override { return fake_; }
  // Over UDP a hand that comes back brings the link back: nothing moves by it.
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  bool poll(Time now, Measurement<HandSample>& newest) noexcept override;

 private:
  bool take_all(Time now) noexcept;  // what has been received; true: a newer hand
  bool take_lines(Time came) noexcept;
  void first_hand();

  HandSettings settings_;
  net::Socket socket_;
  Lines lines_;
  Reception reception_;
  net::Arrival arrival_;
  Measurement<HandSample> newest_;
  Time heard_{};
  bool lockstep_, fake_ = false, polled_ = false, linked_ = true;
  std::int64_t losses_ = 0;
};

[[nodiscard]] std::unique_ptr<HandTracker> listening(const Offer& offer);

}  // namespace enc::hand
