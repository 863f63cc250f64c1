// A link that passes text to a controller directly: the answer to send() is received at once.
#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>

#include "hw_drivers/gcs/drive/link.h"

namespace enc::wires {

class StringLink : public gcs::Link {
 public:
  std::size_t receive(std::span<char> into) noexcept final {
    const std::size_t size = std::min(into.size(), heard_.size());
    std::copy_n(heard_.begin(), size, into.begin());
    heard_.erase(0, size);
    return size;
  }

 protected:
  void hear(std::string_view answers) { heard_.append(answers); }
  [[nodiscard]] bool unread() const noexcept { return !heard_.empty(); }

 private:
  std::string heard_;
};

}  // namespace enc::wires
