// Tool data from a server: datagrams as in [VHMR 2], or a stream from the tracker's own server, such as PLUS.
// It is a PoseTracker that is read within the loop: received data are already in the socket, and it never
// waits.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/devices/driver.h"
#include "hw_drivers/igtl/drive/reception.h"
#include "hw_drivers/igtl/drive/settings.h"
#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"

namespace enc::igtl {

// The connection to a server of tool data: datagrams, or a stream. It transfers single messages and never
// waits.
class Line {
 public:
  // Throws Error (kind device) if no server listens there.
  explicit Line(const IgtlSettings& settings);

  void say(const OutgoingMessage& message) noexcept;
  // The next message; empty: no message yet. Valid until the next call.
  [[nodiscard]] std::span<const std::byte> next() noexcept;
  [[nodiscard]] Duration came() const noexcept {
    return socket_.came();
  }  // arrival of that message, by net::steady_now()
  void wait(Duration most) noexcept { socket_.wait(most); }
  // Stream only: true if the server has closed the connection or sends something other than OpenIGTLink.
  [[nodiscard]] bool closed() const noexcept { return streams_ && (socket_.closed() || stuck_); }
  [[nodiscard]] bool lost() const noexcept { return stream_.lost(); }
  [[nodiscard]] std::int64_t skipped() const noexcept { return stream_.skipped(); }

 private:
  bool streams_, stuck_ = false;  // `stuck_`: it took only half of a message
  net::Socket socket_;
  Stream stream_;
  std::array<std::byte, kMostBytes> datagram_{};
};

class IgtlTracker final : public PoseTracker {
 public:
  // Asks the server to send, and waits for its first message. Throws Error (kind device) if no message comes.
  IgtlTracker(const Offer& offer, const IgtlSettings& settings);
  IgtlTracker(const IgtlTracker&) = delete;
  IgtlTracker& operator=(const IgtlTracker&) = delete;
  ~IgtlTracker() override;  // asks the server to stop

  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool is_fake() const override { return fake_; }
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  [[nodiscard]] std::string refused() const override;
  bool poll(Time now, Measurement<TrackedTool>& newest) noexcept override;

 private:
  void ask() noexcept;  // requests data from the server
  void first_answer();
  // Stream only: queries the status of a silent server, because one whose tools are out of view still
  // answers.
  void keep_awake(Time now) noexcept;
  void say(const char* what, std::span<const std::byte> content = {}) noexcept;
  [[nodiscard]] bool take_next(Time now) noexcept;  // true: a message has come
  void begin_run(Time now) noexcept;                // discards messages from before the run

  IgtlSettings settings_;
  Reception reception_;
  Line line_;
  net::Arrival arrival_;
  Measurement<TrackedTool> newest_;
  Time begun_{}, asked_{}, heard_{};
  bool fake_ = false;  // identified by the name in its STATUS
  bool polled_ = false, begun_run_ = false, linked_ = true, lockstep_, news_ = false;
  int settled_ = 0;
};

[[nodiscard]] std::unique_ptr<PoseTracker> subscribed(const Offer& offer);

}  // namespace enc::igtl
