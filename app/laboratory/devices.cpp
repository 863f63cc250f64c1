// `encounter devices`: reads the devices of a rig without commanding them. It reports whether each device
// answers, how often, how regularly and how late it sends samples, and whether a run could use it.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "app/modules/modules.h"
#include "app/run/percentiles.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/devices/roles.h"
#include "models/files.h"
#include "models/setup/scene_file.h"
#include "trial/assemble/assemble.h"
#include "trial/devices/device_log.h"
#include "trial/operator/signals.h"
#include "trial/time/real_time.h"

namespace enc::app {
namespace {

struct DeviceCheck {
  std::string role, words;  // as in trial::DeviceWords
  bool there = true;
  std::int64_t samples = 0;            // number of new samples in that time
  double rate = kUnset;                // Hz
  Percentiles interval{}, age{};       // s: between samples, by their stamps; age of a sample at its arrival
  std::string last{};                  // the last sample, in words
  std::vector<std::string> remarks{};  // as in the report of a run
  // Reason why a run could not use it; empty: it could.
  std::string unusable{};
};

struct Series {
  Time last{}, came{};  // the newest sample: its time, and when it was read
  bool any = false, linked = true;
  Health health = Health::absent;
  std::int64_t faults = 0;              // number of samples
  std::int64_t repeated = 0;            // poses of a tracker that equal the one before, to the bit
  std::int64_t equal = 0;               // number of them since the last different pose
  Time differed{};                      // time of that pose
  std::vector<double> intervals, ages;  // s
  void add(Time t, Time now) {
    if (any) intervals.push_back(age(t, last));
    ages.push_back(age(now, t));
    last = t;
    came = now;
    any = true;
  }
};

template <class Sample>
bool repeats(const Measurement<Sample>&, const Measurement<Sample>&) {
  return false;
}
// A measuring tracker never gives equal poses twice.
bool repeats(const Measurement<TrackedTool>& before, const Measurement<TrackedTool>& now) {
  return before.value.tool == now.value.tool && before.value.X_CT.xyz == now.value.X_CT.xyz &&
         before.value.X_CT.xyzw == now.value.X_CT.xyzw;
}

// Reason why a run could not use the device. `end`: when the reading ended; `refused`: Device::refused().
std::string unusable(const Series& of, Time end, const std::string& refused) {
  constexpr double kFrozen = 0.5;  // s; a hand that holds still moves by less than a tracker's noise
  const auto samples = static_cast<std::int64_t>(of.ages.size());
  constexpr std::int64_t kFew = 10;  // equal poses; fewer may be luck
  const std::string because = refused.empty() ? "" : ": " + refused;
  if (samples == 0) return "it sent no sample" + because;
  if (of.faults > 0) return fmt::format("{} of {} samples report a fault", of.faults, samples);
  if (!of.linked) return "its link was lost";
  if (of.health != Health::ok) return fmt::format("its last sample is {}", word_of(of.health));
  if (age(end, of.came) > 0.5 * age(end, Time{}))
    return fmt::format("it sent nothing new in the last {:.2f} s{}", age(end, of.came), because);
  if (samples > kFew && of.repeated == samples - 1)
    return "all poses are equal to the bit: it repeats the last pose of a tool that it does not see";
  if (const double frozen = age(of.came, of.differed); of.equal >= kFew && frozen >= kFrozen)
    return fmt::format(
        "the last {} poses, of {:.2f} s, are equal to the bit: it repeats the last pose of a tool that it "
        "does "
        "not see",
        of.equal + 1, frozen);
  return {};
}

std::string words_of(const Vec3& v, double unit) {
  return fmt::format("[{:.3f}, {:.3f}, {:.3f}]", v.x() / unit, v.y() / unit, v.z() / unit);
}

std::string words_of(const Measurement<TipSample>& tip) {
  return words_of(tip.value.X_RH.p(), kMillimetre) + " mm, of H in R";
}
std::string words_of(const Measurement<Wrench>& said) {
  return words_of(said.value.force.e(), 1.0) + " N, " + words_of(said.value.torque.e(), 1.0) + " N m, in F" +
         (said.health == Health::ok ? "" : fmt::format(", {}", word_of(said.health)));
}
std::string words_of(const Measurement<TrackedTool>& tool) {
  return words_of(tool.value.X_CT.p(), kMillimetre) + fmt::format(" mm, of tool {} in C", tool.value.tool);
}
std::string words_of(const Measurement<ArmSample>& arm) {
  return words_of(arm.value.tip.e(), kMillimetre) + " mm, of its tip in R" +
         (arm.health == Health::ok ? "" : fmt::format(", {}", word_of(arm.health)));
}
std::string words_of(const Measurement<HandSample>& hand) {
  return words_of(hand.value.wrist.p(), kMillimetre) +
         fmt::format(" mm, of the {} wrist in L", hand.value.side == HandSide::left ? "left" : "right");
}
template <class Sample>
std::string words_of(const Measurement<Sample>&) {
  return "";
}

// Index of each device in `all`; all.size() or kDevices: none.
std::array<std::size_t, kDevices> places_of(const Rig& rig, const std::vector<DeviceCheck>& all) {
  std::array<std::size_t, kDevices> place{};
  place.fill(all.size());
  each_device([&](const auto& role) {
    if (rig.*role.slot == nullptr) return;
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const DeviceCheck& one) { return one.role == role.table; });
    place[static_cast<std::size_t>(role.id)] = static_cast<std::size_t>(found - all.begin());
  });
  return place;
}

