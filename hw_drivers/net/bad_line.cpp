#include "hw_drivers/net/bad_line.h"

#include <algorithm>
#include <utility>

namespace enc::net {

using Kind = Trouble::Kind;

bool BadLine::knows(Kind kind) const noexcept {
  const bool of_datagrams = kind == Kind::loss || kind == Kind::reorder || kind == Kind::duplicate;
  const bool of_device = kind == Kind::saturate || kind == Kind::error_code;
  return !of_device && (!of_datagrams || wire_ == Wire::datagrams);
}

void BadLine::begin(Time now) {
  begun_ = last_ = now_ = now;
  on_the_way_.clear();
}

// Garbage keeps a final line feed. The receiver then gets invalid data instead of waiting for the end of a
// line.
void BadLine::spoil(std::vector<std::byte>& bytes) {
  const bool line = !bytes.empty() && bytes.back() == std::byte{'\n'};
  for (std::byte& byte : bytes) byte = std::byte{troubles_.noise()};
  if (line) bytes.back() = std::byte{'\n'};
}

void BadLine::put(Time now, std::span<const std::byte> message) {
  if (now < now_) begin(now);  // the simulation was restarted
  now_ = now;
  if (message.empty() || dead() || troubles_.happens(Kind::loss)) return;
  const std::optional<double>& start = troubles_.of(Kind::slow_start);
  const Time ready = start ? begun_ + from_seconds(*start) : now;
  if (now < ready && wire_ == Wire::datagrams) return;  // the device does not send yet
  Message next{std::max(now, ready), {message.begin(), message.end()}};
  if (troubles_.happens(Kind::garbage)) spoil(next.bytes);
  if (troubles_.happens(Kind::half_message)) next.bytes.resize(next.bytes.size() / 2);
  if (troubles_.of(Kind::jitter)) next.due += from_seconds(*troubles_.of(Kind::jitter) * troubles_.uniform());
  if (wire_ == Wire::stream) next.due = last_ = std::max(next.due, last_);
  // Only one message waits at a time: if all waited for another one, no message would leave.
  const bool one_waits =
      std::any_of(on_the_way_.begin(), on_the_way_.end(), [](const Message& other) { return other.waits; });
  next.waits = !one_waits && troubles_.happens(Kind::reorder);
  const int copies = troubles_.happens(Kind::duplicate) ? 2 : 1;
  for (int i = 0; i < copies; ++i) {
    const auto at = std::find_if(on_the_way_.begin(), on_the_way_.end(),
                                 [&](const Message& other) { return other.due > next.due && !other.waits; });
    on_the_way_.insert(at, next);
  }
}

std::optional<std::vector<std::byte>> BadLine::take(Time now) {
  if (now < now_) begin(now);
  if (dead()) return {};
  const auto next = std::find_if(on_the_way_.begin(), on_the_way_.end(),
                                 [now](const Message& m) { return !m.waits && m.due <= now; });
  if (next == on_the_way_.end()) return {};
  std::vector<std::byte> bytes = std::move(next->bytes);
  on_the_way_.erase(next);
  for (Message& other : on_the_way_) other.waits = false;
  return bytes;
}

}  // namespace enc::net
