// Between the core and what moves. A real device that is not armed is read and told nothing. A link that was
// lost stays lost until somebody resumes: the core sees a fault and holds, the device itself is told nothing,
// and the others only what the core says in hold. Whoever stops the run by hand takes all that moves from it
// in the same way.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/devices/roles.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

// What a person wants of a run: that all which moves stands, or goes on.
enum class Hand : std::uint8_t { none, halt, resume };

struct LostLink {
  const char* role;
  Time t;
  bool by_hand = false;
};

class Gate {
 public:
  Gate() = default;
  // Dry: a rig of drivers that is not armed.
  Gate(const models::Setup& setup, bool dry);

  // Around the reading of the devices. What a lost device said is marked as a fault, for that tick: one that
  // has no news afterwards leaves in `in` what it said before.
  void unmark(Inputs& in) noexcept;
  void mark(const Rig& rig, Time now, Inputs& in) noexcept;
  void write(Rig& rig, const Outputs& out) noexcept;
  // At the end of a run, of all that was not dry.
  void stop(Rig& rig) noexcept;
  // By hand: what moves is stopped and told nothing until resume().
  void halt(Rig& rig, Time now) noexcept;
  // Ends the hold of every link that is there again. A machine then begins where it says that it is.
  void resume() noexcept;

  [[nodiscard]] bool lost() const noexcept { return lost_ != std::array<bool, kRoles>{}; }
  // The link of this role's device, and not only by hand.
  [[nodiscard]] bool link_lost(RoleId id) const noexcept {
    return lost_[static_cast<std::size_t>(id)] && !by_hand_[static_cast<std::size_t>(id)];
  }
  [[nodiscard]] bool halted() const noexcept { return halted_; }               // by hand, until resume()
  [[nodiscard]] std::int64_t withheld() const { return withheld_; }            // commands of dry devices
  [[nodiscard]] const std::vector<LostLink>& links() const { return links_; }  // the first 16

 private:
  void lose(RoleId id, const char* role, Time now, bool by_hand) noexcept;
  [[nodiscard]] bool open(RoleId id, const Outputs& out) const noexcept;
  [[nodiscard]] bool sent(RoleId id, const Outputs& out) noexcept;  // counts what is not

  std::array<bool, kRoles> dry_{}, lost_{}, by_hand_{}, marked_{};
  std::array<Health, kRoles> said_{};  // what is marked
  bool resumed_ = false;               // a machine, since the last tick
  bool halted_ = false;
  std::int64_t withheld_ = 0;
  std::vector<LostLink> links_;
  bool stopped_ = true;  // nothing was told since
};

}  // namespace enc::trial
