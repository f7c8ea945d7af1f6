#include "viewer/experiment/experimenter.h"

#include "gi/core/error.h"

#include <cstdio>

namespace viewer {

using study::ExperimenterAction;

Experimenter::Experimenter(RemoteOptions const& remote, gi::Report& report)
{
    if (remote.socket.empty() && !remote.port) return;
    server_ = std::make_unique<RemoteServer>(
        remote, [this](RemoteRequest const& request) { return handle(request); }, report);
    if (remote.port) std::fputs(("note: " + describe_port(*server_) + "\n").c_str(), stderr);
}

void Experimenter::poll(double now_s)
{
    now_s_ = now_s;
    if (server_) server_->poll();
}

void Experimenter::note(double time_s, std::string kind, std::string text)
{
    notes_.push_back({time_s, std::move(kind), std::move(text)});
}

void Experimenter::abort(std::string why)
{
    if (wish_ == ExperimenterAction::abort) return;
    wish_ = ExperimenterAction::abort;
    why_aborted_ = std::move(why);
}

void Experimenter::check_aborted() const
{
    if (wish_ != ExperimenterAction::abort) return;
    if (why_aborted_.empty()) throw study::Aborted();
    throw study::Aborted(why_aborted_);
}

std::optional<nlohmann::json> Experimenter::handle(RemoteRequest const& r)
{
    if (r.what == "ping") return nlohmann::json::object();
    if (r.what == "quit") {
        wish_ = ExperimenterAction::abort;
        return nlohmann::json::object();
    }
    if (r.what != "session")
        throw gi::InputError("'" + r.what + "'", "a running experiment accepts only session, ping and quit",
                             "send one of these");
    std::string const action = r.arguments.at("action").get<std::string>();
    std::string const text = r.has("text") ? r.arguments.at("text").get<std::string>() : "";
    if (action == "note") {
        if (text.find_first_not_of(" \t\r\n") == std::string::npos)
            throw gi::InputError("a note without text", "nothing would be noted", "give its text");
        note(now_s_, "note", text);
    } else if (action == "pause") {
        paused_ = true;
        note(now_s_, "pause", text);
    } else if (action == "go_on") {
        if (paused_) note(now_s_, "resume", text);
        paused_ = false;
    } else if (action == "skip" || action == "abort") {
        wish_ = action == "skip" ? ExperimenterAction::skip : ExperimenterAction::abort;
        paused_ = false;
        note(now_s_, action, text);
    }
    return nlohmann::json{{"experiment", status.experiment},
                          {"participant", status.participant},
                          {"doing", status.doing},
                          {"trials_done", status.trials_done},
                          {"trials_planned", status.trials_planned},
                          {"bad_trials", status.bad_trials},
                          {"seconds", now_s_ - status.started_s},
                          {"last", status.last},
                          {"paused", paused_}};
}

} // namespace viewer
