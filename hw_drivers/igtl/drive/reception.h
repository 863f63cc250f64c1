// What is made of datagrams: which are news, and what time it was. It knows neither sockets nor clocks.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/sample.h"
#include "hw_drivers/igtl/drive/settings.h"
#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/net/clock_tie.h"

namespace enc::igtl {

struct Counts {
  std::int64_t poses = 0;
  std::int64_t missing = 0;  // numbers that never came, or came too late
  std::int64_t old = 0;      // came behind a newer one, or twice
  std::int64_t wrong = 0;    // no message, or of a tool that the scene does not know
  std::int64_t steps = 0;    // of the other clock, back
  int status = 0;            // the last that the server reported and that is not 1, all is well
};

class Reception {
 public:
  // The names of the scene's tools, by index. Lockstep: the other clock is this one.
  Reception(const IgtlSettings& settings, std::span<const std::string> tools, bool lockstep);

  // True where `newest` is new.
  bool take(std::span<const std::byte> datagram, Time now, Stamped<TrackedTool>& newest) noexcept;
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }
  [[nodiscard]] bool heard() const noexcept { return heard_; }  // anything that is a message
  [[nodiscard]] Time last() const noexcept { return last_; }    // when

 private:
  void set_back() noexcept;  // the other clock was

  std::vector<Name<20>> devices_;
  bool lockstep_;
  net::ClockTie tie_;
  Counts counts_;
  bool heard_ = false, numbered_ = false;
  std::uint32_t number_ = 0;
  std::vector<std::int64_t> stamps_ns_;  // of each tool, the last
  Time last_{};
};

}  // namespace enc::igtl
