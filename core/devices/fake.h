// What stands in for a driver's device: its wire, answered out of the same role of another rig, such as the
// twin's. A program of its own serves it (encounter fake), on one thread for all that a rig names.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/devices/driver.h"
#include "core/devices/rig.h"

namespace enc {

// How a fake names itself on its wire: a part of a name or of a number that the protocol has anyway.
inline constexpr std::string_view kFakeName = "Encounter fake";

// What goes wrong with a device or on its wire.
struct Trouble {
  enum class Kind : std::uint8_t {
    loss,          // of so many messages: datagrams alone
    jitter,        // each message takes up to so long
    reorder,       // so many messages come behind the next: datagrams alone
    duplicate,     // so many messages come twice: datagrams alone
    stall,         // nothing is heard or said, the line stays open
    disconnect,    // the line is cut, and nobody is let in
    garbage,       // so many messages are noise
    half_message,  // of so many messages the second half is missing
    saturate,      // the sensor is at its end
    error_code,    // the device reports this error
    slow_start,    // for so long after somebody came nothing is said
  };
  Kind kind = Kind::loss;
  double value = kUnset;  // a share from 0 to 1, a time in s; a code, unset: the device's own
};

class Fake {
 public:
  virtual ~Fake() = default;
  [[nodiscard]] virtual std::string describe() const = 0;  // "C-887 at 127.0.0.1:50000"
  // Answers whoever has said something; never waits. `now`: of the rig's world.
  virtual void serve(Time now) = 0;
  // The world has gone on to this time: what is sent without a question goes now.
  virtual void publish(Time now) = 0;
  // The file descriptors on which something may come.
  virtual void wait_on(std::vector<int>& descriptors) const = 0;
  // What its device or its wire may meet, and a code that it has; with others suffer() is not to be called.
  [[nodiscard]] virtual bool knows(const Trouble& trouble) const = 0;
  virtual void suffer(const Trouble& trouble) = 0;  // from now on, until it is healed
  virtual void heal(Trouble::Kind kind) = 0;
};

struct FakeOffer {
  Settings& table;      // the driver's own: where it looks for its device, there the fake is
  Rig& rig;             // whose roles it shows; stays until the fake is gone
  const RigSpec& spec;  // what the rig file says of each role
  Log& log;             // likewise
  // The world goes on by a period, and all fakes publish; empty: time goes on by itself.
  std::function<void()> advance{};
  std::span<const std::string> tools{};  // names of the scene's, by index; for the call
  std::function<void()> begin{};         // somebody came to tell the machine: the world begins anew
  std::uint64_t seed = 1;                // of what is lost, late or noise
};

}  // namespace enc
