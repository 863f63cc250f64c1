// What must hold on every tick of a run, whatever is done to it: its own small judge of both machines, which
// asks neither the core nor the devices whether they are well.
#pragma once

#include <cstdint>
#include <string>

#include "trial/trial.h"

namespace enc::bench::extremes {

class Judge {
 public:
  void see(const trial::Glance& glance);

  // Ticks on which something was wrong, and what was first.
  [[nodiscard]] std::int64_t broken() const { return broken_; }
  [[nodiscard]] const std::string& first() const { return first_; }

  // What was measured, of commands.
  double fastest = 0.0, hardest = 0.0;  // of a hexapod, m/s and m/s^2
  double force = 0.0;                   // of an arm, beside its weight, N
  double touch = 0.0;                   // of the tool on the tip, true, N
  double condition = 0.0;               // of a hexapod's Jacobian
  double dexterity = 1.0;               // of an arm where it is, least
  std::int64_t over = 0;                // cycles in a row with more force than the device has, most
  std::int64_t held = 0, ticks = 0;     // ticks
  std::uint32_t reasons = 0;            // of all holds

 private:
  void judge_time(const trial::Glance& glance);
  void judge_numbers(const trial::Glance& glance);
  void judge_machine(const trial::Glance& glance);
  void judge_arm(const trial::Glance& glance);
  void wrong(const trial::Glance& glance, const std::string& what);

  bool told_ = false;  // a machine has been told something
  Vec3 at_{0, 0, 0}, velocity_{0, 0, 0};
  std::int64_t index_ = -1, over_now_ = 0, broken_ = 0;
  Time truth_{};
  bool wrong_now_ = false;
  std::string first_;
};

}  // namespace enc::bench::extremes
