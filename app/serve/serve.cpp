// Runs a scene in step with another program: it reads a row of the table from standard output and answers
// with a line on standard input, for which the run waits (docs/guide/python.md).
#include "app/serve/serve.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "app/modules/modules.h"
#include "app/process.h"
#include "app/run/run_window.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "models/schema/printable.h"
#include "models/tables/number_text.h"
#include "trial/measure/record_table.h"
#include "trial/operator/operator.h"

namespace enc::app {
namespace {

constexpr const char* kExpected =
    "expected x, y and z of the tool's tip in W, mm, each within 10 m, such as '0 0 40.5', or an empty line";

constexpr double kFarthest = 10.0;  // m, along each axis

// Lines of standard input. Reading waits, but not past a signal.
class Lines {
 public:
  // Unset: the input has ended, or a signal came.
  std::optional<std::string> next() {
    for (;;) {
      const std::size_t end = text_.find('\n');
      if (std::min(end, text_.size()) > kLongest)
        throw Error(place(number_ + 1) + ": longer than 1000 characters; " + kExpected);
      if (end != std::string::npos) {
        std::string line = text_.substr(0, end);
        text_.erase(0, end + 1);
        ++number_;
        if (!line.empty() && line.back() == '\r') line.pop_back();
        return line;
      }
      if (!more()) return std::nullopt;
    }
  }
  [[nodiscard]] static std::string place(std::size_t line) { return fmt::format("standard input:{}", line); }
  [[nodiscard]] std::size_t number() const { return number_; }  // of the last line, from 1

 private:
  bool more() {
    for (pollfd input{STDIN_FILENO, POLLIN, 0}; trial::Signals::caught() == 0;) {
      constexpr int kWait = 50;  // ms until the next look for a signal
      if (::poll(&input, 1, kWait) <= 0) continue;
      std::array<char, 4096> bytes;
      const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
      if (got > 0) text_.append(bytes.data(), static_cast<std::size_t>(got));
      if (got >= 0) return got > 0;
      if (errno != EINTR && errno != EAGAIN)
        throw Error(
            fmt::format("standard input: cannot be read: {}; expected a pipe from the client's program",
                        std::strerror(errno)));
    }
    return false;
  }
  static constexpr std::size_t kLongest = 1000;
  std::string text_;
  std::size_t number_ = 0;
};

// The place in a client's line; unset: none.
std::optional<Point<'W'>> place_in(std::string_view line, std::size_t number) {
  const auto refuse = [&] {
    throw Error(
        fmt::format("{}: '{}'; {}", Lines::place(number), models::printable(std::string(line)), kExpected));
  };
  Vec3 place;
  int count = 0;
  for (std::string_view rest = line;;) {
    rest.remove_prefix(std::min(rest.find_first_not_of(" \t"), rest.size()));
    if (rest.empty()) break;
    const std::string_view word = rest.substr(0, rest.find_first_of(" \t"));
    rest.remove_prefix(word.size());
    const double x = models::number_in<double>(word).value_or(kUnset) / kMmPerM;
    if (!(std::abs(x) <= kFarthest) || count == 3) refuse();
    place[count++] = x;
  }
  if (count == 0) return std::nullopt;
  if (count != 3) refuse();
  return Point<'W'>(place);
}

// The client between two ticks.
class Client {
 public:
  explicit Client(double every) : every_(every) {}

  void begin(const trial::Trial& trial) {
    table_.emplace(trial.setup(), trial.scene());
    send(trial::RecordTable::header_with_truth());
    each_ = every_ > 0.0 ? std::max<std::int64_t>(std::llround(every_ * trial.setup().rig.loop.rate), 1) : 1;
  }
  // A client's mistake, or its death, ends the run, so that the record is sealed and keeps its places.
  void see(const trial::Glance& glance) {
    try {
      if (!ended_) exchange(glance);
    } catch (const Error&) {
      failure_ = std::current_exception();
      ended_ = true;
    }
  }
  void end() { std::fputs("\n", stdout); }  // the report follows
  [[nodiscard]] bool ended() const { return ended_; }
  // Throws what ended the run too early.
  void check() const {
    if (failure_) std::rethrow_exception(failure_);
  }
  std::optional<trial::HandWord> take() {
    if (!place_) return std::nullopt;
    trial::HandWord word;
    word.place = *std::exchange(place_, std::nullopt);
    return word;
  }

 private:
  void exchange(const trial::Glance& glance) {
    // The table sees each tick, because a pose of the tracker stands in the row of its arrival alone.
    const std::string row = table_->row(glance.tick, glance.in, glance.out);
    if (glance.tick.index % each_ != 0) return;
    send(trial::RecordTable::with_truth(row, glance.truth));
    const std::optional<std::string> line = lines_.next();
    ended_ = !line;
    if (line) place_ = place_in(*line, lines_.number());
  }
  static void send(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
      fail_output();
  }
  double every_;           // s
  std::int64_t each_ = 1;  // ticks between two rows
  std::optional<trial::RecordTable> table_;
  Lines lines_;
  std::optional<Point<'W'>> place_;
  bool ended_ = false;
  std::exception_ptr failure_;
};

void refuse(const models::Setup& setup, const std::string& scene) {
  if (trial::keeps_wall_time(setup, load_module))
    throw Error(scene +
                ": a device of this rig is real and does not wait for a client; expected simulated devices; "
                "choose another --rig");
  if (!setup.scene.user) throw Error(scene + ": has no simulated hand; expected a scene with [user]");
}

}  // namespace

int serve(const ServeOptions& options) {
  if (reads_terminal())
    throw Error(
        "standard input is a terminal; expected a pipe from the client's program (docs/guide/python.md)");
  if (!(options.every >= 0.0 && options.every < 1e3))
    throw Error("--every-ms: expected 0 or more, below a million");
  Client client(options.every);
  RunWindow hooks;
  hooks.draws = false;
  hooks.adapts = [&](const models::Setup& setup) { refuse(setup, options.scene); };
  hooks.begins = [&](const trial::Trial& trial) { client.begin(trial); };
  hooks.ends = [&] { client.end(); };
  hooks.watch = [&](const trial::Glance& glance) { client.see(glance); };
  hooks.stop = [&] { return client.ended(); };
  hooks.steer = [&](std::int64_t) { return client.take(); };
  ServeOptions reported = options;
  reported.json = true;
  const int code = run(reported, &hooks);
  client.check();
  return code;
}

}  // namespace enc::app
