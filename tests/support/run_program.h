// Runs the program as a person would, for tests of its output and its exit code.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <sys/types.h>

#include "tests/support/built.h"

namespace enc::tests {

struct Result {
  int code = -1;         // exit code; 128 + signal after a fatal signal; -1 if it did not start
  std::string out, err;  // its whole output
  double seconds = 0.0;  // from start to end
};

using Environment = std::vector<std::pair<std::string, std::string>>;

// The shipped models, wherever the program starts.
inline const Environment kShipped{{"ENCOUNTER_MODELS", tests::source_dir() + "/models"}};
inline std::string shipped_scene(const std::string& name) {
  return tests::source_dir() + "/models/scenes/" + name + ".toml";
}

// Runs another program from PATH. It is killed (code 137) after `timeout` seconds.
Result run(const std::vector<std::string>& command, const Environment& environment = {},
           double timeout = 60.0);

// Runs program_file() with these arguments, with `environment` on top of ours.
Result run_program(const std::vector<std::string>& args, const Environment& environment = {},
                   double timeout = 60.0);

// A program that writes to us and runs until we close its input.
class PipedChild {
 public:
  // Starts the program with its arguments; the program must exist.
  explicit PipedChild(std::vector<std::string> words);
  ~PipedChild();  // kills the program if it still runs
  PipedChild(const PipedChild&) = delete;
  PipedChild& operator=(const PipedChild&) = delete;

  // Reads after at most so many ms; 0: no bytes, or closed().
  std::size_t read(std::span<char> into, int milliseconds);
  [[nodiscard]] bool closed() const { return closed_; }
  // Closes the program's input and waits for its end; returns the exit code.
  int end();

 private:
  void close(std::size_t end);

  pid_t pid_ = -1;
  std::array<int, 2> ends_{-1, -1};  // its input and its output
  bool closed_ = false;
};

// Expects a refusal: one line on stderr, nothing on stdout, exit code 2. Returns the line.
inline std::string one_line(const Result& r) {
  EXPECT_EQ(r.code, 2) << r.out;
  EXPECT_EQ(r.out, "");
  EXPECT_EQ(std::count(r.err.begin(), r.err.end(), '\n'), 1) << r.err;
  return r.err;
}

}  // namespace enc::tests
