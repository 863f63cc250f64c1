// The fake controller on a port, for one client at a time.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/send_queue.h"
#include "hw_drivers/net/socket.h"

namespace enc::gcs {

class Server final : public Fake {
 public:
  // Port 0: any free port. Throws Error (kind device) if it cannot listen there. `machine` and `log` must
  // outlive the server. `begin` is called when a client connects.
  Server(Manipulator& machine, const ControllerSettings& settings, const std::string& address,
         std::uint16_t port, Log& log, std::function<void()> begin = {}, std::uint64_t seed = 1);

  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }
  [[nodiscard]] std::string describe() const override;
  void serve(Time now) override;
  void publish(Time now) override { controller_.cycle(now); }
  void wait_on(std::vector<int>& descriptors) const override;
  [[nodiscard]] bool knows(const Trouble& trouble) const override;
  void suffer(const Trouble& trouble) override;
  void heal(Trouble::Kind kind) override;

 private:
  bool accept(Time now);  // returns true if a client connected and its simulation was restarted
  bool answer(Time now);  // returns true if data came
  void send(Time now);
  void leave();  // handles the end of the connection

  Log& log_;
  bool lockstep_;  // time advances with its answers: none can be late or missing
  Controller controller_;
  std::string address_;
  std::function<void()> begin_;
  net::Socket listener_;
  net::Socket client_;
  std::int64_t told_before_ = 0, stops_before_ = 0;  // controller's counts when the client connected
  std::vector<Time> stopped_;                        // the client's first stops
  net::BadLine line_;
  net::SendQueue unsent_;
};

// The fake of a rig's [driver.gcs], in front of its manipulator.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::gcs
