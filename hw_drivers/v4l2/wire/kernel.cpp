#include <array>
#include <cerrno>
#include <climits>
#include <vector>

#include <fcntl.h>
#include <grp.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "hw_drivers/net/clocks.h"
#include "hw_drivers/v4l2/wire/system.h"

namespace enc::v4l2 {
namespace {

class Kernel final : public System {
 public:
  int open(const std::string& path) noexcept override {
    struct stat file {};
    if (::stat(path.c_str(), &file) != 0) return -errno;
    if (!S_ISCHR(file.st_mode)) return -ENOTTY;  // opening a named pipe would block
    const int descriptor = ::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    return descriptor < 0 ? -errno : descriptor;
  }
  void close(int descriptor) noexcept override { ::close(descriptor); }
  int control(int descriptor, unsigned long request, void* data) noexcept override {
    int result = -1;
    do result = ::ioctl(descriptor, request, data);
    while (result < 0 && errno == EINTR);
    return result < 0 ? -errno : 0;
  }
  void* map(int descriptor, std::size_t size, std::int64_t offset) noexcept override {
    void* memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_SHARED, descriptor, offset);
    return memory == MAP_FAILED ? nullptr : memory;
  }
  void unmap(void* memory, std::size_t size) noexcept override { ::munmap(memory, size); }
  void wait(std::span<const int> descriptors, Duration most) noexcept override {
    std::array<pollfd, 2> all{};
    const std::size_t count = std::min(descriptors.size(), all.size());
    for (std::size_t i = 0; i < count; ++i) all[i] = {descriptors[i], POLLIN, 0};
    const timespec time{static_cast<time_t>(most.count() / 1'000'000'000),
                        static_cast<long>(most.count() % 1'000'000'000)};
    static_cast<void>(::ppoll(all.data(), count, &time, nullptr));
  }
  Duration now() noexcept override { return net::steady_now(); }
};

}  // namespace

std::unique_ptr<System> kernel() { return std::make_unique<Kernel>(); }

std::string group_of(const std::string& path) {
  constexpr const char* kUsual = "video";
  struct stat file {};
  if (::stat(path.c_str(), &file) != 0 || file.st_gid == 0) return kUsual;
  std::array<char, 4096> text{};
  group entry{}, *found = nullptr;
  if (::getgrgid_r(file.st_gid, &entry, text.data(), text.size(), &found) != 0 || found == nullptr)
    return kUsual;
  return entry.gr_name;
}

}  // namespace enc::v4l2
