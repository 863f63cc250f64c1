// The driver to copy: a machine that is at the next read where it was told to be, and a force sensor that
// feels nothing. A real driver replaces what stands under "wire"; what is checked, clamped and said stays.
#include <memory>

#include "core/module.h"

namespace enc::sample {
namespace {

// A device without a clock of its own stamps what it read with the cycle in which it came.
class SampleManipulator final : public Manipulator {
 public:
  explicit SampleManipulator(const Reach& reach) : reach_(reach), pose_(reach.machine.zero()) {}

  [[nodiscard]] Reach reach() const override { return reach_; }

  Stamped<TipSample> read(Time now) noexcept override {
    // wire: take the newest datagram if there is one; never wait for it
    return {{pose_, Vec<'R'>::zero(), Vec<'R'>::zero()}, now, health_};
  }

  void command(const Pose<'R', 'H'>& X_RH) noexcept override {
    health_ = Health::ok;
    if (!X_RH.valid()) {  // not a number, or not a rotation: refused, and said
      health_ = Health::fault;
      return;
    }
    pose_ = clamped(X_RH);
    // wire: send pose_
  }

 private:
  // The farthest reachable pose on the straight way from where the machine is.
  Pose<'R', 'H'> clamped(const Pose<'R', 'H'>& wanted) noexcept {
    if (reach_.contains(wanted)) return wanted;
    health_ = Health::out_of_range;
    Pose<'R', 'H'> best = pose_;
    double from = 0.0;
    double to = 1.0;
    for (int i = 0; i < 30; ++i) {
      const double share = 0.5 * (from + to);
      const Pose<'R', 'H'> between(pose_.q().slerp(share, wanted.q()),
                                   Vec3(pose_.p() + share * (wanted.p() - pose_.p())));
      const bool reached = reach_.contains(between);
      if (reached) best = between;
      (reached ? from : to) = share;
    }
    return best;
  }

  Reach reach_;
  Pose<'R', 'H'> pose_;
  Health health_ = Health::ok;
};

class SampleForceSensor final : public ForceSensor {
 public:
  Stamped<Wrench> read(Time now) noexcept override {
    return {{Vec<'F'>::zero(), Vec<'F'>::zero()}, now, Health::ok};
  }
};

// A constructor throws Error (kind device) with a way out where the device does not answer.
std::unique_ptr<Manipulator> manipulator(const Reach& reach) {
  return std::make_unique<SampleManipulator>(reach);
}
std::unique_ptr<ForceSensor> force() { return std::make_unique<SampleForceSensor>(); }

constexpr DriverModule kDriver{.manipulator = manipulator, .force = force};
constexpr ModuleInfo kInfo{.name = "sample", .driver = &kDriver};

}  // namespace
}  // namespace enc::sample

extern "C" __attribute__((visibility("default"))) const enc::ModuleInfo* encounter_module() {
  return &enc::sample::kInfo;
}
