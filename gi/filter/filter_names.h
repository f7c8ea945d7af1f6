#pragma once
// Table of the filters by name, used by the command line, the viewer's settings, studies, AR sessions and Python.

#include "gi/filter/denoise.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace gi {

struct NamedFilter {
    char const* name;
    char const* meaning; ///< one line of --help; empty for "none"
    DenoiseSettings settings;
};

std::span<NamedFilter const> named_filters();
std::vector<std::string> filter_names();
/// Throws InputError, listing the known names.
DenoiseSettings find_filter(std::string_view name);

/// Throws InputError if the filter is not installed; call it before rendering starts.
void check_filter(DenoiseSettings const& settings);
/// The same; throws InputError if the filter cannot work with this number of paths per pixel.
void check_filter(DenoiseSettings const& settings, std::uint32_t paths, bool has_reuse);
/// False for atrous if no variance is available: fewer than two paths and no temporal reuse.
bool can_filter(DenoiseSettings const& settings, std::uint32_t paths, bool has_reuse = false);

} // namespace gi
