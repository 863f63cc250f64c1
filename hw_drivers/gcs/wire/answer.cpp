#include "hw_drivers/gcs/wire/answer.h"

#include <algorithm>
#include <cstdint>

namespace enc::gcs {

std::size_t AnswerReader::take(std::string_view bytes) noexcept {
  std::size_t taken = 0;
  while (taken < bytes.size() && !complete_ && !overflown()) {
    const char byte = bytes[taken++];
    const std::string_view before = answer_.view();
    complete_ = byte == '\n' && (before.empty() || before.back() != ' ');
    answer_.add(byte);
    if (overflown()) complete_ = false;
  }
  return overflown() ? bytes.size() : taken;
}

void AnswerReader::next() noexcept {
  if (overflown()) return;
  answer_.clear();
  complete_ = false;
}

bool read_axes(std::string_view answer, std::string_view axes, std::span<double> values) noexcept {
  std::uint32_t seen = 0;  // a bit for each axis
  while (!answer.empty()) {
    const std::size_t end = std::min(answer.find('\n'), answer.size());
    const std::string_view line = trimmed(answer.substr(0, end));
    answer.remove_prefix(std::min(end + 1, answer.size()));
    const std::size_t axis = line.size() < 3 || line[1] != '=' ? std::string_view::npos : axes.find(line[0]);
    if (axis == std::string_view::npos || axis >= values.size() || ((seen >> axis) & 1U) != 0) return false;
    if (!read_number(line.substr(2), values[axis])) return false;
    seen |= 1U << axis;
  }
  return seen == (1U << axes.size()) - 1;
}

bool read_single(std::string_view answer, double& number) noexcept {
  return read_number(trimmed(answer), number);
}
bool read_error(std::string_view answer, int& number) noexcept {
  return read_number(trimmed(answer), number);
}

}  // namespace enc::gcs
