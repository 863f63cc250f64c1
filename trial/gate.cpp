#include "trial/gate.h"

#include <utility>

namespace enc::trial {
namespace {

constexpr std::size_t kLinks = 16;  // most links in the report; the loop allocates nothing

std::size_t at(RoleId id) { return static_cast<std::size_t>(id); }

}  // namespace

Gate::Gate(const models::Setup& setup, bool dry) {
  links_.reserve(kLinks);
  each_role([&](const auto& role) {
    const bool real = setup.scene.*role.scene && (setup.rig.*role.rig).driver != "sim";
    dry_[at(role.id)] = dry && real;
  });
}

void Gate::mark(const Rig& rig, Time now, Inputs& in) noexcept {
  each_role([&](const auto& role) {
    const bool& lost = lost_[at(role.id)];
    if (const auto& device = rig.*role.slot; device && !device->linked())
      lose(role.id, role.name, now, false);
    marked_[at(role.id)] = lost;
    if (lost) said_[at(role.id)] = std::exchange((in.*role.said).health, Health::fault);
  });
  in.resumed = std::exchange(resumed_, false) && !lost_[at(RoleId::manipulator)];
}

void Gate::lose(RoleId id, const char* role, Time now, bool by_hand) noexcept {
  if (!lost_[at(id)] && links_.size() < kLinks) links_.push_back({role, now, by_hand});
  by_hand_[at(id)] = by_hand && (!lost_[at(id)] || by_hand_[at(id)]);
  lost_[at(id)] = true;
}

void Gate::halt(Rig& rig, Time now) noexcept {
  halted_ = true;
  each_role([&](const auto& role) {
    auto& device = rig.*role.slot;
    if constexpr (requires { device->stop(); })
      if (device) {
        lose(role.id, role.name, now, true);
        if (!dry_[at(role.id)]) device->stop();
      }
  });
}

void Gate::unmark(Inputs& in) noexcept {
  each_role([&](const auto& role) {
    if (marked_[at(role.id)]) (in.*role.said).health = said_[at(role.id)];
  });
  marked_ = {};
}

void Gate::resume() noexcept {
  resumed_ = resumed_ || lost_[at(RoleId::manipulator)];
  lost_ = {};
  halted_ = false;
}

bool Gate::open(RoleId id, const Outputs& out) const noexcept {
  return !dry_[at(id)] && !lost_[at(id)] && (!lost() || out.mode == Mode::hold);
}

bool Gate::sent(RoleId id, const Outputs& out) noexcept {
  if (dry_[at(id)]) ++withheld_;
  return open(id, out);
}

void Gate::write(Rig& rig, const Outputs& out) noexcept {
  stopped_ = false;
  if (rig.manipulator && out.manipulator.tip.valid() && sent(RoleId::manipulator, out))
    rig.manipulator->command(out.manipulator.tip);
  if (rig.arm && out.arm.force.finite() && sent(RoleId::arm, out)) rig.arm->command(out.arm.force);
  if (rig.arm && open(RoleId::arm, out)) rig.arm->move_prop({out.arm.prop_speed, out.arm.prop_facing});
  if (rig.display) rig.display->show(out.view);
  if (rig.gripper && sent(RoleId::gripper, out)) rig.gripper->command(out.manipulator.grip);
}

void Gate::stop(Rig& rig) noexcept {
  if (stopped_) return;
  stopped_ = true;
  each_role([&](const auto& role) {
    auto& device = rig.*role.slot;
    if constexpr (requires { device->stop(); })
      if (device && !dry_[at(role.id)]) device->stop();
  });
}

}  // namespace enc::trial
