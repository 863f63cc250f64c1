// A run that viewers watch while it happens (`run --live`): the ticks go to a thread of their own, so that no
// tick waits for a viewer.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <thread>

#include "app/live/live_module.h"
#include "core/record/record.h"
#include "trial/mcap/record_mcap.h"
#include "trial/time/real_time.h"
#include "trial/trial.h"

namespace enc::app {

struct LiveAddress {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  // 0: any free one
};
// Reads "[ADDRESS:]PORT". Throws Error.
[[nodiscard]] LiveAddress live_address(const std::string& text);

class LiveRun {
 public:
  // Listens, and says where. Throws Error. The trial must outlive this.
  LiveRun(const LiveAddress& at, const trial::Trial& trial, const RecordTexts& texts);
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;
  void add(const trial::Glance& glance) noexcept;  // never waits
  void end();                                      // says what viewers have missed

 private:
  void work(const std::stop_token& stop);
  static constexpr std::size_t kRoom = 8192;  // ticks, 8 s at 1 kHz
  std::unique_ptr<LiveServer> server_;
  trial::RecordMcap mcap_;
  trial::Queue<RecordedTick, kRoom> ticks_;
  std::jthread thread_;
};

}  // namespace enc::app
