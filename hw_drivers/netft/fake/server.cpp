#include "hw_drivers/netft/fake/server.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/error.h"
#include "core/devices/fake.h"
#include "hw_drivers/netft/drive/settings.h"
#include "hw_drivers/netft/wire/messages.h"
#include "hw_drivers/netft/wire/page.h"

namespace enc::netft {

// ---- the box

Configuration gamma() {
  Configuration of;
  of.product = "Net F/T";
  of.name = "Gamma SI-130-10";
  of.serial = kFakeName;
  of.per_newton = of.per_newton_metre = 1e6;
  of.ratings = {130, 130, 400, 10, 10, 10};
  of.rate = 1000;
  return of;
}

bool Box::take(std::span<const std::byte> bytes) noexcept {
  Request request;
  if (!read(bytes, request)) return false;
  switch (request.command) {
    case Command::start:
    case Command::start_buffered:  // sends one record per datagram
      streams_ = true;
      number_ = 0;
      left_ = request.samples;
      return true;
    case Command::stop:
      streams_ = false;
      return false;
    case Command::bias:
      bias_ = counts_;
      return false;
    default:
      return false;
  }
}

Record Box::record(Time now) noexcept {
  const Measurement<Wrench> said = sensor_.read(now);
  const Wrench& wrench = said.value;
  Record record;
  record.status = failure_;
  if (said.health == Health::saturated) record.status |= kError | kSaturated;
  if (said.health == Health::fault || said.health == Health::absent) record.status |= kError | 1U << 28U;
  for (std::size_t i = 0; i < 6; ++i) {
    const double value =
        i < 3 ? wrench.force.xyz[i] * of_.per_newton : wrench.torque.xyz[i - 3] * of_.per_newton_metre;
    counts_[i] = std::isfinite(value) ? value : 0.0;
    constexpr double kMost = 2147483647.0;
    record.counts[i] =
        static_cast<std::int32_t>(std::llround(std::clamp(counts_[i] - bias_[i], -kMost, kMost)));
  }
  // The counter continues after a restart of the simulation, and always advances.
  const auto at = [&] {
    return first_ + static_cast<std::uint32_t>(
                        static_cast<std::uint64_t>(seconds(now.time_since_epoch()) * counter_rate_ + 1e-6));
  };
  if (now < before_) first_ = sample_ + 1;
  before_ = now;
  const std::uint32_t wanted = at();
  sample_ = static_cast<std::int32_t>(wanted - sample_) > 0 ? wanted : sample_ + 1;
  record.sample = sample_;
  record.number = ++number_;
  if (left_ > 0 && --left_ == 0) streams_ = false;
  return record;
}

std::vector<std::byte> Box::answer(std::span<const std::byte> question, Time now) {
  const auto bytes = [](const auto& all) { return std::vector<std::byte>(all.begin(), all.end()); };
  constexpr std::uint16_t kScale = 16384;  // makes the ratings fit into 16 bits
  Ask ask;
  if (!read(question, ask)) return {};
  if (ask.question == Question::calibration) {
    Calibration says{2,
                     3,
                     static_cast<std::uint32_t>(of_.per_newton),
                     static_cast<std::uint32_t>(of_.per_newton_metre),
                     {}};
    says.scale.fill(kScale);
    return bytes(bytes_of(says));
  }
  if (ask.bias) bias_ = counts_;
  const Record now_record = record(now);
  Reading reading{static_cast<std::uint16_t>(now_record.status >> 16U), {}};
  for (std::size_t i = 0; i < kAxes; ++i)
    reading.coarse[i] = static_cast<std::int16_t>(std::clamp(now_record.counts[i] / kScale, -32768, 32767));
  return bytes(bytes_of(reading));
}

// ---- its ports

namespace {

constexpr std::size_t kMostReaders = 8, kMostAsked = 4096;
constexpr std::uint32_t kUsualError = 1U << 28U;  // analog board

}  // namespace

Server::Server(ForceSensor& sensor, const Configuration& configuration, const std::string& address,
               const Ports& ports, std::uint64_t seed)
    : box_(sensor, configuration),
      address_(address),
      records_(net::bind_udp(address, ports.records)),
      listener_(net::listen_tcp(address, ports.page)),
      commands_(net::listen_tcp(address, ports.commands)),
      line_(net::BadLine::Wire::datagrams, seed) {}

std::string Server::describe() const {
  return "Net F/T at " + net::place(address_, port()) + ", its page at " + net::place(address_, http_port());
}

void Server::wait_on(std::vector<int>& descriptors) const {
  if (line_.dead()) return;  // unread data would wake the server without end
  descriptors.push_back(records_.descriptor());
  descriptors.push_back(listener_.descriptor());
  descriptors.push_back(commands_.descriptor());
  for (const Reader& reader : readers_) descriptors.push_back(reader.socket.descriptor());
  for (const Reader& reader : askers_) descriptors.push_back(reader.socket.descriptor());
}

void Server::serve(Time now) {
  if (line_.dead()) return;
  std::array<std::byte, 64> bytes{};
  for (std::size_t got = records_.receive(bytes); got > 0; got = records_.receive(bytes)) {
    const bool streamed = box_.streams();
    if (!box_.take(std::span(bytes).first(got))) continue;
    records_.answer_sender();  // the client that requested records receives them
    if (!streamed) line_.begin(now);
    send(now);
  }
  serve_page();
  serve_commands(now);
}

void Server::publish(Time now) {
  if (box_.streams()) send(now);
}

void Server::send(Time now) {
  line_.put(now, bytes_of(box_.record(now)));
  line_.leave(now, [this](std::span<const std::byte> bytes) { static_cast<void>(records_.reply(bytes)); });
}

bool Server::knows(const Trouble& trouble) const {
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();  // error codes are status words
  if (trouble.kind == Trouble::Kind::error_code) return !(trouble.value < 0.0 || trouble.value > kMost);
  return trouble.kind == Trouble::Kind::saturate || line_.knows(trouble.kind);
}

void Server::suffer(const Trouble& trouble) {
  if (trouble.kind == Trouble::Kind::saturate) return box_.fail(kError | kSaturated);
  if (trouble.kind == Trouble::Kind::error_code)
    return box_.fail(kError |
                     (std::isnan(trouble.value) ? kUsualError : static_cast<std::uint32_t>(trouble.value)));
  line_.suffer(trouble);
  if (trouble.kind != Trouble::Kind::disconnect) return;
  readers_.clear();
  askers_.clear();
}

void Server::heal(Trouble::Kind kind) {
  if (kind == Trouble::Kind::saturate || kind == Trouble::Kind::error_code) box_.fail(0);
  line_.heal(kind);
}

void Server::accept(net::Socket& listener, std::vector<Reader>& readers) {
  for (net::Socket next = listener.accept(); next.is_open(); next = listener.accept()) {
    if (readers.size() >= kMostReaders) readers.erase(readers.begin());
    readers.push_back({std::move(next), {}, {}});
  }
}

// Answers queries of 20 bytes, which may follow each other without a gap.
void Server::serve_commands(Time now) {
  accept(commands_, askers_);
  for (Reader& asker : askers_) {
    std::array<char, 1024> bytes{};
    const std::size_t got = asker.socket.receive(std::as_writable_bytes(std::span(bytes)));
    asker.asked.append(bytes.data(), got);
    for (; asker.asked.size() >= kAskSize; asker.asked.erase(0, kAskSize))
      asker.unsent.add(box_.answer(std::as_bytes(std::span(asker.asked)).first(kAskSize), now));
    asker.unsent.send(asker.socket);
    if ((got == 0 && asker.socket.closed()) || asker.unsent.overfull()) asker.socket = {};
  }
  std::erase_if(askers_, [](const Reader& asker) { return !asker.socket.is_open(); });
}

void Server::serve_page() {
  accept(listener_, readers_);
  for (Reader& reader : readers_) {
    std::array<char, 1024> bytes{};
    const std::size_t got = reader.socket.receive(std::as_writable_bytes(std::span(bytes)));
    reader.asked.append(bytes.data(), got);
    if (const std::string_view path = requested_path(reader.asked); !path.empty() && !reader.answered) {
      reader.answered = true;
      const bool known = path.substr(0, path.find('?')) == "/netftapi2.xml";
      const std::string page =
          known ? http_answer(200, "text/xml", box_.xml()) : http_answer(404, "text/plain", "not here\n");
      reader.unsent.add(std::as_bytes(std::span(page)));
    }
    reader.unsent.send(reader.socket);
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
  const auto port = [](std::int64_t number) { return static_cast<std::uint16_t>(number); };
  return std::make_unique<Server>(
      *offer.rig.force, gamma(), settings.address,
      Ports{port(settings.port), port(settings.http_port), port(settings.command_port)}, offer.seed);
}

}  // namespace enc::netft
