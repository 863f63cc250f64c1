// Evaluates messages: which are new, for which tool, and at what time. It uses neither sockets nor clocks.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "core/base/sample.h"
#include "hw_drivers/igtl/drive/held_tool.h"
#include "hw_drivers/igtl/drive/settings.h"
#include "hw_drivers/igtl/wire/content.h"
#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/net/clocks.h"

namespace enc::igtl {

struct Counts {
  std::int64_t poses = 0;
  std::int64_t missing = 0;      // numbers that never came, or came too late
  std::int64_t old = 0;          // arrived after a newer one, or twice
  std::int64_t wrong = 0;        // not a message, or without a pose; a wrong CRC is counted below
  std::int64_t checksum = 0;     // messages with a wrong CRC
  std::int64_t no_checksum = 0;  // messages with a wrong CRC of 0
  std::int64_t standing = 0;     // poses with the stamp of the last two poses
  std::int64_t repeated = 0;     // poses equal to the last one, to the bit
  std::int64_t unknown = 0;      // poses of a tool that the scene does not name
  std::int64_t unseen = 0;       // poses of a tool that is out of view by the server's own report
  // Poses of a visible tool that is not in the hand.
  std::int64_t aside = 0;
  std::int64_t steps = 0;  // backward steps of the tracker's clock
  int status = 0;          // last status of the server other than 1 (all is well)
  Name<20> stranger;       // the first device that the scene does not name
};

class Reception {
 public:
  // `tools`: names of the scene's tools, by index. In lockstep the tracker's clock equals the run's.
  Reception(const IgtlSettings& settings, std::span<const std::string> tools, bool lockstep);

  // Returns true if `newest` is new.
  bool take(std::span<const std::byte> message, Time now, Measurement<TrackedTool>& newest) noexcept;
  [[nodiscard]] std::string expected() const;  // "'stylusToTracker' or 'knifeToTracker'"
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }
  [[nodiscard]] net::ClockEstimate clock() const noexcept { return tie_.estimate(); }
  [[nodiscard]] bool heard() const noexcept { return heard_; }  // a valid message has come
  [[nodiscard]] Time last() const noexcept { return last_; }    // time of the last valid message

 private:
  // The data of one tool in a message.
  struct ToolMessage {
    Name<20> device;
    Pose<'C', 'T'> X_CT;
    std::int64_t stamp_ns = 0;
  };
  [[nodiscard]] bool is_newer(const Message& message) noexcept;  // compares message numbers
  [[nodiscard]] bool take_one(const ToolMessage& told, Time now, Measurement<TrackedTool>& newest) noexcept;
  bool take_all(const Message& message, Time now, Measurement<TrackedTool>& newest) noexcept;
  [[nodiscard]] bool goes_back(std::size_t tool, std::int64_t stamp_ns) noexcept;
  void count_old(std::size_t tool, std::int64_t stamp_ns) noexcept;
  void set_back() noexcept;  // the tracker's clock was set back
  void count_wrong(MessageFault why) noexcept;

  std::vector<Name<20>> devices_, tools_;
  bool lockstep_, ordered_;
  net::ClockTie tie_;
  HeldToolFinder in_hand_;
  Counts counts_;
  bool heard_ = false, numbered_ = false;
  std::uint32_t number_ = 0;
  std::vector<std::int64_t> stamps_ns_;  // last stamp of each tool
  std::vector<std::int64_t> behind_ns_;  // last stamp that was not newer, unless a newer one came since
  std::vector<std::int64_t> again_;      // number of consecutive repeats of the last stamp
  std::vector<Pose<'C', 'T'>> poses_;    // last poses
  std::int64_t newest_ns_ = std::numeric_limits<std::int64_t>::min();  // newest stamp of all tools
  Time last_{};
};

}  // namespace enc::igtl
