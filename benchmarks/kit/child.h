// Another program, run to its end: gnuplot, which draws, or Encounter itself, whose size and start are
// measured. Or beside us, as long as it is needed: the fakes of a rig.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace enc::bench {

struct Child {
  int code = -1;  // exit code; -1: could not be started, or a signal ended it
  bool started = false;
  std::string out, err;
  double cpu = 0.0, wall = 0.0;  // s
};

[[nodiscard]] std::string this_program();  // its file

// The first word is looked for in PATH. What it reads and writes goes through memory files: nothing is left
// behind.
[[nodiscard]] Child run_child(std::vector<std::string> words, const std::string& input = {});

// The first word is the program's file. It is ended by SIGTERM when this goes, and by the system where we are
// killed, or the thread that made this ends.
class Companion {
 public:
  // Returns as soon as it has printed `ready`. Throws Error: it ended instead, with its own words, or was
  // silent for `longest`, s.
  Companion(std::vector<std::string> words, const std::string& ready, double longest);
  ~Companion();
  Companion(const Companion&) = delete;
  Companion& operator=(const Companion&) = delete;

 private:
  void end();
  pid_t child_ = -1;
};

}  // namespace enc::bench
