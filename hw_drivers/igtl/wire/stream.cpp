#include "hw_drivers/igtl/wire/stream.h"

#include <algorithm>

#include "hw_drivers/net/big_endian.h"

namespace enc::igtl {
namespace {

// Of any version: its first byte is 0, and the name of its type is letters, digits or '_' and then zeros.
bool is_header(std::span<const std::byte> bytes) noexcept {
  const auto name = take_name<12>(bytes, 2);
  const std::string_view type = name.view();
  const bool words = !type.empty() && std::all_of(type.begin(), type.end(), [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_';
  });
  const bool zeros = std::all_of(name.letters.begin() + static_cast<std::ptrdiff_t>(type.size()),
                                 name.letters.end(), [](char c) { return c == '\0'; });
  return bytes[0] == std::byte{0} && words && zeros;
}

}  // namespace

std::span<std::byte> Stream::room() noexcept {
  if (begin_ == end_) begin_ = end_ = 0;
  if (begin_ > 0 && end_ == bytes_.size()) {
    std::copy(bytes_.begin() + static_cast<std::ptrdiff_t>(begin_),
              bytes_.begin() + static_cast<std::ptrdiff_t>(end_), bytes_.begin());
    end_ -= begin_;
    begin_ = 0;
  }
  return std::span(bytes_).subspan(end_);
}

std::span<const std::byte> Stream::next() noexcept {
  while (!lost_) {
    const auto passed = static_cast<std::size_t>(std::min<std::uint64_t>(passing_, end_ - begin_));
    begin_ += passed;
    passing_ -= passed;
    const std::span<const std::byte> there = std::span(bytes_).subspan(begin_, end_ - begin_);
    if (there.size() < kHeader) return {};
    lost_ = !is_header(there);
    if (lost_) return {};
    const auto body = net::take<std::uint64_t>(there, 42);
    if (body > kMost - kHeader) {
      begin_ += kHeader;
      passing_ = body;
      ++skipped_;
      continue;
    }
    const std::size_t whole = kHeader + static_cast<std::size_t>(body);
    if (there.size() < whole) return {};
    begin_ += whole;
    return there.first(whole);
  }
  return {};
}

}  // namespace enc::igtl
