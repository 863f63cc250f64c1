// The part that every device reports, whatever its role.
#pragma once

#include <string>
#include <vector>

namespace enc {

class Device {
 public:
  virtual ~Device() = default;
  // The device and its state in one line: "sample 127.0.0.1:4711, answered". Never called within the loop.
  [[nodiscard]] virtual std::string describe() const { return {}; }
  // True if the peer is a fake and has said so in its protocol (kFakeName). An address proves nothing: a
  // relay on this PC can lead to a real machine. Called once, before anything moves.
  [[nodiscard]] virtual bool is_fake() const { return false; }
  // False while no data come from the device or none can be sent to it. The run then holds until the user
  // resumes it, even if the link comes back before. Called in every cycle; never blocks.
  [[nodiscard]] virtual bool linked() const noexcept { return true; }
  // Remarks for the user after a run, one line each.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
  // Reasons for refused data, with counts; empty if the driver accepts all data. `devices` prints this when
  // it ends.
  [[nodiscard]] virtual std::string refused() const { return {}; }
};

}  // namespace enc
