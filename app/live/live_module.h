// The interface to the module that serves a run to viewers, over the Foxglove WebSocket protocol
// (subprotocol foxglove.websocket.v1). It is loaded only for `run --live`.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "trial/mcap/message_sink.h"

namespace enc::app {

// One thread makes all calls. A client that subscribes to a channel gets its newest message and all that
// follow.
class LiveServer : public trial::MessageSink {
 public:
  [[nodiscard]] virtual std::uint16_t port() const = 0;
  // Hears clients and sends to them what they take at once.
  virtual void serve() = 0;
  // Messages that were not sent because a client did not take those before.
  [[nodiscard]] virtual std::uint64_t dropped() const = 0;
};

struct LiveModule {
  // port 0: a free one. name: of the run, for the viewer. Throws Error, which begins with the address.
  std::unique_ptr<LiveServer> (*open)(const std::string& address, std::uint16_t port,
                                      const std::string& name) = nullptr;
};

}  // namespace enc::app
