// What every device says of itself, whatever its role.
#pragma once

#include <string>
#include <vector>

namespace enc {

class Device {
 public:
  virtual ~Device() = default;
  // What it is and what was found, in a line: "sample 127.0.0.1:4711, answered". Never asked within the loop.
  [[nodiscard]] virtual std::string describe() const { return {}; }
  // What answers is a fake, and has said so on its wire (kFakeName): an address is no sign of one, as a relay
  // on this PC leads to a real machine. Asked once, before anything moves.
  [[nodiscard]] virtual bool is_fake() const { return false; }
  // False while nothing comes from it or goes to it. The run then holds until it is told to resume, even
  // where the link comes back before. Asked on every cycle; never blocks.
  [[nodiscard]] virtual bool linked() const noexcept { return true; }
  // What a person should know of a run when it is over, a line each.
  [[nodiscard]] virtual std::vector<std::string> remarks() const { return {}; }
  // Why what comes is not taken, with counts; empty where all of it is. `devices` asks it when it ends.
  [[nodiscard]] virtual std::string refused() const { return {}; }
};

}  // namespace enc
