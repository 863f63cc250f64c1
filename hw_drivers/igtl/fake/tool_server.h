// The server of tool data [VHMR 2]. A client that asks gets each pose of a tracker in a numbered and stamped
// datagram. While no tool is visible, it gets a status "all is well". The server can also act as a tracker's
// own server, such as PLUS. A connected client then gets each pose in a stream, as TRANSFORM or, on request,
// as TDATA.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/igtl/wire/content.h"
#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/send_queue.h"
#include "hw_drivers/net/socket.h"

namespace enc::igtl {

// The server socket for clients that ask for tool data, one client at a time. For datagrams, a later client
// replaces the earlier one; for a stream, it is refused.
enum class Transport : bool { udp, tcp };

class Door {
 public:
  // Port 0: any free port. Throws Error (kind device) if it cannot listen there.
  Door(Transport transport, const std::string& address, std::uint16_t port, std::uint64_t seed);

  [[nodiscard]] std::uint16_t port() const { return socket_.port(); }
  void wait_on(std::vector<int>& descriptors) const;
  // Accepts a new client; returns true if one connected.
  bool open(Time now);
  // The next received message; empty: no message. Valid until the next call.
  [[nodiscard]] std::span<const std::byte> next();
  void answer_sender() noexcept { socket_.answer_sender(); }  // datagrams only
  // put() queues a message, and leave() sends it when it is due.
  void put(Time now, std::span<const std::byte> message);
  void leave(Time now);

  // Faults of the connection.
  [[nodiscard]] bool knows(Trouble::Kind kind) const noexcept { return line_.knows(kind); }
  void suffer(const Trouble& trouble) noexcept;
  void heal(Trouble::Kind kind) noexcept { line_.heal(kind); }
  void begin(Time now) { line_.begin(now); }

 private:
  Transport transport_;
  net::Socket socket_, client_;  // client_: stream only
  net::BadLine line_;
  Stream stream_;
  std::array<std::byte, kMostBytes> datagram_{};
  net::SendQueue unsent_;
};

inline constexpr Duration kServerPeriod{10'000'000};  // [VHMR 2]

struct ToolServerSettings {
  Transport transport = Transport::udp;
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  // 0: any free port
  // After this time without a pose the server reports over UDP that all is well. 0: it reports in each
  // period, with every transport (lockstep).
  Duration alive = kServerPeriod;
  std::uint64_t seed = 1;
};

class ToolServer final : public Fake {
 public:
  // Throws Error (kind device) if it cannot listen there. `tracker` must outlive the server. `devices`:
  // names, by index of tool.
  ToolServer(PoseTracker& tracker, std::vector<std::string> devices, const ToolServerSettings& settings = {});

  [[nodiscard]] std::uint16_t port() const { return door_.port(); }
  [[nodiscard]] std::string describe() const override;
  void serve(Time now) override;
  void publish(Time now) override;
  void wait_on(std::vector<int>& descriptors) const override { door_.wait_on(descriptors); }
  [[nodiscard]] bool knows(const Trouble& trouble) const override;
  void suffer(const Trouble& trouble) override;
  void heal(Trouble::Kind kind) override;

 private:
  void answer(Time now, const Message& message);
  void say(Time now, const char* type, std::string_view device, std::int64_t stamp_ns,
           std::span<const std::byte> content, std::string_view key = {}, std::string_view value = {});
  void say_pose(Time now, const Measurement<TrackedTool>& newest);
  void say_status(Time now);
  [[nodiscard]] bool streams() const { return settings_.transport == Transport::tcp; }

  PoseTracker& tracker_;
  std::vector<std::string> devices_;
  ToolServerSettings settings_;
  Door door_;
  std::uint16_t status_ = 1;
  // The last request sets:
  bool asked_ = false;      // the client wants data
  bool tdata_ = false;      // the client wants TDATA
  bool knows_two_ = false;  // the client supports headers of version 2
  Duration apart_{};        // shortest interval between messages
  std::uint32_t number_ = 0;
  Time sent_{}, posed_{};
};

// The fake of a rig's [driver.igtl], in front of its tracker.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::igtl
