// The devices of a rig that is not at hand: their wires, answered by the twin.
#include <array>
#include <cstdio>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include "app/laboratory/fakes.h"
#include "app/laboratory/laboratory.h"
#include "app/modules/modules.h"
#include "app/process.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "trial/operator/signals.h"

namespace enc::app {
namespace {

// Lines of standard input, without waiting for one. In the background of a terminal there are none.
class Lines {
 public:
  // Of what has come: each whole line, to `take`.
  template <class Take>
  void read(Take take) {
    pollfd ready{STDIN_FILENO, POLLIN, 0};
    if (over_ || ::poll(&ready, 1, 0) <= 0) return;
    if (isatty(STDIN_FILENO) != 0 && !reads_terminal()) return;
    std::array<char, 512> bytes{};
    const ssize_t got = ::read(STDIN_FILENO, bytes.data(), bytes.size());
    over_ = got <= 0;
    if (over_) return;
    text_.append(bytes.data(), static_cast<std::size_t>(got));
    for (std::size_t end = text_.find('\n'); end != std::string::npos; end = text_.find('\n')) {
      take(text_.substr(0, end));
      text_.erase(0, end + 1);
    }
    if (text_.size() > kLongest) text_.clear();
  }

 private:
  static constexpr std::size_t kLongest = 4096;
  std::string text_;
  bool over_ = false;
};

void by_hand(Fakes& fakes, const std::string& line) {
  try {
    if (line == "heal") return fakes.heal();
    if (line.find_first_not_of(" \t\r") == std::string::npos) return;
    fakes.suffer(fault_of(line, "standard input"), "standard input");
  } catch (const Error& e) {
    fmt::print(stderr, "encounter: {}\n", models::printable(e.what()));  // who types may try again
  }
}

}  // namespace

int fake(const LaboratoryOptions& options) {
  trial::Signals signals;
  signals.begin();
  FakesOptions how{load_module, options.seed, options.lockstep, {}};
  for (const std::string& text : options.faults) how.faults.push_back(fault_of(text, "--fault"));
  Fakes fakes(load_setup(with_scene(options)), std::move(how));
  for (const std::string& line : fakes.describe()) fmt::print("{}\n", line);
  for (const std::string& set : options.set) fmt::print("--set {}\n", set);
  fmt::print("{}; ends with SIGINT or SIGTERM\n", options.lockstep
                                                      ? "time goes on by a period with each set-point"
                                                      : "time goes on with the wall clock");
  std::fflush(stdout);  // whoever began us waits for it
  check_output();
  Lines lines;
  while (trial::Signals::caught() == 0) {
    fakes.turn();
    lines.read([&](const std::string& line) { by_hand(fakes, line); });
  }
  for (const std::string& line : fakes.log()) fmt::print("{}\n", line);
  return 128 + trial::Signals::caught();
}

}  // namespace enc::app
