// The driver of a hand tracker over LeapC. A thread waits for the library; the loop takes the newest frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/driver.h"
#include "hw_drivers/leap/drive/service.h"
#include "hw_drivers/leap/drive/settings.h"
#include "hw_drivers/leap/wire/leapc.h"
#include "hw_drivers/net/clocks.h"

namespace enc::leap {

class LeapTracker final : public HandTracker {
 public:
  // Waits for the first frame, in which no hand needs to be. Throws Error (kind device) if none comes.
  LeapTracker(const Offer& offer, const LeapSettings& settings, const leapc::Functions& leap);
  LeapTracker(const LeapTracker&) = delete;
  LeapTracker& operator=(const LeapTracker&) = delete;
  ~LeapTracker() override;

  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool is_fake() const override;
  // A frame that comes brings the link back: nothing moves by it.
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  bool poll(Time now, Measurement<HandSample>& newest) noexcept override;

 private:
  struct Counts {
    std::int64_t frames = 0, hands = 0;
    std::int64_t missing = 0;  // frame numbers that never came
    std::int64_t wrong = 0;    // a hand that cannot be, or a stamp from the future or long ago
    std::int64_t steps = 0;    // its clock was set back
    std::int64_t silent = 0;
  };
  void wait_for_device() const;
  bool evaluate(const Frame& frame, Time now, Measurement<HandSample>& newest) noexcept;
  [[nodiscard]] bool place_in_time(const Frame& frame, Time now, Time& exposed) noexcept;

  LeapSettings settings_;
  std::unique_ptr<Service> service_;
  net::Arrival arrival_;
  net::ClockTie tie_{Duration{}};  // of the library's clock and the loop's, which are read together
  Counts counts_;
  Frame frame_;
  std::int64_t number_ = 0, read_ = 0;  // of the last frame
  Time heard_{}, stamp_{};
  bool polled_ = false, any_ = false, linked_ = true;
};

// The driver by its table, with the vendor's library or the fake.
[[nodiscard]] std::unique_ptr<HandTracker> opened(const Offer& offer);

}  // namespace enc::leap
