// Evaluates lines: joins a wrist with its landmarks to a hand, and finds the time of it. It uses neither
// sockets nor clocks.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/base/hand_sample.h"
#include "core/base/sample.h"
#include "hw_drivers/hand/drive/settings.h"
#include "hw_drivers/hand/wire/line.h"
#include "hw_drivers/net/clocks.h"

namespace enc::hand {

struct Counts {
  std::int64_t hands = 0;
  std::int64_t wrong = 0;    // not a line, or a hand that cannot be
  std::int64_t other = 0;    // the other hand, and the head
  std::int64_t old = 0;      // arrived after a newer one, or twice
  std::int64_t alone = 0;    // a wrist without landmarks, or the other way round
  std::int64_t missing = 0;  // frame numbers that never came
  std::int64_t steps = 0;    // its clock was set back
};

class Reception {
 public:
  explicit Reception(const HandSettings& settings)
      : settings_(settings), tie_(from_seconds(settings.least_delay)) {}

  // True if the line completes a newer hand.
  bool take(std::string_view line, Time came, Measurement<HandSample>& newest) noexcept;
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }
  [[nodiscard]] bool fake() const noexcept { return fake_; }
  [[nodiscard]] net::ClockEstimate clock() const noexcept { return tie_.estimate(); }

 private:
  [[nodiscard]] bool believed(std::string_view line, Time came, Packet& packet) noexcept;
  [[nodiscard]] bool is_newer(const Packet& packet, Time came) noexcept;
  [[nodiscard]] bool make(HandSample& hand) const noexcept;
  [[nodiscard]] Time time_of(Time came) noexcept;

  HandSettings settings_;
  net::ClockTie tie_;
  Counts counts_;
  Packet wrist_, landmarks_;
  bool has_wrist_ = false, has_landmarks_ = false;  // not used yet
  bool fake_ = false, any_ = false, stamped_ = false;
  std::int64_t frame_ = 0, stamp_ = 0;  // of the last hand
  Time came_{};                         // arrival of the last hand
};

}  // namespace enc::hand
