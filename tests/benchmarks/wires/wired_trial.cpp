#include "tests/benchmarks/wires/wired_trial.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "hw_drivers/gcs/drive/settings.h"
#include "hw_drivers/igtl/drive/settings.h"
#include "hw_drivers/netft/drive/settings.h"
#include "models/setup/driver_table.h"
#include "trial/assemble/assemble.h"

namespace enc::bench::wires {

Laboratory::Laboratory(models::Setup setup, WireChoice which, std::uint64_t seed)
    : setup_(std::move(setup)), which_(which), wires_(seed) {
  for (const auto& [name, declare] :
       {std::pair{"gcs", +[](Settings& table) { gcs::GcsSettings{}.declare(table); }},
        {"netft", +[](Settings& table) { netft::NetftSettings{}.declare(table); }},
        {"igtl", +[](Settings& table) { igtl::IgtlSettings{}.declare(table); }}})
    models::read_driver_table(setup_, name, declare);
}

trial::TrialOptions Laboratory::behind(trial::TrialOptions options) {
  options.drivers = {};  // the twin fills each role first
  options.fit_out = [this](Rig& rig) {
    models::DriverTableReader gcs(setup_, "gcs"), netft(setup_, "netft"), igtl(setup_, "igtl");
    const std::vector<std::string> tools = trial::tool_names(setup_);
    wires_.fit_out(rig, setup_.rig, {gcs, netft, igtl}, tools, log_, which_);
  };
  return options;
}

PressResult pressed(trial::Trial& trial) {
  constexpr Time kBegun{Duration(10'000'000)};  // the first record exists
  PressResult of;
  while (trial.tick()) {
    const Mode mode = trial.outputs().mode;
    of.peak = std::max(of.peak, trial.truth().contact_force.norm());
    of.height.push_back(trial.truth().tip.xyz[2]);
    if (std::isnan(of.touched) && mode == Mode::contact)
      of.touched = seconds(trial.now().t.time_since_epoch());
    of.held = of.held || (trial.now().t > kBegun && mode == Mode::hold);
  }
  of.contacts = trial.outputs().contacts;
  return of;
}

}  // namespace enc::bench::wires
