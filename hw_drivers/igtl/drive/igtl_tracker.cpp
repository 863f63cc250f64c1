#include "hw_drivers/igtl/drive/udp_tracker.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include "core/error.h"
#include "hw_drivers/net/steady.h"

namespace enc::igtl {
namespace {

constexpr int kMostDatagrams = 64;  // of a poll: a flood does not hold up the loop
constexpr int kMostWaiting = 4096;  // before the first: more than a socket holds

}  // namespace

UdpTracker::UdpTracker(const Offer& offer, const IgtlSettings& settings)
    : settings_(settings),
      reception_(settings, offer.tools, offer.lockstep),
      socket_(net::connect_udp(settings.address, static_cast<std::uint16_t>(settings.port))),
      arrival_(!offer.waits),
      lockstep_(offer.lockstep) {
  constexpr Duration kAgain{50'000'000};  // a datagram may be lost
  const Duration until = net::steady_now() + from_seconds(settings.timeout);
  std::array<std::byte, kMostBytes> bytes{};
  Message answer;
  do {
    if (net::steady_now() > until)
      throw Error(fmt::format("{}: no tool data within {:.0f} ms; see that its server runs, and sends "
                              "OpenIGTLink over UDP to who asks",
                              settings_.place(), 1e3 * settings.timeout),
                  {}, ErrorKind::device);
    ask("STT_TRANS");
    socket_.wait(kAgain);
  } while (read({bytes.data(), socket_.receive(bytes)}, answer) != Wrong::nothing);
}

UdpTracker::~UdpTracker() { ask("STP_TRANS"); }

void UdpTracker::ask(const char* what) noexcept {
  static_cast<void>(socket_.send(Written(what, "Encounter", 0, 0, {}).bytes()));
}

std::string UdpTracker::describe() const { return "tool data of " + settings_.place() + ", answered"; }

bool UdpTracker::poll(Time now, Stamped<TrackedTool>& newest) noexcept {
  const bool first = !polled_;
  if (first) begun_ = now;
  if (polled_ && lockstep_) socket_.wait(from_seconds(settings_.timeout));  // one for each period
  polled_ = true;
  bool news = false;
  static_cast<void>(arrival_.at(now, net::steady_now()));  // how far apart the two clocks are
  std::array<std::byte, kMostBytes> bytes{};
  if (first && !lockstep_)  // what came before the run is old
    for (int i = 0; i < kMostWaiting && socket_.receive(bytes) > 0; ++i) {
    }
  for (int i = 0; i < kMostDatagrams && linked_; ++i) {
    const std::size_t got = socket_.receive(bytes);
    if (got == 0) break;
    news = reception_.take({bytes.data(), got}, arrival_.at(now, net::steady_now()), newest_) || news;
  }
  const Time last = reception_.heard() ? reception_.last() : begun_;
  if (!lockstep_ && age(now, last) > settings_.silent) linked_ = false;
  if (news) newest = newest_;
  if (news)
    newest.t = std::min(newest.t, now);  // in a tick that was held up it may be of after its beginning
  return news;
}

std::vector<std::string> UdpTracker::remarks() const {
  const Counts& counts = reception_.counts();
  return {fmt::format("{}: {} poses, {} datagrams missing, {} old or twice, {} wrong{}{}", describe(),
                      counts.poses, counts.missing, counts.old, counts.wrong,
                      counts.steps > 0 ? fmt::format("; its clock was set back {} times", counts.steps) : "",
                      counts.status > 1 ? fmt::format("; it reported status {}", counts.status) : "")};
}

std::unique_ptr<PoseTracker> subscribed(const Offer& offer) {
  IgtlSettings settings;
  settings.declare(offer.table);
  return std::make_unique<UdpTracker>(offer, settings);
}

}  // namespace enc::igtl
