// The fake of a Net Box: its data and its ports.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/devices/device.h"
#include "core/devices/fake.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/send_queue.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/netft/drive/session.h"
#include "hw_drivers/netft/wire/messages.h"
#include "hw_drivers/netft/wire/page.h"

namespace enc::netft {

// Simulated Net Box for any force sensor of the core. It uses neither sockets nor clocks.

// A Gamma SI-130-10 on a box that sends a record each millisecond.
[[nodiscard]] Configuration gamma();

class Box {
 public:
  Box(ForceSensor& sensor, const Configuration& configuration) : sensor_(sensor), of_(configuration) {}

  // Takes a request, or other bytes; true: a record must be sent at once.
  bool take(std::span<const std::byte> request) noexcept;
  [[nodiscard]] bool streams() const noexcept { return streams_; }
  [[nodiscard]] Record record(Time now) noexcept;  // the next record
  // Answer to 20 bytes of the command interface; empty: unknown command.
  [[nodiscard]] std::vector<std::byte> answer(std::span<const std::byte> question, Time now);
  [[nodiscard]] std::string xml() const { return xml_of(of_); }
  // Test aid: counts at the rate of another box, Hz.
  void count_at(double rate) noexcept { counter_rate_ = rate; }
  // Test aid: status of each record from now on; 0: no fault.
  void fail(std::uint32_t status) noexcept { failure_ = status; }

 private:
  ForceSensor& sensor_;
  Configuration of_;
  double counter_rate_ = kNetBoxRate;
  bool streams_ = false;
  std::uint32_t number_ = 0, left_ = 0, sample_ = 0, failure_ = 0;
  std::array<double, 6> bias_{}, counts_{};
  Time before_{};
  std::uint32_t first_ = 0;  // counter at time 0
};

// The fake box on its ports: records over UDP to the last client, its page over HTTP, its command interface
// over TCP.
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
    std::string asked;
    net::SendQueue unsent;
    bool answered = false;
  };
  void send(Time now);
  static void accept(net::Socket& listener, std::vector<Reader>& readers);
  void serve_page();
  void serve_commands(Time now);

  Box box_;
  std::string address_;
  net::Socket records_, listener_, commands_;
  net::BadLine line_;  // used for records; page and commands either work or do not
  std::vector<Reader> readers_, askers_;
};

// The fake of a rig's [driver.netft], in front of its force sensor.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::netft
