// Where the tools of a session lie while they are not held (SessionSpec::tray).
#pragma once

namespace enc::sim {

inline constexpr double kTrayBeside = 0.080;  // m along y of W, from the first tool's place to the other's

}  // namespace enc::sim
