// A stand-in for a driver's device: it speaks the device's protocol and takes its data from that role of
// another rig, such as the twin's. A separate program serves it (encounter fake), on one thread for all fakes
// of a rig.
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

// A fake's name in its protocol, inside a name or number that the protocol already has.
inline constexpr std::string_view kFakeName = "Encounter fake";

// A fault of a device or of its connection.
struct Trouble {
  enum class Kind : std::uint8_t {
    loss,          // share of lost messages; datagrams only
    jitter,        // longest delay of a message
    reorder,       // share of messages that arrive after their successor; datagrams only
    duplicate,     // share of messages sent twice; datagrams only
    stall,         // no data in or out, the connection stays open
    disconnect,    // the connection is cut, and new ones are refused
    garbage,       // share of messages that are noise
    half_message,  // share of messages that lack their second half
    saturate,      // the sensor is at its range
    error_code,    // the device reports this error code
    slow_start,    // silence for this time after a client connects
  };
  Kind kind = Kind::loss;
  // Share from 0 to 1, time in s, or error code. Code unset: the device's default code.
  double value = kUnset;
};

class Fake {
 public:
  virtual ~Fake() = default;
  [[nodiscard]] virtual std::string describe() const = 0;  // "C-887 at 127.0.0.1:50000"
  // Answers every waiting request; never blocks. `now`: time of the rig's world.
  virtual void serve(Time now) = 0;
  // The world has reached this time: sends the data that need no request.
  virtual void publish(Time now) = 0;
  // Adds the file descriptors that may receive data.
  virtual void wait_on(std::vector<int>& descriptors) const = 0;
  // True if this device or its connection can have this fault (and error code). Otherwise, never call
  // suffer() with it.
  [[nodiscard]] virtual bool knows(const Trouble& trouble) const = 0;
  virtual void suffer(const Trouble& trouble) = 0;  // lasts until heal()
  virtual void heal(Trouble::Kind kind) = 0;
};

struct FakeOffer {
  Settings& table;  // the driver's own; the fake listens where the driver connects
  // The rig whose roles the fake shows; lives until the fake is gone.
  Rig& rig;
  const RigSpec& spec;  // the rig file's data of each role
  Log& log;             // lives until the fake is gone
  // Advances the world by a period, and all fakes publish. Empty: time runs by itself.
  std::function<void()> advance{};
  std::span<const std::string> tools{};  // the scene's tools: names by index; valid during the call
  std::function<void()> begin{};         // a client connected to command the machine: restart the world
  std::uint64_t seed = 1;                // seed of losses, delays and noise
  StereoCamera* camera = nullptr;        // the twin's, of a scene with a camera; lives until the fake is gone
};

}  // namespace enc
