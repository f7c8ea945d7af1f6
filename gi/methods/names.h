#pragma once
// What programs that do not render know of methods by their names.

#include <algorithm>
#include <array>
#include <string_view>

namespace gi {

/// The method of renders, viewers, studies and AR sessions that name none: the plan chooses.
inline constexpr std::string_view kDefaultMethod = "auto";

/// Name of the method in a file written by version 0.1 of the program or following a schema of that version:
/// its `slhb` was exact rays or look-ups, depending on its options.
constexpr std::string_view method_of_0_1(std::string_view name) { return name == "slhb" ? "slhb_0_1" : name; }

/// The method of viewers, studies and AR sessions of version 0.1 that name none.
inline constexpr std::string_view kDefaultMethodOf01 = method_of_0_1("slhb");
/// That of its `render`.
inline constexpr std::string_view kRenderMethodOf01 = "reference";

/// True if an interrupted and resumed picture by this method equals an uninterrupted one bit for bit.
/// The other methods start their light afresh.
constexpr bool resumes_exactly(std::string_view method)
{
    constexpr std::array kMethods{"auto",
                                  "paths",
                                  "paths_shadow_maps",
                                  "slhb",
                                  "slhb_shadow_rays",
                                  "screen_lhb",
                                  "paths_layered_lens",
                                  "slhb_0_1",
                                  "reference",
                                  "whitted"};
    return method.starts_with("vpl_") ||
           std::ranges::find(kMethods, method, [](char const* m) { return std::string_view(m); }) != kMethods.end();
}

} // namespace gi
