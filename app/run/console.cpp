#include "app/run/console.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "app/run/percentiles.h"
#include "trial/time/real_time.h"

namespace enc::app {
namespace {

using trial::RunEvent;
using trial::RunStatus;
using trial::RunWatch;

using std::chrono::milliseconds;
constexpr milliseconds kTurn{10}, kStatusTurn{100}, kLast{200};

std::size_t columns() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 1 ? size.ws_col : 80;
}

double in_s(Time t) { return seconds(t.time_since_epoch()); }

// UTC time as "2026-11-29T12:00:00.123Z".
std::string stamp() {
  const auto now = std::chrono::time_point_cast<milliseconds>(std::chrono::system_clock::now());
  const auto day = std::chrono::floor<std::chrono::days>(now);
  const std::chrono::year_month_day date(day);
  const std::chrono::hh_mm_ss time(now - day);
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                     time.hours().count(), time.minutes().count(), time.seconds().count(),
                     time.subseconds().count());
}

}  // namespace

std::string event_text(const RunEvent& event, const std::vector<std::string>& objects) {
  using Kind = RunEvent::Kind;
  const auto object = [&] {
    const auto index = static_cast<std::size_t>(event.object);
    return event.object >= 0 && index < objects.size() ? fmt::format(" with '{}'", objects[index])
                                                       : std::string();
  };
  switch (event.kind) {
    case Kind::hold:
      return "hold: " + why_text(event.why);
    case Kind::hold_over:
      return fmt::format("hold is over: {}", mode_name(event.mode));
    case Kind::contact:
      return fmt::format("contact {}{}", event.contact, object());
    case Kind::contact_over:
      return fmt::format("contact {} is over", event.contact);
    case Kind::link_lost:
      return fmt::format("link lost: {}; it needs a new run (q ends this one)", event.role);
    case Kind::halted:
      return "stopped by hand: the machine stands until r (or SIGUSR2)";
    case Kind::suspended:
      return "suspended: the machine stands; continue the process, then press r (or send SIGUSR2)";
    case Kind::resumed:
      return "resumed";
    case Kind::ends:
      return event.signal == 0 ? std::string("ends: q")
                               : fmt::format("ends: SIG{}", sigabbrev_np(event.signal) != nullptr
                                                                ? sigabbrev_np(event.signal)
                                                                : std::to_string(event.signal).c_str());
  }
  return {};
}

std::string status_text(const RunStatus& status, bool keys) {
  const std::uint32_t why = status.why & kHoldReasons;
  std::string text = fmt::format("{:8.2f} s  {}", in_s(status.t),
                                 status.halted ? "STOPPED BY HAND"
                                 : why != 0    ? "HOLD: " + why_text(why)
                                               : std::string(mode_name(status.mode)));
  if (keys) text += "  | space stops, r resumes, q ends |";  // first, so that a narrow terminal shows them
  const double force = std::abs(status.force) < 0.005 ? 0.0 : status.force;  // avoids -0.00
  if (std::isfinite(force)) text += fmt::format("  {:.2f} N", force);
  if (std::isfinite(status.gap)) text += fmt::format("  gap {:.2f} mm", 1e3 * status.gap);
  if (const Percentiles of = periods_of(status); !std::isnan(of.most))
    text += std::isnan(of.p99) ? fmt::format("  max {:.2f} ms", 1e-6 * of.most)
                               : fmt::format("  p99 {:.2f} ms", 1e-6 * of.p99);
  text += fmt::format("  missed {}", status.missed);
  return text;
}

Console::Console(RunWatch& watch, std::vector<std::string> objects, std::function<bool()> reads_keys)
    : watch_(watch), objects_(std::move(objects)), reads_keys_(std::move(reads_keys)) {
  thread_ = trial::beside_loop([this](const std::stop_token& stop) { show(stop); });
}

Console::~Console() {
  thread_.request_stop();
  thread_.join();
}

void Console::flush() const noexcept {
  const std::uint64_t begun = rounds_;
  for (int i = 0; i < 100 && rounds_ < begun + 2; ++i) std::this_thread::sleep_for(milliseconds(1));
}

void Console::show(const std::stop_token& stop) {
  int turns = 0;
  for (; !stop.stop_requested(); ++turns) {
    show_events();
    if (error_.terminal() && turns % (kStatusTurn / kTurn) == 0) show_status();
    ++rounds_;
    std::this_thread::sleep_for(kTurn);
  }
  for (auto left = kLast; left > milliseconds(0); left -= kTurn) {
    show_events();
    if (pending_.empty()) break;
    std::this_thread::sleep_for(kTurn);
  }
  if (error_.terminal() && pending_.empty()) error_.write("\r" + std::string(shown_width_, ' ') + "\r");
}

void Console::show_events() {
  constexpr std::size_t kMostPending = 64 * 1024;  // bytes; further text is dropped and counted
  RunEvent event;
  std::string lines;
  while (pending_.size() + lines.size() < kMostPending && watch_.next(event)) {
    const std::string text = fmt::format("{:8.3f} s  {}", in_s(event.t), event_text(event, objects_));
    lines += error_.terminal() ? text + "\n" : stamp() + text + "\n";
  }
  if (const std::size_t dropped = watch_.take_dropped(); dropped > 0)
    lines += fmt::format("{}{} more events came too fast to be shown\n",
                         error_.terminal() ? "" : stamp() + "  ", dropped);
  if (!lines.empty()) {
    pending_ += error_.terminal() ? "\r" + std::string(shown_width_, ' ') + "\r" + lines : lines;
    shown_width_ = 0;
  }
  pending_.erase(0, error_.write(pending_));
}

void Console::show_status() {
  RunStatus status;
  if (!pending_.empty() || !watch_.newest(status)) return;
  std::string text = status_text(status, reads_keys_());
  text.resize(std::min(text.size(), columns() - 1));
  const std::size_t width = text.size();
  text.resize(std::max(width, shown_width_), ' ');
  text.insert(0, 1, '\r');
  pending_ = text.substr(error_.write(text));  // write the rest first, so that no line is cut
  shown_width_ = width;
}

}  // namespace enc::app
