// The table that a fit reads: a CSV file, or a record as `encounter export` makes a table of it.
#pragma once

#include <string>

namespace enc::trial {

// kind, expected: of the table, for the message of a file that cannot be read. Throws Error; of a record that
// is cut off, too.
[[nodiscard]] std::string read_table(const std::string& path, const std::string& kind,
                                     const std::string& expected);

}  // namespace enc::trial
