#pragma once
// Options of RenderSettings. Each setting is declared once, in the table of its method's folder or, if all methods
// share it, in common_options(); gi/methods/options.h lists all.

#include "gi/core/option.h"
#include "gi/render/render_settings.h"

#include <initializer_list>
#include <string_view>
#include <vector>

namespace gi {

/// Why frames and pictures with a schedule of slhb do not use an option.
struct UnusedBy {
    Schedule schedule;
    char const* why;
};

struct OptionUse {
    std::vector<std::string_view> methods; ///< that read it, a last * for any ending; empty = all
    std::vector<UnusedBy> unused_by;
    bool live = true; ///< viewers and AR sessions have it
};

struct RenderOption : Option<RenderSettings> {
    std::string group; ///< heading in --help and panel; empty for common options
    OptionUse use;
};
using RenderOptionTable = std::vector<RenderOption>;

/// True if the method reads the option, with some schedule.
bool reads(std::string_view method, RenderOption const& option);

/// Options and their values as on the command line: "--hit-buffer 128 --packed". Flags that are off are left out.
std::string as_options(RenderOptionTable const& table, RenderSettings const& settings,
                       std::vector<std::string_view> const& names);

/// Bounces, seed, pixel filter and threads.
RenderOptionTable const& common_options();

/// Throws InputError if a picture of this size does not fit into memory.
void check_picture_size(int width, int height);

} // namespace gi
