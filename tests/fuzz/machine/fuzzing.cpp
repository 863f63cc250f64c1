#include "tests/fuzz/machine/fuzzing.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>
#include <string_view>

#include <fcntl.h>
#include <fmt/format.h>
#include <malloc.h>
#include <sys/time.h>
#include <unistd.h>

#include "core/base/error.h"
#include "models/schema/wording.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/common_interface_defs.h>
#endif

namespace enc::fuzz {
namespace {

std::map<std::string, Target (*)()>& offers() {
  static std::map<std::string, Target (*)()> all;
  return all;
}

constexpr std::size_t kLongest = 1U << 16U;  // bytes; only long runs exceed it
constexpr std::size_t kMostKept = 64;

bool in_word(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '.' || c == '-' ||
         c == '+' || c == '_';
}

struct Piece {
  std::size_t at = 0, size = 0;
};
// The word, or the line with its end, around a byte.
Piece word_at(const std::string& bytes, std::size_t at) {
  std::size_t end = at;
  while (at > 0 && in_word(bytes[at - 1])) --at;
  while (end < bytes.size() && in_word(bytes[end])) ++end;
  return {at, end - at};
}
Piece line_at(const std::string& bytes, std::size_t at) {
  const std::size_t begin = at == 0 ? 0 : bytes.rfind('\n', at - 1) + 1;  // npos + 1 is 0
  return {begin, std::min(bytes.find('\n', at), bytes.size() - 1) + 1 - begin};
}

std::atomic<std::size_t> live{0}, peak{0};

// State for the report at the end of the program; a signal handler may not allocate.
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

// Limits the text to one line that any terminal shows.
std::string wrong_with(const std::string& words) {
  if (words.empty()) return "an Error without words";
  if (models::printable(words) != words) return fmt::format("an Error of more than one line: {}", words);
  return {};
}

}  // namespace

Offer::Offer(const std::string& name, Target (*make)()) { offers()[name] = make; }

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& [name, make] : offers()) all.push_back(name);
  return all;
}

const Target& target(const std::string& name) {
  static std::map<std::string, Target> made;
  const auto found = made.find(name);
  if (found != made.end()) return found->second;
  Target one = offers().at(name)();
  one.name = name;
  return made[name] = std::move(one);
}

Mutator::Mutator(std::uint64_t seed, std::vector<std::string> seeds, std::vector<std::string> tokens)
    : engine_(seed), seeds_(std::move(seeds)), tokens_(std::move(tokens)) {
  const std::array<std::string, 26> common{"nan",
                                           "-nan",
                                           "inf",
                                           "-inf",
                                           "1e999",
                                           "-1e999",
                                           "1e-999",
                                           "-0",
                                           "0",
                                           "-1",
                                           "5e-324",
                                           "1e308",
                                           "18446744073709551616",
                                           "9223372036854775807",
                                           "-9223372036854775808",
                                           "4294967295",
                                           "2147483648",
                                           "1e15",
                                           "0x7f",
                                           "1_0",
                                           "\n",
                                           "\r\n",
                                           "\t",
                                           std::string(1, '\0'),
                                           "\x7f",
                                           "\xc3\xa9"};
  tokens_.insert(tokens_.end(), common.begin(), common.end());
}

void Mutator::keep(const std::string& input) {
  if (input.size() > kLongest) return;
  if (kept_.size() < kMostKept)
    kept_.push_back(input);
  else if (of(64) == 0)
    kept_[of(kMostKept)] = input;
}

std::string Mutator::next() {
  std::string bytes = kept_.empty() || of(2) == 0 ? seeds_[of(seeds_.size())] : kept_[of(kept_.size())];
  do spoil(bytes);
  while (of(3) != 0);
  return bytes;
}

void Mutator::spoil(std::string& bytes) {
  if (bytes.empty()) bytes = token();
  switch (of(8)) {
    case 0:
    case 1:
      return spoil_bytes(bytes);
    case 2:
    case 3:
    case 4:
      return spoil_words(bytes);
    case 5:
    case 6:
      return spoil_lines(bytes);
    default:
      return spoil_whole(bytes);
  }
}

void Mutator::spoil_bytes(std::string& bytes) {
  const std::size_t at = of(bytes.size());
  const auto number = [&] {
    const std::array<std::uint64_t, 12> some{0,     1,           bytes.size(), bytes.size() - 1,
                                             0x7f,  0x7fffffff,  0x80000000,   0xffffffffU,
                                             ~0ULL, 1ULL << 63U, 0xffff,       engine_()};
    return some[of(some.size())];
  };
  switch (of(4)) {
    case 0:
      bytes[at] = static_cast<char>(bytes[at] ^ (1 << of(8)));
      return;
    case 1:
      bytes[at] = static_cast<char>(engine_());
      return;
    case 2: {  // a number of 1, 2, 4 or 8 bytes, mostly at the place of such a number
      const std::size_t size = std::size_t{1} << of(4), place = of(4) == 0 ? at : at / size * size;
      const std::uint64_t value = number();
      std::memcpy(bytes.data() + place, &value, std::min(size, bytes.size() - place));
      return;
    }
    default: {  // the number at that place, slightly more or less
      const std::size_t size = std::size_t{1} << of(4);
      if (bytes.size() < size) return;
      const std::size_t place = std::min(at / size * size, bytes.size() - size);
      std::uint64_t value = 0;
      std::memcpy(&value, bytes.data() + place, size);
      value += of(17) - 8;
      std::memcpy(bytes.data() + place, &value, size);
    }
  }
}

