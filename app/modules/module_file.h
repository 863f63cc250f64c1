// Checks that the file of a module is complete. The loader maps the sizes in its header, and reading beyond
// the end of a truncated file ends the program (SIGBUS).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace enc::app {

// head: from the file's start to the end of its segment table. Returns the reason why the file is incomplete;
// empty: complete, or not a 64-bit library, which the loader reports itself.
[[nodiscard]] std::string cut_off(std::string_view head, std::uint64_t size);
[[nodiscard]] std::string cut_off(const std::string& path);

}  // namespace enc::app
