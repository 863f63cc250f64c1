// What this process has mapped and started, as the kernel tells it: so that "left out" can be checked, not
// only said. And whether what it has printed went anywhere.
#pragma once

#include <string>
#include <vector>

namespace enc::app {

// Of standard input, output and error those that are closed get something that cannot be written: otherwise
// the next file that is opened takes their place, and what is printed goes into it.
void fill_streams();
// Throws Error unless all that was printed has got where it should.
void check_output();
[[noreturn]] void fail_output();

// Standard input is a terminal, and who types there types for this process.
[[nodiscard]] bool reads_terminal();
// On a line of standard error, which is a terminal; what it does not take at once is not shown.
void show_progress(double share);
void clear_progress();
[[nodiscard]] int thread_count();
[[nodiscard]] double peak_memory_mb();
[[nodiscard]] double cpu_seconds();  // of this process since it was started, loading included
[[nodiscard]] std::vector<std::string>
mapped_libraries();  // file names of shared objects, in order, each once

}  // namespace enc::app
