// The fake device of a rig's [driver.forcedimension], in front of its arm.
#pragma once

#include <memory>

#include "core/devices/fake.h"

namespace enc::forcedimension {

[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::forcedimension
