#include "app/modules/driver_names.h"

#include <algorithm>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "app/modules/modules.h"
#include "core/base/error.h"
#include "models/schema/wording.h"
#include "trial/assemble/assemble.h"

namespace enc::app {
namespace {

std::string all_quoted(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + models::quoted(name);
  return list;
}

bool fills(const std::string& driver, const trial::DrivenRole& role) {
  const ModuleInfo& module = load_module(driver);
  return module.driver != nullptr && role.filled_by(*module.driver);
}

// Of those that are there; one that cannot be loaded fills nothing.
std::vector<std::string> who_fill(const trial::DrivenRole& role, const std::vector<std::string>& there) {
  std::vector<std::string> names{"sim"};
  for (const std::string& driver : there) {
    try {
      if (fills(driver, role)) names.push_back(driver);
    } catch (const Error&) {
    }
  }
  return names;
}

std::string unknown(const std::string& driver, std::vector<std::string> there) {
  there.insert(there.begin(), "sim");
  const std::string near = models::nearest_name(driver, there);
  return fmt::format("there is no driver {}; expected one of {}; {}", models::quoted(driver),
                     all_quoted(there),
                     near.empty() ? "correct the name, or build it (cmake --build --preset release)"
                                  : fmt::format("did you mean {}?", models::quoted(near)));
}

}  // namespace

void check_driver_names(const models::Setup& setup) {
  const std::vector<std::string> there = drivers_there();
  if (there.empty()) return;
  for (const trial::DrivenRole& role : trial::driven_roles(setup)) {
    const std::string place = models::place_of(setup, role.key);
    if (std::find(there.begin(), there.end(), role.driver) == there.end())
      throw Error(fmt::format("{}: {}", place, unknown(role.driver, there)));
    if (!fills(role.driver, role))
      throw Error(fmt::format("{}: driver {} is for no {}; expected one of {}; name one of them", place,
                              models::quoted(role.driver), role.name, all_quoted(who_fill(role, there))));
  }
}

}  // namespace enc::app
