#include "hw_drivers/gripper/wire/requests.h"

#include <algorithm>

#include "hw_drivers/net/big_endian.h"

namespace enc::gripper {
namespace {

constexpr std::uint16_t kMostBits = 2000, kMostRegisters = 125, kMostWrittenBits = 1968, kMostWritten = 123;
constexpr std::uint16_t kOn = 0xff00;

bool reads_bits(std::uint8_t function) {
  return function == static_cast<std::uint8_t>(Function::read_coils) ||
         function == static_cast<std::uint8_t>(Function::read_inputs);
}
bool reads_words(std::uint8_t function) {
  return function == static_cast<std::uint8_t>(Function::read_registers) ||
         function == static_cast<std::uint8_t>(Function::read_input_registers);
}

// One value behind the address: a coil or a register.
void take_one(std::span<const std::byte> body, bool coil, Request& request) {
  request.count = 1;
  const auto value = net::take<std::uint16_t>(body, 2);
  if (coil && value != 0 && value != kOn) request.wrong = Exception::value;
  request.values = {static_cast<std::uint16_t>(coil ? value == kOn : value)};
}

// A count, a number of bytes and the values.
void take_many(std::span<const std::byte> body, bool coils, Request& request) {
  constexpr std::size_t kValues = 5;
  request.count = net::take<std::uint16_t>(body, 2);
  const std::size_t bytes = coils ? (request.count + 7U) / 8U : 2U * request.count;
  if (request.count == 0 || request.count > (coils ? kMostWrittenBits : kMostWritten) ||
      body.size() != kValues + bytes || std::to_integer<std::size_t>(body[4]) != bytes) {
    request.wrong = Exception::value;
    return;
  }
  for (std::size_t i = 0; i < request.count; ++i)
    request.values.push_back(
        coils ? static_cast<std::uint16_t>(std::to_integer<unsigned>(body[kValues + i / 8]) >> (i % 8) & 1U)
              : net::take<std::uint16_t>(body, kValues + 2 * i));
}

void head(const Request& request, std::size_t content, std::vector<std::byte>& bytes) {
  bytes.resize(kHeader + content);
  net::put(std::span(bytes), 0, request.transaction);
  net::put(std::span(bytes), 4, static_cast<std::uint16_t>(content + 1));
  bytes[6] = static_cast<std::byte>(request.unit);
  bytes[kHeader] = static_cast<std::byte>(request.function);
}

}  // namespace

std::optional<Request> Requests::next() {
  const auto all = std::span<const std::byte>(bytes_).first(size_);
  if (lost_ || all.size() < kHeader) return {};
  const auto length = net::take<std::uint16_t>(all, 4);  // unit, function and content
  lost_ = net::take<std::uint16_t>(all, 2) != 0 || length < 2 || length > kMostTelegram - kHeader + 1;
  const std::size_t size = kHeader - 1 + length;
  if (lost_ || all.size() < size) return {};
  Request request = request_of(all.first(size));
  std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(size),
            bytes_.begin() + static_cast<std::ptrdiff_t>(size_), bytes_.begin());
  size_ -= size;
  return request;
}

Request request_of(std::span<const std::byte> telegram) {
  Request request;
  if (telegram.size() <= kHeader) {
    request.wrong = Exception::function;
    return request;
  }
  request.transaction = net::take<std::uint16_t>(telegram, 0);
  request.unit = std::to_integer<std::uint8_t>(telegram[6]);
  request.function = std::to_integer<std::uint8_t>(telegram[kHeader]);
  const auto body = telegram.subspan(kHeader + 1);
  const auto is = [&](Function one) { return request.function == static_cast<std::uint8_t>(one); };
  const bool reads = reads_bits(request.function) || reads_words(request.function);
  const bool one = is(Function::write_coil) || is(Function::write_register);
  const bool many = is(Function::write_coils) || is(Function::write_registers);
  if (!reads && !one && !many) {
    request.wrong = Exception::function;
    return request;
  }
  if (body.size() < (many ? 5U : 4U) || (!many && body.size() != 4)) {
    request.wrong = Exception::value;
    return request;
  }
  request.address = net::take<std::uint16_t>(body, 0);
  if (one) take_one(body, is(Function::write_coil), request);
  if (many) take_many(body, is(Function::write_coils), request);
  if (!reads) return request;
  request.count = net::take<std::uint16_t>(body, 2);
  if (request.count == 0 || request.count > (reads_bits(request.function) ? kMostBits : kMostRegisters))
    request.wrong = Exception::value;
  return request;
}

std::vector<std::byte> refusal(const Request& request, Exception why) {
  std::vector<std::byte> bytes;
  head(request, 2, bytes);
  bytes[kHeader] |= std::byte{0x80};
  bytes[kHeader + 1] = static_cast<std::byte>(why);
  return bytes;
}

std::vector<std::byte> answer(const Request& request, std::span<const std::uint16_t> values) {
  std::vector<std::byte> bytes;
  const bool bits = reads_bits(request.function);
  if (bits || reads_words(request.function)) {
    const std::size_t size = bits ? (values.size() + 7) / 8 : 2 * values.size();
    head(request, 2 + size, bytes);
    bytes[kHeader + 1] = static_cast<std::byte>(size);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!bits) net::put(std::span(bytes), kHeader + 2 + 2 * i, values[i]);
      if (bits && values[i] != 0) bytes[kHeader + 2 + i / 8] |= static_cast<std::byte>(1U << (i % 8));
    }
    return bytes;
  }
  head(request, 5, bytes);
  net::put(std::span(bytes), kHeader + 1, request.address);
  const bool coil = request.function == static_cast<std::uint8_t>(Function::write_coil);
  const bool one = coil || request.function == static_cast<std::uint8_t>(Function::write_register);
  const auto value = static_cast<std::uint16_t>(coil && request.values[0] != 0 ? kOn
                                                : one                          ? request.values[0]
                                                                               : request.count);
  net::put(std::span(bytes), kHeader + 3, value);
  return bytes;
}

}  // namespace enc::gripper
