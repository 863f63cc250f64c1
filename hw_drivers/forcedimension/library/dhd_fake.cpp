// The fake libdhd.so: functions of Force Dimension's DHD in front of a fake arm of `encounter fake`. The
// serial number is the fake's port; 0 connects to the usual place, or to that of ENCOUNTER_FAKE_DHD. Reading
// the position waits for the fake's next state, a thousand times a second.
#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <stdexcept>

#include "hw_drivers/arm/fake/client.h"
#include "hw_drivers/forcedimension/drive/settings.h"
#include "hw_drivers/forcedimension/wire/dhd.h"

namespace enc::forcedimension {
namespace {

constexpr Duration kConnect{1'000'000'000}, kState{100'000'000};

thread_local int last_error = dhd::kNoError;

int failed(int error) {
  last_error = error;
  return -1;
}

// The one device. It is never destroyed, because a thread of its user may still call it at exit.
class FakeDhd {
 public:
  static FakeDhd& one() {
    static auto* const kOne = new FakeDhd;
    return *kOne;
  }

  int open(int serial);
  int close();
  int enable(bool on);
  int status(int* to) const;
  int position(double* x, double* y, double* z);
  int velocity(double* x, double* y, double* z) const;
  int push(double x, double y, double z);
  int set_watchdog(unsigned char steps);
  int watchdog(unsigned char* steps) const;
  [[nodiscard]] unsigned buttons() const { return state_.buttons; }
  void expert(bool on) { expert_ = on; }
  [[nodiscard]] bool is_open() const { return client_.is_open(); }

 private:
  arm::Client client_;
  arm::State state_;  // at the last reading of the position
  std::array<double, 3> force_{};
  std::atomic<bool> enabled_ = false;
  bool expert_ = false;
  unsigned char watchdog_ = 0;
};

int FakeDhd::open(int serial) {
  if (is_open()) return failed(dhd::kDeviceInUse);
  ForceDimensionSettings settings;
  settings.serial = serial;
  arm::Place place = settings.fake_place();
  if (const char* set = std::getenv(kPlaceVariable); set != nullptr && serial == 0)
    static_cast<void>(arm::read_place(set, place));
  if (!client_.open(place, kConnect)) return failed(dhd::kNoDevice);
  state_ = client_.state();
  enabled_ = false;
  force_ = {};
  return 0;
}

int FakeDhd::close() {
  if (!is_open()) return failed(dhd::kNoDevice);
  client_.close();
  return 0;
}

int FakeDhd::enable(bool on) {
  if (!is_open()) return failed(dhd::kNoDevice);
  if (enabled_.exchange(on) && !on) client_.end_force();
  if (!on) force_ = {};
  return 0;
}

int FakeDhd::status(int* to) const {
  if (!is_open()) return failed(dhd::kNoDevice);
  std::fill_n(to, 17, 0);
  to[dhd::kPower] = to[1] = to[2] = 1;  // connected and started, too
  to[dhd::kReset] = (state_.flags & arm::kUncalibrated) != 0 ? 1 : 0;
  to[5] = enabled_ ? 1 : 0;
  to[6] = enabled_ ? 0 : 1;  // brake
  return 0;
}

int FakeDhd::position(double* x, double* y, double* z) {
  if (!is_open()) return failed(dhd::kNoDevice);
  if (!client_.wait(kState)) return failed(dhd::kTimeout);
  state_ = client_.state();
  if ((state_.flags & arm::kThrows) != 0) throw std::runtime_error("the fake throws, as a test asks for");
  if (state_.error != 0) return failed(static_cast<int>(state_.error));
  if (!enabled_) client_.send({}, false);
  *x = state_.tip[0] - state_.home[0];
  *y = state_.tip[1] - state_.home[1];
  *z = state_.tip[2] - state_.home[2];
  return 0;
}

int FakeDhd::velocity(double* x, double* y, double* z) const {
  if (!is_open()) return failed(dhd::kNoDevice);
  *x = state_.velocity[0];
  *y = state_.velocity[1];
  *z = state_.velocity[2];
  return 0;
}

int FakeDhd::push(double x, double y, double z) {
  if (!is_open()) return failed(dhd::kNoDevice);
  force_ = {x, y, z};
  client_.send(enabled_ ? force_ : std::array<double, 3>{}, enabled_);
  return 0;
}

int FakeDhd::set_watchdog(unsigned char steps) {
  constexpr int kExpertModeDisabled = 9;
  if (!expert_) return failed(kExpertModeDisabled);
  watchdog_ = steps;
  client_.set_watchdog(dhd::kWatchdogStep * steps);
  return 0;
}

int FakeDhd::watchdog(unsigned char* steps) const {
  *steps = watchdog_;
  return 0;
}

FakeDhd& one() { return FakeDhd::one(); }

}  // namespace
}  // namespace enc::forcedimension

// ---- the functions of libdhd.so

namespace dhd = enc::forcedimension::dhd;
using enc::forcedimension::one;
#define DHD_API extern "C" __attribute__((visibility("default")))

DHD_API int dhdOpen() { return one().open(0); }
DHD_API int dhdOpenSerial(int serial) { return one().open(serial); }
DHD_API int dhdClose(char) { return one().close(); }
DHD_API const char* dhdGetSystemName(char) { return "Encounter fake omega.3"; }
DHD_API int dhdGetSerialNumber(std::uint16_t* serial, char) {
  *serial = 1;
  return 0;
}
DHD_API void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
  *major = 3;
  *minor = 17;
  *release = 6;
  *revision = 0;
}
DHD_API int dhdGetStatus(int* to, char) { return one().status(to); }
DHD_API int dhdEnableForce(unsigned char on, char) { return one().enable(on != 0); }
DHD_API int dhdStop(char) { return one().enable(false); }
DHD_API int dhdSetBrakes(unsigned char on, char) { return on != 0 ? one().enable(false) : 0; }
DHD_API int dhdEnableExpertMode() {
  one().expert(true);
  return 0;
}
DHD_API int dhdDisableExpertMode() {
  one().expert(false);
  return 0;
}
DHD_API int dhdSetWatchdog(unsigned char steps, char) { return one().set_watchdog(steps); }
DHD_API int dhdGetWatchdog(unsigned char* steps, char) { return one().watchdog(steps); }
DHD_API int dhdSetMaxForce(double, char) { return 0; }
DHD_API int dhdGetPosition(double* x, double* y, double* z, char) { return one().position(x, y, z); }
DHD_API int dhdGetLinearVelocity(double* x, double* y, double* z, char) { return one().velocity(x, y, z); }
DHD_API int dhdSetForce(double x, double y, double z, char) { return one().push(x, y, z); }
DHD_API unsigned dhdGetButtonMask(char) { return one().buttons(); }
DHD_API int dhdErrorGetLast() { return enc::forcedimension::last_error; }
DHD_API const char* dhdErrorGetLastStr() {
  static thread_local std::array<char, 128> text{};
  const std::string words = dhd::words_of(enc::forcedimension::last_error);
  text[words.copy(text.data(), text.size() - 1)] = '\0';
  return text.data();
}
