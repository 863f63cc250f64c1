#include "hw_drivers/wires/wires.h"

#include <atomic>
#include <string_view>
#include <thread>
#include <utility>

#include "core/control/scene/scene.h"
#include "hw_drivers/igtl/drive/igtl_tracker.h"
#include "hw_drivers/netft/drive/netft_sensor.h"
#include "hw_drivers/wires/string_link.h"

namespace enc::wires {
namespace {

// A driver's settings with the actual ports of a fake.
class PortSettings final : public Settings {
 public:
  PortSettings(Settings& table, std::int64_t port, std::int64_t http_port = 0)
      : table_(table), port_(port), http_port_(http_port) {}
  void value(const Setting& key, double& number) override { table_.value(key, number); }
  void value(const Setting& key, std::int64_t& whole) override {
    table_.value(key, whole);
    if (key.name == "port") whole = port_;
    if (key.name == "http_port") whole = http_port_;
    if (key.name == "command_port") whole = 0;
  }
  void value(const Setting& key, std::string& text) override {
    table_.value(key, text);
    if (key.name == "address") text = "127.0.0.1";
  }
  void value(const Setting& key, std::vector<double>& numbers) override { table_.value(key, numbers); }

 private:
  Settings& table_;
  std::int64_t port_, http_port_;
};

// Answers a driver's queries during its construction. Time does not advance.
class AnswerThread {
 public:
  explicit AnswerThread(Fake& fake)
      : thread_([this, &fake] {
          while (!end_) {
            fake.serve(Time{});
            std::this_thread::sleep_for(std::chrono::microseconds(200));
          }
        }) {}
  ~AnswerThread() { end_ = true; }
  AnswerThread(const AnswerThread&) = delete;
  AnswerThread& operator=(const AnswerThread&) = delete;

 private:
  std::atomic<bool> end_ = false;
  std::jthread thread_;
};

}  // namespace

class Wires::Link final : public StringLink {
 public:
  explicit Link(Wires& of) : of_(of) {}
  std::size_t send(std::string_view bytes) noexcept override {
    if (closed()) return 0;
    if (of_.machine.cut) return bytes.size();  // the data stay in a buffer on this side
    std::string answers(of_.controller_->take(bytes));
    WireFaults& spoilt = of_.machine;
    if (!spoilt.instead.empty() && !answers.empty()) answers = std::exchange(spoilt.instead, {});
    if (spoilt.half && !answers.empty()) {
      answers.resize(answers.size() / 2);
      spoilt.half = false;
      spoilt.silent = true;
      hear(answers);
    } else if (!spoilt.silent) {
      hear(answers);
    }
    return bytes.size();
  }
  [[nodiscard]] bool closed() const noexcept override { return of_.machine.hung_up; }
  void wait(Duration) noexcept override {}
  [[nodiscard]] Duration now() const noexcept override { return of_.now_.time_since_epoch(); }

 private:
  Wires& of_;
};

// The rig's clock, which also advances the devices behind the fakes.
class Wires::Clock final : public enc::Clock {
 public:
  Clock(Wires& of, std::unique_ptr<enc::Clock> clock) : of_(of), clock_(std::move(clock)) {}
  Tick next() override {
    missed_ = 0;
    Tick tick = clock_->next();
    of_.pass(tick.t);
    for (const Time until = tick.t + std::exchange(of_.standing_, {}); tick.t < until; ++missed_) {
      if (of_.driver_ != nullptr && !of_.process_stands_) static_cast<void>(of_.driver_->turn());
      tick = clock_->next();
      of_.pass(tick.t);
    }
    return tick;
  }
  [[nodiscard]] std::int64_t missed() const noexcept override { return missed_; }

 private:
  Wires& of_;
  std::unique_ptr<enc::Clock> clock_;
  std::int64_t missed_ = 0;
};

Wires::~Wires() = default;

void Wires::put_machine(Rig& rig, const Offer& offer, Settings& table) {
  twin_.manipulator = std::move(rig.manipulator);
  gcs::ControllerSettings controller;
  controller.velocity = offer.reach.speed;
  controller_ = std::make_unique<gcs::Controller>(*twin_.manipulator, controller);
  controller_->cycle(now_);
  gcs::GcsSettings settings;
  settings.declare(table);
  auto driver = std::make_unique<gcs::GcsManipulator>(offer, settings, std::make_unique<Link>(*this),
                                                      gcs::Turns::called);
  driver_ = driver.get();
  rig.manipulator = std::move(driver);
}

void Wires::serve_tools(Rig& rig, Settings& table, std::span<const std::string> tools) {
  twin_.tracker = std::move(rig.tracker);
  igtl::IgtlSettings settings;
  settings.declare(table);
  std::vector<std::string> devices;
  for (const std::string& tool : tools) devices.push_back(tool + settings.suffix);
  igtl::ToolServerSettings server;
  server.transport = settings.streams() ? igtl::Transport::tcp : igtl::Transport::udp;
  server.seed = seed_ + 1;
  tools_ = std::make_unique<igtl::ToolServer>(*twin_.tracker, devices, server);
}

void Wires::fit_out(Rig& rig, const RigSpec& spec, const Tables& tables, std::span<const std::string> tools,
                    Log& log, WireChoice which) {
  const Reach reach = reach_of(spec);
  const auto offer = [&](Settings& table) {
    return Offer{table, spec, reach, from_seconds(1.0 / spec.loop.rate), log, true, false, tools};
  };
  if (which.machine && rig.manipulator) put_machine(rig, offer(tables.gcs), tables.gcs);
  if (which.force && rig.force) {
    twin_.force = std::move(rig.force);
    box_ = std::make_unique<netft::Server>(*twin_.force, netft::gamma(), "127.0.0.1", netft::Ports{}, seed_);
    const AnswerThread answering(*box_);
    PortSettings table(tables.netft, box_->port(), box_->http_port());
    rig.force = netft::streaming(offer(table));
  }
  if (which.tracker && rig.tracker) {
    serve_tools(rig, tables.igtl, tools);
    const AnswerThread answering(*tools_);
    PortSettings table(tables.igtl, tools_->port());
    rig.tracker = igtl::subscribed(offer(table));
  }
  rig.clock = std::make_unique<Clock>(*this, std::move(rig.clock));
}

void Wires::pass(Time now) {
  now_ = now;
  if (controller_) controller_->cycle(now);
  for (Fake* const fake : {static_cast<Fake*>(box_.get()), static_cast<Fake*>(tools_.get())}) {
    if (fake == nullptr) continue;
    fake->serve(now);
    fake->publish(now);
  }
}

}  // namespace enc::wires
