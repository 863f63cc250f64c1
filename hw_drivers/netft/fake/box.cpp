#include "hw_drivers/netft/fake/box.h"

#include <algorithm>
#include <cmath>

#include "core/devices/fake.h"
#include "hw_drivers/netft/wire/command.h"

namespace enc::netft {

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
    case Command::start_buffered:  // of one record each
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
  const Stamped<Wrench> said = sensor_.read(now);
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
  // The counter goes on where the world has begun anew, and never stands.
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
  constexpr std::uint16_t kScale = 16384;  // so that the ratings fit into 16 bits
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

}  // namespace enc::netft
