#include "hw_drivers/igtl/drive/igtl_tracker.h"

#include <algorithm>

#include <fmt/format.h>

#include "core/base/error.h"
#include "core/devices/fake.h"
#include "hw_drivers/net/clocks.h"

namespace enc::igtl {

// ---- the connection

Line::Line(const IgtlSettings& settings)
    : streams_(settings.streams()),
      socket_(streams_ ? net::connect_tcp(settings.address, static_cast<std::uint16_t>(settings.port),
                                          from_seconds(settings.timeout))
                       : net::connect_udp(settings.address, static_cast<std::uint16_t>(settings.port))) {}

std::span<const std::byte> Line::next() noexcept {
  if (!streams_) return std::span(datagram_).first(socket_.receive(datagram_));
  constexpr int kMost = 32;  // chunks of a skipped picture read at once: 2 MiB
  for (int i = 0; i < kMost; ++i) {
    const std::span<const std::byte> message = stream_.next();
    if (!message.empty() || stream_.lost()) return message;
    const std::size_t came = socket_.receive(stream_.room());
    if (came == 0) return {};
    stream_.came(came);
  }
  return stream_.next();
}

void Line::say(const OutgoingMessage& message) noexcept {
  const std::size_t sent = socket_.send(message.bytes());
  stuck_ = stuck_ || (sent > 0 && sent < message.bytes().size());
}

// ---- the device

namespace {

constexpr int kMostMessages = 64;      // per poll: a flood of messages cannot block the loop
constexpr int kMostWaiting = 4096;     // before the run: more than a socket buffer holds
constexpr int kFew = 8;                // a poll with at most this many messages holds no old ones,
constexpr int kSettled = 3;            // after this many such polls in a row the stream is current
constexpr std::int32_t kEachPose = 1;  // ms, the shortest interval that a client can request: every pose

// Describes why the server's data are not a valid message.
const char* fault(MessageFault why) {
  switch (why) {
    case MessageFault::no_checksum:
      return "what it sends has CRC 0; expected the CRC of each message; let the server compute it";
    case MessageFault::checksum:
      return "what it sends has a wrong CRC; expected CRC-64 ECMA-182 of the body; see the server's version";
    case MessageFault::version:
      return "what it sends has a header of another version; expected 1 or 2; see the server's version";
    default:
      return "what it sends is cut or of a wrong size; expected messages of OpenIGTLink; see the server";
  }
}

Error no_answer(const IgtlSettings& settings, const Line& line, MessageFault why) {
  const char* const what =
      why != MessageFault::nothing ? fault(why)
      : line.lost()
          ? "what answers does not speak OpenIGTLink; see that this is the port of the tracker's server"
      : line.closed()      ? "let us in and hung up; see that it takes another client"
      : settings.streams() ? "let us in and said nothing within {:.0f} ms; see that the server runs, and "
                             "that a tool is in view"
                           : "no tool data within {:.0f} ms; see that its server runs, and sends OpenIGTLink "
                             "over UDP to who asks";
  return Error(settings.place() + ": " + fmt::format(fmt::runtime(what), 1e3 * settings.timeout), {},
               ErrorKind::device);
}

}  // namespace

IgtlTracker::IgtlTracker(const Offer& offer, const IgtlSettings& settings)
    : settings_(settings),
      reception_(settings, offer.tools, offer.lockstep),
      line_(settings),
      arrival_(!offer.waits),
      lockstep_(offer.lockstep) {
  if (settings_.streams()) ask();
  first_answer();
}

// Waits for the first message, and for the STATUS that identifies the server. Not every server sends one, so
// the wait for it ends after kStatus.
void IgtlTracker::first_answer() {
  constexpr Duration kAgain{50'000'000};  // a datagram may be lost
  constexpr Duration kStatus{100'000'000};
  bool answered = false;
  MessageFault why = MessageFault::nothing;  // fault of the last message
  for (Duration until = net::steady_now() + from_seconds(settings_.timeout);;) {
    Message answer;
    const std::span<const std::byte> bytes = line_.next();
    if (!bytes.empty()) why = read(bytes, answer);
    const bool came = !bytes.empty() && why == MessageFault::nothing;
    if (came && answer.type.view() == "STATUS") {
      fake_ = answer.device.view() == kFakeName;
      return;
    }
    if (came && !answered) until = net::steady_now() + kStatus;
    answered = answered || came;
    const bool over = line_.lost() || line_.closed() || net::steady_now() > until;
    if (over && answered) return;
    if (over) throw no_answer(settings_, line_, why);
    if (!bytes.empty()) continue;
    if (!settings_.streams() && !answered) ask();
    line_.wait(kAgain);
  }
}

IgtlTracker::~IgtlTracker() {
  if (!settings_.streams()) say("STP_TRANS");
  if (settings_.streams() && settings_.asks_for_tdata()) say("STP_TDATA");
}

void IgtlTracker::say(const char* what, std::span<const std::byte> content) noexcept {
  line_.say(OutgoingMessage(what, "Encounter", 0, 0, content));
}

void IgtlTracker::ask() noexcept {
  if (!settings_.streams()) return say("STT_TRANS");
  if (settings_.asks_for_tdata()) say("STT_TDATA", ask_for_tdata(kEachPose));
  say("GET_STATUS");
}

std::string IgtlTracker::describe() const {
  return (settings_.streams() ? "tracker's server at " : "tool data of ") + settings_.place() + ", answered";
}

bool IgtlTracker::take_next(Time now) noexcept {
  const std::span<const std::byte> message = line_.next();
  if (message.empty()) return false;
  const Time came = arrival_.of(now, line_.came());
  news_ = reception_.take(message, came, newest_) || news_;
  // The silence counts from the time of reading, not of arrival. A delayed tick is then not taken for a
  // silent server.
  if (reception_.heard() && reception_.last() == came) heard_ = arrival_.of(now, net::steady_now());
  return true;
}

// Discards messages from before the run. Lockstep has none, because time advances with the run.
void IgtlTracker::begin_run(Time now) noexcept {
  if (!polled_) begun_ = asked_ = now;
  polled_ = true;
  int count = 0;
  while (!lockstep_ && count < kMostWaiting && !line_.next().empty()) ++count;
  // A stream has settled only after several short polls: messages that the server could not send earlier
  // follow the ones in this buffer.
  settled_ = count <= kFew ? settled_ + 1 : 0;
  begun_run_ = lockstep_ || !settings_.streams() || settled_ >= kSettled;
}

void IgtlTracker::keep_awake(Time now) noexcept {
  const Time last = std::max(asked_, reception_.heard() ? heard_ : begun_);
  if (!settings_.streams() || age(now, last) < 0.25 * settings_.silent) return;
  asked_ = now;
  say("GET_STATUS");
}

bool IgtlTracker::poll(Time now, Measurement<TrackedTool>& newest) noexcept {
  news_ = false;
  const bool first = !polled_;
  arrival_.begin(now, net::steady_now());
  if (!begun_run_) begin_run(now);
  bool came = linked_ && begun_run_ && take_next(now);
  if (!first && lockstep_) {  // one message for each period, in any number of pieces
    const Duration until = net::steady_now() + from_seconds(settings_.timeout);
    while (!came && linked_ && !line_.closed() && !line_.lost() && net::steady_now() < until) {
      line_.wait(until - net::steady_now());
      came = take_next(now);
    }
    linked_ = linked_ && came;
  }
  for (int i = 1; i < kMostMessages && came; ++i) came = take_next(now);
  const Time last = reception_.heard() ? heard_ : begun_;
  if (line_.closed() || line_.lost() || (!lockstep_ && age(now, last) > settings_.silent)) linked_ = false;
  if (linked_ && !lockstep_) keep_awake(now);
  if (!news_) return false;
  newest = newest_;
  newest.t = std::min(newest.t, now);  // the message may be newer than the time of a delayed tick
  return true;
}

std::string IgtlTracker::refused() const {
  const Counts& counts = reception_.counts();
  std::string text;
  const auto add = [&text](std::int64_t count, const char* what, const auto&... more) {
    if (count == 0) return;
    if (!text.empty()) text += "; ";
    text += fmt::format(fmt::runtime(what), count, more...);
  };
  add(counts.checksum, "{} with a wrong CRC{}",
      counts.no_checksum == counts.checksum ? ": 0, the server does not compute it" : "");
  add(counts.unknown, "{} of tools that the scene does not name, such as '{}'; expected {}",
      net::printable(counts.stranger.view()), reception_.expected());
  add(counts.standing, "{} with a stamp that stands still");
  return text;
}

std::vector<std::string> IgtlTracker::remarks() const {
  const Counts& counts = reception_.counts();
  std::string text = fmt::format("{}: {} poses, ", describe(), counts.poses);
  if (!settings_.streams()) text += fmt::format("{} datagrams missing, ", counts.missing);
  text += fmt::format("{} old or twice, {} wrong", counts.old, counts.wrong);
  if (const std::string not_taken = refused(); !not_taken.empty()) text += "; " + not_taken;
  const auto add = [&text](std::int64_t count, const char* what) {
    if (count > 0) text += fmt::format(fmt::runtime(what), count);
  };
  add(counts.repeated, "; {} equal to the bit to the pose before");
  add(counts.unseen, "; {} of tools out of view");
  add(counts.aside, "; {} of tools in view that nobody moved");
  add(line_.skipped(), "; {} too long for tool data");
  add(counts.steps, "; its clock was set back {} times");
  if (line_.lost())
    text += "; then what came was no OpenIGTLink";
  else if (line_.closed())
    text += "; then it hung up";
  if (counts.status > 1) text += fmt::format("; it reported status {}", counts.status);
  if (const std::string clock = net::words(reception_.clock()); !clock.empty()) text += "; " + clock;
  return {text};
}

std::unique_ptr<PoseTracker> subscribed(const Offer& offer) {
  IgtlSettings settings;
  settings.declare(offer.table);
  return std::make_unique<IgtlTracker>(offer, settings);
}

}  // namespace enc::igtl
