#include "app/laboratory/fakes.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <poll.h>
#include <pthread.h>
#include <sched.h>
#include <unistd.h>

#include "app/modules/modules.h"
#include "app/process.h"
#include "core/base/error.h"
#include "core/base/sample.h"
#include "encounter_version.h"
#include "models/schema/wording.h"
#include "models/setup/driver_table.h"
#include "trial/assemble/assemble.h"
#include "trial/assemble/vision.h"
#include "trial/operator/signals.h"
#include "trial/time/real_time.h"

namespace enc::app {

// ---- faults in words

namespace {

enum class Value : std::uint8_t { none, share, time, code };

struct FaultEntry {
  const char* name;
  Trouble::Kind kind;
  Value value;
  double usual;         // value if none is given; unset: the fake's own
  const char* example;  // example of a value
};

constexpr std::array<FaultEntry, 11> kNames{{
    {"loss", Trouble::Kind::loss, Value::share, 1.0, "5%"},
    {"jitter", Trouble::Kind::jitter, Value::time, 0.020, "20ms"},
    {"reorder", Trouble::Kind::reorder, Value::share, 1.0, "30%"},
    {"duplicate", Trouble::Kind::duplicate, Value::share, 1.0, "10%"},
    {"stall", Trouble::Kind::stall, Value::none, 0.0, ""},
    {"disconnect", Trouble::Kind::disconnect, Value::none, 0.0, ""},
    {"garbage", Trouble::Kind::garbage, Value::share, 1.0, "1%"},
    {"half-message", Trouble::Kind::half_message, Value::share, 1.0, "1%"},
    {"saturate", Trouble::Kind::saturate, Value::none, 0.0, ""},
    {"error-code", Trouble::Kind::error_code, Value::code, kUnset, "504 or 0x90000000"},
    {"slow-start", Trouble::Kind::slow_start, Value::time, 2.0, "2s"},
}};

constexpr double kMostTime = 1e6, kMostCode = 4294967295.0;  // s; a status word
constexpr double kMostDecimal = 65535.0;                     // a larger code is shown as a status word

// Splits "20ms" into 20 and "ms"; unset: not a number from 0 on.
double number_of(std::string_view text, std::string_view& unit) {
  double number = kUnset;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  unit = text.substr(static_cast<std::size_t>(end - text.data()));
  return error == std::errc{} && number >= 0.0 ? number : kUnset;  // also refuses NaN
}

double time_of(std::string_view text) {
  std::string_view unit;
  const double number = number_of(text, unit);
  const double time = unit == "s" ? number : unit == "ms" ? 1e-3 * number : kUnset;
  return time <= kMostTime ? time : kUnset;
}

double share_of(std::string_view text) {
  std::string_view unit;
  const double number = number_of(text, unit);
  return unit == "%" && number <= 100.0 ? 0.01 * number : kUnset;
}

// Reads a decimal code, or a hexadecimal one for status words.
double code_of(std::string_view text) {
  if (text.starts_with("0x") || text.starts_with("0X")) {
    std::uint32_t code = 0;
    const auto [end, error] = std::from_chars(text.data() + 2, text.data() + text.size(), code, 16);
    return error == std::errc{} && end == text.data() + text.size() ? code : kUnset;
  }
  std::string_view unit;
  const double number = number_of(text, unit);
  return unit.empty() && number <= kMostCode && std::floor(number) == number ? number : kUnset;
}

const FaultEntry& named(Trouble::Kind kind) {
  return *std::find_if(kNames.begin(), kNames.end(),
                       [kind](const FaultEntry& one) { return one.kind == kind; });
}

// Value of a fault that takes one; unset: the text is not of the right kind.
double value_of(const FaultEntry& fault, std::string_view text) {
  switch (fault.value) {
    case Value::share:
      return share_of(text);
    case Value::time:
      return time_of(text);
    case Value::code:
      return code_of(text);
    default:
      return kUnset;
  }
}

// Cuts the text behind the last `mark`, if there is one.
bool cut(std::string_view& text, char mark, std::string_view& behind) {
  const std::size_t at = text.rfind(mark);
  if (at == std::string_view::npos) return false;
  behind = text.substr(at + 1);
  text = text.substr(0, at);
  return true;
}

}  // namespace

std::string fault_examples() {
  std::string all;
  for (const FaultEntry& one : kNames)
    all += fmt::format("{}{}{}{}", all.empty() ? "" : ", ", one.name, *one.example == '\0' ? "" : "=",
                       one.example);
  return all;
}

std::string text_of(const Trouble& trouble) {
  const FaultEntry& one = named(trouble.kind);
  switch (one.value) {
    case Value::share:
      return fmt::format("{}={:g}%", one.name, 100.0 * trouble.value);
    case Value::time:
      return fmt::format("{}={:g}ms", one.name, 1e3 * trouble.value);
    case Value::code:
      if (std::isnan(trouble.value)) return one.name;
      return trouble.value > kMostDecimal
                 ? fmt::format("{}={:#010x}", one.name, static_cast<std::uint32_t>(trouble.value))
                 : fmt::format("{}={:.0f}", one.name, trouble.value);
    default:
      return one.name;
  }
}

Fault fault_of(const std::string& text, const std::string& where) {
  const auto refuse = [&](const std::string& what) {
    return Error(
        fmt::format("{}: '{}': {}; expected DRIVER:FAULT[=V][@TIME][+TIME], such as "
                    "gcs:stall@3s+500ms, with a fault of {}",
                    where, text, what, fault_examples()));
  };
  Fault fault;
  std::string_view rest = text, time, value;
  if (cut(rest, '+', time)) {
    fault.lasts = time_of(time);
    if (!(fault.lasts > 0.0)) throw refuse(fmt::format("'{}' is no time to last", time));
  }
  if (cut(rest, '@', time)) {
    fault.at = time_of(time);
    if (std::isnan(fault.at)) throw refuse(fmt::format("'{}' is no time", time));
  }
  const bool valued = cut(rest, '=', value);
  std::string_view kind = rest;
  const std::size_t colon = rest.find(':');
  if (colon == std::string_view::npos || colon == 0) throw refuse("no driver is named");
  fault.driver = rest.substr(0, colon);
  kind = rest.substr(colon + 1);
  const auto* const found =
      std::find_if(kNames.begin(), kNames.end(), [kind](const FaultEntry& one) { return one.name == kind; });
  if (found == kNames.end()) throw refuse(fmt::format("there is no fault '{}'", kind));
  fault.trouble = {found->kind, found->usual};
  if (!valued) return fault;
  if (found->value == Value::none) throw refuse(fmt::format("'{}' has no value", kind));
  fault.trouble.value = value_of(*found, value);
  if (std::isnan(fault.trouble.value)) throw refuse(fmt::format("'{}' is no value of '{}'", value, kind));
  return fault;
}

// ---- the fakes

namespace {

constexpr Duration kLongest{50'000'000};  // longest turn
// A longer delay is not made up for: a real device would not wait for us.
constexpr Duration kLate{5'000'000'000};

Duration wall_now() {
  return std::chrono::duration_cast<Duration>(std::chrono::steady_clock::now().time_since_epoch());
}

}  // namespace

Fakes::Fakes(models::Setup setup, FakesOptions options)
    : setup_(std::move(setup)), options_(std::move(options)), scene_(trial::prepare_setup(setup_)) {
  const std::set<std::string> drivers = trial::drivers_used(setup_);
  if (drivers.empty())
    throw Error(setup_.rig_path +
                ": every device that the scene names is simulated, and has no wire; expected a "
                "driver such as \"gcs\"; name another rig");
  trial::read_driver_tables(setup_, [&](const std::string& name) {
    return drivers.contains(name) ? &options_.drivers(name) : nullptr;
  });
  world_ = trial::make_world(setup_, scene_, options_.seed);
  rig_ = world_->rig();
  first_ = world_->save();
  if (setup_.scene.camera && setup_.rig.camera.driver != "sim")
    camera_ = trial::make_drawn_camera(setup_, options_.drivers, *world_, options_.seed, options_.lockstep);
  const std::vector<std::string> tools = trial::tool_names(setup_);
  for (const std::string& name : drivers) {
    const ModuleInfo& module = options_.drivers(name);
    if (module.driver == nullptr || module.driver->fake == nullptr)
      throw Error(
          fmt::format("{}: module '{}' has no fake; leave that role to \"sim\", or name another driver",
                      setup_.rig_path, name),
          {}, ErrorKind::device);
    models::DriverTableReader table(setup_, name);
    const auto go_on =
        options_.lockstep ? std::function<void()>([this] { advance(); }) : std::function<void()>();
    fakes_.push_back(module.driver->fake({table, rig_, setup_.rig, log_, go_on, tools, [this] { begin(); },
                                          options_.seed + fakes_.size(), camera_.get()}));
    names_.push_back(name);
  }
  for (const Fault& fault : options_.faults) plans_.push_back(planned(fault, "--fault"));
  advance();
  due_ = wall_now() + now_.dt;
}

std::vector<std::string> Fakes::describe() const {
  std::vector<std::string> lines{fmt::format("Encounter {}: {}, rig {}, seed {}", ENCOUNTER_VERSION,
                                             setup_.scene_path, setup_.rig_path, options_.seed)};
  for (const auto& fake : fakes_) lines.push_back(fake->describe());
  return lines;
}

// Restores the initial world for a new client of the machine, so that all runs are equal.
void Fakes::begin() {
  ++begun_;
  world_->restore(first_);
  std::erase_if(plans_, [](const FaultPlan& plan) { return plan.by_hand && plan.over; });
  for (FaultPlan& plan : plans_) {
    if (plan.by_hand) {  // a typed fault is not tied to a run: it stays active or scheduled
      plan.from -= now_.t.time_since_epoch();
      if (plan.to != Time::max()) plan.to -= now_.t.time_since_epoch();
      continue;
    }
    if (plan.begun && !plan.over) plan.fake->heal(plan.fault.trouble.kind);
    plan.begun = plan.over = false;
  }
  advance();
  due_ = wall_now() + now_.dt;
}

Fakes::FaultPlan Fakes::planned(const Fault& fault, const std::string& where) {
  const auto refuse = [&](const std::string& what) { return Error(fmt::format("{}: {}", where, what)); };
  const auto name = std::find(names_.begin(), names_.end(), fault.driver);
  if (name == names_.end())
    throw refuse(
        fmt::format("there is no fake of '{}'; {}", fault.driver, models::advice(fault.driver, names_)));
  Fake* const fake = fakes_[static_cast<std::size_t>(name - names_.begin())].get();
  const bool of_wire = fault.trouble.kind != Trouble::Kind::error_code;
  if (!fake->knows(fault.trouble))
    throw refuse(fmt::format("{} knows no '{}'{}", fake->describe(), text_of(fault.trouble),
                             options_.lockstep && of_wire ? "; without --lockstep it may" : ""));
  const Time from(from_seconds(fault.at));
  return {fault, fake, from, std::isnan(fault.lasts) ? Time::max() : from + from_seconds(fault.lasts)};
}

void Fakes::suffer(const Fault& fault, const std::string& where) {
  Fault from_now = fault;
  from_now.at += seconds(now_.t.time_since_epoch());
  plans_.push_back(planned(from_now, where));
  plans_.back().by_hand = true;
  trouble();
}

void Fakes::heal() {
  for (FaultPlan& plan : plans_)
    if (plan.begun && !plan.over) end(plan);
}

void Fakes::say(const FaultPlan& plan, const char* what) {
  log_.say(fmt::format("{:.3f} s: {} {} {}", seconds(now_.t.time_since_epoch()), plan.fault.driver, what,
                       text_of(plan.fault.trouble)));
}

void Fakes::trouble() {
  for (FaultPlan& plan : plans_) {
    if (!plan.begun && now_.t >= plan.from) {
      plan.begun = true;
      plan.fake->suffer(plan.fault.trouble);
      say(plan, "suffers");
    }
    if (plan.begun && !plan.over && now_.t >= plan.to) end(plan);
  }
}

void Fakes::end(FaultPlan& plan) {
  plan.fake->heal(plan.fault.trouble.kind);
  plan.over = true;
  say(plan, "is healed of");
}

void Fakes::advance() {
  now_ = rig_.clock->next();
  trouble();
  for (const auto& fake : fakes_) fake->publish(now_.t);
}

void Fakes::wait(Duration most) {
  std::vector<int> descriptors;
  for (const auto& fake : fakes_) fake->wait_on(descriptors);
  std::vector<pollfd> all;
  all.reserve(descriptors.size());
  for (const int descriptor : descriptors) all.push_back({descriptor, POLLIN, 0});
  const std::int64_t ns = std::clamp<std::int64_t>(most.count(), 0, kLongest.count());
  const timespec time{0, static_cast<long>(ns)};
  static_cast<void>(ppoll(all.data(), all.size(), &time, nullptr));
}

void Fakes::turn() {
  wait(options_.lockstep ? kLongest : due_ - wall_now());
  for (const auto& fake : fakes_) fake->serve(now_.t);
  if (options_.lockstep) return;
  const Duration now = wall_now();
  if (now - due_ > kLate) due_ = now;
  for (; due_ <= now; due_ += now_.dt) advance();
}

// ---- `encounter fake`: the twin answers on the connections of an absent rig

namespace {

// Reads lines of standard input without waiting. A background process of a terminal gets no lines.
class Lines {
 public:
  // Passes each complete line to `take`.
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
    fmt::print(stderr, "encounter: {}\n", models::printable(e.what()));  // the user may type it again
  }
}

// A busy processor delays no device, so the fakes come before other programs, where the system permits it,
// and after a run on the same processor.
void come_before_others() {
  constexpr sched_param kPriority{20};
  static_assert(kPriority.sched_priority < trial::RealTime::kPriority);
  static_cast<void>(pthread_setschedparam(pthread_self(), SCHED_FIFO, &kPriority));
}

}  // namespace

int fake(const LaboratoryOptions& options) {
  trial::Signals signals;
  signals.begin();
  if (!options.lockstep) come_before_others();
  FakesOptions how{load_module, options.seed, options.lockstep, {}};
  for (const std::string& text : options.faults) how.faults.push_back(fault_of(text, "--fault"));
  Fakes fakes(load_setup(with_scene(options)), std::move(how));
  for (const std::string& line : fakes.describe()) fmt::print("{}\n", line);
  for (const std::string& set : options.set) fmt::print("--set {}\n", set);
  fmt::print("{}; ends with SIGINT or SIGTERM\n", options.lockstep
                                                      ? "time goes on by a period with each set-point"
                                                      : "time goes on with the wall clock");
  std::fflush(stdout);  // the calling process waits for these lines
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
