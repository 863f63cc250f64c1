// The fake PHANToM of a rig's [driver.phantom], in front of its arm.
#pragma once

#include <memory>

#include "core/devices/fake.h"

namespace enc::phantom {

[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::phantom
