// A live stereo camera. A thread of its own captures and converts, so that neither the loop nor vision waits
// for it. After a camera was unplugged the thread opens it again.
#pragma once

#include <atomic>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/devices/driver.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/v4l2/drive/capture.h"
#include "hw_drivers/v4l2/drive/exchange.h"

namespace enc::v4l2 {

class LiveCamera final : public StereoCamera {
 public:
  // Opens the devices and waits for the first pair. Throws Error (kind device).
  LiveCamera(const Offer& offer, const V4l2Settings& settings, std::unique_ptr<System> system);
  LiveCamera(const LiveCamera&) = delete;
  LiveCamera& operator=(const LiveCamera&) = delete;
  ~LiveCamera() override;

  [[nodiscard]] std::string describe() const override { return words_; }
  [[nodiscard]] bool is_fake() const override { return capture_.fake(); }
  [[nodiscard]] bool linked() const noexcept override { return state_.load() == State::live; }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] ImageSize size() const override { return size_; }
  // The newest pair, stamped with the mean of its two exposures. A device that is unplugged (fault) or silent
  // (stale) is reported once, with the last pair.
  bool poll(Time now, Measurement<StereoFrame>& newest) noexcept override;

 private:
  enum class State : std::uint8_t { live, silent, gone };

  void first_pair();
  void work() noexcept;
  void turn();
  void come_back();
  void become(State state);

  std::unique_ptr<System> system_;
  V4l2Settings settings_;
  Log& log_;
  ImageSize size_;
  double rate_;
  Capture capture_;
  std::string words_;
  Exchange<StereoPicture> pictures_;
  std::atomic<State> state_ = State::live;

  mutable std::mutex counts_change_;  // the loop never takes it
  CaptureCounts counts_;              // as of the last turn
  std::int64_t unread_ = 0;           // pairs that poll() did not fetch; of the thread
  std::mutex stops_;
  std::condition_variable stopped_;
  std::atomic<bool> stop_ = false;

  // Of the caller of poll().
  net::Arrival arrival_;
  State told_ = State::live;
  bool polled_ = false, any_ = false;
  Time begun_{}, exposed_{};
  std::thread thread_;
};

}  // namespace enc::v4l2
