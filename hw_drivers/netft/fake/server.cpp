#include "hw_drivers/netft/fake/server.h"

#include <algorithm>
#include <array>
#include <utility>

#include "core/error.h"
#include "hw_drivers/netft/drive/settings.h"
#include "hw_drivers/netft/wire/http.h"

namespace enc::netft {
namespace {

constexpr std::size_t kMostReaders = 8, kMostAsked = 4096;

}  // namespace

Server::Server(ForceSensor& sensor, const Configuration& configuration, const std::string& address,
               std::uint16_t port, std::uint16_t http_port)
    : box_(sensor, configuration),
      address_(address),
      records_(net::bind_udp(address, port)),
      listener_(net::listen_tcp(address, http_port)) {}

std::string Server::describe() const {
  return "Net F/T at " + net::place(address_, port()) + ", its page at " + net::place(address_, http_port());
}

void Server::wait_on(std::vector<int>& descriptors) const {
  descriptors.push_back(records_.descriptor());
  descriptors.push_back(listener_.descriptor());
  for (const Reader& reader : readers_) descriptors.push_back(reader.socket.descriptor());
}

void Server::serve(Time now) {
  std::array<std::byte, 64> bytes{};
  for (std::size_t got = records_.receive(bytes); got > 0; got = records_.receive(bytes))
    if (box_.take(std::span(bytes).first(got))) send(now);
  serve_page();
}

void Server::publish(Time now) {
  if (box_.streams()) send(now);
}

void Server::send(Time now) noexcept { static_cast<void>(records_.reply(bytes_of(box_.record(now)))); }

void Server::serve_page() {
  for (net::Socket next = listener_.accept(); next.is_open(); next = listener_.accept()) {
    if (readers_.size() >= kMostReaders) readers_.erase(readers_.begin());
    readers_.push_back({std::move(next), {}, {}});
  }
  for (Reader& reader : readers_) {
    std::array<char, 1024> bytes{};
    const std::size_t got = reader.socket.receive(std::as_writable_bytes(std::span(bytes)));
    reader.asked.append(bytes.data(), got);
    if (const std::string_view path = requested_path(reader.asked); !path.empty() && !reader.answered) {
      reader.answered = true;
      const bool known = path.substr(0, path.find('?')) == "/netftapi2.xml";
      reader.unsent =
          known ? http_answer(200, "text/xml", box_.xml()) : http_answer(404, "text/plain", "not here\n");
    }
    reader.unsent.erase(
        0, reader.unsent.empty() ? 0 : reader.socket.send(std::as_bytes(std::span(reader.unsent))));
    if (got == 0 && reader.socket.closed()) reader.socket = {};
  }
  std::erase_if(readers_, [](const Reader& reader) {
    return !reader.socket.is_open() || (reader.answered && reader.unsent.empty()) ||
           reader.asked.size() > kMostAsked;
  });
}

std::unique_ptr<Fake> served(const FakeOffer& offer) {
  NetftSettings settings;
  settings.declare(offer.table);
  if (!offer.rig.force)
    throw Error("the scene names no [force], whose records a fake Net F/T sends; choose another scene");
  return std::make_unique<Server>(*offer.rig.force, gamma(), settings.address,
                                  static_cast<std::uint16_t>(settings.port),
                                  static_cast<std::uint16_t>(settings.http_port));
}

}  // namespace enc::netft
