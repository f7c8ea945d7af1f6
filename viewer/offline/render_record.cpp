#include "viewer/offline/render_record.h"

#include "gi/core/processor_level.h"
#include "gi/core/shell.h"
#include "gi/kernel/device.h"
#include "viewer/base/report_json.h"
#include "viewer/base/version.h"
#include "viewer/report/machine.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSchema = 1; // of the statistics; incremented if a key changes its meaning or is removed

std::string filter_of(gi::RenderSettings const& s) { return gi::render_option("filter").get(s); }

/// All options that determine the picture, in a fixed order and with defaults written out.
std::string normalised_command(RenderOptions const& o, gi::RenderSettings const& s, std::string const& amount,
                               Chosen const& chosen)
{
    std::string command = fmt::format(
        "lightwell render {} --method {} --size {}x{} --bounces {} --filter {} --seed {} {}",
        gi::shell_quoted(o.scene), chosen.method.empty() ? o.method : chosen.method, s.width, s.height, s.bounces,
        filter_of(s), o.seed_per_frame && !o.frames.empty() ? o.settings.seed : s.seed, amount);
    auto const add = [&](char const* option, std::string const& value) {
        if (!value.empty()) command += fmt::format(" {} {}", option, gi::shell_quoted(value));
    };
    add("--camera", o.camera);
    add("--look-from", o.look_from);
    add("--look-at", o.look_at);
    if (o.fov_deg) add("--fov", fmt::format("{}", *o.fov_deg));
    if (o.aperture_radius_m) add("--aperture-radius", fmt::format("{}", *o.aperture_radius_m));
    if (o.focus_distance_m) add("--focus-distance", fmt::format("{}", *o.focus_distance_m));
    if (!o.eye.empty()) {
        add("--eye", o.eye);
        add("--eye-distance", fmt::format("{}", o.eye_distance_m));
        if (o.screen_distance_m) add("--screen-distance", fmt::format("{}", *o.screen_distance_m));
    }
    if (o.time_s) add("--time", fmt::format("{}", *o.time_s));
    add("--envmap", o.environment);
    if (o.environment_rotate_deg != 0) add("--envmap-rotate", fmt::format("{}", o.environment_rotate_deg));
    if (o.environment_scale != 1) add("--envmap-scale", fmt::format("{}", o.environment_scale));
    if (o.light != "studio") add("--light", o.light);
    add("--background", o.background);
    if (o.denoise != "none") add("--denoise", o.denoise);
    add("--camera-path", o.camera_path);
    add("--frames", o.frames);
    if (o.turns) add("--turntable", o.turntable.empty() ? "1" : o.turntable);
    if (o.reuse > 1) add("--reuse", std::to_string(o.reuse));
    if (o.seed_per_frame && !o.frames.empty()) command += " --seed-per-frame";
    if (o.shutter_s > 0) add("--shutter", fmt::format("{}", o.shutter_s));
    if (!chosen.options.empty()) command += " " + chosen.options;
    return command;
}

/// False with one path, from which no variance can be estimated.
bool knows_error(gi::RenderResult const& r) { return r.paths >= 2; }

/// A command that makes the picture; where that was interrupted in its first pass, one with more paths.
std::string paths_option(gi::RenderResult const& r) { return fmt::format("--paths {}", std::max(1u, r.paths)); }

double rays_per_second(gi::RenderResult const& r) { return r.seconds > 0 ? r.rays / r.seconds : 0; }

} // namespace

char const* end_text(gi::RenderEnd end)
{
    switch (end) {
    case gi::RenderEnd::paths:
        return "paths";
    case gi::RenderEnd::budget:
        return "budget";
    case gi::RenderEnd::error_target:
        return "error target";
    case gi::RenderEnd::interrupted:
        return "interrupted";
    }
    return "";
}

std::string stop_option(gi::RenderSettings const& s)
{
    if (s.budget_s > 0) return fmt::format("--budget {}s", s.budget_s);
    if (s.until_relmse > 0) return fmt::format("--until relmse={}", s.until_relmse);
    return fmt::format("--paths {}", s.paths);
}

/// What of light is wrong by look-ups, with 95 % intervals.
std::string bias_text(gi::LookUpBias const& b)
{
    auto const part = [](gi::Deviation const& d) {
        return std::isfinite(d.value) ? fmt::format("{:+.2f} +- {:.2f} %", 100 * d.value, 100 * d.error)
                                      : fmt::format("{:+.2f} % of all where there is none", 100 * d.of_all);
    };
    return fmt::format("direct {}, indirect {}", part(b.direct), part(b.indirect));
}

Json bias_json(std::optional<gi::LookUpBias> const& b)
{
    if (!b) return {};
    auto const part = [](gi::Deviation const& d) {
        return Json{
            {"value", std::isfinite(d.value) ? Json(d.value) : Json()}, {"error", d.error}, {"of_all", d.of_all}};
    };
    return {{"direct", part(b->direct)}, {"indirect", part(b->indirect)}, {"paths", b->paths}};
}

Json relmse_json(gi::RenderResult const& r) { return knows_error(r) ? Json(r.relmse) : Json(); }

std::map<std::string, std::string> make_metadata(RenderOptions const& o, gi::RenderSettings const& s,
                                                 gi::RenderResult const& result)
{
    std::map<std::string, std::string> facts{
        {"version", version_number()},
        {"git", git_hash()},
        {"level", gi::kCompiledLevel},
        {"embree", embree_version()},
        {"command", normalised_command(o, s, paths_option(result), chosen_of(result))},
        {"scene", o.scene},
        {"method", result.method.empty() ? o.method : result.method},
        {"size", fmt::format("{}x{}", s.width, s.height)},
        {"seed", std::to_string(s.seed)},
        {"filter", filter_of(s)},
        {"denoise", o.denoise},
        {"bounces", std::to_string(s.bounces)},
        {"paths", std::to_string(result.paths)},
        {"units", "radiance, W/(m2 sr), linear Rec. 709"}};
    if (s.space == gi::Space::device) facts["device"] = gi::is_device_simulated() ? "cuda, simulated" : "cuda";
    if (knows_error(result)) facts["estimated_relmse"] = fmt::format("{:.3g}", result.relmse); // unfiltered
    return facts;
}

