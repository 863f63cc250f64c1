#include "tests/hygiene/tally.h"

#include <numeric>

namespace enc::test {

std::int64_t Tally::all() const { return std::accumulate(count.begin(), count.end(), std::int64_t{0}); }

}  // namespace enc::test

#ifdef ENCOUNTER_CAN_TALLY

#include <algorithm>
#include <bit>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <string_view>

#include <dlfcn.h>
#include <execinfo.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

namespace enc::test {
namespace {

bool counting = false;
pthread_t counted{};
Tally tally;
std::int64_t before_tick = 0;  // all calls
rusage at_begin{};

void add(Offence kind, std::string_view name) noexcept {
  if (!counting || pthread_equal(pthread_self(), counted) == 0) return;
  counting = false;  // calls from here do not count for the tick
  ++tally.count[static_cast<std::size_t>(kind)];
  if (tally.offenders < tally.first.size()) {
    Offender& one = tally.first[tally.offenders++];
    one.kind = kind;
    one.tick = tally.ticks;
    std::copy_n(name.begin(), std::min(name.size(), one.name.size() - 1), one.name.begin());
    one.depth = static_cast<std::size_t>(backtrace(one.callers.data(), static_cast<int>(one.callers.size())));
  }
  counting = true;
}

// The C library's own function of that name.
template <class Function>
Function* next(const char* name) {
  return std::bit_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}  // namespace
}  // namespace enc::test

// ---- the heap

using enc::test::add;
using enc::test::Offence;

extern "C" {

void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) {
  add(Offence::heap, "malloc");
  return __libc_malloc(size);
}
void* calloc(std::size_t n, std::size_t size) {
  add(Offence::heap, "calloc");
  return __libc_calloc(n, size);
}
void* realloc(void* p, std::size_t size) {
  add(Offence::heap, "realloc");
  return __libc_realloc(p, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  add(Offence::heap, "memalign");
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  add(Offence::heap, "aligned_alloc");
  return __libc_memalign(alignment, size);
}
int posix_memalign(void** p, std::size_t alignment, std::size_t size) {
  add(Offence::heap, "posix_memalign");
  *p = __libc_memalign(alignment, size);
  return *p != nullptr ? 0 : ENOMEM;
}
void free(void* p) {
  if (p != nullptr) add(Offence::heap, "free");
  __libc_free(p);
}

// ---- locks

#define ENCOUNTER_LOCK(name, parameters, arguments)                   \
  int name parameters {                                               \
    static auto* const real = enc::test::next<int parameters>(#name); \
    add(Offence::lock, #name);                                        \
    return real arguments;                                            \
  }
ENCOUNTER_LOCK(pthread_mutex_lock, (pthread_mutex_t * m), (m))
ENCOUNTER_LOCK(pthread_mutex_trylock, (pthread_mutex_t * m), (m))
ENCOUNTER_LOCK(pthread_mutex_timedlock, (pthread_mutex_t * m, const timespec* t), (m, t))
ENCOUNTER_LOCK(pthread_rwlock_rdlock, (pthread_rwlock_t * m), (m))
ENCOUNTER_LOCK(pthread_rwlock_tryrdlock, (pthread_rwlock_t * m), (m))
ENCOUNTER_LOCK(pthread_rwlock_wrlock, (pthread_rwlock_t * m), (m))
ENCOUNTER_LOCK(pthread_rwlock_trywrlock, (pthread_rwlock_t * m), (m))
ENCOUNTER_LOCK(pthread_spin_lock, (pthread_spinlock_t * m), (m))
ENCOUNTER_LOCK(pthread_cond_wait, (pthread_cond_t * c, pthread_mutex_t* m), (c, m))
ENCOUNTER_LOCK(pthread_cond_timedwait, (pthread_cond_t * c, pthread_mutex_t* m, const timespec* t), (c, m, t))
ENCOUNTER_LOCK(pthread_cond_signal, (pthread_cond_t * c), (c))
ENCOUNTER_LOCK(pthread_cond_broadcast, (pthread_cond_t * c), (c))
ENCOUNTER_LOCK(sem_wait, (sem_t * s), (s))
ENCOUNTER_LOCK(sem_trywait, (sem_t * s), (s))
ENCOUNTER_LOCK(sem_post, (sem_t * s), (s))
#undef ENCOUNTER_LOCK

// ---- system calls

// A system call from an address that the filter allows: it performs a call that the filter has stopped.
long encounter_call(long number, long a, long b, long c, long d, long e, long f);
extern const char encounter_call_end[];
}  // extern "C"
asm(R"(
  .text
  .globl encounter_call
  .globl encounter_call_end
  .type encounter_call, @function
encounter_call:
  movq %rdi, %rax
  movq %rsi, %rdi
  movq %rdx, %rsi
  movq %rcx, %rdx
  movq %r8, %r10
  movq %r9, %r8
  movq 8(%rsp), %r9
  syscall
encounter_call_end:
  ret
  .size encounter_call, .-encounter_call
)");

namespace enc::test {
namespace {

void on_system_call(int /*signal*/, siginfo_t* /*info*/, void* context) {
  const int kept = errno;
  auto& at = static_cast<ucontext_t*>(context)->uc_mcontext.gregs;
  const auto number = static_cast<std::size_t>(at[REG_RAX]);
  std::array<char, 24> name{};
  std::to_chars(name.begin(), name.end(), number);
  if (counting && number < tally.calls.size()) ++tally.calls[number];
  add(Offence::system_call, name.data());
  at[REG_RAX] =
      encounter_call(at[REG_RAX], at[REG_RDI], at[REG_RSI], at[REG_RDX], at[REG_R10], at[REG_R8], at[REG_R9]);
  errno = kept;
}

}  // namespace

bool filter_system_calls() {
  struct sigaction action {};
  action.sa_sigaction = on_system_call;
  action.sa_flags = SA_SIGINFO | SA_NODEFER;
  if (sigaction(SIGSYS, &action, nullptr) != 0) return false;
  const auto ours = std::bit_cast<std::uint64_t>(&encounter_call_end[0]);
  const auto if_equal = [](std::uint64_t k, std::size_t skip, std::size_t otherwise) {
    return sock_filter BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, static_cast<std::uint32_t>(k),
                                static_cast<std::uint8_t>(skip), static_cast<std::uint8_t>(otherwise));
  };
  const auto load = [](std::size_t offset) {
    return sock_filter BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
  };
  std::array<sock_filter, 11> rules{
      load(offsetof(seccomp_data, instruction_pointer)),
      if_equal(ours, 0, 2),
      load(offsetof(seccomp_data, instruction_pointer) + 4),
      if_equal(ours >> 32, 6, 0),
      load(offsetof(seccomp_data, nr)),
      if_equal(SYS_rt_sigreturn, 4, 0),
      if_equal(SYS_clock_gettime, 3, 0),
      if_equal(SYS_clock_nanosleep, 2, 0),
      if_equal(SYS_nanosleep, 1, 0),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_TRAP),
      BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW),
  };
  sock_fprog program{static_cast<unsigned short>(rules.size()), rules.data()};
  tally.filtered =
      prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0) == 0 &&
      syscall(SYS_seccomp, SECCOMP_SET_MODE_FILTER, SECCOMP_FILTER_FLAG_SPEC_ALLOW, &program) == 0;
  return tally.filtered;
}

