#include "tests/conformance/wired_trial.h"

#include <utility>

#include "models/setup/driver_table.h"
#include "trial/prepare.h"

namespace enc::test {
namespace {

// A driver's table with the port of a fake that has taken any.
class Ported final : public Settings {
 public:
  Ported(const models::Setup& setup, const std::string& driver, std::int64_t port, std::int64_t http_port = 0)
      : table_(setup, driver), port_(port), http_port_(http_port) {}
  void value(const Setting& key, double& number) override { table_.value(key, number); }
  void value(const Setting& key, std::int64_t& whole) override {
    table_.value(key, whole);
    if (key.name == "port") whole = port_;
    if (key.name == "http_port") whole = http_port_;
    if (key.name == "command_port") whole = 0;
  }
  void value(const Setting& key, std::string& text) override { table_.value(key, text); }
  void value(const Setting& key, std::vector<double>& numbers) override { table_.value(key, numbers); }

 private:
  models::DriverTableReader table_;
  std::int64_t port_, http_port_;
};

}  // namespace

class WiredTrial::Link final : public gcs::Link {
 public:
  explicit Link(WiredTrial& of) : of_(of) {}
  std::size_t send(std::string_view bytes) noexcept override {
    if (closed()) return 0;
    std::string answers(of_.controller_->take(bytes));
    Spoilt& spoilt = of_.machine;
    if (!spoilt.instead.empty() && !answers.empty()) answers = std::exchange(spoilt.instead, {});
    if (spoilt.half && !answers.empty()) {
      answers.resize(answers.size() / 2);
      spoilt.half = false;
      spoilt.silent = true;
      answers_ += answers;
    } else if (!spoilt.silent) {
      answers_ += answers;
    }
    return bytes.size();
  }
  std::size_t receive(std::span<char> into) noexcept override {
    const std::size_t size = std::min(into.size(), answers_.size());
    std::copy_n(answers_.begin(), size, into.begin());
    answers_.erase(0, size);
    return size;
  }
  [[nodiscard]] bool closed() const noexcept override { return of_.machine.hung_up; }
  void wait(Duration) noexcept override {}
  [[nodiscard]] Duration now() const noexcept override { return of_.now_.time_since_epoch(); }

 private:
  WiredTrial& of_;
  std::string answers_;
};

// The twin's, and what is behind the wires goes on with it.
class WiredTrial::Clock final : public enc::Clock {
 public:
  Clock(WiredTrial& of, std::unique_ptr<enc::Clock> clock) : of_(of), clock_(std::move(clock)) {}
  Tick next() override {
    const Tick tick = clock_->next();
    of_.pass(tick.t);
    return tick;
  }

 private:
  WiredTrial& of_;
  std::unique_ptr<enc::Clock> clock_;
};

WiredTrial::WiredTrial(models::Setup setup, trial::TrialOptions options, Wires wires)
    : setup_(std::move(setup)) {
  for (const auto& [name, declare] :
       {std::pair{"gcs", +[](Settings& table) { gcs::GcsSettings{}.declare(table); }},
        {"netft", +[](Settings& table) { netft::NetftSettings{}.declare(table); }},
        {"igtl", +[](Settings& table) { igtl::IgtlSettings{}.declare(table); }}})
    models::read_driver_table(setup_, name, declare);
  options.drivers = {};
  options.fit_out = [this, wires](Rig& rig) { put(rig, wires); };
  trial_ = std::make_unique<trial::Trial>(setup_, std::move(options));
}

void WiredTrial::put(Rig& rig, const Wires& wires) {
  const Reach reach = reach_of(setup_.rig);
  const auto offer = [&](Settings& table, std::span<const std::string> tools = {}) {
    return Offer{table, setup_.rig, reach, from_seconds(1.0 / setup_.rig.loop.rate),
                 log_,  true,       false, tools};
  };
  if (wires.machine) {
    twin_.manipulator = std::move(rig.manipulator);
    gcs::ControllerSettings settings;
    settings.velocity = reach.speed;
    controller_ = std::make_unique<gcs::Controller>(*twin_.manipulator, settings);
    controller_->cycle(now_);
    models::DriverTableReader table(setup_, "gcs");
    gcs::GcsSettings of;
    of.declare(table);
    auto driver = std::make_unique<gcs::GcsManipulator>(offer(table), of, std::make_unique<Link>(*this),
                                                        gcs::Turns::called);
    driver_ = driver.get();
    rig.manipulator = std::move(driver);
  }
  if (wires.force) {
    twin_.force = std::move(rig.force);
    box_ = std::make_unique<netft::Server>(*twin_.force, netft::gamma(), "127.0.0.1", netft::Ports{});
    const Served served(*box_);
    Ported table(setup_, "netft", box_->port(), box_->http_port());
    rig.force = netft::streaming(offer(table));
  }
  if (wires.tracker) {
    twin_.tracker = std::move(rig.tracker);
    const std::vector<std::string> tools = trial::tool_names(setup_);
    std::vector<std::string> devices;
    for (const std::string& tool : tools) devices.push_back(tool + "ToTracker");
    tools_ = std::make_unique<igtl::ToolServer>(*twin_.tracker, devices, "127.0.0.1", std::uint16_t{0});
    const Served served(*tools_);
    Ported table(setup_, "igtl", tools_->port());
    rig.tracker = igtl::subscribed(offer(table, tools));
  }
  rig.clock = std::make_unique<Clock>(*this, std::move(rig.clock));
}

void WiredTrial::pass(Time now) {
  now_ = now;
  if (controller_) controller_->cycle(now);
  if (box_) box_->serve(now);
  if (box_ && !force_silent) box_->publish(now);
  if (tools_) tools_->serve(now);
  if (tools_ && !tracker_silent) tools_->publish(now);
}

void WiredTrial::loop_stands(Duration longest) {
  for (const Time until = now_ + longest; now_ < until;) {
    now_ += Duration(1'000'000);
    if (driver_ != nullptr) driver_->turn();
    controller_->cycle(now_);
  }
}

}  // namespace enc::test
