#include "hw_drivers/netft/drive/netft_sensor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "core/base/error.h"
#include "hw_drivers/net/clocks.h"
#include "hw_drivers/net/socket.h"
#include "hw_drivers/netft/wire/messages.h"
#include "hw_drivers/netft/wire/page.h"

namespace enc::netft {

// ---- the inspection of a box

namespace {

[[noreturn]] void refuse(const std::string& words) { throw Error(words, {}, ErrorKind::device); }

}  // namespace

std::string fetch(const NetftSettings& settings, const std::string& path) {
  const auto port = static_cast<std::uint16_t>(settings.http_port);
  const std::string page = "http://" + net::place(settings.address, port) + path;
  constexpr Duration kTurn{10'000'000};
  const Duration timeout = from_seconds(settings.timeout);
  net::Socket socket = net::connect_tcp(settings.address, port, timeout);
  const std::string request = http_request(net::place(settings.address, port), path);
  std::span<const std::byte> unsent = std::as_bytes(std::span(request));
  std::array<char, 4096> bytes{};
  HttpAnswer answer;
  for (const Duration until = net::steady_now() + timeout; !answer.complete();) {
    if (!unsent.empty()) unsent = unsent.subspan(socket.send(unsent));
    socket.wait(kTurn);
    const std::size_t got = socket.receive(std::as_writable_bytes(std::span(bytes)));
    answer.take({bytes.data(), got});
    if (got == 0 && socket.closed()) answer.closed();
    if (!answer.complete() && net::steady_now() > until)
      refuse(fmt::format("{}: no whole answer within {:.0f} ms; see that it is a Net F/T, and ready", page,
                         1e3 * settings.timeout));
  }
  if (!answer.wrong().empty())
    refuse(fmt::format("{} {}; see that it is a Net F/T, and driver.netft.http_port", page, answer.wrong()));
  return std::string(answer.body());
}

std::vector<std::byte> ask_calibration(const NetftSettings& settings) {
  const Duration timeout = from_seconds(settings.timeout);
  net::Socket socket;
  try {
    socket = net::connect_tcp(settings.address, static_cast<std::uint16_t>(settings.command_port), timeout);
  } catch (const Error&) {
    return {};
  }
  const auto question = bytes_of(Ask{.question = Question::calibration});
  std::vector<std::byte> answer;
  std::size_t sent = 0;
  for (const Duration until = net::steady_now() + timeout; answer.size() < kCalibrationSize;) {
    sent += socket.send(std::span(question).subspan(sent));
    constexpr Duration kTurn{10'000'000};
    socket.wait(kTurn);
    std::array<std::byte, kCalibrationSize> bytes{};
    const std::size_t got = socket.receive(std::span(bytes).first(kCalibrationSize - answer.size()));
    answer.insert(answer.end(), bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(got));
    if ((got == 0 && socket.closed()) || net::steady_now() > until)
      refuse(fmt::format(
          "{}: its command interface takes READCALINFO and says nothing; see driver.netft.command_port "
          "(0: not asked)",
          net::place(settings.address, static_cast<std::uint16_t>(settings.command_port))));
  }
  return answer;
}

void agree(std::span<const std::byte> answer, const Configuration& page, const NetftSettings& settings) {
  Calibration says;
  const auto same = [](double a, double b) { return std::abs(a - b) <= 1e-6 * b; };  // NaN equals nothing
  if (read(answer, says) && same(says.per_force / force_of_code(says.force_unit), page.per_newton) &&
      same(says.per_torque / torque_of_code(says.torque_unit), page.per_newton_metre))
    return;
  refuse(fmt::format(
      "{}: its page says {:g} counts for a newton and {:g} for a newton metre, its command interface {} for "
      "unit {} and {} for unit {}; save its page Configurations again, and switch it off and on",
      settings.place(), page.per_newton, page.per_newton_metre, says.per_force, says.force_unit,
      says.per_torque, says.torque_unit));
}

Configuration inspect(const std::string& xml, const NetftSettings& settings, Duration period) {
  Configuration found;
  const std::string place = settings.place();
  if (const std::string wrong = read_xml(xml, found); !wrong.empty())
    refuse(fmt::format("{}: its netftapi2.xml {}; see that it is a Net F/T", place, net::printable(wrong)));
  if (found.product.find(settings.product) == std::string::npos)
    refuse(
        fmt::format("{} is another device: it says '{}', expected '{}'; correct driver.netft.address or "
                    "driver.netft.product",
                    place, net::printable(found.product), settings.product));
  if (found.turned)
    refuse(
        fmt::format("{} turns or moves its axes itself (tool transform, cfgtfx); set it to 0 on its page "
                    "Configurations: where the sensor stands is the rig's to say (frames.H_F)",
                    place));
  if (!found.streams)
    refuse(
        fmt::format("{} sends no records: RDT is switched off; enable it on its page Communications", place));
  const double needed = 1.0 / seconds(period);
  if (!(found.rate >= needed * (1 - 1e-9)))
    refuse(fmt::format(
        "{} sends {:g} records a second, and the loop makes {:g}; set the RDT output rate to {:g} Hz or "
        "more on its page Communications",
        place, found.rate, needed, needed));
  for (std::size_t i = 0; i < 6; ++i) {
    const bool force = i < 3;
    const double least = force ? settings.range : settings.torque_range;
    if (found.ratings[i] >= least * (1 - 1e-9)) continue;
    constexpr std::array<const char*, kAxes> kNames{"Fx", "Fy", "Fz", "Tx", "Ty", "Tz"};
    refuse(fmt::format(
        "{} can do less than the rig file promises: {} to {:g} of {:g} {}; choose another configuration "
        "on its page, or lower driver.netft.{}",
        place, kNames[i], found.ratings[i], least, force ? "N" : "N m",
        force ? "range_N" : "torque_range_Nm"));
  }
  return found;
}

// ---- the device

namespace {

constexpr int kMostRecords = 4096;  // per read: more than a socket buffer holds

}  // namespace

NetftSensor::NetftSensor(const Offer& offer, const NetftSettings& settings)
    : settings_(settings),
      found_(inspect(fetch(settings, "/netftapi2.xml"), settings, offer.period)),
      session_(found_, from_seconds(settings.least_delay), offer.lockstep),
      socket_(net::connect_udp(settings.address, static_cast<std::uint16_t>(settings.port))),
      arrival_(!offer.waits),
      period_(offer.period),
      lockstep_(offer.lockstep),
      wall_clock_(!offer.lockstep && !offer.waits) {
  if (settings_.command_port != 0)
    if (const std::vector<std::byte> answer = ask_calibration(settings_); !answer.empty()) {
      agree(answer, found_, settings_);
      agreed_ = true;
    }
  first_record();
  if (wall_clock_) find_counter_rate();
  if (!lockstep_) ask(Command::stop);  // until the run begins; records before it are discarded
}

NetftSensor::~NetftSensor() { ask(Command::stop); }

void NetftSensor::first_record() {
  constexpr Duration kAgain{50'000'000};  // a datagram may be lost
  for (const Duration until = net::steady_now() + from_seconds(settings_.timeout);;) {
    ask(Command::start);
    socket_.wait(kAgain);
    Record record;
    if (receive() && netft::read(std::span(datagram_).first(size_), record)) return;
    if (net::steady_now() > until)
      throw Error(
          fmt::format("{}: its page answers, and no record comes within {:.0f} ms; see that UDP passes the "
                      "network, and driver.netft.port",
                      settings_.place(), 1e3 * settings_.timeout),
          {}, ErrorKind::device);
  }
}

// Watches records until the rate is known. Only called on the wall clock, since other runs use our fake with
// its known rate.
void NetftSensor::find_counter_rate() {
  constexpr double kLeast = 0.4, kMost = 3.0;  // s
  constexpr Duration kTurn{10'000'000};
  CounterRate rate(settings_.counter);
  double watched = 0.0;  // s, when the rate was last checked
  for (const Duration until = net::steady_now() + from_seconds(kMost); net::steady_now() < until;) {
    socket_.wait(kTurn);
    for (Record record; receive();)
      if (netft::read(std::span(datagram_).first(size_), record)) rate.take(record.sample, socket_.came());
    if (rate.watched() < watched + kLeast) continue;
    watched = rate.watched();
    if (std::isnan(rate.known())) continue;
    counter_rate_ = rate.known();
    session_ = Session(found_, from_seconds(settings_.least_delay), lockstep_, counter_rate_);
    return;
  }
  throw Error(fmt::format("{}: its counter runs at {}/s, not {}; expected the rate of a box that is known; "
                          "set driver.netft.counter_Hz to the sampling rate of this box",
                          settings_.place(), grouped(rate.measured()), grouped(rate.expected())),
              {}, ErrorKind::device);
}

void NetftSensor::ask(Command command) noexcept {
  static_cast<void>(socket_.send(bytes_of(Request{command})));
}

bool NetftSensor::receive() noexcept {
  size_ = socket_.receive(datagram_);
  return size_ > 0;
}

std::string NetftSensor::describe() const {
  std::string text = fmt::format("{} at {}, configuration '{}', {:g} records a second, answered{}",
                                 found_.product, settings_.place(), found_.name, found_.rate,
                                 agreed_ ? ", its command interface agrees" : "");
  if (counter_rate_ != kNetBoxRate) text += fmt::format(", its counter runs at {}/s", grouped(counter_rate_));
  return text;
}

Measurement<Wrench> NetftSensor::read(Time now) noexcept {
  const bool first = !reading_;
  reading_ = true;
  arrival_.begin(now, net::steady_now());
  if (first) begun_ = now;
  if (first && lockstep_) session_.take(std::span(datagram_).first(size_), now);
  if (first && !lockstep_) {
    while (receive()) {  // discard old records
    }
    ask(Command::start);
    // Only the first read waits. The machine has not moved yet, and without a record the first tick would
    // hold.
    socket_.wait(period_);
  }
  if (!first && lockstep_) socket_.wait(from_seconds(settings_.timeout));  // one record for each period
  const std::int64_t before = session_.counts().records;
  for (int i = 0; i < kMostRecords && linked_ && receive(); ++i)
    session_.take(std::span(datagram_).first(size_), arrival_.of(now, socket_.came()));
  // The silence counts from the time of reading, not of arrival. Records lost in a full socket during a
  // delayed tick are not silence.
  if (session_.counts().records > before) heard_ = arrival_.of(now, net::steady_now());
  Measurement<Wrench> newest = session_.newest();
  newest.t = std::min(newest.t, now);  // the record may be newer than the time of a delayed tick
  if (linked_) read_ = now;            // after a lost link, the silence no longer grows
  if (silence() > settings_.silent + 1e-9) linked_ = false;
  if (!linked_) newest.health = Health::fault;
  return newest;
}

double NetftSensor::silence() const noexcept {
  if (lockstep_ || !reading_) return 0.0;
  return age(read_, session_.newest().health == Health::absent ? begun_ : heard_);
}

std::vector<std::string> NetftSensor::remarks() const {
  const Counts& counts = session_.counts();
  std::string line =
      fmt::format("{}: {} records, {} missing, {} old or twice, {} wrong; longest without one {:.1f} ms",
                  describe(), counts.records, counts.missing, counts.old, counts.wrong,
                  1e3 * std::max(counts.longest_gap, silence()));
  if (counts.beyond > 0) line += fmt::format("; {} beyond the rating of an axis (cfgmr)", counts.beyond);
  if (counts.status != 0) line += "; " + status_words(counts.status);
  // Two quartz clocks differ by a tenth of this share of the rate.
  constexpr double kRight = 1e-3;
  const double counted = wall_clock_ ? session_.counted() : kUnset;
  if (std::abs(counted - counter_rate_) > kRight * counter_rate_)
    line += fmt::format(
        "; its counter ran at {:.1f}/s, not {:.1f}: with each second its records seem {:.1f} ms {}; "
        "set driver.netft.counter_Hz to its sampling rate",
        counted, counter_rate_, 1e3 * std::abs(counted / counter_rate_ - 1.0),
        counted < counter_rate_ ? "older" : "younger");
  if (const std::string clock = net::words(session_.clock()); !clock.empty()) line += "; " + clock;
  return {line};
}

std::unique_ptr<ForceSensor> streaming(const Offer& offer) {
  NetftSettings settings;
  settings.declare(offer.table);
  return std::make_unique<NetftSensor>(offer, settings);
}

}  // namespace enc::netft
