// The fake coupler on a port, for one client at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/gripper/fake/coupler_image.h"
#include "hw_drivers/gripper/wire/requests.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/send_queue.h"
#include "hw_drivers/net/socket.h"

namespace enc::gripper {

class Server final : public Fake {
 public:
  // settings.port 0: any free port. Throws Error (kind device) if it cannot listen there. `gripper` and `log`
  // must outlive the server.
  Server(Gripper& gripper, const GripperSettings& settings, double force, Log& log, bool lockstep = false,
         std::uint64_t seed = 1);

  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }
  [[nodiscard]] const CouplerImage& image() const { return image_; }
  [[nodiscard]] std::string describe() const override;
  void serve(Time now) override;
  void publish(Time now) override;
  void wait_on(std::vector<int>& descriptors) const override;
  [[nodiscard]] bool knows(const Trouble& trouble) const override;
  void suffer(const Trouble& trouble) override;
  void heal(Trouble::Kind kind) override;

 private:
  void accept(Time now);
  bool answer(Time now);  // returns true if data came
  void send(Time now);
  void leave();  // handles the end of the connection

  CouplerImage image_;
  std::string address_;
  Log& log_;
  bool lockstep_;
  net::Socket listener_, client_;
  Requests requests_;
  net::BadLine line_;
  net::SendQueue unsent_;
  std::int64_t switched_before_ = 0, fallbacks_ = 0;
};

// The fake of a rig's [driver.gripper], in front of its gripper.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::gripper
