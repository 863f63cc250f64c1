// Deflection limits that change from contact to contact [VHMR 4.3: 6, 4 and 2 mm]: contact k of an experiment
// takes limit k; the last limit stays.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace enc {

class ContactLimits {
 public:
  static constexpr std::size_t kMost = 16;

  ContactLimits() = default;
  // Uses the first kMost of `limits`, m. An empty list gives no contact a limit of its own.
  explicit ContactLimits(std::span<const double> limits) : count_(std::min(limits.size(), kMost)) {
    std::copy_n(limits.begin(), count_, limits_.begin());
  }
  // Limit of a contact, m, counted from 1 as State::contacts is; `otherwise` if the contact has no limit of
  // its own.
  [[nodiscard]] double at(std::int32_t contact, double otherwise) const {
    if (count_ == 0) return otherwise;
    const auto index = static_cast<std::size_t>(std::max(contact, 1) - 1);
    return limits_[std::min(index, count_ - 1)];
  }

 private:
  std::array<double, kMost> limits_{};
  std::size_t count_ = 0;
};

}  // namespace enc
