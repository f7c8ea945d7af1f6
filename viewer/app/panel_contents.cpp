#include "viewer/app/panel_contents.h"

#include "gi/core/error.h"

#include <algorithm>
#include <fmt/format.h>
#include <imgui.h>

namespace viewer {
namespace {

void try_change(ViewState& s, Change const& c)
{
    try {
        s.change(c);
        s.message.clear();
    } catch (gi::InputError const& e) {
        s.message = e.what();
    }
}

void edit_setting(ViewState& s, SettingKey const& k)
{
    nlohmann::json const value = get(s.settings(), k.key);
    std::string const label = label_of(k), id = "##" + k.key;
    bool const is_box = k.type == gi::OptionType::yes_or_no;
    bool hovered = false;
    if (!is_box) {
        ImGui::TextUnformatted(label.c_str());
        hovered = ImGui::IsItemHovered();
        ImGui::SetNextItemWidth(-1);
    }
    if (is_box) {
        bool on = value.get<bool>();
        if (ImGui::Checkbox((label + id).c_str(), &on)) try_change(s, {k.key, on});
    } else if (k.type == gi::OptionType::word) {
        std::string const now = value.get<std::string>();
        if (ImGui::BeginCombo(id.c_str(), now.empty() ? "(none)" : now.c_str())) {
            for (std::string const& w : k.words)
                if (ImGui::Selectable(w.empty() ? "(none)" : w.c_str(), w == now)) try_change(s, {k.key, w});
            ImGui::EndCombo();
        }
    } else if (k.type == gi::OptionType::whole_number) {
        int n = value.get<int>();
        bool const done = ImGui::InputInt(id.c_str(), &n, 1, 16, ImGuiInputTextFlags_EnterReturnsTrue);
        if (done || (n != value.get<int>() && ImGui::IsItemDeactivated())) try_change(s, {k.key, n});
    } else {
        float v = value.get<float>();
        bool const narrow = k.high - k.low <= 64;
        bool const moved =
            narrow ? ImGui::SliderFloat(id.c_str(), &v, float(k.low), float(k.high))
                   : ImGui::InputFloat(id.c_str(), &v, 0, 0, "%.3f", ImGuiInputTextFlags_EnterReturnsTrue);
        if (moved) try_change(s, {k.key, double(v)});
    }
    if (hovered || ImGui::IsItemHovered())
        ImGui::SetTooltip("%s\n%s, %s", k.meaning.c_str(), k.key.c_str(), k.values_text().c_str());
}

/// Settings that the methods in use read, under the headings of their groups, the viewer's own first.
void edit_settings(ViewState& s)
{
    auto const is_read = [&](SettingKey const& k) {
        return k.is_offered() && (k.option == nullptr || k.option->read_by(s.settings().method) ||
                                  k.option->read_by(s.settings().compare));
    };
    std::vector<std::string> groups{""};
    for (SettingKey const& k : setting_keys())
        if (is_read(k) && std::ranges::find(groups, k.group) == groups.end()) groups.push_back(k.group);
    for (std::string const& group : groups)
        if (ImGui::CollapsingHeader(group.empty() ? "Settings" : group.c_str()))
            for (SettingKey const& k : setting_keys())
                if (k.group == group && is_read(k)) edit_setting(s, k);
}

void show_numbers(ViewState& s, double frames_per_s)
{
    ImGui::TextWrapped("%s: %u triangles", s.facts.scene.c_str(), s.facts.triangles);
    if (!s.frame) return;
    LiveFrame const& f = *s.frame;
    ViewCommand const& v = f.command.views[0];
    ImGui::Text("%.1f Hz, frame %.1f ms", frames_per_s, 1e3 * (f.done_s - f.begun_s));
    std::size_t const views = f.command.views.size();
    ImGui::TextWrapped("%s%d x %d, %d path%s per pixel", views > 1 ? fmt::format("{} views of ", views).c_str() : "",
                       v.width, v.height, f.command.paths, f.command.paths == 1 ? "" : "s");
    ImGui::ProgressBar(float(f.still_paths) / float(kConvergedPaths), ImVec2(-1, 0),
                       fmt::format("{} paths while still", f.still_paths).c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("rests at %u", kConvergedPaths);
    for (std::string const& line : frame_notes(s, f)) ImGui::TextWrapped("%s", line.c_str());
    if (s.live_error)
        ImGui::Text("%s - %s: relMSE %.2e, FLIP %.4f", s.settings().method.c_str(), s.settings().compare.c_str(),
                    s.live_error->relmse, s.live_error->flip);
    if (!f.result.options.empty() && ImGui::IsItemHovered()) ImGui::SetTooltip("%s", f.result.options.c_str());
    if (!f.schedule.empty()) ImGui::TextWrapped("%s", f.schedule.c_str());
    if (ImGui::TreeNode("stages")) {
        for (auto const& [stage, seconds] : f.result.stages_s)
            ImGui::Text("%7.2f ms  %s", 1e3 * seconds, stage.c_str());
        ImGui::TreePop();
    }
}

void edit_material(ViewState& s, SceneFacts::Named& m, std::size_t index)
{
    std::string const key = fmt::format("material.{}.", index);
    auto const numbers = [](gi::vec3 v) { return nlohmann::json{double(v.x), double(v.y), double(v.z)}; };
    if (ImGui::ColorEdit3("base colour", &m.material.base_color.x, ImGuiColorEditFlags_Float))
        try_change(s, {key + "base_color", numbers(m.material.base_color)});
    if (ImGui::SliderFloat("roughness", &m.material.roughness, 0, 1))
        try_change(s, {key + "roughness", double(m.material.roughness)});
    if (ImGui::SliderFloat("metallic", &m.material.metallic, 0, 1))
        try_change(s, {key + "metallic", double(m.material.metallic)});
    if (ImGui::DragFloat3("emission", &m.material.emission.x, 0.1f, 0, 1e6f))
        try_change(s, {key + "emission", numbers(m.material.emission)});
}

void edit_scene(ViewState& s)
{
    if (s.selection && ImGui::CollapsingHeader("Selected", ImGuiTreeNodeFlags_DefaultOpen)) {
        Selection const& chosen = *s.selection;
        ImGui::Text("%s, material %s, %.3f m away", chosen.object.c_str(), chosen.material.c_str(),
                    chosen.picked.distance_m);
        if (chosen.picked.material < s.facts.materials.size())
            edit_material(s, s.facts.materials[chosen.picked.material], chosen.picked.material);
    }
    if (!s.facts.lights.empty() && ImGui::CollapsingHeader("Lights"))
        for (std::size_t i = 0; i < s.facts.lights.size(); ++i) {
            ImGui::PushID(int(i));
            gi::vec3& v = s.facts.lights[i].intensity;
            if (ImGui::DragFloat3(fmt::format("{}", i).c_str(), &v.x, 0.1f, 0, 1e9f))
                try_change(s, {fmt::format("light.{}.intensity", i), {double(v.x), double(v.y), double(v.z)}});
            ImGui::PopID();
        }
    if (!s.facts.materials.empty() && ImGui::CollapsingHeader("Materials"))
        for (std::size_t i = 0; i < s.facts.materials.size(); ++i) {
            ImGui::PushID(int(i));
            if (ImGui::TreeNode(s.facts.materials[i].name.c_str())) {
                edit_material(s, s.facts.materials[i], i);
                ImGui::TreePop();
            }
            ImGui::PopID();
        }
    if (s.facts.has_environment && ImGui::CollapsingHeader("Environment")) {
        if (ImGui::SliderAngle("rotation", &s.facts.environment_rotation_rad))
            try_change(s, {"environment.rotation", double(s.facts.environment_rotation_rad)});
        if (ImGui::DragFloat("scale", &s.facts.environment_scale, 0.01f, 0, 1e6f))
            try_change(s, {"environment.scale", double(s.facts.environment_scale)});
    }
}

} // namespace

std::vector<std::string> frame_notes(ViewState const& s, LiveFrame const& f)
{
    std::vector<std::string> notes;
    bool const still = f.result.still_frames > 1;
    if (s.facts.moves && s.settings().play && s.settings().speed != 0)
        notes.emplace_back("Animation plays: press space to let the picture refine");
    else if (still && !s.settings().refine)
        notes.emplace_back("Refinement of still pictures is off");
    if (!still && (f.budget.scale < 1 || s.settings().paths == 0))
        notes.push_back(fmt::format("For up to {:g} Hz: {} path{} per pixel, {:.0f} % of the window's width{}",
                                    f.settings.rate_hz, f.command.paths, f.command.paths == 1 ? "" : "s",
                                    100 * f.budget.scale,
                                    f.budget.surfaces > f.budget.scale
                                        ? fmt::format(" for light, {:.0f} % for surfaces", 100 * f.budget.surfaces)
                                        : ""));
    if (s.settings().auto_exposure != "off")
        notes.push_back(fmt::format("Exposure {:+.2f} stops, {} (T)", s.settings().exposure_ev,
                                    s.settings().auto_exposure == "on" ? "automatic" : "held"));
    return notes;
}

void fill_panel(ViewState& s, double frames_per_s)
{
    ImGui::SetNextWindowPos(ImVec2(8, 8), ImGuiCond_FirstUseEver);
    float const em = ImGui::GetFontSize();
    ImVec2 const screen = ImGui::GetIO().DisplaySize;
    constexpr float kShare = 0.35f; // of a small window's width, so that the picture is seen beside it
    ImGui::SetNextWindowSize(ImVec2(std::min(24 * em, kShare * screen.x), std::min(34 * em, screen.y - 16)),
                             ImGuiCond_FirstUseEver);
    if (ImGui::Begin("Lightwell  (F1 hides this)")) {
        show_numbers(s, frames_per_s);
        if (!s.message.empty()) ImGui::TextWrapped("%s", s.message.c_str());
        if (ImGui::Button("open scene")) s.open_dialog.toggle(s.facts.scene);
        ImGui::SameLine();
        if (ImGui::Button("help")) s.shows_help = !s.shows_help;
        if (ImGui::Button("screenshot")) s.wants_screenshot = s.own_screenshot = true;
        ImGui::SameLine();
        if (ImGui::Button("first camera")) s.navigation.go_to(s.first_camera.world_from_camera);
        if (ImGui::Button(name_of(s.navigation.mode())))
            s.navigation.set_mode(NavigationMode((int(s.navigation.mode()) + 1) % 3));
        edit_settings(s);
        ImGui::PushItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
        edit_scene(s);
        ImGui::PopItemWidth();
    }
    ImGui::End();
}

} // namespace viewer
