#include "viewer/app/panel_contents.h"

#include "gi/core/error.h"
#include "viewer/engine/quality.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
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

/// Wrapped text beside the pointer, if the last item is under it.
void explain(std::string const& text)
{
    if (!ImGui::IsItemHovered()) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(std::min(28 * ImGui::GetFontSize(), 0.8f * ImGui::GetIO().DisplaySize.x));
    ImGui::TextUnformatted(text.c_str());
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

/// A button, beside the last one if there is room.
bool next_button(char const* text)
{
    float const right = ImGui::GetItemRectMax().x + ImGui::GetStyle().ItemSpacing.x + ImGui::CalcTextSize(text).x +
                        2 * ImGui::GetStyle().FramePadding.x;
    if (right <= ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
    return ImGui::Button(text);
}

/// The label of the next control, which gets the width of the panel.
void label(std::string const& text, std::string const& meaning)
{
    ImGui::TextWrapped("%s", text.c_str());
    explain(meaning);
    ImGui::SetNextItemWidth(-1);
}

void edit_setting(ViewState& s, SettingKey const& k)
{
    nlohmann::json const value = get(s.settings(), k.key);
    std::string const id = "##" + k.key, meaning = fmt::format("{}\n\n{}: {}", k.meaning, k.key, k.values_text());
    if (k.type == gi::OptionType::yes_or_no) {
        bool on = value.get<bool>();
        if (ImGui::Checkbox(id.c_str(), &on)) try_change(s, {k.key, on});
        explain(meaning);
        ImGui::SameLine();
        return label(label_of(k), meaning);
    }
    label(label_of(k), meaning);
    if (k.type == gi::OptionType::word) {
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
    explain(meaning);
}

void edit_quality(ViewState& s)
{
    std::string const meaning = fmt::format(
        "fast: a picture for every movement; exact: what the method computes, without cache, reuse or "
        "filter, finer and finer while nothing moves.\n\nIt sets what is under \"Time against error\", "
        "and the radiance cache. {}: {}",
        kQuality, fmt::join(quality_names(), ", "));
    label("Quality, from fast to exact", meaning);
    auto const found = quality_of(s.settings());
    int step = found ? int(*found) : -1;
    char const* const name = found ? quality_names()[*found].c_str() : "(set one by one)";
    if (ImGui::SliderInt("##quality", &step, 0, int(quality_names().size()) - 1, name, ImGuiSliderFlags_NoInput))
        try_change(s, {kQuality, quality_names()[std::size_t(step)]});
    explain(meaning);
}

/// False for settings of the viewer that change nothing as things are.
bool has_effect(ViewState const& s, std::string const& key)
{
    Settings const& now = s.settings();
    bool const compares = !now.compare.empty(), two_views = s.frame && s.frame->command.views.size() > 1;
    if (key == "view") return compares;
    if (key == "split") return compares && now.view == "split";
    if (key == "play" || key == "speed") return s.facts.moves;
    if (key == "eye_distance" || key == "swap_eyes" || key == "share_eyes") return two_views;
    if (key == "first_surfaces") return now.scale == 0;
    if (key == "draw_surfaces") return now.reproject && !compares && !s.is_one_of_ranks;
    if (key == "reproject") return !s.is_one_of_ranks;
    return key != "updated_axes"; // which the viewer sets itself
}

bool is_shown(ViewState const& s, SettingKey const& k)
{
    Settings const& now = s.settings();
    if (!k.is_offered()) return false;
    if (k.option == nullptr) return has_effect(s, k.key);
    if (k.option->unused && k.option->unused(now.render)) return false;
    return k.option->read_by(now.method) || (!now.compare.empty() && k.option->read_by(now.compare));
}

/// Settings that the methods in use read and that have an effect: the method, then each group under its heading.
void edit_settings(ViewState& s)
{
    constexpr char const* kOfAll = "All methods";
    auto const heading = [](SettingKey const& k) { return k.group.empty() ? kOfAll : k.group.c_str(); };
    std::vector<std::string> headings;
    for (SettingKey const& k : setting_keys()) {
        if (k.key == "method")
            edit_setting(s, k);
        else if (is_shown(s, k) && std::ranges::find(headings, heading(k)) == headings.end())
            headings.emplace_back(heading(k));
    }
    for (std::string const& h : headings)
        if (ImGui::CollapsingHeader(h.c_str()))
            for (SettingKey const& k : setting_keys())
                if (k.key != "method" && heading(k) == h && is_shown(s, k)) edit_setting(s, k);
}

void show_numbers(ViewState& s, double frames_per_s)
{
    if (!s.frame) return;
    LiveFrame const& f = *s.frame;
    ViewCommand const& v = f.command.views[0];
    ImGui::ProgressBar(float(f.still_paths) / float(kConvergedPaths), ImVec2(-1, 0),
                       fmt::format("{} path{}", f.still_paths, f.still_paths == 1 ? "" : "s").c_str());
    explain(fmt::format("paths per pixel since anything moved; at {} the picture is finished", kConvergedPaths));
    for (std::string const& line : frame_notes(s, f)) ImGui::TextWrapped("%s", line.c_str());
    if (s.live_error)
        ImGui::TextWrapped("%s - %s: relMSE %.2e, FLIP %.4f", s.settings().method.c_str(),
                           s.settings().compare.c_str(), s.live_error->relmse, s.live_error->flip);
    if (!ImGui::CollapsingHeader("This picture")) return;
    ImGui::TextWrapped("%s: %u triangles", s.facts.scene.c_str(), s.facts.triangles);
    ImGui::TextWrapped("%.1f pictures a second, this one took %.1f ms", frames_per_s,
                       1e3 * (f.done_s - f.begun_s));
    std::size_t const views = f.command.views.size();
    ImGui::TextWrapped("%s%d x %d, %d path%s per pixel",
                       views > 1 ? fmt::format("{} views of ", views).c_str() : "", v.width, v.height,
                       f.command.paths, f.command.paths == 1 ? "" : "s");
    if (!f.schedule.empty()) ImGui::TextWrapped("%s", f.schedule.c_str());
    if (!f.result.options.empty()) ImGui::TextWrapped("%s", f.result.options.c_str());
    for (auto const& [stage, seconds] : f.result.stages_s)
        ImGui::TextWrapped("%.2f ms  %s", 1e3 * seconds, stage.c_str());
}

void edit_material(ViewState& s, SceneFacts::Named& m, std::size_t index)
{
    std::string const key = fmt::format("material.{}.", index);
    auto const numbers = [](gi::vec3 v) { return nlohmann::json{double(v.x), double(v.y), double(v.z)}; };
    ImGui::TextUnformatted("base colour");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::ColorEdit3("##base colour", &m.material.base_color.x, ImGuiColorEditFlags_Float))
        try_change(s, {key + "base_color", numbers(m.material.base_color)});
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##roughness", &m.material.roughness, 0, 1, "roughness %.3f"))
        try_change(s, {key + "roughness", double(m.material.roughness)});
    ImGui::SetNextItemWidth(-1);
    if (ImGui::SliderFloat("##metallic", &m.material.metallic, 0, 1, "metallic %.3f"))
        try_change(s, {key + "metallic", double(m.material.metallic)});
    ImGui::TextUnformatted("emission");
    ImGui::SetNextItemWidth(-1);
    if (ImGui::DragFloat3("##emission", &m.material.emission.x, 0.1f, 0, 1e6f, "%.3g"))
        try_change(s, {key + "emission", numbers(m.material.emission)});
}

void edit_scene(ViewState& s)
{
    if (s.selection && ImGui::CollapsingHeader("Selected", ImGuiTreeNodeFlags_DefaultOpen)) {
        Selection const& chosen = *s.selection;
        ImGui::TextWrapped("%s, material %s, %.3f m away", chosen.object.c_str(), chosen.material.c_str(),
                           chosen.picked.distance_m);
        if (chosen.picked.material < s.facts.materials.size())
            edit_material(s, s.facts.materials[chosen.picked.material], chosen.picked.material);
    }
    if (!s.facts.lights.empty() && ImGui::CollapsingHeader("Lights"))
        for (std::size_t i = 0; i < s.facts.lights.size(); ++i) {
            ImGui::PushID(int(i));
            gi::vec3& v = s.facts.lights[i].intensity;
            ImGui::Text("intensity of light %zu", i);
            ImGui::SetNextItemWidth(-1);
            if (ImGui::DragFloat3("##intensity", &v.x, 0.1f, 0, 1e9f, "%.3g"))
                try_change(s, {fmt::format("light.{}.intensity", i), {double(v.x), double(v.y), double(v.z)}});
            ImGui::PopID();
        }
    if (!s.facts.materials.empty() && ImGui::CollapsingHeader("Materials"))
        for (std::size_t i = 0; i < s.facts.materials.size(); ++i) {
            ImGui::PushID(int(i));
            bool const open = ImGui::TreeNode(s.facts.materials[i].name.c_str());
            explain(s.facts.materials[i].name);
            if (open) {
                edit_material(s, s.facts.materials[i], i);
                ImGui::TreePop();
            }
            ImGui::PopID();
        }
    if (s.facts.has_environment && ImGui::CollapsingHeader("Environment")) {
        ImGui::SetNextItemWidth(-1);
        if (ImGui::SliderAngle("##rotation", &s.facts.environment_rotation_rad, -360, 360, "rotation %.0f deg"))
            try_change(s, {"environment.rotation", double(s.facts.environment_rotation_rad)});
        ImGui::SetNextItemWidth(-1);
        if (ImGui::DragFloat("##scale", &s.facts.environment_scale, 0.01f, 0, 1e6f, "scale %.3f"))
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

void fill_panel(ViewState& s, double frames_per_s, PanelPlace place)
{
    bool const over_picture = place == PanelPlace::over_picture;
    if (over_picture) {
        constexpr float kShare = 0.33f, kMargin = 8, kUsual_em = 22;
        ImVec2 const screen = ImGui::GetIO().DisplaySize;
        float const width = std::min(kUsual_em * ImGui::GetFontSize(), kShare * screen.x);
        ImGui::SetNextWindowPos(ImVec2(kMargin, kMargin), ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSizeConstraints(ImVec2(width, 0), ImVec2(width, screen.y - 2 * kMargin));
    }
    if (ImGui::Begin("Lightwell", nullptr, over_picture ? ImGuiWindowFlags_AlwaysAutoResize : 0)) {
        if (!s.message.empty()) ImGui::TextWrapped("%s", s.message.c_str());
        edit_quality(s);
        show_numbers(s, frames_per_s);
        if (ImGui::Button("open scene")) s.open_dialog.toggle(s.facts.scene);
        if (next_button("help")) s.shows_help = !s.shows_help;
        if (next_button("screenshot")) s.wants_screenshot = s.own_screenshot = true;
        if (next_button("first camera")) s.navigation.go_to(s.first_camera.world_from_camera);
        if (next_button(fmt::format("move: {}", name_of(s.navigation.mode())).c_str()))
            s.navigation.set_mode(NavigationMode((int(s.navigation.mode()) + 1) % 3));
        edit_settings(s);
        edit_scene(s);
    }
    ImGui::End();
}

} // namespace viewer
