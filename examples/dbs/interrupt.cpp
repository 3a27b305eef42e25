#include "interrupt.hpp"

#include <csignal>
#include <initializer_list>

namespace dbs {
namespace {

volatile std::sig_atomic_t came = 0;

void note(int number) { came = number; }

}  // namespace

void catch_interrupts() {
  struct sigaction action {};
  action.sa_handler = note;
  action.sa_flags = int(SA_RESETHAND);   // a solve that hangs can still be ended
  sigemptyset(&action.sa_mask);
  for (int number : {SIGINT, SIGTERM}) {
    struct sigaction before {};
    sigaction(number, nullptr, &before);
    if (before.sa_handler != SIG_IGN) sigaction(number, &action, nullptr);   // nohup, background jobs
  }
}

int interrupted() { return int(came); }

int exit_status_of_interrupt() { return 128 + interrupted(); }

}  // namespace dbs
