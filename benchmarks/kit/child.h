// Another program, run to its end: gnuplot for plots, or Encounter itself to measure size and start-up. Or a
// program that runs beside this one while it is needed: the fakes of a rig.
#pragma once

#include <string>
#include <vector>

#include <sys/types.h>

namespace enc::bench {

struct Child {
  int code = -1;  // exit code; -1: start failed, or a signal ended it
  bool started = false;
  std::string out, err;
  double cpu = 0.0, wall = 0.0;  // s
};

[[nodiscard]] std::string this_program();  // its file

// PATH is searched for the first word. Input and output go through memory files, so no file is left behind.
[[nodiscard]] Child run_child(std::vector<std::string> words, const std::string& input = {});

// The first word is the program's file. The destructor ends it by SIGTERM; the system ends it if this process
// is killed or the creating thread ends.
class Companion {
 public:
  // Returns as soon as it has printed `ready`. Throws Error if it ends instead, with its own words, or is
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
