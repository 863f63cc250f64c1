// The names of the axes, as the subcommands of modules print them.
#pragma once

namespace enc::app {

inline constexpr const char* kNames = "xyz";

}  // namespace enc::app