Json describe_call(RenderOptions const& o, gi::RenderSettings const& s, std::string const& amount,
                   Chosen const& chosen)
{
    auto const or_null = [](auto const& value) { return value ? Json(*value) : Json(); };
    auto const name_or_null = [](std::string const& name) { return name.empty() ? Json() : Json(name); };
    Json j;
    j["schema"] = kSchema;
    j["program"] = version_text();
    j["command"] = normalised_command(o, s, amount, chosen);
    MachineFacts const machine = this_machine();
    j["machine"] = {{"cpu", machine.cpu}, {"cores", machine.cores}, {"memory_gib", machine.memory_gib}};
    j["settings"] = {{"scene", o.scene},
                     {"method", o.method},
                     {"chosen_method", name_or_null(chosen.method)},
                     {"chosen_method_because", name_or_null(chosen.why_method)},
                     {"width", s.width},
                     {"height", s.height},
                     {"camera", name_or_null(o.camera)},
                     {"look_from", name_or_null(o.look_from)},
                     {"look_at", name_or_null(o.look_at)},
                     {"fov_deg", or_null(o.fov_deg)},
                     {"aperture_radius_m", or_null(o.aperture_radius_m)},
                     {"focus_distance_m", or_null(o.focus_distance_m)},
                     {"eye", name_or_null(o.eye)},
                     {"eye_distance_m", o.eye.empty() ? Json() : Json(o.eye_distance_m)},
                     {"screen_distance_m", or_null(o.screen_distance_m)},
                     {"time_s", or_null(o.time_s)},
                     {"envmap", name_or_null(o.environment)},
                     {"envmap_rotate_deg", o.environment_rotate_deg},
                     {"envmap_scale", o.environment_scale},
                     {"light", o.light},
                     {"background", name_or_null(o.background)},
                     {"paths_limit", s.paths},
                     {"budget_s", s.budget_s > 0 ? Json(s.budget_s) : Json()},
                     {"until_relmse", s.until_relmse > 0 ? Json(s.until_relmse) : Json()},
                     {"bounces", s.bounces},
                     {"filter", filter_of(s)},
                     {"denoise", o.denoise},
                     {"seed", s.seed},
                     {"threads", s.threads},
                     {"resume", o.resume},
                     {"state", name_or_null(s.checkpoint.string())},
                     {"checkpoint_s", s.checkpoint.empty() || s.checkpoint_s == 0 ? Json() : Json(s.checkpoint_s)},
                     {"aovs", o.layers},
                     {"half", o.half},
                     {"exposure_ev", o.exposure_ev},
                     {"tone", o.tone},
                     {"frames", name_or_null(o.frames)},
                     {"turntable", o.turns ? Json(o.turntable.empty() ? "1" : o.turntable) : Json()},
                     {"camera_path", name_or_null(o.camera_path)},
                     {"seed_per_frame", o.seed_per_frame},
                     {"reuse", o.reuse},
                     {"shutter_s", o.shutter_s}};
    j["outputs"] = {{"exr", name_or_null(o.out)},
                    {"png", name_or_null(o.png)},
                    {"video", name_or_null(o.video)},
                    {"stats", name_or_null(o.stats)}};
    return j;
}

Json make_stats(RenderOptions const& o, gi::RenderSettings const& s, gi::ScenePlan const& plan,
                gi::RenderResult const& r, gi::Report const& report)
{
    Json j = describe_call(o, s, paths_option(r), chosen_of(r));
    j["result"] = {{"end", end_text(r.end)},
                   {"paths_per_pixel", r.paths},
                   {"seconds", r.seconds},
                   {"relmse_estimate", relmse_json(r)},
                   {"look_up_bias", bias_json(r.look_up_bias)},
                   {"rays", r.rays},
                   {"rays_per_s", rays_per_second(r)}};
    j["plan"] = to_json(plan.items);
    j["report"] = to_json(report);
    return j;
}

Json to_json(std::vector<gi::PlanItem> const& plan)
{
    auto list = Json::array();
    for (gi::PlanItem const& item : plan) {
        auto numbers = Json::object();
        for (gi::PlanNumber const& n : item.numbers)
            std::visit([&](auto value) { numbers[n.key] = value; }, n.value);
        list.push_back({{"name", item.name},
                        {"what", item.what},
                        {"build", item.build},
                        {"reason", item.reason},
                        {"numbers", numbers}});
    }
    return list;
}

std::string summary_line(RenderOptions const& o, gi::RenderSettings const& s, gi::RenderResult const& r)
{
    std::string const bias =
        r.look_up_bias ? ", light by look-ups against exact rays: " + bias_text(*r.look_up_bias) : "";
    return fmt::format("{} x {} pixels, {} paths each, {:.2f} s, {:.2f} Mrays/s, {}{}", s.width, s.height, r.paths,
                       r.seconds, rays_per_second(r) * 1e-6,
                       knows_error(r) ? fmt::format("estimated relMSE {:.2g}{}", r.relmse,
                                                    o.denoise == "none" ? "" : " before the filter")
                       : r.paths == 0 ? std::string("interrupted before all pixels had a path")
                                      : std::string("relMSE unknown from one path"),
                       bias);
}

} // namespace viewer
