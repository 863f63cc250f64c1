// The link to a controller over TCP.
#pragma once

#include <memory>
#include <utility>

#include "core/devices/driver.h"
#include "hw_drivers/gcs/drive/link.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/net/steady.h"

namespace enc::gcs {

class NetLink final : public Link {
 public:
  explicit NetLink(net::Socket socket) : socket_(std::move(socket)) {}
  NetLink(const NetLink&) = delete;
  NetLink& operator=(const NetLink&) = delete;
  ~NetLink() override {
    constexpr Duration kRead{200'000'000};
    socket_.finish(kRead);
  }
  std::size_t send(std::string_view bytes) noexcept override {
    return bytes.empty() ? 0 : socket_.send(std::as_bytes(std::span(bytes)));
  }
  std::size_t receive(std::span<char> into) noexcept override {
    return socket_.receive(std::as_writable_bytes(into));
  }
  [[nodiscard]] bool closed() const noexcept override { return socket_.closed(); }
  void wait(Duration most) noexcept override { socket_.wait(most); }
  [[nodiscard]] Duration now() const noexcept override { return net::steady_now(); }

 private:
  net::Socket socket_;
};

// The driver, connected by its table.
[[nodiscard]] std::unique_ptr<Manipulator> connected(const Offer& offer);

}  // namespace enc::gcs
