#pragma once
// Contents of a file of `lightwell render --stats` that reports show.

#include <string>
#include <vector>

namespace viewer {

struct RenderStats {
    std::string name;                                 ///< file name without extension
    std::string command, program, machine;            ///< machine: as formatted by to_text; empty = unknown
    std::string method, denoise, eye;                 ///< eye: "left", "right", or empty
    std::string but_for_eye;                          ///< all other settings; the same for both eyes of a pair
    std::string png, video;                           ///< file names beside it; empty = none
    std::string anaglyph;                             ///< file name, for a left eye with a right one; empty = none
    double eye_distance_m = 0, screen_distance_m = 0; ///< 0 = unknown
    int width = 0, height = 0;                        ///< pixels
    int frames = 0;                                   ///< 0 = a single picture
    double paths = 0;                                 ///< per pixel (and frame); NaN = unknown
    double relmse = 0;                                ///< estimated, before the filter; NaN = unknown
    /// Totals over all frames: structures built before paths, everything that is traced, the filter, and all of it
    /// including loading and saving.
    double structures_s = 0, trace_s = 0, denoise_s = 0, whole_s = 0;
    double frame_s = 0, frame_p95_s = 0; ///< median and 95th percentile; NaN = unknown
    double memory_bytes = 0;             ///< peak
};

/// True if a JSON text appears to be such a file.
bool is_render_stats(std::string const& json);
/// Throws InputError if it is not such a file. @param name  for messages
RenderStats parse_render_stats(std::string const& json, std::string const& name);

/// Pairs of indices of a left and a right eye whose calls are otherwise equal, in order.
std::vector<std::pair<std::size_t, std::size_t>> stereo_pairs(std::vector<RenderStats> const& renders);

} // namespace viewer
