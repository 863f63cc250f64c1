// The fake of a rig's [driver.leap], in front of its hand tracker: the fake headset of the driver `hand`,
// whose lines the fake libLeapC.so turns into frames.
#pragma once

#include <memory>

#include "core/devices/fake.h"

namespace enc::leap {

[[nodiscard]] std::unique_ptr<Fake> served(const FakeOffer& offer);

}  // namespace enc::leap
