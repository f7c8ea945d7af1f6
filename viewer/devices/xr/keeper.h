#pragma once
// Keeps a headset session available: a lost session is destroyed and a new one created.

#include "viewer/devices/xr/session.h"

namespace viewer {

class HmdKeeper {
public:
    /// Creates the first session; throws InputError as HmdSession does.
    /// The context must outlive this; nullptr = poses only.
    HmdKeeper(GlContext const* context, HmdOptions const& options);

    /// Polls the session. After a loss, destroys it and tries to create another, at most once per second. Returns
    /// nullptr while there is none, or after it has ended on request.
    HmdSession* poll();
    /// Reason why there is no session: "lost: ...", or the error of the last attempt.
    std::string const& trouble() const { return trouble_; }
    bool ended() const { return ended_; }
    /// Number of sessions lost so far.
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
