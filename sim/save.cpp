// Save and restore of a whole world: each part's plain state, in a fixed order, behind its size.
#include <cstring>
#include <type_traits>

#include "core/base/error.h"
#include "sim/world.h"

namespace enc::sim {
namespace {

class Saver {
 public:
  template <class T>
  void put(const T& part) {
    static_assert(std::is_trivially_copyable_v<T>);
    put_bytes(&part, sizeof(T));
  }
  void put_bytes(const void* from, std::size_t size) {
    const auto* first = static_cast<const std::byte*>(from);
    const auto* length = reinterpret_cast<const std::byte*>(&size);
    bytes.insert(bytes.end(), length, length + sizeof(size));
    bytes.insert(bytes.end(), first, first + size);
  }
  std::vector<std::byte> bytes;
};

class Restorer {
 public:
  explicit Restorer(const std::vector<std::byte>& bytes) : bytes_(bytes) {}
  template <class T>
  T take() {
    static_assert(std::is_trivially_copyable_v<T>);
    T part;
    take_bytes(&part, sizeof(T));
    return part;
  }
  void take_bytes(void* to, std::size_t size) {
    std::size_t length = 0;
    if (at_ + sizeof(length) > bytes_.size()) throw Error("this saved world is cut short");
    std::memcpy(&length, bytes_.data() + at_, sizeof(length));
    at_ += sizeof(length);
    if (length != size || at_ + length > bytes_.size())
      throw Error("this saved world is of another scene or another build");
    std::memcpy(to, bytes_.data() + at_, length);
    at_ += length;
  }

  void end() const {
    if (at_ != bytes_.size()) throw Error("this saved world is of another scene or another build");
  }

 private:
  const std::vector<std::byte>& bytes_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<std::byte> World::save() const {
  Saver saver;
  const std::vector<double> physics = physics_.save();
  saver.put_bytes(physics.data(), physics.size() * sizeof(double));
  if (machine) saver.put(machine->state());
  if (arm) saver.put(arm->state());
  if (force) saver.put(force->state());
  if (tracker) saver.put(tracker->state());
  if (display) saver.put(display->state());
  if (ball) saver.put(ball->state());
  if (pusher) saver.put(pusher->state());
  if (gripper) saver.put(gripper->state());
  if (user_) saver.put(user_->state());
  saver.put(next_);
  saver.put(truth_);
  saver.put(diverged_at_);
  return saver.bytes;
}

void World::restore(const std::vector<std::byte>& saved) {
  Restorer from(saved);
  std::vector<double> physics = physics_.save();
  from.take_bytes(physics.data(), physics.size() * sizeof(double));
  if (machine) machine->restore(from.take<HexapodPlant::State>());
  if (arm) arm->restore(from.take<ArmPlant::State>());
  if (force) force->restore(from.take<ForcePlant::State>());
  if (tracker) tracker->restore(from.take<TrackerPlant::State>());
  if (display) display->restore(from.take<DisplayPlant::State>());
  if (ball) ball->restore(from.take<BallContact::State>());
  if (pusher) pusher->restore(from.take<Pusher::State>());
  if (gripper) gripper->restore(from.take<GripperPlant::State>());
  if (user_) user_->restore(from.take<User::State>());
  next_ = from.take<Tick>();
  truth_ = from.take<Truth>();
  diverged_at_ = from.take<std::int64_t>();
  from.end();
  fatal_.clear();
  physics_.restore(physics);
  if (arm) mj_kinematics(physics_.model(), physics_.data());  // the prop is turned by where its arm is
}

}  // namespace enc::sim
