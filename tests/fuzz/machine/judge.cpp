#include "tests/fuzz/machine/judge.h"

#include <array>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/time.h>
#include <unistd.h>

#include "core/base/error.h"
#include "models/schema/wording.h"
#include "tests/fuzz/machine/memory.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

namespace enc::fuzz {
namespace {

// What the end of the program has to tell; a handler of signals may allocate nothing.
struct Now {
  std::array<char, 256> words{}, file{};
  const char* data = nullptr;
  std::size_t size = 0;
};
Now now;

void say(const char* text) { static_cast<void>(!::write(STDERR_FILENO, text, std::strlen(text))); }

void tell() {
  if (now.data == nullptr) return;
  const int file = open(now.file.data(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  static_cast<void>(!::write(file, now.data, now.size));
  close(file);
  const std::array<const char*, 5> texts{"\nfuzz: ended within ", now.words.data(), "; the input is in ",
                                         now.file.data(), "\n"};
  for (const char* text : texts) say(text);
}

void at_signal(int number) {
  if (number == SIGPROF) say("\nfuzz: an input takes too long");
  tell();
  std::signal(number, SIG_DFL);
  std::raise(number == SIGPROF ? SIGABRT : number);
}

std::string file_of(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("encounter_fuzz_" + name)).string();
}

void limit_cpu(int seconds) {
  const itimerval timer{{0, 0}, {seconds, 0}};
  setitimer(ITIMER_PROF, &timer, nullptr);
}

double cpu_time() {
  timespec used{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

// One line that any terminal shows.
std::string wrong_with(const std::string& words) {
  if (words.empty()) return "an Error without words";
  if (models::printable(words) != words) return fmt::format("an Error of more than one line: {}", words);
  return {};
}

}  // namespace

std::string kept_input(const Target& target, const std::string& input) {
  std::string path = file_of(target.name);
  std::ofstream(path, std::ios::binary) << input;
  return path;
}

void watch(const std::string& words) {
  words.copy(now.words.data(), now.words.size() - 1);
#ifdef __SANITIZE_ADDRESS__
  __sanitizer_set_death_callback(&tell);
  std::signal(SIGPROF, &at_signal);
#else
  // On a stack of its own, as a deep recursion has used up the other.
  static std::array<char, 1U << 16U> stack;
  const stack_t own{stack.data(), 0, stack.size()};
  sigaltstack(&own, nullptr);
  struct sigaction action {};
  action.sa_handler = &at_signal;
  action.sa_flags = SA_ONSTACK;
  for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGPROF})
    sigaction(number, &action, nullptr);
#endif
}

Verdict judge(const Target& target, const std::string& input) {
  const std::string file = file_of(target.name);
  now.file.fill('\0');
  file.copy(now.file.data(), now.file.size() - 1);
  now.size = input.size();
  now.data = input.data();
  limit_cpu(kMostCpu);
  forget_peak();
  const std::size_t before = live_bytes();
  Verdict verdict;
  const double began = cpu_time();
  try {
    verdict.accepted = target.run(input);
  } catch (const Error& e) {
    verdict.wrong = wrong_with(e.what());
  } catch (const Broken& e) {
    verdict.wrong = fmt::format("accepted, but {}", e.what());
  } catch (const std::exception& e) {
    verdict.wrong = fmt::format("an exception that is no Error: {}", e.what());
  }
  limit_cpu(0);
  verdict.seconds = cpu_time() - began;
  now.data = nullptr;
  verdict.most_heap = peak_bytes() - before;
  const std::size_t most = target.bound.per_byte * input.size() + target.bound.besides;
  if (verdict.wrong.empty() && verdict.most_heap > most)
    verdict.wrong = fmt::format("{} bytes of heap at once for an input of {}; at most {} are expected",
                                verdict.most_heap, input.size(), most);
  return verdict;
}

}  // namespace enc::fuzz
