// The fake of a headset that streams hands: it sends each hand of a tracker in two lines, over UDP to the PC,
// or over TCP to the PC that connects.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/hand/drive/settings.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/send_queue.h"
#include "hw_drivers/net/socket.h"

namespace enc::hand {

// The two lines of a hand.
[[nodiscard]] std::string lines_of(const Measurement<HandSample>& hand, std::int64_t frame, bool from_wrist);

class Server final : public Fake {
 public:
  // TCP with settings.port 0: any free port. Throws Error (kind device) if it cannot listen there. `tracker`
  // must outlive the server.
  Server(HandTracker& tracker, const HandSettings& settings, std::uint64_t seed = 1,
         std::string name = "headset");

  [[nodiscard]] std::uint16_t port() const { return socket_.port(); }
  [[nodiscard]] std::string describe() const override;
  void serve(Time now) override;
  void publish(Time now) override;
  void wait_on(std::vector<int>& descriptors) const override;
  [[nodiscard]] bool knows(const Trouble& trouble) const override;
  void suffer(const Trouble& trouble) override;
  void heal(Trouble::Kind kind) override;

 private:
  void leave(Time now);

  HandTracker& tracker_;
  HandSettings settings_;
  std::string name_;
  net::Socket socket_, client_;  // client_: TCP only
  net::BadLine line_;
  net::SendQueue unsent_;
  std::int64_t frame_ = 0;
};

// The fake of a rig's [driver.hand], in front of its hand tracker.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);
// A fake of another driver that sends these lines.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer, const HandSettings& settings,
                                           const std::string& name);

}  // namespace enc::hand
