#pragma once
// What the remote control can ask of the viewer (docs/remote.md).

#include "viewer/app/controls.h"
#include "viewer/app/view_state.h"
#include "viewer/protocol/remote/remote_server.h"

#include <future>
#include <list>

namespace viewer {

class Requests {
public:
    /// Both outlive it.
    Requests(ViewState& state, Controls& controls, gi::Report& report)
        : state_(state), controls_(controls), report_(report)
    {
    }
    /// As RemoteServer::Handler.
    std::optional<nlohmann::json> handle(RemoteRequest const& request);
    /// Answers those that waited for it. @param shown_s  when the window showed what there is
    void presented(double shown_s, glm::ivec2 window_px, std::vector<unsigned char> const& window_bytes);
    /// Before input is read: releases of keys that were tapped.
    void step();
    void answer_with(RemoteServer* server) { server_ = server; }
    /// Window bytes are needed with the next presentation.
    bool wants_bytes() const { return !shots_.empty(); }
    nlohmann::json stats() const;

private:
    struct Shot {
        std::string file;
        int view = -1; ///< -1 = the window
        bool converged = false;
        double since_s = 0;     ///< the last change before it
        bool has_frame = false; ///< that comes even where the picture rests
        std::uint64_t token = 0;
    };
    struct Key {
        double pressed_s = 0;
        std::uint64_t token = 0;
        gi::dmat4 camera{1}; ///< before
    };
    struct Loaded {
        double asked_s = 0;
        std::uint64_t token = 0;
    };
    nlohmann::json camera(RemoteRequest const& r);
    void load(RemoteRequest const& r);
    void press(RemoteRequest const& r);
    void pick(RemoteRequest const& r);
    bool has_seen(double changed_s) const { return state_.frame && state_.frame->order.pose_s >= changed_s; }
    void save(Shot const& shot, glm::ivec2 window_px, std::vector<unsigned char> const& bytes);

    ViewState& state_;
    Controls& controls_;
    gi::Report& report_;
    RemoteServer* server_ = nullptr;
    std::vector<std::future<void>> saving_;
    std::list<Shot> shots_;
    std::list<Key> keys_;
    std::list<Loaded> loads_;
    double changed_s_ = 0;                         ///< when something was asked last that pictures may show
    double stepped_s_ = 0;                         ///< what was asked before is on its way to the renderer
    std::vector<std::pair<double, int>> releases_; ///< session time, key code
};

} // namespace viewer
