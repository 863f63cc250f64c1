// Tool data from a server, in datagrams: the PoseTracker of [VHMR 2]. Read within the loop: what has come is
// in the socket, and nothing waits.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/devices/driver.h"
#include "hw_drivers/igtl/drive/reception.h"
#include "hw_drivers/net/arrival.h"
#include "hw_drivers/net/socket.h"

namespace enc::igtl {

class UdpTracker final : public PoseTracker {
 public:
  // Asks the server to send, and waits for its first datagram. Throws Error (kind device) where none comes.
  UdpTracker(const Offer& offer, const IgtlSettings& settings);
  UdpTracker(const UdpTracker&) = delete;
  UdpTracker& operator=(const UdpTracker&) = delete;
  ~UdpTracker() override;  // asks it to send no more

  [[nodiscard]] std::string describe() const override;
  [[nodiscard]] bool linked() const noexcept override { return linked_; }
  [[nodiscard]] std::vector<std::string> remarks() const override;
  bool poll(Time now, Stamped<TrackedTool>& newest) noexcept override;

 private:
  void ask(const char* what) noexcept;

  IgtlSettings settings_;
  Reception reception_;
  net::Socket socket_;
  net::Arrival arrival_;
  Stamped<TrackedTool> newest_;
  Time begun_{};
  bool polled_ = false, linked_ = true, lockstep_;
};

[[nodiscard]] std::unique_ptr<PoseTracker> subscribed(const Offer& offer);

}  // namespace enc::igtl
