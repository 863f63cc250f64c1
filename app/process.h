// This process: its resources as the kernel reports them, so that "left out" can be checked. Also checks that
// output was written, and finds programs to start.
#pragma once

#include <string>
#include <vector>

namespace enc::app {

// Opens closed standard streams on something unwritable. Otherwise the next opened file would take their
// place, and output would go into it.
void fill_streams();
// Throws Error unless all output has been written.
void check_output();
[[noreturn]] void fail_output();

// True if standard input is a terminal, and its user types for this process.
[[nodiscard]] bool reads_terminal();
// Shows progress on a line of standard error, which must be a terminal; text that it does not take at once is
// dropped.
void show_progress(double share);
void clear_progress();
[[nodiscard]] int thread_count();
[[nodiscard]] double peak_memory_mb();
[[nodiscard]] double cpu_seconds();  // since the start of the process, loading included
// File names of shared objects, in order, each once.
[[nodiscard]] std::vector<std::string> mapped_libraries();
// Full path of a program in PATH; empty: it is not installed.
[[nodiscard]] std::string program_path(const std::string& name);

}  // namespace enc::app
