#include "viewer/base/interrupt.h"

#include <csignal>

namespace viewer {
namespace {

gi::StopRequest* g_stop = nullptr; // global, as a signal handler gets no arguments of its own

void handle(int signal)
{
    if (g_stop != nullptr) g_stop->request();
    std::signal(signal, SIG_DFL);
}

} // namespace

InterruptGuard::InterruptGuard(gi::StopRequest& stop)
{
    g_stop = &stop;
    std::signal(SIGINT, handle);
    std::signal(SIGTERM, handle);
}

InterruptGuard::~InterruptGuard()
{
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
    g_stop = nullptr;
}

} // namespace viewer
