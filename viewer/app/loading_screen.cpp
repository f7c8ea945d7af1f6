#include "viewer/app/loading_screen.h"

#include <filesystem>
#include <fmt/format.h>
#include <imgui.h>

namespace viewer {
namespace {

constexpr ImGuiWindowFlags kPlain = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                    ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                                    ImGuiWindowFlags_NoFocusOnAppearing;

std::string file_name(std::string const& scene)
{
    std::string const name = std::filesystem::path(scene).filename().string();
    return name.empty() ? scene : name;
}

/// Begins a window at a place given in shares of the screen, whose own point of the same shares is put there.
void begin_at(char const* name, ImVec2 share)
{
    ImVec2 const size = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(share.x * size.x, share.y * size.y), ImGuiCond_Always, share);
    ImGui::SetNextWindowBgAlpha(0.7f);
    ImGui::Begin(name, nullptr, kPlain);
}

} // namespace

void fill_loading(LoadProgress const& p, LoadingPlace where)
{
    bool const alone = where == LoadingPlace::alone;
    begin_at("loading", alone ? ImVec2(0.5f, 0.5f) : ImVec2(0.5f, 1));
    if (alone) ImGui::TextUnformatted("Lightwell");
    ImGui::TextUnformatted(text_of({file_name(p.scene), p.step, p.elapsed_s, p.fraction}).c_str());
    float const width = std::min(24 * ImGui::GetFontSize(), 0.9f * ImGui::GetIO().DisplaySize.x);
    ImGui::ProgressBar(float(p.fraction), ImVec2(width, 0.4f * ImGui::GetFontSize()), "");
    if (alone) ImGui::TextDisabled("Esc ends the program");
    ImGui::End();
}

void fill_building(LoadProgress const& p)
{
    begin_at("building", ImVec2(0.5f, 1));
    std::string const counted = p.step.of > 0 ? fmt::format(" {} of {}", p.step.done, p.step.of) : "";
    ImGui::TextUnformatted(fmt::format("next picture: {}{}, {:.1f} s", p.step.what, counted, p.elapsed_s).c_str());
    ImGui::End();
}

void fill_help(std::span<KeyMeaning const> keys)
{
    begin_at("help", ImVec2(0.5f, 0.5f));
    if (ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
        for (KeyMeaning const& k : keys) {
            ImGui::TableNextRow();
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(k.keys);
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(k.meaning);
        }
        ImGui::EndTable();
    }
    ImGui::TextDisabled("H closes this. Everything else: docs/viewer.md");
    ImGui::End();
}

void fill_message(std::string const& message)
{
    begin_at("message", ImVec2(0.5f, 0));
    ImGui::PushTextWrapPos(std::min(40 * ImGui::GetFontSize(), 0.9f * ImGui::GetIO().DisplaySize.x));
    ImGui::TextUnformatted(message.c_str());
    ImGui::PopTextWrapPos();
    ImGui::End();
}

} // namespace viewer
