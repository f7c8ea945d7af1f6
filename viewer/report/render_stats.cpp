#include "viewer/report/render_stats.h"

#include "gi/core/error.h"
#include "viewer/report/machine.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace viewer {
namespace {

using StatsJson = nlohmann::json;

constexpr int kStatsSchema = 1; // of viewer/offline/render_record.cpp
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

StatsJson const* value_at(StatsJson const& json, char const* key)
{
    auto const found = json.find(key);
    return found == json.end() || found->is_null() ? nullptr : &*found;
}

std::string text_at(StatsJson const& json, char const* key)
{
    StatsJson const* const value = value_at(json, key);
    return value == nullptr ? "" : value->get<std::string>();
}

double number_at(StatsJson const& json, char const* key, double otherwise)
{
    StatsJson const* const value = value_at(json, key);
    return value == nullptr ? otherwise : value->get<double>();
}

/// Accepts only plain file names beside the file, as it may be from an untrusted source.
std::string file_at(StatsJson const& json, char const* key)
{
    return std::filesystem::path(text_at(json, key)).filename().string();
}

void read_stages(StatsJson const& stages, RenderStats& r)
{
    double loading_s = 0;
    for (auto const& [stage, seconds] : stages.items()) {
        double const s = seconds.get<double>();
        if (stage.starts_with("build ") || stage == "layers that moved" || stage.starts_with("BVH of"))
            r.structures_s += s;
        else if (stage == "trace")
            r.trace_s = s;
        else if (stage == "denoise")
            r.denoise_s = s;
        else if (stage == "load" || stage == "world" || stage == "save")
            loading_s += s;
    }
    r.whole_s = loading_s + r.structures_s + r.trace_s + r.denoise_s;
}

RenderStats to_render_stats(StatsJson const& json)
{
    RenderStats r;
    StatsJson const &settings = json.at("settings"), &outputs = json.at("outputs"), &report = json.at("report");
    r.command = json.at("command");
    r.program = json.at("program");
    if (StatsJson const* const m = value_at(json, "machine"))
        r.machine = to_text(MachineFacts{m->at("cpu"), m->at("cores"), m->at("memory_gib")});
    r.method = settings.at("method");
    r.denoise = settings.at("denoise");
    r.eye = text_at(settings, "eye");
    r.eye_distance_m = number_at(settings, "eye_distance_m", 0);
    r.screen_distance_m = number_at(settings, "screen_distance_m", 0);
    StatsJson others = settings;
    for (char const* const own : {"eye", "state", "checkpoint_s"}) others.erase(own);
    r.but_for_eye = others.dump();
    r.width = settings.at("width");
    r.height = settings.at("height");
    r.png = file_at(outputs, "png");
    r.video = file_at(outputs, "video");
    read_stages(report.at("stages_s"), r);
    r.memory_bytes = number_at(report, "peak_memory_bytes", kUnknown);
    r.paths = r.relmse = r.frame_s = r.frame_p95_s = kUnknown;
    if (StatsJson const* const result = value_at(json, "result")) {
        r.paths = result->at("paths_per_pixel");
        r.relmse = number_at(*result, "relmse_estimate", kUnknown);
        return r;
    }
    StatsJson const& frames = json.at("frames");
    r.frames = int(frames.size());
    for (StatsJson const& frame : frames) r.paths = number_at(frame, "paths_per_pixel", r.paths);
    if (StatsJson const* const seconds = value_at(json, "frame_seconds")) {
        r.frame_s = seconds->at("median");
        r.frame_p95_s = seconds->at("p95");
        r.whole_s = seconds->at("total");
    }
    return r;
}

} // namespace

bool is_render_stats(std::string const& json)
{
    StatsJson const parsed = StatsJson::parse(json, nullptr, false);
    return parsed.is_object() && parsed.contains("settings") && parsed.contains("outputs");
}

RenderStats parse_render_stats(std::string const& json, std::string const& name)
{
    auto const bad = [&](std::string const& why) {
        return gi::InputError("'" + name + "' holds no statistics of lightwell render", why,
                              "delete it, or create it again with lightwell render --stats");
    };
    try {
        StatsJson const parsed = StatsJson::parse(json);
        if (parsed.at("schema") != kStatsSchema)
            throw bad(fmt::format("only version {} of its format is known", kStatsSchema));
        RenderStats r = to_render_stats(parsed);
        r.name = std::filesystem::path(name).stem().string();
        return r;
    } catch (gi::InputError const&) {
        throw;
    } catch (std::exception const& e) { // from the parser, or on a wrong type
        throw bad(e.what());
    }
}

std::vector<std::pair<std::size_t, std::size_t>> stereo_pairs(std::vector<RenderStats> const& renders)
{
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    for (std::size_t l = 0; l < renders.size(); ++l)
        for (std::size_t r = 0; r < renders.size(); ++r)
            if (renders[l].eye == "left" && renders[r].eye == "right" && !renders[l].png.empty() &&
                !renders[r].png.empty() && renders[l].but_for_eye == renders[r].but_for_eye)
                pairs.emplace_back(l, r);
    return pairs;
}

} // namespace viewer
