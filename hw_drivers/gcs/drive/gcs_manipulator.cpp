#include "hw_drivers/gcs/drive/gcs_manipulator.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/driver.h"
#include "hw_drivers/gcs/drive/link.h"
#include "hw_drivers/gcs/wire/error_text.h"
#include "hw_drivers/gcs/wire/text.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/lockstep.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/net/thread_priority.h"

namespace enc::gcs {
namespace {

constexpr Duration kTurn{1'000'000};  // longest wait of the thread for data
constexpr Duration kStopTime{100'000'000};
constexpr Duration kAgain{20'000'000};  // interval between repeated stops after a lost link
constexpr int kStops = 3;

Health worse(Health a, Health b) noexcept {
  if (a == Health::fault || b == Health::fault) return Health::fault;
  return a == Health::out_of_range ? a : b;
}

}  // namespace

GcsManipulator::GcsManipulator(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link,
                               Turns turns)
    : machine_(offer, settings, std::move(link)),
      conversation_(settings, machine_.found().stand, machine_.found().at, machine_.link().now(),
                    machine_.found().velocity) {
  constexpr double kCycles = 3.0;  // fewer cycles would stop the machine at each late cycle
  if (settings.watchdog < kCycles * seconds(offer.period) - 1e-9)
    throw Error(fmt::format("{}: watchdog_ms is {:g}, and the loop's cycle takes {:g} ms; expected at least "
                            "{:g} of them",
                            settings.place(), 1e3 * settings.watchdog, 1e3 * seconds(offer.period), kCycles),
                {}, ErrorKind::device);
  if (offer.rig.force.stale < settings.poll)
    throw Error(
        fmt::format("{}: stale_ms of [force] is {:g}, and poll_ms is {:g}: each position would be lost "
                    "before the next; expected poll_ms and twice the longest answer",
                    settings.place(), 1e3 * offer.rig.force.stale, 1e3 * settings.poll),
        {}, ErrorKind::device);
  if (machine_.found().lockstep)
    throw Error(
        machine_.describe() +
            ": its time goes on with each set-point; begin the fake without --lockstep, or run with it",
        {}, ErrorKind::device);
  report_.X_RH = machine_.at_first();
  report_.velocity = Vec<'R'>::zero();
  report_.t = machine_.link().now();
  if (turns == Turns::thread) thread_ = std::thread([this] { talk(); });
}

GcsManipulator::~GcsManipulator() {
  if (order_.number > 0) stop();
  end_ = true;
  if (thread_.joinable()) thread_.join();
  if (!conversation_.by_points() || !linked_) return;
  Text text;
  add_own_path(text);  // restore the controller's own path
  static_cast<void>(machine_.link().send(text.view()));
}

Measurement<TipSample> GcsManipulator::read(Time now) noexcept {
  tick_ = machine_.link().now();
  if (!thread_.joinable()) turn();
  if (reports_.read(report_) || !read_) {
    // Subtract the report's age once, when the report is new. A report never comes from the future.
    const Duration old = std::max(Duration{}, machine_.link().now() - report_.t);
    stamp_ = read_ ? std::max(stamp_, now - old) : now - old;
    read_ = true;
  }
  const Health health = linked() ? worse(machine_.aim().health, report_.health) : Health::fault;
  return {{report_.X_RH, report_.velocity, machine_.acceleration()}, stamp_, health};
}

void GcsManipulator::command(const Pose<'R', 'H'>& X_RH) noexcept {
  const Aim& aim = machine_.aim(X_RH);
  if (aim.health == Health::fault) return;
  ++order_.number;
  order_.to = aim.to;
  order_.given = tick_;
  orders_.write(order_);
  if (!thread_.joinable()) turn();
}

void GcsManipulator::stop() noexcept {
  ++order_.stops;
  order_.stopped = order_.number;
  orders_.write(order_);
  machine_.stand();
  if (!thread_.joinable()) {
    turn();
    return;
  }
  for (const Duration until = machine_.link().now() + kStopTime;
       stops_sent_ < order_.stops && linked() && machine_.link().now() < until;)
    std::this_thread::sleep_for(std::chrono::microseconds(100));
}

void GcsManipulator::talk() noexcept {
  net::shift_priority(1);  // before the loop, whose watchdog this is: a runaway loop cannot starve it
  while (!end_ && turn()) machine_.link().wait(kTurn);
  if (conversation_.loss() != Loss::none) return;
  // Send a pending stop that this thread has not handled yet.
  if (orders_.read(newest_)) conversation_.told(newest_);
  if (unsent_.empty()) unsent_ = conversation_.send(machine_.link().now());
  static_cast<void>(machine_.link().send(unsent_));
}

bool GcsManipulator::turn() noexcept {
  if (!linked_) return false;
  Link& link = machine_.link();
  // Take received data first, so that a pause of the process does not look like a late answer.
  const std::size_t got = link.receive(bytes_);
  if (conversation_.take({bytes_.data(), got}, link.now())) publish();
  if (got == 0 && link.closed()) conversation_.closed();
  if (orders_.read(newest_)) conversation_.told(newest_);
  // Ask for new data only after all earlier data are sent, so that lines stay whole.
  if (unsent_.empty()) unsent_ = conversation_.send(link.now());
  unsent_.remove_prefix(link.send(unsent_));
  if (unsent_.empty() && conversation_.stopped()) stops_sent_ = conversation_.report().stops;
  if (conversation_.loss() != Loss::none) lose(conversation_.loss(), newest_.number > 0);
  return linked_;
}

void GcsManipulator::publish() noexcept {
  const Report& report = conversation_.report();
  reports_.write(report);
  answers_ = conversation_.answers();
  watchdogs_ = conversation_.watchdogs();
  longest_ = conversation_.longest_answer().count();
  const int error = report.health == Health::ok ? kNoError : report.error;
  if (error != kNoError && error != said_) machine_.say(fmt::format(" met {}", error_words(error)));
  if (error != kNoError) said_ = error;
}

// The link is lost for the rest of the run. While it can still be written to, send stops: first after the
// rest of a cut line, then again, because a set-point that the controller had not read yet may follow the
// first stop.
void GcsManipulator::lose(Loss loss, bool told) noexcept {
  linked_ = false;
  Link& link = machine_.link();
  for (int i = 0; told && i < kStops && !link.closed(); ++i) {
    unsent_.remove_prefix(link.send(unsent_));
    if (unsent_.empty()) static_cast<void>(link.send(std::string_view(&kStopByte, 1)));
    for (const Duration until = link.now() + kAgain; thread_.joinable() && link.now() < until;) {
      link.wait(kTurn);
      while (link.receive(bytes_) > 0) {  // discard earlier answers
      }
      if (link.closed()) break;
    }
  }
  machine_.say(fmt::format(" lost: {}; see to it, then begin a new run", words_of(loss)));
}

std::vector<std::string> GcsManipulator::remarks() const {
  std::vector<std::string> lines{fmt::format("{}: {} positions, the longest answer took {:.1f} ms",
                                             describe(), answers_.load(),
                                             1e3 * seconds(Duration(longest_.load())))};
  if (const std::int64_t times = watchdogs_; times > 0)
    lines.push_back(fmt::format("{}: stopped {} times: the loop was silent for {:g} ms", describe(), times,
                                1e3 * machine_.settings().watchdog));
  return lines;
}

// ---- in lockstep with a fake

LockstepManipulator::LockstepManipulator(const Offer& offer, const GcsSettings& settings,
                                         std::unique_ptr<Link> link)
    : machine_(offer, settings, std::move(link)), period_(seconds(offer.period)) {
  if (!machine_.found().lockstep)
    throw Error(
        machine_.describe() + ": its time goes on by itself; leave out --lockstep, or begin the fake with it",
        {}, ErrorKind::device);
  sample_ = {machine_.at_first(), Vec<'R'>::zero(), Vec<'R'>::zero()};
}

Measurement<TipSample> LockstepManipulator::read(Time now) noexcept {
  send("POS?\n");
  Coordinates at{};
  if (linked_ && !read_axes(hear(), kAxisNames, at)) lose(": no position in time");
  if (linked_) {
    const Pose<'R', 'H'> before = sample_.X_RH;
    sample_.X_RH = pose_of(from_wire_units(at), machine_.found().stand);
    sample_.velocity = Vec<'R'>(Vec3((sample_.X_RH.p() - before.p()) / period_));
    sample_.acceleration = machine_.acceleration();
  }
  const Health health = machine_.aim().health == Health::ok ? said_ : machine_.aim().health;
  return {sample_, now, linked_ ? health : Health::fault};
}

// An invalid pose is not sent. The last aim is sent again instead, so that time advances.
void LockstepManipulator::command(const Pose<'R', 'H'>& X_RH) noexcept {
  Text text;
  if (!add_move(text, machine_.aim(X_RH).to)) return;
  add_line(text, "ERR?");
  told_ = true;
  send(text.view());
  int error = kNoError;
  if (linked_ && !read_error(hear(), error)) lose(": no answer in time");
  said_ = error == kOutOfLimits ? Health::out_of_range : Health::ok;
  if (error != kNoError && error != kOutOfLimits) lose(" met " + error_words(error));
}

void LockstepManipulator::stop() noexcept {
  if (told_) send({&kStopByte, 1});
  machine_.stand();
}

void LockstepManipulator::lose(const std::string& why) noexcept {
  if (linked_) machine_.say(why);
  linked_ = false;
}

void LockstepManipulator::send(std::string_view bytes) noexcept {
  Link& link = machine_.link();
  if (!linked_) return;
  for (const Duration until = link.now() + from_seconds(machine_.settings().timeout); !bytes.empty();) {
    bytes.remove_prefix(link.send(bytes));
    if (!bytes.empty() && (link.closed() || link.now() > until)) return lose(": takes nothing more");
  }
}

std::string_view LockstepManipulator::hear() noexcept {
  Link& link = machine_.link();
  const Duration until = link.now() + from_seconds(machine_.settings().timeout);
  for (reader_.next();;) {
    heard_.remove_prefix(reader_.take(heard_));
    if (reader_.complete()) return reader_.answer();
    if (reader_.overflown() || link.closed() || link.now() > until) return {};
    link.wait(kTurn);
    heard_ = {bytes_.data(), link.receive(bytes_)};
  }
}

// ---- over TCP

namespace {

class NetLink final : public Link {
 public:
  explicit NetLink(net::Socket socket) : socket_(std::move(socket)) {}
  NetLink(const NetLink&) = delete;
  NetLink& operator=(const NetLink&) = delete;
  ~NetLink() override {
    constexpr Duration kRead{200'000'000};
    socket_.finish(kRead);
  }
  std::size_t send(std::string_view bytes) noexcept override {
    return bytes.empty() ? 0 : socket_.send(std::as_bytes(std::span(bytes)));
  }
  std::size_t receive(std::span<char> into) noexcept override {
    return socket_.receive(std::as_writable_bytes(into));
  }
  [[nodiscard]] bool closed() const noexcept override { return socket_.closed(); }
  void wait(Duration most) noexcept override { socket_.wait(most); }
  [[nodiscard]] Duration now() const noexcept override { return net::steady_now(); }

 private:
  net::Socket socket_;
};

}  // namespace

std::unique_ptr<Manipulator> connected(const Offer& offer) {
  constexpr Duration kConnect{2'000'000'000};
  GcsSettings settings;
  settings.declare(offer.table);
  settings.timeout = net::longest_wait(settings.timeout, offer.lockstep);
  net::Socket socket = net::connect_tcp(settings.address, static_cast<std::uint16_t>(settings.port), kConnect,
                                        from_seconds(settings.timeout));
  auto link = std::make_unique<NetLink>(std::move(socket));
  if (offer.lockstep) return std::make_unique<LockstepManipulator>(offer, settings, std::move(link));
  return std::make_unique<GcsManipulator>(offer, settings, std::move(link));
}

}  // namespace enc::gcs
