#pragma once
// Handles the requests of the remote control (docs/remote.md).

#include "viewer/app/controls.h"
#include "viewer/app/screenshot.h"
#include "viewer/app/view_state.h"
#include "viewer/protocol/remote/remote_server.h"

#include <future>
#include <list>

namespace viewer {

class Requests {
public:
    /// All arguments must outlive it.
    Requests(ViewState& state, Controls& controls, gi::Report& report)
        : state_(state), controls_(controls), report_(report)
    {
    }
    /// As RemoteServer::Handler.
    std::optional<nlohmann::json> handle(RemoteRequest const& request);
    /// Answers requests that waited for a frame to be shown.
    /// @param shown_s  when the window showed the current frame
    /// @param shot  the windows' or eyes' picture; empty if it was not asked for
    void presented(double shown_s, Snapshot const& shot);
    /// The windows' picture cannot be had: refuses requests for it. @param why  empty = it can
    void no_picture(std::string const& why) { no_picture_ = why; }
    /// Call before input is read: releases tapped keys.
    void step();
    /// Call when a scene is loaded: handles the requests that waited for it.
    void begin();
    void answer_with(RemoteServer* server) { server_ = server; }
    /// True if the next call of presented() needs the window's bytes.
    bool wants_bytes() const { return !shots_.empty(); }
    nlohmann::json stats() const;

private:
    struct Shot {
        std::string file;
        int view = -1; ///< -1 = the window
        bool converged = false;
        double since_s = 0;     ///< time of the last change before the request
        bool has_frame = false; ///< a new frame was requested, in case the picture rests
        std::uint64_t token = 0;
    };
    struct Key {
        double pressed_s = 0;
        std::uint64_t token = 0;
        gi::dmat4 camera{1}; ///< before the key press
    };
    struct Loaded {
        double asked_s = 0;
        std::uint64_t token = 0;
    };
    nlohmann::json camera(RemoteRequest const& r);
    void load(RemoteRequest const& r);
    void press(RemoteRequest const& r);
    void pick(RemoteRequest const& r);
    bool has_seen(double changed_s) const { return state_.frame && state_.frame->command.pose_s >= changed_s; }
    void save(Shot const& shot, Snapshot const& picture);

    /// True for requests that wait: for the first scene, or for one that an earlier request loads.
    bool waits(RemoteRequest const& request) const;

    ViewState& state_;
    Controls& controls_;
    gi::Report& report_;
    RemoteServer* server_ = nullptr;
    std::vector<std::future<void>> saving_;
    std::list<Shot> shots_;
    std::string no_picture_;
    std::list<Key> keys_;
    std::list<Loaded> loads_;
    std::vector<RemoteRequest> early_;             ///< that wait for a scene
    int loading_ = 0;                              ///< requests to load that are not done
    double changed_s_ = 0;                         ///< time of the last request that may change the picture
    double stepped_s_ = 0;                         ///< requests before this time were passed to the renderer
    std::vector<std::pair<double, int>> releases_; ///< session time, key code
};

} // namespace viewer
