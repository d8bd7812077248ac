#include "apps/inlay/interrupt.h"

#include <atomic>
#include <csignal>

namespace inlay {
namespace {

std::atomic<bool> asked_to_stop = false;
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers may only touch such");

void note_signal(int signal) {
    asked_to_stop = true;
    std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
}

bool interrupted() { return asked_to_stop; }

}  // namespace inlay
