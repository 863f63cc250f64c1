#include "benchmarks/wires/wired_trial.h"

#include <string>
#include <utility>
#include <vector>

#include "hw_drivers/gcs/drive/settings.h"
#include "hw_drivers/igtl/drive/settings.h"
#include "hw_drivers/netft/drive/settings.h"
#include "models/setup/driver_table.h"
#include "trial/assemble.h"

namespace enc::bench::wires {

Laboratory::Laboratory(models::Setup setup, Which which, std::uint64_t seed)
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

}  // namespace enc::bench::wires
