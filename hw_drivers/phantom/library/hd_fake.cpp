// The fake libHD.so: the functions of OpenHaptics HD in front of a fake arm of `encounter fake`. The device's
// name is the fake's HOST:PORT; another name connects to the usual place, or to that of ENCOUNTER_FAKE_HD.
// The scheduler calls at each state that the fake sends, a thousand times a second: a fake that stalls is a
// device whose scheduler makes no calls.
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "hw_drivers/arm/fake/client.h"
#include "hw_drivers/net/lockstep.h"
#include "hw_drivers/phantom/drive/settings.h"
#include "hw_drivers/phantom/wire/coordinates.h"
#include "hw_drivers/phantom/wire/hd.h"

namespace enc::phantom {
namespace {

constexpr hd::Handle kHandle = 1;
constexpr Duration kConnect{1'000'000'000}, kTurn{20'000'000};

struct CallbackEntry {
  unsigned long handle = 0;
  hd::Callback callback = nullptr;
  void* data = nullptr;
};

// The one device. It is never destroyed, because a thread of its user may still call it at exit.
class FakeHd {
 public:
  static FakeHd& one() {
    static auto* const kOne = new FakeHd;
    return *kOne;
  }

  hd::Handle open(const char* name);
  void close();
  void start();
  void stop();
  unsigned long add(hd::Callback callback, void* data);
  void remove(unsigned long handle);
  bool has(unsigned long handle);
  void run_once(hd::Callback callback, void* data);

  void begin_frame();
  void end_frame();
  void enable(hd::Enum what, bool on);
  [[nodiscard]] bool enabled(hd::Enum what) const { return what == hd::kForceOutput && enabled_; }
  [[nodiscard]] bool is_open() const { return client_.is_open(); }
  [[nodiscard]] bool in_step() const { return client_.lockstep(); }
  void fail(hd::Enum error);
  hd::ErrorInfo take_error();

  void doubles(hd::Enum of, double* to);
  void integers(hd::Enum of, int* to);
  void set(hd::Enum of, const double* from);
  [[nodiscard]] hd::Enum calibration() const;
  void calibrate() { calibrated_ = true; }
  [[nodiscard]] double time() const { return 1e-3 * static_cast<double>(seen_.number); }

 private:
  void turn();  // the scheduler's thread
  void call_all();
  [[nodiscard]] Vec3 tip_mm() const;

  arm::Client client_;
  arm::State seen_;                       // of the present frame
  std::array<double, 3> force_{};         // in R, N
  bool pushed_ = false;                   // in this frame
  int frames_ = 0;                        // open ones
  std::atomic<std::uint32_t> flags_ = 0;  // of the newest frame
  std::atomic<bool> enabled_ = false, runs_ = false, calibrated_ = false;
  std::thread thread_;
  std::mutex calls_mutex_, errors_mutex_;
  std::vector<CallbackEntry> calls_;
  unsigned long next_ = 1;
  std::deque<hd::Enum> errors_;
};

hd::Handle FakeHd::open(const char* name) {
  if (is_open()) {
    fail(hd::kAlreadyInitiated);
    return hd::kNoDevice;
  }
  arm::Place place;
  const char* const set = std::getenv(kPlaceVariable);
  const bool good = arm::read_place(name != nullptr ? name : "", place) ||
                    arm::read_place(set != nullptr ? set : kUsualPlace, place);
  calibrated_ = enabled_ = false;
  force_ = {};
  frames_ = 0;
  if (good && client_.open(place, kConnect)) {
    seen_ = client_.state();
    flags_ = seen_.flags;
    return kHandle;
  }
  fail(hd::kCommError);
  return hd::kNoDevice;
}

void FakeHd::close() {
  stop();
  client_.close();
}

void FakeHd::start() {
  if (!runs_.exchange(true)) thread_ = std::thread([this] { turn(); });
}

void FakeHd::stop() {
  runs_ = false;
  if (thread_.joinable() && thread_.get_id() != std::this_thread::get_id()) thread_.join();
}

void FakeHd::turn() {
  while (runs_) {
    if (!client_.is_open() || client_.lockstep()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      continue;
    }
    if (!client_.wait(kTurn)) continue;
    call_all();
    client_.send(enabled_ ? force_ : std::array<double, 3>{}, enabled_);
  }
}

void FakeHd::call_all() {
  std::vector<CallbackEntry> now;
  {
    const std::lock_guard lock(calls_mutex_);
    now = calls_;
  }
  for (const CallbackEntry& one : now)
    if (one.callback(one.data) == hd::kDone) remove(one.handle);
}

unsigned long FakeHd::add(hd::Callback callback, void* data) {
  const std::lock_guard lock(calls_mutex_);
  calls_.push_back({next_, callback, data});
  return next_++;
}

void FakeHd::remove(unsigned long handle) {
  const std::lock_guard lock(calls_mutex_);
  std::erase_if(calls_, [handle](const CallbackEntry& one) { return one.handle == handle; });
}

bool FakeHd::has(unsigned long handle) {
  const std::lock_guard lock(calls_mutex_);
  return std::any_of(calls_.begin(), calls_.end(),
                     [handle](const CallbackEntry& one) { return one.handle == handle; });
}

// Waits until the scheduler's thread has called it; without a scheduler, calls at once.
void FakeHd::run_once(hd::Callback callback, void* data) {
  if (!runs_) {
    static_cast<void>(callback(data));
    return;
  }
  const unsigned long handle = add(callback, data);
  while (runs_ && has(handle)) std::this_thread::sleep_for(std::chrono::microseconds(200));
}

void FakeHd::begin_frame() {
  if (frames_++ > 0) fail(hd::kIllegalBegin);
  pushed_ = false;
  if (client_.lockstep()) client_.wait(Duration{});  // a state that came without a force
  seen_ = client_.state();
  flags_ = seen_.flags;
  if (seen_.error != 0) fail(seen_.error);
}

void FakeHd::end_frame() {
  if (frames_ == 0) return fail(hd::kIllegalEnd);
  --frames_;
  if (!pushed_ || !client_.lockstep()) return;
  if (!client_.exchange(enabled_ ? force_ : std::array<double, 3>{}, enabled_, from_seconds(net::kFakeHangs)))
    fail(hd::kCommError);
}

void FakeHd::enable(hd::Enum what, bool on) {
  if (what != hd::kForceOutput) return;
  const bool was = enabled_.exchange(on);
  if (was && !on && client_.is_open()) client_.end_force();
}

void FakeHd::fail(hd::Enum error) {
  constexpr std::size_t kMost = 32;
  const std::lock_guard lock(errors_mutex_);
  if (errors_.size() < kMost) errors_.push_back(error);
}

hd::ErrorInfo FakeHd::take_error() {
  const std::lock_guard lock(errors_mutex_);
  if (errors_.empty()) return {hd::kSuccess, 0, kHandle};
  const hd::Enum error = errors_.front();
  errors_.pop_front();
  return {error, 0, kHandle};
}

Vec3 FakeHd::tip_mm() const {
  const Point<'R'> home(seen_.home[0], seen_.home[1], seen_.home[2]);
  return hd_point(Point<'R'>(seen_.tip[0], seen_.tip[1], seen_.tip[2]), home);
}

void FakeHd::doubles(hd::Enum of, double* to) {
  if ((seen_.flags & arm::kThrows) != 0) throw std::runtime_error("the fake throws, as a test asks for");
  const auto put = [to](const Vec3& v) { std::copy_n(v.data(), 3, to); };
  switch (of) {
    case hd::kPosition:
      return put(tip_mm());
    case hd::kVelocity:
      return put(axes_to_hd(Vec3(seen_.velocity[0], seen_.velocity[1], seen_.velocity[2])) / kMillimetre);
    case hd::kJointAngles:
      return put(Vec3(-seen_.joints[0], seen_.joints[1], seen_.joints[2]));  // its turret turns the other way
    case hd::kGimbalAngles:
      return put(Vec3::Zero());
    case hd::kCurrentForce:
      return put(axes_to_hd(Vec3(force_[0], force_[1], force_[2])));
    case hd::kMotorTemperature:
      if (std::isnan(seen_.warmth)) return fail(hd::kInvalidEnum);
      std::fill_n(to, hd::kMotors, seen_.warmth);
      return;
    case hd::kNominalMaxForce:
      *to = seen_.peak;
      return;
    case hd::kContinuousForce:
      *to = seen_.continuous;
      return;
    case hd::kTransform: {
      std::fill_n(to, 16, 0.0);
      to[0] = to[5] = to[10] = to[15] = 1.0;
      const Vec3 at = tip_mm();
      std::copy_n(at.data(), 3, to + 12);
      return;
    }
    default:
      fail(hd::kInvalidEnum);
  }
}

void FakeHd::integers(hd::Enum of, int* to) {
  constexpr int kRate = 1000;
  if (of == hd::kButtons)
    *to = static_cast<int>(seen_.buttons);
  else if (of == hd::kCalibrationStyle)
    *to = hd::kEncoderReset;
  else if (of == hd::kUpdateRate)
    *to = kRate;
  else
    fail(hd::kInvalidEnum);
}

void FakeHd::set(hd::Enum of, const double* from) {
  if (of != hd::kCurrentForce) return fail(hd::kInvalidEnum);
  if (frames_ == 0) return fail(hd::kInvalidOperation);
  const Vec3 force = axes_to_ours(Vec3(from[0], from[1], from[2]));
  std::copy_n(force.data(), 3, force_.data());
  pushed_ = true;
}

hd::Enum FakeHd::calibration() const {
  const bool needs = (flags_ & arm::kUncalibrated) != 0 && !calibrated_;
  return needs ? hd::kNeedsUpdate : hd::kCalibrated;
}

const char* text_of(hd::Enum of) {
  switch (of) {
    case hd::kVendor:
      return "Encounter fake";  // kFakeName
    case hd::kModel:
      return "PHANToM Premium 1.0A";
    case hd::kSerial:
      return FakeHd::one().in_step() ? "F0001 in lockstep" : "F0001";  // kInStep
    case hd::kVersion:
      return "3.4.0";
    case hd::kDriverVersion:
      return "2023.11.15";
    default:
      FakeHd::one().fail(hd::kInvalidEnum);
      return "";
  }
}

FakeHd& one() { return FakeHd::one(); }

}  // namespace
}  // namespace enc::phantom

// ---- the functions of libHD.so

namespace hd = enc::phantom::hd;
using enc::phantom::one;
#define HD_API extern "C" __attribute__((visibility("default")))

HD_API hd::Handle hdInitDevice(const char* name) { return one().open(name); }
HD_API void hdDisableDevice(hd::Handle) { one().close(); }
HD_API void hdMakeCurrentDevice(hd::Handle) {}
HD_API hd::Handle hdGetCurrentDevice() { return enc::phantom::kHandle; }
HD_API void hdBeginFrame(hd::Handle) { one().begin_frame(); }
HD_API void hdEndFrame(hd::Handle) { one().end_frame(); }
HD_API hd::ErrorInfo hdGetError() { return one().take_error(); }
HD_API const char* hdGetErrorString(hd::Enum error) {
  static thread_local std::array<char, 128> text{};
  const std::string words = hd::words_of(error);
  text[words.copy(text.data(), text.size() - 1)] = '\0';
  return text.data();
}
HD_API void hdEnable(hd::Enum what) { one().enable(what, true); }
HD_API void hdDisable(hd::Enum what) { one().enable(what, false); }
HD_API unsigned char hdIsEnabled(hd::Enum what) { return one().enabled(what) ? 1 : 0; }
HD_API void hdGetIntegerv(hd::Enum of, int* to) { one().integers(of, to); }
HD_API void hdGetDoublev(hd::Enum of, double* to) { one().doubles(of, to); }
HD_API const char* hdGetString(hd::Enum of) { return enc::phantom::text_of(of); }
HD_API void hdSetDoublev(hd::Enum of, const double* from) { one().set(of, from); }
HD_API hd::Enum hdCheckCalibration() { return one().calibration(); }
HD_API hd::Enum hdCheckCalibrationStyle() { return hd::kEncoderReset; }
HD_API void hdUpdateCalibration(hd::Enum) { one().calibrate(); }
HD_API void hdStartScheduler() { one().start(); }
HD_API void hdStopScheduler() { one().stop(); }
HD_API void hdSetSchedulerRate(unsigned long) {}
HD_API unsigned long hdScheduleAsynchronous(hd::Callback callback, void* data, std::uint16_t) {
  return one().add(callback, data);
}
HD_API void hdScheduleSynchronous(hd::Callback callback, void* data, std::uint16_t) {
  one().run_once(callback, data);
}
HD_API void hdUnschedule(unsigned long handle) { one().remove(handle); }
HD_API unsigned char hdWaitForCompletion(unsigned long handle, unsigned) { return one().has(handle) ? 1 : 0; }
HD_API double hdGetSchedulerTimeStamp() { return one().time(); }
