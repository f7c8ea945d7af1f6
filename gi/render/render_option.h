#pragma once
// Options of RenderSettings. Each setting is declared once, in the table of its method's folder or, if different
// methods share it, in common_options(); gi/methods/registry.h lists all.

#include "gi/core/option.h"
#include "gi/render/render_settings.h"

namespace gi {

/// Another option because of which a method that reads an option does not use it.
struct Unused {
    std::string by;  ///< "--schedule stored"
    char const* why;
};

struct RenderOption : Option<RenderSettings> {
    std::string group;                     ///< heading in --help and panel; empty for common options
    std::vector<std::string_view> methods; ///< that read it, a last * for any ending; empty = all
    std::function<std::optional<Unused>(RenderSettings const&)> unused = {};
    bool live = true;     ///< viewers and AR sessions have it
    bool restarts = true; ///< in viewers, a change restarts the methods
    std::string replaced_by = {}; ///< only in files of earlier versions; what to give instead. Empty = offered to people

    bool read_by(std::string_view method) const;
};
using RenderOptionTable = std::vector<RenderOption>;

/// Bounces, seed, pixel filter, threads, and the device of the methods that have kernels.
RenderOptionTable const& common_options();

/// Options and their values as on the command line: "--hit-buffer 128 --packed", quoted for a shell where they
/// must be. Flags that are off are left out.
std::string as_options(RenderOptionTable const& table, RenderSettings const& settings,
                       std::vector<std::string_view> const& names);

/// The same of all options whose values are not the defaults, and of those named.
std::string changed_options(RenderOptionTable const& table, RenderSettings const& settings,
                            std::vector<std::string_view> names);

/// Throws InputError if a picture of this size does not fit into memory.
void check_picture_size(int width, int height);

} // namespace gi