// Collects a new sample in a reading at `now`, and its fault.
template <class Sample>
void listen(const Measurement<Sample>& before, const Measurement<Sample>& said, Time now, Series& of) {
  if (said.health == Health::absent) return;
  of.health = said.health;
  if (of.any && said.t <= of.last) return;
  if (said.health == Health::fault) ++of.faults;
  if (of.any && repeats(before, said)) {
    ++of.repeated, ++of.equal;
  } else {
    of.equal = 0, of.differed = now;
  }
  of.add(said.t, now);
}

// The new samples of all roles of the loop.
void listen(const Rig& rig, const Inputs& before, const Inputs& in, Time now,
            std::array<Series, kDevices>& series) {
  each_role([&](const auto& role) {
    if (rig.*role.slot)
      listen(before.*role.said, in.*role.said, now, series[static_cast<std::size_t>(role.id)]);
  });
}

void tell_times(const Series& of, double seconds, DeviceCheck& device) {
  device.samples = static_cast<std::int64_t>(of.ages.size());
  device.rate = static_cast<double>(device.samples) / seconds;
  device.age = percentiles_of(of.ages);
  device.interval = percentiles_of(of.intervals);
}

void judge(const Device& device, Time end, Series& of, DeviceCheck& probed) {
  probed.remarks = device.remarks();
  of.linked = device.linked();
  probed.unusable = unusable(of, end, device.refused());
}

// Makes every real device, reads each for this time at the loop's rate, and releases it. Sends no command:
// nothing moves. If a machine does not answer, the other devices are not queried, because a run may hold them
// all and would lose them. `stop` is called before each reading.
std::vector<DeviceCheck> probe_devices(const models::Setup& setup, const trial::DriverSource& drivers,
                                       double seconds, const std::function<bool()>& stop) {
  std::vector<DeviceCheck> all;
  Rig rig;
  trial::DeviceLog log;
  for (const trial::DeviceWords& words : trial::put_each_driver(rig, setup, drivers, log))
    all.push_back({words.role, words.words, words.there});
  const std::array<std::size_t, kDevices> place = places_of(rig, all);
  std::array<Series, kDevices> series;
  Inputs in;
  Measurement<HandSample> hand;
  Time end{};
  using Wall = std::chrono::steady_clock;
  const auto period = std::chrono::nanoseconds(from_seconds(1.0 / setup.rig.loop.rate));
  const Wall::time_point begun = Wall::now();
  rig.clock = std::make_unique<trial::CountingClock>(setup.rig.loop.rate);
  for (std::int64_t i = 1; !stop(); ++i) {
    std::this_thread::sleep_until(begun + i * period);
    const Time now(std::chrono::duration_cast<Duration>(Wall::now() - begun));
    if (age(now, Time{}) > seconds) break;
    const Inputs before = in;
    end = now;
    rig.read(now, in);
    listen(rig, before, in, now, series);
    if (rig.hand_tracker && rig.hand_tracker->poll(now, hand))
      listen({}, hand, now, series[static_cast<std::size_t>(RoleId::hand_tracker)]);
  }
  each_device([&](const auto& role) {
    const auto id = static_cast<std::size_t>(role.id);
    if (place[id] >= all.size()) return;
    if constexpr (requires { role.said; })
      all[place[id]].last = words_of(in.*role.said);
    else
      all[place[id]].last = words_of(hand);
    judge(*(rig.*role.slot), end, series[id], all[place[id]]);
  });
  for (std::size_t i = 0; i < kDevices; ++i)
    if (place[i] < all.size() && series[i].any) tell_times(series[i], seconds, all[place[i]]);
  return all;
}

std::string line_of(const DeviceCheck& device) {
  if (!device.there) return fmt::format("{:12} NOT THERE: {}\n", device.role, device.words);
  std::string text = fmt::format("{:12} {}\n", device.role, device.words);
  if (device.samples > 0 && !device.last.empty()) text += fmt::format("{:12} {}\n", "", device.last);
  for (std::string remark : device.remarks) {
    if (remark.starts_with(device.words + ": ")) remark.erase(0, device.words.size() + 2);
    text += fmt::format("{:12} {}\n", "", remark);
  }
  if (device.samples == 1) text += fmt::format("{:12} 1 sample\n", "");
  if (device.samples > 1)
    text += fmt::format("{:12} {:.1f} samples a second; apart {} ms; old when they come {} ms\n", "",
                        device.rate, text_of(device.interval, 1e3, 2, 2), text_of(device.age, 1e3, 2, 2));
  if (!device.unusable.empty()) text += fmt::format("{:12} NOT USABLE: {}\n", "", device.unusable);
  return text;
}

}  // namespace

int devices(const LaboratoryOptions& options) {
  trial::Signals signals;
  signals.begin();
  if (!(options.seconds > 0.0 && options.seconds <= 1e4))
    throw Error("--for-s: expected a number above 0, up to 10000");
  const models::Setup setup = load_setup(with_scene(options));
  const trial::RealTime priority(true);  // as in a run: a busy processor is no fault of a device
  const auto found =
      probe_devices(setup, load_module, options.seconds, [] { return trial::Signals::caught() != 0; });
  if (found.empty()) fmt::print("every device that the scene names is simulated\n");
  bool all = true;
  for (const DeviceCheck& device : found) {
    fmt::print("{}", line_of(device));
    all = all && device.there && device.unusable.empty();
  }
  if (trial::Signals::caught() != 0) return 128 + trial::Signals::caught();
  return all ? 0 : 3;
}

}  // namespace enc::app
