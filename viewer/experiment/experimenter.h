#pragma once
// The experimenter's hand on a running session: wishes and notes through the remote protocol ("session"), from
// `lightwell study control` or any other program, also from another terminal or machine (ssh).

#include "study/run/presenter.h"
#include "viewer/protocol/remote/remote_server.h"

namespace viewer {

/// What a running session is at.
struct SessionStatus {
    std::string experiment, participant, doing; ///< doing: "trial 3 of 80, similarity"
    int trials_done = 0, trials_planned = 0;
    double started_s = 0; ///< steady clock
    int bad_trials = 0;
    std::string last; ///< of the last trial: its answer and reaction time
};

class Experimenter {
public:
    /// @param remote  where it listens; may be nowhere   @param report  outlives it
    Experimenter(RemoteOptions const& remote, gi::Report& report);

    /// Reads requests. Never blocks.
    void poll(double now_s);
    SessionStatus status;

    bool is_paused() const { return paused_; }
    /// Skip or abort were asked for and not yet taken.
    bool wants_end() const
    {
        return wish_ == study::ExperimenterAction::skip || wish_ == study::ExperimenterAction::abort;
    }
    study::ExperimenterAction action() const { return wish_; }
    study::ExperimenterAction take_wish() { return std::exchange(wish_, study::ExperimenterAction::go_on); }
    std::vector<study::NoteTaken> take_notes() { return std::exchange(notes_, {}); }
    /// By a key of the participant's window, or what the machine saw.
    void note(double time_s, std::string kind, std::string text);
    /// Ends the session; who does it first counts. @param why  "aborted by the participant"
    void abort(std::string why);
    /// Throws Aborted, with who wanted it, where an abort was asked for.
    void check_aborted() const;

private:
    std::optional<nlohmann::json> handle(RemoteRequest const& request);

    study::ExperimenterAction wish_ = study::ExperimenterAction::go_on;
    std::string why_aborted_; ///< empty = the experimenter wanted it
    bool paused_ = false;
    std::vector<study::NoteTaken> notes_;
    double now_s_ = 0;
    std::unique_ptr<RemoteServer> server_;
};

} // namespace viewer
