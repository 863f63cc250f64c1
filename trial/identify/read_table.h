// The table that a fit reads: a CSV file, or a record in the table form of `encounter export`.
#pragma once

#include <string>

namespace enc::trial {

// kind, expected: of the table, for the message of an unreadable file. Throws Error, also for a truncated
// record.
[[nodiscard]] std::string read_table(const std::string& path, const std::string& kind,
                                     const std::string& expected);

}  // namespace enc::trial
