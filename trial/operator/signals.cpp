#include "trial/operator/signals.h"

#include <unistd.h>

namespace enc::trial {
namespace {

volatile std::sig_atomic_t begun = 0, first_end = 0, halts = 0, resumes = 0, suspensions = 0, continued = 0;
// Earlier handling of the fault signals, by number.
std::array<struct sigaction, 32> faults_before{};

extern "C" {

void note_end(int number) {
  if (begun == 0) _exit(128 + number);
  if (first_end == 0) first_end = number;
}
void note_halt(int) { halts = 1; }
void note_resume(int) { resumes = 1; }
void note_suspension(int) { suspensions = 1; }
void note_continued(int) { continued = 1; }

// A signal from another process, such as a supervisor, requests the end. Otherwise this program is at fault,
// and the signal gets its earlier handling: the faulty instruction runs again, or abort() raises it again.
void note_fault(int number, siginfo_t* info, void*) {
  if (info->si_code == SI_USER && info->si_pid != getpid()) return note_end(number);
  sigaction(number, &faults_before[static_cast<std::size_t>(number)], nullptr);
  if (info->si_code <= 0) raise(number);
}

}  // extern "C"

bool taken(volatile std::sig_atomic_t& flag) noexcept {
  if (flag == 0) return false;
  flag = 0;
  return true;
}

}  // namespace

Signals::Signals() {
  for (volatile std::sig_atomic_t* flag : {&begun, &first_end, &halts, &resumes, &suspensions, &continued})
    *flag = 0;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT}) take(signal, note_end, PriorHandling::ignored);
  // A profiler or a test may handle one of these signals.
  for (const int signal : {SIGALRM, SIGVTALRM, SIGPROF, SIGXCPU, SIGIO, SIGPWR, SIGSTKFLT})
    take(signal, note_end, PriorHandling::handled);
  for (int signal = SIGRTMIN; signal <= SIGRTMAX; ++signal) take(signal, note_end, PriorHandling::handled);
  take_faults();
  take(SIGUSR1, note_halt, PriorHandling::nothing);
  take(SIGUSR2, note_resume, PriorHandling::nothing);
  for (const int signal : {SIGPIPE, SIGXFSZ, SIGTTIN, SIGTTOU}) take(signal, SIG_IGN, PriorHandling::ignored);
}

Signals::~Signals() {
  for (; count_ > 0; --count_) sigaction(taken_[count_ - 1].signal, &taken_[count_ - 1].before, nullptr);
}

void Signals::take(int signal, void (*handler)(int), PriorHandling spared) {
  if (count_ == taken_.size()) return;
  SavedSignal& one = taken_[count_];
  one.signal = signal;
  if (sigaction(signal, nullptr, &one.before) != 0) return;
  if (spared != PriorHandling::nothing && one.before.sa_handler == SIG_IGN) return;
  if (spared == PriorHandling::handled && one.before.sa_handler != SIG_DFL) return;
  struct sigaction action {};
  action.sa_handler = handler;
  if (sigaction(signal, &action, nullptr) == 0) ++count_;
}

void Signals::take_faults() {
  for (const int signal : {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGSEGV, SIGSYS, SIGTRAP}) {
    SavedSignal& one = taken_[count_];
    one.signal = signal;
    if (sigaction(signal, nullptr, &one.before) != 0) continue;
    faults_before[static_cast<std::size_t>(signal)] = one.before;
    struct sigaction action {};
    action.sa_sigaction = note_fault;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK;
    if (sigaction(signal, &action, nullptr) == 0) ++count_;
  }
}

void Signals::begin() noexcept { begun = 1; }

void Signals::take_suspensions() noexcept {
  take(SIGTSTP, note_suspension, PriorHandling::ignored);
  take(SIGCONT, note_continued, PriorHandling::nothing);
}

int Signals::caught() noexcept { return first_end; }
bool Signals::take_halt() noexcept { return taken(halts); }
bool Signals::take_resume() noexcept { return taken(resumes); }
bool Signals::take_suspension() noexcept { return taken(suspensions); }
bool Signals::take_continued() noexcept { return taken(continued); }

void Signals::suspend() noexcept {
  struct sigaction ours {
  }, plain{};
  plain.sa_handler = SIG_DFL;
  if (sigaction(SIGTSTP, &plain, &ours) != 0) return;
  raise(SIGTSTP);  // returns when the process is continued
  sigaction(SIGTSTP, &ours, nullptr);
}

}  // namespace enc::trial
