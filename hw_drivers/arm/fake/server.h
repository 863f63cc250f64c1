// A fake force-controlled arm in front of any arm of the core. A fake vendor's library (client.h) in the
// program of the driver shows it to the driver.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/arm/fake/message.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/socket.h"

namespace enc::arm {

struct ArmServerSettings {
  std::string name = "arm";  // "PHANToM"
  Place place;
  std::uint32_t usual_error = 1;  // error code of a fault without a value
  std::array<double, 3> home{};   // the tip with all joints at 0, m in R
  // Advances time for each force; empty: time runs by itself.
  std::function<void()> advance{};
  std::function<void()> begin{};  // restarts the world for a new client
  std::uint64_t seed = 1;
};

class ArmServer final : public Fake {
 public:
  // Port 0: any free port. Throws Error (kind device) if it cannot listen there. `arm` and `log` must outlive
  // the server.
  ArmServer(HapticArm& arm, const ArmServerSettings& settings, Log& log);

  [[nodiscard]] std::uint16_t port() const { return socket_.port(); }
  [[nodiscard]] std::string describe() const override;
  void serve(Time now) override;
  void publish(Time now) override;
  void wait_on(std::vector<int>& descriptors) const override;
  [[nodiscard]] bool knows(const Trouble& trouble) const override;
  void suffer(const Trouble& trouble) override;
  void heal(Trouble::Kind kind) override;

  // Test aids.
  void press(bool pressed) noexcept { state_.buttons = pressed ? 1U : 0U; }
  // NaN: the device does not report it.
  void warm(double warmth) noexcept { state_.warmth = warmth; }
  void flag(std::uint32_t flag, bool on) noexcept {
    state_.flags = on ? state_.flags | flag : state_.flags & ~flag;
  }
  [[nodiscard]] const Vec<'R'>& force() const noexcept { return force_; }  // the last one received
  [[nodiscard]] bool enabled() const noexcept { return enabled_; }
  [[nodiscard]] std::int64_t forces() const noexcept { return forces_; }
  // The library has answered the newest state.
  [[nodiscard]] bool answered() const noexcept { return answered_ == state_.number; }
  [[nodiscard]] double watchdog() const noexcept { return watchdog_; }  // s, as the client set it

 private:
  // Returns true if a client came and the world was restarted.
  bool greet(const Command& command, Time now);
  void obey(const Command& command);
  void leave();
  void send(Time now);
  void watch();  // the firmware's watchdog

  HapticArm& arm_;
  ArmServerSettings settings_;
  Log& log_;
  net::Socket socket_;
  net::BadLine line_;
  State state_;
  std::uint64_t answered_ = 0;  // number of the last state that the library answered
  std::uint64_t session_ = 0;   // of the client; 0: no client
  Duration heard_{};            // steady clock, last datagram of the client
  double watchdog_ = 0.0;       // s; 0: none
  Vec<'R'> force_ = Vec<'R'>::zero();
  bool enabled_ = false;
  std::int64_t barks_ = 0;   // of the watchdog, for this client
  std::int64_t forces_ = 0;  // with the motors on, of this client
  double largest_ = 0.0;     // N
};

// The fake in front of the rig's arm. Throws Error for a scene without [arm].
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer, const std::string& name,
                                           const Place& place, std::uint32_t usual_error);

}  // namespace enc::arm
