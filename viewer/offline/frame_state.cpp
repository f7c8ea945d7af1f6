#include "viewer/offline/frame_state.h"

#include "viewer/offline/render_record.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {

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
    for (char const* key : {"frame", "asked_method", "size", "seed", "filter", "denoise", "bounces", "stop", "reuse",
                            "shutter", "layers", "numbers", "version", "git", "fingerprint", "motion"}) {
        auto const found = there.metadata.find(key);
        if (found == there.metadata.end()) return "it is not a frame of a sequence";
        std::string const& value = wanted.at(key);
        if (found->second == value) continue;
        if (std::string(key) == "fingerprint") return "its scene, camera or settings differ";
        if (std::string(key) == "motion") return "its motion blur differs";
        if (std::string(key) == "asked_method") return fmt::format("its method is {}, not {}", found->second, value);
        return fmt::format("its {} is {}, not {}", key, found->second, value);
    }
    return {};
}

} // namespace viewer
