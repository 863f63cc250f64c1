#include "benchmarks/extremes/faults.h"

#include <array>
#include <memory>
#include <utility>

namespace enc::bench::extremes {
namespace {

// Says at each poll what the device said last, whatever became of it.
template <class Role, class Sample>
class Clean : public Role {
 public:
  explicit Clean(std::unique_ptr<Role> device) : device_(std::move(device)) {}
  bool poll(Time now, Stamped<Sample>& newest) noexcept override {
    device_->poll(now, newest_);
    newest = newest_;
    return true;
  }

 protected:
  std::unique_ptr<Role> device_;

 private:
  Stamped<Sample> newest_;
};
using CleanTracker = Clean<PoseTracker, TrackedTool>;
class CleanDisplay final : public Clean<Display, DentSample> {
 public:
  using Clean::Clean;
  void show(const View& view) noexcept override { device_->show(view); }
};

}  // namespace

const char* name_of(Junk junk) {
  return std::array{"NaN", "Inf", "-Inf", "1e12"}[static_cast<std::size_t>(junk)];
}

void keep_clean(Rig& rig) {
  if (rig.tracker) rig.tracker = std::make_unique<CleanTracker>(std::move(rig.tracker));
  if (rig.display) rig.display = std::make_unique<CleanDisplay>(std::move(rig.display));
}

void Network::operator()(Time now, Inputs& in) {
  if (in.tool.health != Health::absent && in.tool.t > newest_) {
    newest_ = in.tool.t;
    if (share() >= faults_.loss) {
      const auto delay = [&] {
        return share() < faults_.late ? from_seconds(faults_.least + (faults_.most - faults_.least) * share())
                                      : Duration(0);
      };
      under_way_.push_back({now + delay(), in.tool});
      if (share() < faults_.twice) under_way_.push_back({now + from_seconds(0.005), in.tool});
    }
  }
  for (std::size_t i = 0; i < under_way_.size();) {
    if (under_way_[i].due > now) {
      ++i;
      continue;
    }
    shown_ = under_way_[i].sample;
    under_way_.erase(under_way_.begin() + static_cast<std::ptrdiff_t>(i));
  }
  in.tool = shown_;
}

// What it is, and for how many ticks.
void Storm::begin() {
  constexpr int kKinds = 10;
  kind_ = static_cast<int>(random_() % kKinds);
  Inputs none;
  Spoil count;
  fields(count, none);
  field_ = static_cast<int>(random_() % static_cast<std::uint64_t>(count.seen));
  junk_ = static_cast<Junk>(random_() % 4);
  const double longest = kind_ == 1 ? 0.5 : kind_ == 3 ? 0.1 : kind_ == 4 ? 0.001 : 0.02;
  left_ = 1 + static_cast<std::int64_t>(1e3 * in(0.0, longest));
  shift_ = Vec3(in(-1, 1), in(-1, 1), in(-1, 1));
  freezes_ = false;
  ++faults_;
}

void Storm::spoil(Inputs& in) {
  Spoil one{field_, junk_};
  switch (kind_) {
    case 1:  // no news of the tool
      if (!std::exchange(freezes_, true)) frozen_ = in.tool;
      in.tool = frozen_;
      return;
    case 2:  // the tracker is at fault
      in.tool.health = Health::fault;
      return;
    case 3:  // it has leapt, and is believed
      in.tool.value.X_CT.xyz[0] += shift_.x();
      in.tool.value.X_CT.xyz[2] += shift_.z();
      return;
    case 4:  // cycles were missed
      in.missed = 1 + static_cast<std::int64_t>(100.0 * std::abs(shift_.x()));
      return;
    case 5:  // the machine says nothing
      in.tip.health = in.arm.health = Health::absent;
      return;
    case 6:  // force is at the sensor's range
      if (in.wrench.health == Health::ok) in.wrench.health = Health::saturated;
      return;
    case 7:  // a spike of force
      if (in.wrench.health == Health::ok) in.wrench.value.force.xyz[2] += 60.0 * shift_.z();
      return;
    case 8:  // old packets
      in.tool.t -= from_seconds(std::abs(shift_.y()));
      return;
    default:  // nonsense in one number
      fields(one, in);
  }
}

void Storm::operator()(Time now, Inputs& in) {
  const std::int64_t tick = now.time_since_epoch() / Duration(1'000'000);
  if (seconds(now.time_since_epoch()) >= quiet_from_) return;
  if (tick >= next_) {
    begin();
    next_ = tick + static_cast<std::int64_t>(1e3 / rate_);
  }
  if (left_-- > 0) spoil(in);
}

}  // namespace enc::bench::extremes
