#include "viewer/devices/xr/keeper.h"

#include "gi/core/error.h"

#include <chrono>

namespace viewer {
namespace {

double seconds_now()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

HmdKeeper::HmdKeeper(GlContext const* context, HmdOptions const& options) : context_(context), options_(options)
{
    build();
}

void HmdKeeper::build()
{
    session_ =
        context_ ? std::make_unique<HmdSession>(*context_, options_) : std::make_unique<HmdSession>(options_);
}

HmdSession* HmdKeeper::poll()
{
    if (session_ && session_->poll() == HmdPhase::ended) {
        ended_ = true;
        trouble_ = session_->why();
        session_.reset();
    } else if (session_ && session_->phase() == HmdPhase::lost) {
        ++losses_;
        trouble_ = "lost: " + session_->why();
        session_.reset();
        next_attempt_s_ = seconds_now() + 1;
    }
    if (session_ || ended_ || seconds_now() < next_attempt_s_) return session_.get();
    try {
        build();
        trouble_.clear();
    } catch (gi::InputError const& e) {
        trouble_ = e.what();
        next_attempt_s_ = seconds_now() + 1;
    }
    return session_.get();
}

} // namespace viewer
