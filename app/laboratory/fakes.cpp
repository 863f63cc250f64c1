#include "app/laboratory/fakes.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <poll.h>

#include "core/base/error.h"
#include "encounter_version.h"
#include "models/schema/wording.h"
#include "models/setup/driver_table.h"
#include "trial/assemble/prepare.h"

namespace enc::app {
namespace {

constexpr Duration kLongest{50'000'000};  // of a turn
constexpr Duration kLate{5'000'000'000};  // what is later is not made up: a device goes on without us

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
    fakes_.push_back(module.driver->fake(
        {table, rig_, setup_.rig, log_, go_on, tools, [this] { begin(); }, options_.seed + fakes_.size()}));
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

// Who comes to tell the machine finds the world as it was at first, so that each run is the same.
void Fakes::begin() {
  ++begun_;
  world_->restore(first_);
  std::erase_if(plans_, [](const Planned& plan) { return plan.by_hand && plan.over; });
  for (Planned& plan : plans_) {
    if (plan.by_hand) {  // it lasts or is still to come, whoever comes
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

Fakes::Planned Fakes::planned(const Fault& fault, const std::string& where) {
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
  for (Planned& plan : plans_)
    if (plan.begun && !plan.over) end(plan);
}

void Fakes::say(const Planned& plan, const char* what) {
  log_.say(fmt::format("{:.3f} s: {} {} {}", seconds(now_.t.time_since_epoch()), plan.fault.driver, what,
                       text_of(plan.fault.trouble)));
}

void Fakes::trouble() {
  for (Planned& plan : plans_) {
    if (!plan.begun && now_.t >= plan.from) {
      plan.begun = true;
      plan.fake->suffer(plan.fault.trouble);
      say(plan, "suffers");
    }
    if (plan.begun && !plan.over && now_.t >= plan.to) end(plan);
  }
}

void Fakes::end(Planned& plan) {
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

}  // namespace enc::app
