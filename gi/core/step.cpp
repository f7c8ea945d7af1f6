#include "gi/core/step.h"

#include <utility>

namespace gi {
namespace {

thread_local StepListener* g_listener = nullptr;

} // namespace

StepListener::StepListener(std::function<void(Step const&)> hear, StopRequest const* stop)
    : stop_(stop), hear_(std::move(hear)), before_(std::exchange(g_listener, this))
{
}

StepListener::~StepListener() { g_listener = before_; }

StopRequest const* stop_of_steps() { return g_listener != nullptr ? g_listener->stop_ : nullptr; }

void at_step(char const* what, std::uint64_t done, std::uint64_t of)
{
    if (g_listener != nullptr) g_listener->hear_({what, done, of});
}

} // namespace gi
