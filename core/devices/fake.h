// What stands in for a driver's device: its wire, answered out of the same role of another rig, such as the
// twin's. A program of its own serves it (encounter fake), on one thread for all that a rig names.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/devices/driver.h"
#include "core/rig.h"

namespace enc {

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
};

}  // namespace enc
