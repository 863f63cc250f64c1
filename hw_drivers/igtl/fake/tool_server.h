// The server of tool data [VHMR 2]: whoever asks gets each pose of a tracker in a datagram, numbered and
// stamped; while none is in view, that all is well.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/fake.h"
#include "hw_drivers/igtl/wire/message.h"
#include "hw_drivers/net/bad_line.h"
#include "hw_drivers/net/socket.h"

namespace enc::igtl {

inline constexpr Duration kServerPeriod{10'000'000};  // [VHMR 2]

class ToolServer final : public Fake {
 public:
  // Port 0: any that is free. Throws Error (kind device) where nobody may listen there. `tracker` stays until
  // the server is gone.
  // `alive`: after so long without a pose it says that all is well.
  ToolServer(PoseTracker& tracker, std::vector<std::string> devices, const std::string& address,
             std::uint16_t port, Duration alive = kServerPeriod, std::uint64_t seed = 1);

  [[nodiscard]] std::uint16_t port() const { return socket_.port(); }
  [[nodiscard]] std::string describe() const override;
  void serve(Time now) override;
  void publish(Time now) override;
  void wait_on(std::vector<int>& descriptors) const override {
    if (!line_.dead())
      descriptors.push_back(socket_.descriptor());  // what is not taken would wake us for ever
  }
  [[nodiscard]] bool knows(const Trouble& trouble) const override;
  void suffer(const Trouble& trouble) override;
  void heal(Trouble::Kind kind) override;

 private:
  void send(Time now, const Written& message);
  void say_status(Time now);
  void leave(Time now);  // what is due

  PoseTracker& tracker_;
  std::vector<std::string> devices_;  // by index of tool
  std::string address_;
  net::Socket socket_;
  Duration alive_;
  net::BadLine line_;
  std::uint16_t status_ = 1;
  bool asked_ = false;  // by who asked last, and not to stop
  std::uint32_t number_ = 0;
  Time sent_{};
};

// The fake of a rig's [driver.igtl], in front of its tracker.
[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::igtl
