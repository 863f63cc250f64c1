// The server of tool data [VHMR 2]: whoever asks gets each pose of a tracker in a datagram, numbered and
// stamped; while none is in view, that all is well. Or a tracker's own server, such as PLUS: who connects
// gets each pose in a stream, as TRANSFORM or, where asked for, as TDATA.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/igtl/fake/door.h"
#include "hw_drivers/igtl/wire/content.h"

namespace enc::igtl {

inline constexpr Duration kServerPeriod{10'000'000};  // [VHMR 2]

struct ToolServerSettings {
  Transport transport = Transport::udp;
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;  // 0: any that is free
  // After so long without a pose it says over UDP that all is well. 0, in lockstep: on each period, however
  // it sends.
  Duration alive = kServerPeriod;
  std::uint64_t seed = 1;
};

class ToolServer final : public Fake {
 public:
  // Throws Error (kind device) where nobody may listen there. `tracker` stays until the server is gone.
  // `devices`: names, by index of tool.
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
  void say_pose(Time now, const Stamped<TrackedTool>& newest);
  void say_status(Time now);
  [[nodiscard]] bool streams() const { return settings_.transport == Transport::tcp; }

  PoseTracker& tracker_;
  std::vector<std::string> devices_;
  ToolServerSettings settings_;
  Door door_;
  std::uint16_t status_ = 1;
  // By who asked last:
  bool asked_ = false;      // and not to stop
  bool tdata_ = false;      // for TDATA
  bool knows_two_ = false;  // headers of version 2
  Duration apart_{};        // no oftener than that
  std::uint32_t number_ = 0;
  Time sent_{}, posed_{};
};

// The fake of a rig's [driver.igtl], in front of its tracker.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::igtl
