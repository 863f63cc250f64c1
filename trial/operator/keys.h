// The keys of the terminal at standard input, one by one and without waiting.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace enc::trial {

class Keys {
 public:
  Keys();
  ~Keys();  // the terminal has the settings that it had
  Keys(const Keys&) = delete;
  Keys& operator=(const Keys&) = delete;

  // Reads the keys of the terminal from here on, while this process is in its foreground.
  void begin() noexcept;
  // The keys that were pressed since the last look, at most as many as fit. It looks at the terminal on each
  // `kSeldom`-th call, and takes it anew where a shell has changed its settings or has brought this process
  // to the foreground.
  [[nodiscard]] std::size_t read(std::span<char> into) noexcept;
  void release() noexcept;  // gives the terminal back, until take()
  void take() noexcept;     // if this process is in the foreground
  [[nodiscard]] bool reading() const noexcept { return taken_; }
  [[nodiscard]] bool lost() const noexcept { return lost_; }  // the terminal was closed

  static constexpr std::uint32_t kSeldom = 16;

 private:
  struct Terminal;
  [[nodiscard]] bool in_foreground() const noexcept;

  std::unique_ptr<Terminal> terminal_;  // none: standard input is no terminal
  std::uint32_t calls_ = 0;
  std::atomic<bool> taken_ = false;  // another thread may ask
  bool lost_ = false;
};

}  // namespace enc::trial
