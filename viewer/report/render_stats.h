#pragma once
// What the report shows of a file that `lightwell render --stats` has written.

#include <string>
#include <vector>

namespace viewer {

struct RenderStats {
    std::string name;                                 ///< of its file, without extension
    std::string command, program, machine;            ///< machine: as to_text has it; empty = not told
    std::string method, denoise, eye;                 ///< eye: "left", "right", or empty
    std::string but_for_eye;                          ///< all other settings; the same for both eyes of a pair
    std::string png, video;                           ///< names of files beside it; empty = none
    std::string anaglyph;                             ///< of a left eye whose right one is there; empty = none
    double eye_distance_m = 0, screen_distance_m = 0; ///< 0 = not told
    int width = 0, height = 0;                        ///< pixels
    int frames = 0;                                   ///< 0 = a single picture
    double paths = 0;                                 ///< per pixel (and frame); NaN = not told
    double relmse = 0;                                ///< estimated, before the filter; NaN = not told
    /// Of all frames together: structures that are built before paths, everything that is traced, the filter, the
    /// whole of it with loading and saving.
    double structures_s = 0, trace_s = 0, denoise_s = 0, whole_s = 0;
    double frame_s = 0, frame_p95_s = 0; ///< median and 95th percentile; NaN = not told
    double memory_bytes = 0;             ///< at the most
};

/// Whether a JSON text looks like such a file at all.
bool is_render_stats(std::string const& json);
/// `name` is used in messages. Throws InputError on what is none.
RenderStats parse_render_stats(std::string const& json, std::string const& name);

/// Indices of a left and a right eye that were rendered by the same call otherwise, in their order.
std::vector<std::pair<std::size_t, std::size_t>> stereo_pairs(std::vector<RenderStats> const& renders);

} // namespace viewer
