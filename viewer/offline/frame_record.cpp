#include "viewer/offline/frame_record.h"

#include "gi/core/quantile.h"
#include "viewer/offline/rank_work.h"
#include "viewer/offline/render_record.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <numeric>

namespace viewer {

using Json = nlohmann::ordered_json;

nlohmann::json to_message(FrameRecord const& r)
{
    return {{"frame", r.frame},          {"reused", r.reused},
            {"seconds", r.seconds},      {"end", int(r.result.end)},
            {"paths", r.result.paths},   {"trace_s", r.result.seconds},
            {"relmse", r.result.relmse}, {"options", r.result.options},
            {"rays", r.result.rays},     {"losses", losses_json(r.losses)},
            {"method", r.result.method}, {"why_method", r.result.why_method}};
}

FrameRecord record_of(nlohmann::json const& m)
{
    FrameRecord r;
    r.frame = m.at("frame");
    r.reused = m.at("reused");
    r.seconds = m.at("seconds");
    r.result.end = gi::RenderEnd(m.at("end").get<int>());
    r.result.paths = m.at("paths");
    r.result.seconds = m.at("trace_s");
    r.result.relmse = m.at("relmse");
    r.result.options = m.at("options");
    r.result.rays = m.at("rays");
    r.result.method = m.at("method");
    r.result.why_method = m.at("why_method");
    r.losses = losses_of(m.at("losses"));
    return r;
}

Json to_json(std::vector<FrameRecord> const& records, FrameSettings const& frames)
{
    auto const name = [](std::optional<FrameName> const& pattern, int frame) {
        return pattern ? Json(pattern->of(frame)) : Json();
    };
    Json all = Json::array();
    for (FrameRecord const& r : records) {
        bool const known = !r.reused;
        Json losses = Json::object();
        for (auto const& [what, loss] : r.losses) losses[what] = {{"count", loss.count}, {"first", loss.first}};
        all.push_back({{"frame", r.frame},
                       {"time_s", frames.range.time_s(r.frame)},
                       {"exr", name(frames.exr, r.frame)},
                       {"png", name(frames.png, r.frame)},
                       {"reused", r.reused},
                       {"seconds", known ? Json(r.seconds) : Json()},
                       {"trace_s", known ? Json(r.result.seconds) : Json()},
                       {"paths_per_pixel", known ? Json(r.result.paths) : Json()},
                       {"rays", known ? Json(r.result.rays) : Json()},
                       {"relmse_estimate", known ? relmse_json(r.result) : Json()},
                       {"end", known ? Json(end_text(r.result.end)) : Json()},
                       {"losses", losses},
                       {"changes", r.changes},
                       {"mean_of_frames", r.reuse.frames},
                       {"surfaces_without_history", r.reuse.started}});
    }
    return all;
}

Json frame_seconds(std::vector<FrameRecord> const& records)
{
    std::vector<double> s;
    for (FrameRecord const& r : records)
        if (!r.reused) s.push_back(r.seconds);
    if (s.empty()) return {};
    s = gi::sorted_values(std::move(s));
    return {{"median", gi::quantile_of_sorted(s, 0.5)},
            {"p95", gi::quantile_of_sorted(s, 0.95)},
            {"p99", gi::quantile_of_sorted(s, 0.99)},
            {"most", s.back()},
            {"total", std::accumulate(s.begin(), s.end(), 0.0)}};
}

std::map<std::string, std::string> frame_metadata(RenderOptions const& o, gi::RenderSettings const& s,
                                                  gi::RenderResult const& result, int frame,
                                                  std::uint64_t fingerprint, std::uint64_t motion)
{
    std::map<std::string, std::string> m = make_metadata(o, s, result);
    m["asked_method"] = o.method; // which may have chosen another one: --resume compares it
    m["frame"] = std::to_string(frame);
    m["stop"] = stop_option(s);
    m["reuse"] = std::to_string(o.reuse);
    m["shutter"] = fmt::format("{}", o.shutter_s);
    m["layers"] = o.layers.empty() ? "all" : fmt::format("{}", fmt::join(o.layers, ","));
    m["numbers"] = o.half ? "half" : "single";
    m["fingerprint"] = fmt::format("{:016x}", fingerprint);
    m["motion"] = fmt::format("{:016x}", motion);
    return m;
}

std::string difference(gi::Picture const& there, std::map<std::string, std::string> const& wanted)
{
    if (!there.metadata.contains("frame")) return "it is not a frame of a sequence";
    // The build first: frames of another one may have other keys.
    for (char const* key :
         {"version", "git", "level", "embree", "frame", "asked_method", "size", "seed", "filter", "denoise",
          "bounces", "stop", "reuse", "shutter", "layers", "numbers", "fingerprint", "motion"}) {
        auto const found = there.metadata.find(key);
        if (found == there.metadata.end()) return "it is not a frame of a sequence";
        std::string const& value = wanted.at(key);
        if (found->second == value) continue;
        if (std::string(key) == "fingerprint") return "its scene, camera or settings differ";
        if (std::string(key) == "motion") return "its motion blur differs";
        if (std::string(key) == "asked_method")
            return fmt::format("its method is {}, not {}", found->second, value);
        return fmt::format("its {} is {}, not {}", key, found->second, value);
    }
    return {};
}

} // namespace viewer
