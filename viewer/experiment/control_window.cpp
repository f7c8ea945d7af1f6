#include "viewer/experiment/control_window.h"

#include "gi/core/error.h"
#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/panel.h"
#include "viewer/protocol/remote/remote_client.h"
#include "viewer/protocol/remote/remote_token.h"

#include <array>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <imgui.h>

namespace viewer {
namespace {

constexpr double kAsk_s = 0.2;
constexpr std::chrono::milliseconds kAnswer{10000};

RemoteClient connect(std::string const& where, std::string const& token_file)
{
    if (!token_file.empty()) read_token(token_file); // says itself what is wrong
    try {
        return RemoteClient(where, token_file);
    } catch (gi::InputError const&) { // its suggestion applies to the viewer only
        throw gi::InputError("cannot connect to '" + where + "'", "no session listens there, or not to this user",
                             "start lightwell study run with --remote and name the same, or the digits of its "
                             "--remote-port");
    }
}

class Control {
public:
    Control(std::string const& where, std::string const& token_file) : client_(connect(where, token_file)) {}

    /// Sends a request. Returns false if the session has ended.
    bool ask(std::string const& action, std::string const& text = {})
    {
        nlohmann::json request{{"do", "session"}, {"action", action}};
        if (!text.empty()) request["text"] = text;
        try {
            nlohmann::json const answer = client_.ask(std::move(request), kAnswer);
            if (answer.contains("result")) status_ = answer.at("result");
            problem_ = answer.value("error", "");
        } catch (gi::InputError const& e) {
            problem_ = e.what();
            return false;
        }
        return true;
    }
    std::string const& problem() const { return problem_; }

    /// Draws the window. Returns false if the session has ended.
    bool draw(ImVec2 size)
    {
        bool there = true;
        ImGui::SetNextWindowPos({0, 0});
        ImGui::SetNextWindowSize(size);
        ImGui::Begin("session", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
        std::string const who = status_.value("participant", "");
        ImGui::Text("%s %s", status_.value("experiment", "").c_str(), who.c_str());
        ImGui::Text("%s", status_.value("doing", "").c_str());
        int const done = status_.value("trials_done", 0), planned = status_.value("trials_planned", 0);
        ImGui::ProgressBar(planned > 0 ? float(done) / float(planned) : 0, ImVec2(-1, 0),
                           fmt::format("{} of {} trials", done, planned).c_str());
        int const s = int(status_.value("seconds", 0.0));
        ImGui::Text("%d:%02d min, %d bad trials", s / 60, s % 60, status_.value("bad_trials", 0));
        ImGui::Text("last answer: %s", status_.value("last", "").c_str());
        ImGui::Separator();
        bool const paused = status_.value("paused", false);
        if (ImGui::Button(paused ? "go on" : "pause")) there &= ask(paused ? "go_on" : "pause");
        ImGui::SameLine();
        if (ImGui::Button("skip this step")) there &= ask("skip");
        ImGui::SameLine();
        if (ImGui::Button("abort ...")) ImGui::OpenPopup("abort");
        if (ImGui::BeginPopup("abort")) {
            ImGui::TextUnformatted("End the session? What is done is kept; it can go on later.");
            if (ImGui::Button("end it")) {
                there &= ask("abort");
                ImGui::CloseCurrentPopup();
            }
            ImGui::SameLine();
            if (ImGui::Button("no")) ImGui::CloseCurrentPopup();
            ImGui::EndPopup();
        }
        ImGui::InputText("##note", note_.data(), note_.size());
        ImGui::SameLine();
        if (ImGui::Button("note") && note_[0] != '\0') {
            there &= ask("note", note_.data());
            note_.fill('\0');
        }
        if (!problem_.empty()) ImGui::TextWrapped("%s", problem_.c_str());
        ImGui::End();
        return there;
    }

private:
    RemoteClient client_;
    nlohmann::json status_ = nlohmann::json::object();
    std::string problem_;
    std::array<char, 400> note_{};
};

} // namespace

void run_control_window(std::string const& where, std::string const& token_file, gi::StopRequest const& stop,
                        gi::Report& report)
{
    Control control(where, token_file);
    if (!control.ask("status"))
        throw gi::InputError("'" + where + "'", control.problem(), "give the --remote of a running study run");
    WindowSettings settings;
    settings.title = "Lightwell: experimenter";
    settings.size_px = {520, 300};
    Window window(settings, report);
    Panel panel(window, 16);
    auto asked = std::chrono::steady_clock::now();
    bool there = true;
    while (there && !stop.requested() && !window.wants_close()) {
        wait_for_windows(1.0 / 30);
        window.take_events();
        auto const now = std::chrono::steady_clock::now();
        if (std::chrono::duration<double>(now - asked).count() > kAsk_s) {
            there = control.ask("status");
            asked = now;
        }
        panel.begin();
        glm::vec2 const px = window.framebuffer_px();
        there = control.draw({px.x, px.y}) && there;
        panel.finish();
        clear(target_of(window), 0.2f);
        panel.draw();
        window.swap();
    }
}

} // namespace viewer
