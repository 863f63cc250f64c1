// Shows an armed run on standard error while it happens. A terminal gets a status line that renews itself and
// one line for each event; any other stream gets one line with a time stamp for each event. It writes from a
// separate thread, so that a blocked terminal or disk delays no tick.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "trial/operator/run_watch.h"
#include "trial/operator/terminal.h"

namespace enc::app {

class Console {
 public:
  // `watch` must outlive this. `objects`: their names, by index. `reads_keys`: returns whether the run reads
  // keys at present; called from another thread.
  Console(trial::RunWatch& watch, std::vector<std::string> objects, std::function<bool()> reads_keys);
  ~Console();  // shows the rest, for 0.2 s at most, and clears the status line
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  // Waits until all events so far are shown, for 0.1 s at most; call it before the process is suspended.
  void flush() const noexcept;

 private:
  void show(const std::stop_token& stop);
  void show_events();
  void show_status();
  trial::RunWatch& watch_;
  const std::vector<std::string> objects_;
  const std::function<bool()> reads_keys_;
  const trial::StandardError error_;
  std::string pending_;          // lines that standard error has not taken yet
  std::size_t shown_width_ = 0;  // status line's, in columns
  std::atomic<std::uint64_t> rounds_ = 0;
  std::jthread thread_;
};

// Texts of an event and of the status, without a line break.
[[nodiscard]] std::string event_text(const trial::RunEvent& event, const std::vector<std::string>& objects);
[[nodiscard]] std::string status_text(const trial::RunStatus& status, bool keys);

}  // namespace enc::app
