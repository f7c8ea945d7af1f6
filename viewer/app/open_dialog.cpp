#include "viewer/app/open_dialog.h"

#include "gi/core/file.h"
#include "gi/scene/load/load.h"

#include <algorithm>
#include <array>
#include <imgui.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostEntries = 5000;

bool is_scene(fs::path const& file)
{
    static std::vector<std::string> const endings = gi::scene_extensions();
    return file.filename() == "sequence.json" ||
           std::ranges::find(endings, gi::lower_extension(file)) != endings.end();
}

/// A clickable line; true if it was clicked. @param shown  may differ from the name that identifies the line
bool line(std::string const& shown, std::string const& id)
{
    return ImGui::Selectable((shown + "##" + id).c_str());
}

} // namespace

FolderContents contents_of(fs::path const& folder)
{
    FolderContents c;
    std::error_code failure;
    for (fs::directory_iterator at(folder, fs::directory_options::skip_permission_denied, failure), end;
         !failure && at != end; at.increment(failure)) {
        std::string const name = at->path().filename().string();
        if (name.starts_with('.')) continue;
        if (c.folders.size() + c.files.size() >= kMostEntries) {
            c.cut = true;
            break;
        }
        std::error_code unknown;
        if (at->is_directory(unknown))
            c.folders.push_back(name);
        else if (is_scene(at->path()))
            c.files.push_back(name);
    }
    if (failure) c.problem = failure.message();
    std::ranges::sort(c.folders);
    std::ranges::sort(c.files);
    return c;
}

void OpenDialog::go_to(fs::path const& folder)
{
    folder_ = folder.lexically_normal();
    contents_ = contents_of(folder_);
    filter_.clear();
}

void OpenDialog::toggle(std::string const& scene)
{
    open_ = !open_;
    if (!open_) return;
    std::error_code failure;
    fs::path folder = fs::current_path(failure);
    if (fs::exists(scene, failure)) folder = fs::absolute(scene, failure).parent_path();
    recently_ = recent_.read();
    built_in_ = gi::built_in_scenes();
    go_to(folder);
}

std::optional<std::string> OpenDialog::draw()
{
    if (!open_) return {};
    std::optional<std::string> chosen;
    fs::path next;
    float const em = ImGui::GetFontSize();
    ImVec2 const screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(screen.x / 2, screen.y / 2), ImGuiCond_Appearing, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(std::min(36 * em, 0.9f * screen.x), std::min(30 * em, 0.9f * screen.y)),
                             ImGuiCond_Appearing);
    if (ImGui::Begin("Open a scene", &open_, ImGuiWindowFlags_NoSavedSettings)) {
        ImGui::TextUnformatted("Built in:");
        for (std::string const& name : built_in_) {
            ImGui::SameLine();
            if (ImGui::SmallButton(name.c_str())) chosen = name;
        }
        if (!recently_.empty() && ImGui::CollapsingHeader("Recent", ImGuiTreeNodeFlags_DefaultOpen))
            for (std::string const& file : recently_) {
                if (line(fs::path(file).filename().string(), "recent " + file)) chosen = file;
                if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", file.c_str());
            }
        ImGui::Separator();
        ImGui::TextWrapped("%s", folder_.c_str());
        std::array<char, 128> text{};
        std::copy_n(filter_.begin(), std::min(filter_.size(), text.size() - 1), text.begin());
        ImGui::SetNextItemWidth(-1);
        if (ImGui::InputTextWithHint("##filter", "part of a name", text.data(), text.size()))
            filter_ = text.data();
        ImGui::BeginChild("files");
        if (folder_.has_relative_path() && line("..", "up")) next = folder_.parent_path();
        auto const matches = [&](std::string const& name) { return name.find(filter_) != std::string::npos; };
        for (std::string const& name : contents_.folders)
            if (matches(name) && line(name + "/", "folder " + name)) next = folder_ / name;
        for (std::string const& name : contents_.files)
            if (matches(name) && line(name, "file " + name)) chosen = (folder_ / name).string();
        if (!contents_.problem.empty()) ImGui::TextWrapped("cannot be read: %s", contents_.problem.c_str());
        if (contents_.cut) ImGui::TextDisabled("(the first %d entries)", int(kMostEntries));
        ImGui::EndChild();
    }
    ImGui::End();
    if (!next.empty()) go_to(next);
    if (chosen) open_ = false;
    return chosen;
}

} // namespace viewer
