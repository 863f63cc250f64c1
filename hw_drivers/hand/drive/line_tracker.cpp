#include "hw_drivers/hand/drive/line_tracker.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"

namespace enc::hand {
namespace {

constexpr int kMostReads = 64;  // per poll: a flood of lines cannot block the loop

net::Socket socket_for(const HandSettings& settings) {
  const auto port = static_cast<std::uint16_t>(settings.port);
  return settings.streams() ? net::connect_tcp(settings.address, port, from_seconds(settings.timeout))
                            : net::bind_udp(settings.address, port);
}

}  // namespace

LineTracker::LineTracker(const Offer& offer, const HandSettings& settings)
    : settings_(settings),
      socket_(socket_for(settings)),
      reception_(settings),
      arrival_(!offer.waits),
      lockstep_(offer.lockstep) {
  if (lockstep_) return;  // the time of a fake stands until the run begins
  first_hand();
  // The time of what came before the run is not the run's.
  fake_ = reception_.fake();
  reception_ = Reception(settings_);
  newest_ = {};
}

void LineTracker::first_hand() {
  constexpr Duration kTurn{50'000'000};
  for (const Duration until = net::steady_now() + from_seconds(settings_.timeout);;) {
    if (take_all({})) return;
    const bool over = settings_.streams() && socket_.closed();
    if (!over && net::steady_now() < until) {
      socket_.wait(kTurn);
      continue;
    }
    const Counts& counts = reception_.counts();
    throw Error(
        fmt::format("{}: {} within {:.0f} ms; see that the headset streams {}, and that the {} hand is in "
                    "its view",
                    settings_.place(),
                    over               ? "it hung up, without a hand"
                    : counts.wrong > 0 ? fmt::format("{} lines that are no hands, and no hand", counts.wrong)
                    : counts.other > 0 ? "only the other hand came"
                    : counts.alone > 0 ? "a wrist or landmarks alone came"
                                       : std::string("no line"),
                    1e3 * settings_.timeout, settings_.streams() ? "over TCP" : "over UDP to this PC",
                    settings_.side),
        {}, ErrorKind::device);
  }
}

std::string LineTracker::describe() const {
  return fmt::format("{} hand {} {}, answered", settings_.side,
                     settings_.streams() ? "of the headset at" : "sent by a headset to", settings_.place());
}

bool LineTracker::take_lines(Time came) noexcept {
  bool news = false;
  for (auto line = lines_.next(); line; line = lines_.next())
    news = reception_.take(*line, came, newest_) || news;
  return news;
}

bool LineTracker::take_all(Time now) noexcept {
  bool news = false;
  for (int i = 0; i < kMostReads; ++i) {
    if (settings_.streams()) {
      const std::size_t got = socket_.receive(lines_.room());
      if (got == 0) break;
      lines_.came(got);
    } else {
      // The last line of a datagram may have no line feed.
      const std::span<std::byte> room = lines_.room();
      std::size_t got = socket_.receive(room.first(room.size() - 1));
      if (got == 0) break;
      // A datagram that fills the room was cut, perhaps within a number: it counts as one wrong line.
      if (got == room.size() - 1) room[0] = std::byte{'?'}, got = 1;
      room[got] = std::byte{'\n'};
      lines_.came(got + 1);
    }
    news = take_lines(polled_ ? arrival_.of(now, socket_.came()) : Time(socket_.came())) || news;
  }
  return news;
}

bool LineTracker::poll(Time now, Measurement<HandSample>& newest) noexcept {
  arrival_.begin(now, net::steady_now());
  if (!polled_) {
    heard_ = now;
    // Discard what came before the run.
    for (int i = 0; !lockstep_ && i < kMostReads && socket_.receive(lines_.room()) > 0; ++i) {
    }
  }
  polled_ = true;
  const bool news = take_all(now);
  if (news) heard_ = now;
  const bool silent = !lockstep_ && age(now, heard_) > settings_.silent;
  const bool linked = !silent && !(settings_.streams() && socket_.closed());
  losses_ += linked_ && !linked ? 1 : 0;
  linked_ = linked;
  if (!news) return false;
  newest = newest_;
  newest.t = std::min(newest.t, now);
  return true;
}

std::vector<std::string> LineTracker::remarks() const {
  const Counts& counts = reception_.counts();
  std::string text = fmt::format("{}: {} hands, {} frames missing, {} old or twice, {} wrong", describe(),
                                 counts.hands, counts.missing, counts.old, counts.wrong + lines_.skipped());
  const auto add = [&text](std::int64_t count, const char* what) {
    if (count > 0) text += fmt::format(fmt::runtime(what), count);
  };
  add(counts.other, "; {} lines of the other hand and the head");
  add(counts.alone, "; {} wrists or landmarks alone");
  add(counts.steps, "; its clock was set back {} times");
  add(losses_, "; silent {} times");
  if (const std::string clock = net::words(reception_.clock()); !clock.empty()) text += "; " + clock;
  return {text};
}

std::unique_ptr<HandTracker> listening(const Offer& offer) {
  HandSettings settings;
  settings.declare(offer.table);
  return std::make_unique<LineTracker>(offer, settings);
}

}  // namespace enc::hand
