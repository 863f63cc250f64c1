// The fake controller on a port: one client at a time, one thread, on the wall clock.
#pragma once

#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>
#include <thread>

#include "core/devices/driver.h"
#include "hw_drivers/gcs/fake/controller.h"
#include "hw_drivers/net/socket.h"

namespace enc::gcs {

class Server {
 public:
  // Port 0: any that is free. Throws Error (kind device) where nobody may listen there. `machine` and `log`
  // stay until the server is gone, and the machine is the thread's until then.
  Server(Manipulator& machine, const ControllerSettings& settings, const std::string& address,
         std::uint16_t port, Log& log);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  [[nodiscard]] std::uint16_t port() const { return listener_.port(); }

 private:
  void serve() noexcept;  // the thread
  void accept();
  bool answer();  // true: something came

  Log& log_;
  Controller controller_;
  net::Socket listener_;
  net::Socket client_;
  std::string unsent_;
  std::atomic<bool> end_ = false;
  std::thread thread_;
};

}  // namespace enc::gcs
