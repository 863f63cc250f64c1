#include "hw_drivers/gripper/drive/coupler.h"

#include <cerrno>
#include <cmath>

#include <modbus/modbus.h>
#include <sys/select.h>

#include "core/base/error.h"
#include "hw_drivers/net/socket.h"

namespace enc::gripper {

struct Coupler::Link {
  net::Socket socket;
  modbus_t* modbus = nullptr;
};

Coupler::Coupler(const GripperSettings& settings) : link_(std::make_unique<Link>()) {
  constexpr Duration kConnect{2'000'000'000};
  const auto port = static_cast<std::uint16_t>(settings.port);
  link_->socket = net::connect_tcp(settings.address, port, kConnect, from_seconds(settings.timeout));
  // libmodbus waits by select(), which knows no higher descriptor.
  if (link_->socket.descriptor() >= FD_SETSIZE)
    throw Error(settings.place() + ": too many files are open; close some, then begin again", {},
                ErrorKind::device);
  // The library only keeps the address: it gets a socket that is connected.
  link_->modbus = modbus_new_tcp("127.0.0.1", static_cast<int>(settings.port));
  if (link_->modbus == nullptr || modbus_set_slave(link_->modbus, static_cast<int>(settings.unit)) != 0 ||
      modbus_set_socket(link_->modbus, link_->socket.descriptor()) != 0) {
    modbus_free(link_->modbus);
    throw Error(settings.place() + ": libmodbus refuses driver.gripper.unit; expected 0 to 247, or 255", {},
                ErrorKind::device);
  }
  const auto us = static_cast<std::uint32_t>(std::lround(1e6 * settings.timeout));
  constexpr std::uint32_t kSecond = 1'000'000;
  modbus_set_response_timeout(link_->modbus, us / kSecond, us % kSecond);
  modbus_set_byte_timeout(link_->modbus, 0, 0);  // none: that time is for the whole answer
  modbus_set_error_recovery(link_->modbus, MODBUS_ERROR_RECOVERY_NONE);
}

Coupler::~Coupler() { modbus_free(link_->modbus); }

Outcome Coupler::outcome(int returned, std::size_t expected) noexcept {
  if (returned == static_cast<int>(expected)) return Outcome::done;
  error_ = returned < 0 ? errno : EMBBADDATA;
  exception_ = error_ > MODBUS_ENOBASE && error_ <= EMBXGTAR ? error_ - MODBUS_ENOBASE : 0;
  return exception_ != 0 || error_ == EMBUNKEXC ? Outcome::refused : Outcome::lost;
}

Outcome Coupler::read_inputs(int from, std::span<std::uint8_t> into) noexcept {
  const int got = modbus_read_input_bits(link_->modbus, from, static_cast<int>(into.size()), into.data());
  return outcome(got, into.size());
}

Outcome Coupler::read_outputs(int from, std::span<std::uint8_t> into) noexcept {
  const int got = modbus_read_bits(link_->modbus, from, static_cast<int>(into.size()), into.data());
  return outcome(got, into.size());
}

Outcome Coupler::read_registers(int from, std::span<std::uint16_t> into) noexcept {
  const int got = modbus_read_registers(link_->modbus, from, static_cast<int>(into.size()), into.data());
  return outcome(got, into.size());
}

Outcome Coupler::write_output(int at, bool on) noexcept {
  return outcome(modbus_write_bit(link_->modbus, at, on ? 1 : 0), 1);
}

Outcome Coupler::write_register(int at, std::uint16_t value) noexcept {
  return outcome(modbus_write_register(link_->modbus, at, value), 1);
}

const char* Coupler::why() const noexcept {
  if (error_ == ETIMEDOUT) return "no answer in time";
  return error_ == ECONNRESET || error_ == EPIPE ? "it hung up" : "its answer is no Modbus TCP";
}

}  // namespace enc::gripper