// ---- counting

void begin_tally() {
  const bool filtered = tally.filtered;
  tally = Tally{};
  tally.filtered = filtered;
  before_tick = 0;
  std::array<void*, 2> some{};
  (void)backtrace(some.data(), 2);  // loads once whatever it needs
  counted = pthread_self();
  getrusage(RUSAGE_THREAD, &at_begin);
  counting = true;
}

void end_tick() {
  const std::int64_t now = tally.all();
  tally.dirty += now > before_tick ? 1 : 0;
  before_tick = now;
  ++tally.ticks;
}

Tally end_tally() {
  counting = false;
  rusage now{};
  getrusage(RUSAGE_THREAD, &now);
  tally.count[static_cast<std::size_t>(Offence::minor_fault)] = now.ru_minflt - at_begin.ru_minflt;
  tally.count[static_cast<std::size_t>(Offence::major_fault)] = now.ru_majflt - at_begin.ru_majflt;
  return tally;
}

void touch_all_pages() {
  std::FILE* maps = std::fopen("/proc/self/maps", "r");
  if (maps == nullptr) return;
  const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
  std::array<char, 1024> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), maps) != nullptr) {
    std::uint64_t from = 0, to = 0;
    std::array<char, 5> rights{};
    std::array<char, 256> name{};
    if (std::sscanf(line.data(), "%lx-%lx %4s %*s %*s %*s %255s", &from, &to, rights.data(), name.data()) < 3)
      continue;
    const bool written = rights[0] == 'r' && rights[1] == 'w' && rights[3] == 'p';
    const bool read = rights[0] == 'r' && name[0] == '/';
    for (std::uint64_t at = from; at < to && (written || read); at += page) {
      auto* byte = std::bit_cast<volatile char*>(at);
      const char was = *byte;
      if (written) *byte = was;
    }
  }
  std::fclose(maps);
}

}  // namespace enc::test

#else

namespace enc::test {

bool filter_system_calls() { return false; }
void begin_tally() {}
void end_tick() {}
Tally end_tally() { return {}; }
void touch_all_pages() {}

}  // namespace enc::test

#endif
