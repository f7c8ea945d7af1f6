#pragma once
// Keeps a session with a headset alive over losses: a lost one is destroyed and another built.

#include "viewer/devices/xr/session.h"

namespace viewer {

class HmdKeeper {
public:
    /// Builds the first session; throws InputError as it does. The context outlives this; nullptr = poses only.
    HmdKeeper(GlContext const* context, HmdOptions const& options);

    /// Polls the session. After a loss destroys it and tries to build another, at most once a second; nullptr
    /// while there is none, or once it has ended for good because it was asked to.
    HmdSession* poll();
    /// What is wrong while there is no session: "lost: ...", and why the last attempt failed.
    std::string const& trouble() const { return trouble_; }
    bool ended() const { return ended_; }
    /// Sessions lost so far.
    int losses() const { return losses_; }

private:
    void build();

    GlContext const* context_;
    HmdOptions options_;
    std::unique_ptr<HmdSession> session_;
    std::string trouble_;
    double next_attempt_s_ = 0; ///< steady_clock
    bool ended_ = false;
    int losses_ = 0;
};

} // namespace viewer
