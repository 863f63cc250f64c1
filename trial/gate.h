// The gate between the core and the moving devices. It reads a real device that is not armed, but sends it no
// command. A lost link stays lost until the operator resumes: the core sees a fault and holds. The gate then
// sends the lost device nothing, and the other devices only the core's commands in hold. A stop by hand
// treats all moving devices in this way.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/devices/roles.h"
#include "models/setup/scene_file.h"

namespace enc::trial {

// The operator's request: stop all motion, or go on.
enum class Hand : std::uint8_t { none, halt, resume };

struct LostLink {
  const char* role;
  Time t;
  bool by_hand = false;
};

class Gate {
 public:
  Gate() = default;
  // `dry`: a rig of drivers that is not armed.
  Gate(const models::Setup& setup, bool dry);

  // Call these around the reading of the devices. mark() marks the data of a lost device as a fault, for that
  // tick. A device without new data leaves its last data in `in`, so unmark() removes the mark before the
  // next reading.
  void unmark(Inputs& in) noexcept;
  void mark(const Rig& rig, Time now, Inputs& in) noexcept;
  void write(Rig& rig, const Outputs& out) noexcept;
  // Called at the end of a run; stops every device that was not dry.
  void stop(Rig& rig) noexcept;
  // Stops the moving devices by hand, and sends them nothing until resume().
  void halt(Rig& rig, Time now) noexcept;
  // Ends the hold of every link that is back. A machine then starts at its reported position.
  void resume() noexcept;

  [[nodiscard]] bool lost() const noexcept { return lost_ != std::array<bool, kRoles>{}; }
  // True if this role's device lost its link, other than by a stop by hand.
  [[nodiscard]] bool link_lost(RoleId id) const noexcept {
    return lost_[static_cast<std::size_t>(id)] && !by_hand_[static_cast<std::size_t>(id)];
  }
  [[nodiscard]] bool halted() const noexcept { return halted_; }               // by hand, until resume()
  [[nodiscard]] std::int64_t withheld() const { return withheld_; }            // commands of dry devices
  [[nodiscard]] const std::vector<LostLink>& links() const { return links_; }  // the first 16

 private:
  void lose(RoleId id, const char* role, Time now, bool by_hand) noexcept;
  [[nodiscard]] bool open(RoleId id, const Outputs& out) const noexcept;
  [[nodiscard]] bool sent(RoleId id, const Outputs& out) noexcept;  // counts the commands not sent

  std::array<bool, kRoles> dry_{}, lost_{}, by_hand_{}, marked_{};
  std::array<Health, kRoles> said_{};  // health before the mark
  bool resumed_ = false;               // a machine resumed since the last tick
  bool halted_ = false;
  std::int64_t withheld_ = 0;
  std::vector<LostLink> links_;
  bool stopped_ = true;  // no command was sent since
};

}  // namespace enc::trial
