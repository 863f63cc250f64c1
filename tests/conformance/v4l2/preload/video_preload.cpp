// Loaded into a foreign program by LD_PRELOAD: where it opens the file ENCOUNTER_VIDEO_FILE, it gets the fake
// camera behind the socket ENCOUNTER_VIDEO_SOCKET, and its ioctls go there.
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include "hw_drivers/v4l2/wire/relay.h"

namespace {

enc::v4l2::System& fake() {
  static const std::unique_ptr<enc::v4l2::System> system = enc::v4l2::relayed();
  return *system;
}
int camera = -1;  // its descriptor, while it is open

// The function that this library stands in front of.
template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

bool is_camera(const char* path) {
  const char* const file = std::getenv("ENCOUNTER_VIDEO_FILE");
  return file != nullptr && path != nullptr && std::string(file) == path;
}

int result_of(int answer) {
  if (answer >= 0) return answer;
  errno = -answer;
  return -1;
}

int open_camera() {
  const char* const socket = std::getenv("ENCOUNTER_VIDEO_SOCKET");
  camera = socket == nullptr ? -ENODEV : fake().open(socket);
  return result_of(camera);
}

// What the kernel says of a device number that a plain file has: that of a camera.
FILE* open_event() {
  constexpr std::string_view kText = "DEVNAME=video0\n";
  const int file = ::memfd_create("uevent", MFD_CLOEXEC);
  if (file < 0 || ::write(file, kText.data(), kText.size()) < 0 || ::lseek(file, 0, SEEK_SET) != 0)
    return nullptr;
  return ::fdopen(file, "r");
}
bool is_event(const char* path) { return std::string_view(path) == "/sys/dev/char/0:0/uevent"; }

}  // namespace

extern "C" {

[[gnu::visibility("default")]] FILE* fopen(const char* path, const char* mode) {
  return is_event(path) ? open_event() : next<FILE*(const char*, const char*)>("fopen")(path, mode);
}

[[gnu::visibility("default")]] FILE* fopen64(const char* path, const char* mode) {
  return is_event(path) ? open_event() : next<FILE*(const char*, const char*)>("fopen64")(path, mode);
}

[[gnu::visibility("default")]] int open(const char* path, int flags, ...) {
  if (is_camera(path)) return open_camera();
  va_list more;
  va_start(more, flags);
  const auto mode = va_arg(more, mode_t);
  va_end(more);
  return next<int(const char*, int, ...)>("open")(path, flags, mode);
}

[[gnu::visibility("default")]] int __open_2(const char* path, int flags) {
  if (is_camera(path)) return open_camera();
  return next<int(const char*, int)>("__open_2")(path, flags);
}

[[gnu::visibility("default")]] int ioctl(int descriptor, unsigned long request, ...) noexcept {
  va_list more;
  va_start(more, request);
  void* const data = va_arg(more, void*);
  va_end(more);
  if (descriptor >= 0 && descriptor == camera) return result_of(fake().control(descriptor, request, data));
  return next<int(int, unsigned long, ...)>("ioctl")(descriptor, request, data);
}

[[gnu::visibility("default")]] int close(int descriptor) {
  if (descriptor < 0 || descriptor != camera) return next<int(int)>("close")(descriptor);
  camera = -1;  // first: the fake closes this descriptor by this function
  fake().close(descriptor);
  return 0;
}

}  // extern "C"
