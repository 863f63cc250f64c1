#include "tests/hygiene/in_child.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <sstream>
#include <type_traits>
#include <vector>

#include <dlfcn.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/support/run_program.h"

namespace enc::test {
namespace {

static_assert(std::is_trivially_copyable_v<Tally>);
// Through the pipe.
struct Parcel {
  Tally tally;
  double extra = 0.0;
  std::array<char, 512> error{};
};

[[noreturn]] void be_child(const std::function<void(Told&)>& work, int to) {
  Told told;
  try {
    touch_all_pages();
    work(told);
  } catch (const std::exception& e) {
    told.error = e.what();
    if (told.error.empty()) told.error = "an exception without words";
  }
  Parcel parcel{told.tally, told.extra, {}};
  std::copy_n(told.error.begin(), std::min(told.error.size(), parcel.error.size() - 1), parcel.error.begin());
  const auto* bytes = reinterpret_cast<const char*>(&parcel);
  std::size_t sent = 0;
  while (sent < sizeof(parcel)) {
    const ssize_t n = ::write(to, bytes + sent, sizeof(parcel) - sent);
    if (n <= 0) break;
    sent += static_cast<std::size_t>(n);
  }
  ::_exit(0);
}

// "file.cpp:12 function", where the program has lines and addr2line is there.
std::string place_of(void* caller) {
  Dl_info info{};
  if (dladdr(caller, &info) == 0 || info.dli_fname == nullptr) return "?";
  const auto at = reinterpret_cast<std::uintptr_t>(caller) - 1;
  const auto offset = at - reinterpret_cast<std::uintptr_t>(info.dli_fbase);
  // A program that is not moved has its addresses in its file.
  for (const std::uintptr_t address : {offset, at}) {
    const std::string found =
        tests::run({"addr2line", "-Cfpse", info.dli_fname, fmt::format("{:#x}", address)}).out;
    if (!found.empty() && found.find("??") == std::string::npos)
      return found.substr(0, std::min<std::size_t>(found.find('\n'), 100));
  }
  return fmt::format("{} in {}", info.dli_sname != nullptr ? info.dli_sname : "?", info.dli_fname);
}

}  // namespace

Told in_child(const std::function<void(Told&)>& work) {
  Told told;
  std::array<int, 2> ends{};
  std::fflush(nullptr);
  if (::pipe(ends.data()) != 0) return {{}, 0.0, "no pipe"};
  const pid_t child = ::fork();
  if (child == 0) be_child(work, ends[1]);
  ::close(ends[1]);
  Parcel parcel;
  auto* bytes = reinterpret_cast<char*>(&parcel);
  std::size_t got = 0;
  for (ssize_t n = 1; n > 0 && got < sizeof(parcel); got += static_cast<std::size_t>(std::max<ssize_t>(n, 0)))
    n = ::read(ends[0], bytes + got, sizeof(parcel) - got);
  ::close(ends[0]);
  int status = 0;
  if (child < 0 || ::waitpid(child, &status, 0) != child || status != 0 || got != sizeof(parcel))
    return {{}, 0.0, fmt::format("the child ended with status {:#x}", status)};
  return {parcel.tally, parcel.extra, parcel.error.data()};
}

std::string words(const Tally& tally) {
  constexpr std::array<const char*, kOffences> kNames{"heap call", "lock", "system call", "minor page fault",
                                                      "major page fault"};
  std::string text;
  for (std::size_t i = 0; i < kOffences; ++i)
    if (tally.count[i] != 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", tally.count[i], kNames[i]);
  text = (text.empty() ? "nothing" : text) + fmt::format(" in {} ticks", tally.ticks);
  for (std::size_t i = 0; i < tally.offenders; ++i) {
    const Offender& one = tally.first[i];
    text += fmt::format("\n  tick {}: {} {}", one.tick, kNames[static_cast<std::size_t>(one.kind)],
                        one.name.data());
    for (std::size_t d = 2; d < one.depth && d < 14; ++d) text += "\n    " + place_of(one.callers[d]);
  }
  return text;
}

}  // namespace enc::test
