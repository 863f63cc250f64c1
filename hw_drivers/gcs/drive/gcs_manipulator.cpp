#include "hw_drivers/gcs/drive/gcs_manipulator.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <utility>

#include <fmt/format.h>

#include "core/error.h"
#include "hw_drivers/gcs/wire/answer.h"
#include "hw_drivers/gcs/wire/command.h"
#include "hw_drivers/gcs/wire/error_text.h"

namespace enc::gcs {
namespace {

constexpr Duration kAnswer{1'000'000'000};  // to a question before the run: some take the controller longer
constexpr Duration kTurn{1'000'000};        // of the thread, where nothing comes
constexpr Duration kStopTime{100'000'000};

Health worse(Health a, Health b) noexcept {
  if (a == Health::fault || b == Health::fault) return Health::fault;
  return a == Health::out_of_range ? a : b;
}

}  // namespace

GcsManipulator::GcsManipulator(const Offer& offer, const GcsSettings& settings, std::unique_ptr<Link> link)
    : settings_(settings),
      log_(offer.log),
      link_(std::move(link)),
      found_(inspect([this](std::string_view line) { return ask(line); }, settings_, offer.reach)),
      reach_(offer.reach),
      accelerations_(seconds(offer.period), offer.reach.acceleration) {
  constexpr double kCycles = 3.0;  // with fewer it stops at each that is late, and goes on
  if (settings_.watchdog < kCycles * seconds(offer.period) - 1e-9)
    throw Error(
        fmt::format("{}: watchdog_ms is {:g}, and the loop's cycle takes {:g} ms; expected at least "
                    "{:g} of them",
                    settings_.place(), 1e3 * settings_.watchdog, 1e3 * seconds(offer.period), kCycles),
        {}, ErrorKind::device);
  reach_.speed = found_.velocity;
  if (found_.left_over != kNoError)
    log_.say(fmt::format("{}: had {}, before anything was told", describe(), error_words(found_.left_over)));
  report_.X_RH = pose_ = pose_of(found_.at, found_.stand);
  report_.velocity = Vec<'R'>::zero();
  report_.t = link_->now();
  thread_ = std::thread([this] { talk(); });
}

GcsManipulator::~GcsManipulator() {
  if (order_.number > 0) stop();
  end_ = true;
  thread_.join();
}

// Before the thread begins: waits for the answer.
std::string GcsManipulator::ask(std::string_view line) {
  const auto failed = [&](const std::string& what) {
    return Error(fmt::format("{}: {}", settings_.place(), what), {}, ErrorKind::device);
  };
  Text text;
  add_line(text, line);
  std::string_view unsent = text.view();
  AnswerReader reader;
  std::array<char, kMostText> bytes{};
  for (const Duration until = link_->now() + kAnswer; !reader.complete(); link_->wait(kTurn)) {
    unsent.remove_prefix(link_->send(unsent));
    const std::string_view more(bytes.data(), link_->receive(bytes));
    if (reader.take(more) != more.size() || reader.overflown())
      throw failed(fmt::format("said more than an answer to {}; see that it is a C-887", line));
    if (reader.complete()) break;
    if (link_->closed())
      throw failed("closed the connection; close other clients (PIMikroMove) and try again");
    if (link_->now() > until)
      throw failed(fmt::format("no answer to {} within {:.0f} ms; see that it is a C-887, and ready", line,
                               1e3 * seconds(kAnswer)));
  }
  return std::string(reader.answer());
}

std::string GcsManipulator::describe() const {
  return fmt::format("{} at {}, firmware {}, referenced", found_.identity, settings_.place(),
                     found_.firmware.empty() ? "unknown" : found_.firmware);
}

Stamped<TipSample> GcsManipulator::read(Time now) noexcept {
  if (reports_.read(report_) || !read_) {
    // How old it is is taken off once, when it is new; it never is from the time to come.
    const Duration old = std::max(Duration{}, link_->now() - report_.t);
    stamp_ = read_ ? std::max(stamp_, now - old) : now - old;
    read_ = true;
  }
  const Health health = linked() ? worse(health_, report_.health) : Health::fault;
  return {{report_.X_RH, report_.velocity, acceleration_}, stamp_, health};
}

void GcsManipulator::command(const Pose<'R', 'H'>& X_RH) noexcept {
  health_ = Health::fault;  // not a number, or not a rotation: refused, and said
  acceleration_ = Vec<'R'>::zero();
  Coordinates to{};
  if (!X_RH.valid() || !coordinates_of(clamped(reach_, pose_, X_RH), found_.stand, to))
    return accelerations_.stand();
  // Within the struts, and within what the controller takes on each axis.
  const bool beyond = found_.travel.clamp(to);
  health_ = !beyond && reach_.contains(X_RH) ? Health::ok : Health::out_of_range;
  pose_ = pose_of(to, found_.stand);
  acceleration_ = accelerations_.next(pose_.p());
  ++order_.number;
  told_ = true;
  order_.to = to;
  order_.given = link_->now();
  orders_.write(order_);
}

void GcsManipulator::stop() noexcept {
  ++order_.stops;
  order_.stopped = order_.number;
  orders_.write(order_);
  acceleration_ = Vec<'R'>::zero();
  accelerations_.stand();
  for (const Duration until = link_->now() + kStopTime;
       stops_sent_ < order_.stops && linked() && link_->now() < until;)
    std::this_thread::sleep_for(std::chrono::microseconds(100));
}

void GcsManipulator::talk() noexcept {
  Conversation conversation(settings_, found_.stand, found_.at, link_->now());
  Order order;
  std::array<char, kMostText> bytes{};
  std::string_view unsent;
  int said = kNoError;
  while (!end_ && conversation.loss() == Loss::none) {
    // What has come is taken first: after a pause of the process it is no late answer.
    const std::size_t got = link_->receive(bytes);
    if (conversation.take({bytes.data(), got}, link_->now())) publish(conversation, said);
    if (got == 0 && link_->closed()) conversation.closed();
    if (orders_.read(order)) conversation.told(order);
    // Only when all is gone, so that a line is never cut by the next one.
    if (unsent.empty()) unsent = conversation.send(link_->now());
    unsent.remove_prefix(link_->send(unsent));
    if (unsent.empty()) stops_sent_ = conversation.report().stops;
    link_->wait(kTurn);
  }
  // A stop that was asked for while this thread had no turn still goes.
  if (orders_.read(order)) conversation.told(order);
  if (unsent.empty() && conversation.loss() == Loss::none) unsent = conversation.send(link_->now());
  static_cast<void>(link_->send(unsent));
  if (conversation.loss() != Loss::none) lose(conversation.loss());
}

void GcsManipulator::publish(const Conversation& conversation, int& said) noexcept {
  const Report& report = conversation.report();
  reports_.write(report);
  answers_ = conversation.answers();
  watchdogs_ = conversation.watchdogs();
  longest_ = conversation.longest_answer().count();
  const int error = report.health == Health::ok ? kNoError : report.error;
  if (error != kNoError && error != said) log_.say(fmt::format("{} met {}", describe(), error_words(error)));
  if (error != kNoError) said = error;
}

// For good. Where it still hears us it is told to stand.
void GcsManipulator::lose(Loss loss) noexcept {
  static_cast<void>(link_->send(std::string_view(&kStopByte, told_ ? 1 : 0)));
  linked_ = false;
  log_.say(fmt::format("{} lost: {}; see to it, then begin a new run", describe(), words_of(loss)));
}

std::vector<std::string> GcsManipulator::remarks() const {
  std::vector<std::string> lines{fmt::format("{}: {} positions, the longest answer took {:.1f} ms",
                                             describe(), answers_.load(),
                                             1e3 * seconds(Duration(longest_.load())))};
  if (const std::int64_t times = watchdogs_; times > 0)
    lines.push_back(fmt::format("{}: stopped {} times: the loop was silent for {:g} ms", describe(), times,
                                1e3 * settings_.watchdog));
  return lines;
}

}  // namespace enc::gcs