void Mutator::spoil_words(std::string& bytes) {
  const std::size_t at = of(bytes.size());
  const Piece word = word_at(bytes, at);
  switch (of(5)) {
    case 0:
      bytes.insert(at, token());
      return;
    case 1:
    case 2:
      bytes.replace(word.at, word.size, token());
      return;
    case 3: {  // another word of the input
      const Piece other = word_at(bytes, of(bytes.size()));
      bytes.replace(word.at, word.size, bytes.substr(other.at, other.size));
      return;
    }
    default:  // a digit
      for (std::size_t i = word.at; i < word.at + word.size; ++i)
        if (bytes[i] >= '0' && bytes[i] <= '9' && of(2) == 0) bytes[i] = static_cast<char>('0' + of(10));
  }
}

void Mutator::spoil_lines(std::string& bytes) {
  const std::size_t at = of(bytes.size());
  const Piece line = line_at(bytes, at);
  const std::string text = bytes.substr(line.at, line.size);
  switch (of(6)) {
    case 0:
      bytes.erase(line.at, line.size);
      return;
    case 1:
      bytes.insert(line.at, text);
      return;
    case 2: {
      const Piece other = line_at(bytes, of(bytes.size()));
      bytes.insert(other.at, text);
      return;
    }
    case 3:
      bytes.erase(at, of(bytes.size() - at) + 1);
      return;
    case 4: {  // a piece, many times
      const std::string piece = bytes.substr(at, 1 + of(40));
      for (std::size_t i = of(50); i > 0 && bytes.size() < kLongest; --i) bytes.insert(at, piece);
      return;
    }
    default: {  // a piece of another input
      const std::string& other = seeds_[of(seeds_.size())];
      if (other.empty()) return;
      const std::size_t from = of(other.size());
      bytes.replace(at, of(2) == 0 ? std::string::npos : of(64),
                    other.substr(from, of(2) == 0 ? std::string::npos : of(256)));
      bytes.resize(std::min(bytes.size(), kLongest));
    }
  }
}

void Mutator::spoil_whole(std::string& bytes) {
  const std::size_t at = of(bytes.size());
  switch (of(6)) {
    case 0:
    case 1:
      bytes.resize(at);
      return;
    case 2:
      bytes.insert(0, of(2) == 0 ? "\xEF\xBB\xBF" : std::string(1, '\0'));
      return;
    case 3:  // foreign line ends
      if (bytes.size() > kLongest) return;
      for (std::size_t i = bytes.find('\n'); i != std::string::npos; i = bytes.find('\n', i + 2))
        bytes.insert(i, "\r");
      return;
    case 4: {  // deep nesting
      static constexpr std::array<std::string_view, 5> kOpen{"[", "{", "[[", "{a=", "{\"a\":["};
      const std::string_view open = kOpen[of(kOpen.size())];
      std::string nest;
      for (std::size_t i = of(of(50) == 0 ? 20'000 : 300); i > 0; --i) nest += open;
      bytes.insert(at, nest);
      return;
    }
    default:  // a long run
      bytes.insert(at, std::string(of(of(50) == 0 ? 200'000 : 300), token().empty() ? 'a' : token()[0]));
  }
}

std::size_t live_bytes() { return live.load(std::memory_order_relaxed); }
std::size_t peak_bytes() { return peak.load(std::memory_order_relaxed); }
void forget_peak() { peak.store(live_bytes(), std::memory_order_relaxed); }

void* count_new(void* memory) {
  if (memory == nullptr) throw std::bad_alloc();
  const std::size_t usable = malloc_usable_size(memory);
  const std::size_t in_use = live.fetch_add(usable, std::memory_order_relaxed) + usable;
  if (in_use > peak_bytes()) peak.store(in_use, std::memory_order_relaxed);
  return memory;
}
void count_delete(void* memory) {
  if (memory == nullptr) return;
  live.fetch_sub(malloc_usable_size(memory), std::memory_order_relaxed);
  std::free(memory);
}

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
  // The handler needs a stack of its own, because a deep recursion has used up the first one.
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
  } catch (const InvariantError& e) {
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

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__) && !defined(__clang__)
// The array forms and the non-throwing forms call these.
void* operator new(std::size_t size) { return enc::fuzz::count_new(std::malloc(size == 0 ? 1 : size)); }
void* operator new(std::size_t size, std::align_val_t align) {
  const auto to = static_cast<std::size_t>(align);
  return enc::fuzz::count_new(std::aligned_alloc(to, (size / to + 1) * to));
}
void operator delete(void* memory) noexcept { enc::fuzz::count_delete(memory); }
void operator delete(void* memory, std::size_t) noexcept { enc::fuzz::count_delete(memory); }
void operator delete(void* memory, std::align_val_t) noexcept { enc::fuzz::count_delete(memory); }
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  enc::fuzz::count_delete(memory);
}
#endif
