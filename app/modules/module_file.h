// Whether the file of a module is all there. The loader maps what its header promises, and reading beyond the
// end of a file that was cut off ends the program (SIGBUS).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace enc::app {

// head: from the file's start, as far as the table of its segments. Why not all is there; empty: it is, or it
// is no 64-bit library, which the loader says itself.
[[nodiscard]] std::string cut_off(std::string_view head, std::uint64_t size);
[[nodiscard]] std::string cut_off(const std::string& path);

}  // namespace enc::app
