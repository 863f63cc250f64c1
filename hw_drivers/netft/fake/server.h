// The fake box on its ports: records over UDP to the last client, its page over HTTP, its command interface
// over TCP.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/netft/fake/box.h"

namespace enc::netft {

struct Ports {
  std::uint16_t records = 0, page = 0, commands = 0;
};

class Server final : public Fake {
 public:
  // Port 0: any free port. Throws Error (kind device) if it cannot listen there. `sensor` must outlive the
  // server.
  Server(ForceSensor& sensor, const Configuration& configuration, const std::string& address,
         const Ports& ports, std::uint64_t seed = 1);

  [[nodiscard]] std::uint16_t port() const { return records_.port(); }
  [[nodiscard]] std::uint16_t http_port() const { return listener_.port(); }
  [[nodiscard]] std::uint16_t command_port() const { return commands_.port(); }
  [[nodiscard]] Box& box() { return box_; }
  [[nodiscard]] std::string describe() const override;
  void serve(Time now) override;
  void publish(Time now) override;
  void wait_on(std::vector<int>& descriptors) const override;
  [[nodiscard]] bool knows(const Trouble& trouble) const override;
  void suffer(const Trouble& trouble) override;
  void heal(Trouble::Kind kind) override;

 private:
  struct Reader {
    net::Socket socket;
    std::string asked, unsent;
    bool answered = false;
  };
  void send(Time now);
  static void accept(net::Socket& listener, std::vector<Reader>& readers);
  void serve_page();
  void serve_commands(Time now);

  Box box_;
  std::string address_;
  net::Socket records_, listener_, commands_;
  net::BadLine line_;  // records only; page and commands are only available or not
  std::vector<Reader> readers_, askers_;
};

// The fake of a rig's [driver.netft], in front of its force sensor.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::netft
