// Settings for models/rigs/fakes.toml, used by tests and benchmarks.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "hw_drivers/net/socket.h"

namespace enc::wires {

// Free ports as settings for the fakes of models/rigs/fakes.toml, because tests and benchmarks run in
// parallel.

inline std::vector<std::string> free_ports() {
  std::vector<std::string> set;
  const net::Socket machine = net::listen_tcp("127.0.0.1", 0), page = net::listen_tcp("127.0.0.1", 0),
                    commands = net::listen_tcp("127.0.0.1", 0), coupler = net::listen_tcp("127.0.0.1", 0);
  const net::Socket records = net::bind_udp("127.0.0.1", 0), tools = net::bind_udp("127.0.0.1", 0);
  for (const auto& [key, port] : {std::pair{"gcs.port", machine.port()},
                                  {"netft.http_port", page.port()},
                                  {"netft.command_port", commands.port()},
                                  {"netft.port", records.port()},
                                  {"igtl.port", tools.port()},
                                  {"gripper.port", coupler.port()}})
    set.push_back("rig.driver." + std::string(key) + "=" + std::to_string(port));
  return set;
}

// The time limits of a real rig, as settings. models/rigs/fakes.toml allows ten times as much, because fakes
// on the wall clock share the processor with the run. In virtual time and in lockstep no data are late.

inline std::vector<std::string> tight_times(std::vector<std::string> more = {}) {
  std::vector<std::string> set{"rig.loop.late_cycles=5", "rig.force.stale_ms=5"};
  set.insert(set.end(), more.begin(), more.end());
  return set;
}

}  // namespace enc::wires
