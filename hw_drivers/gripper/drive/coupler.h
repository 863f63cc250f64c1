// The coupler behind libmodbus, the only file that knows this library. Each call is one request and waits for
// its answer, so only the driver's thread makes them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "hw_drivers/gripper/drive/settings.h"

namespace enc::gripper {

enum class Outcome : std::uint8_t { done, refused, lost };

class Coupler {
 public:
  // Throws Error (kind device) if nothing listens there.
  explicit Coupler(const GripperSettings& settings);
  Coupler(const Coupler&) = delete;
  Coupler& operator=(const Coupler&) = delete;
  ~Coupler();

  Outcome read_inputs(int from, std::span<std::uint8_t> into) noexcept;
  Outcome read_outputs(int from, std::span<std::uint8_t> into) noexcept;
  Outcome read_registers(int from, std::span<std::uint16_t> into) noexcept;
  Outcome write_output(int at, bool on) noexcept;
  Outcome write_register(int at, std::uint16_t value) noexcept;
  // Code of the last refusal; 0: none, or unknown.
  [[nodiscard]] int exception() const noexcept { return exception_; }
  // Why the link is lost, for a person.
  [[nodiscard]] const char* why() const noexcept;

 private:
  struct Link;
  Outcome outcome(int returned, std::size_t expected) noexcept;

  std::unique_ptr<Link> link_;
  int exception_ = 0, error_ = 0;
};

}  // namespace enc::gripper
