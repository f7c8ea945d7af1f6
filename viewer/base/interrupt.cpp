#include "viewer/base/interrupt.h"

#include <cstddef>

namespace viewer {
namespace {

constexpr int kSignals[]{SIGINT, SIGTERM, SIGHUP};
gi::StopRequest* g_stop = nullptr; // global, as a signal handler gets no arguments of its own
volatile std::sig_atomic_t g_signal = 0;

void handle(int signal)
{
    g_signal = signal;
    if (g_stop != nullptr) g_stop->request();
    if (signal != SIGHUP) std::signal(signal, SIG_DFL);
}

} // namespace

int interrupted_code() { return 128 + (was_interrupted() ? int(g_signal) : SIGINT); }

bool was_interrupted() { return g_signal != 0; }

InterruptGuard::InterruptGuard(gi::StopRequest& stop)
{
    g_stop = &stop;
    struct sigaction on {};
    on.sa_handler = handle;
    on.sa_flags = SA_RESTART;
    sigemptyset(&on.sa_mask);
    for (std::size_t k = 0; k < std::size(kSignals); ++k) {
        sigaction(kSignals[k], nullptr, &before_[k]);
        bool const is_nohup = kSignals[k] == SIGHUP && before_[k].sa_handler == SIG_IGN;
        if (!is_nohup) sigaction(kSignals[k], &on, nullptr);
    }
}

InterruptGuard::~InterruptGuard()
{
    for (std::size_t k = 0; k < std::size(kSignals); ++k) sigaction(kSignals[k], &before_[k], nullptr);
    g_stop = nullptr;
}

} // namespace viewer
