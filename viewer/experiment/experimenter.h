#pragma once
// The experimenter's control of a running session: actions and notes through the remote protocol ("session"), from
// `lightwell study control` or any other program, also from another terminal or machine (ssh).

#include "study/run/presenter.h"
#include "viewer/protocol/remote/remote_server.h"

namespace viewer {

/// State of a running session.
struct SessionStatus {
    std::string experiment, participant, doing; ///< doing: "trial 3 of 80, similarity"
    int trials_done = 0, trials_planned = 0;
    double started_s = 0; ///< steady clock
    int bad_trials = 0;
    std::string last; ///< answer and reaction time of the last trial
};

class Experimenter {
public:
    /// @param remote  where it listens; may be empty   @param report  must outlive this
    Experimenter(RemoteOptions const& remote, gi::Report& report);

    /// Reads requests. Never blocks.
    void poll(double now_s);
    SessionStatus status;

    bool is_paused() const { return paused_; }
    /// True if skip or abort was requested and not yet taken.
    bool wants_end() const
    {
        return wish_ == study::ExperimenterAction::skip || wish_ == study::ExperimenterAction::abort;
    }
    study::ExperimenterAction action() const { return wish_; }
    study::ExperimenterAction take_wish() { return std::exchange(wish_, study::ExperimenterAction::go_on); }
    std::vector<study::NoteTaken> take_notes() { return std::exchange(notes_, {}); }
    /// Adds a note from a key in the participant's window, or from the program itself.
    void note(double time_s, std::string kind, std::string text);
    /// Ends the session; only the first call counts. @param why  e.g. "aborted by the participant"
    void abort(std::string why);
    /// Throws Aborted, with the reason, if an abort was requested.
    void check_aborted() const;

private:
    std::optional<nlohmann::json> handle(RemoteRequest const& request);

    study::ExperimenterAction wish_ = study::ExperimenterAction::go_on;
    std::string why_aborted_; ///< empty = aborted by the experimenter
    bool paused_ = false;
    std::vector<study::NoteTaken> notes_;
    double now_s_ = 0;
    std::unique_ptr<RemoteServer> server_;
};

} // namespace viewer
