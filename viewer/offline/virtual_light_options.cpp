#include "gi/core/error.h"
#include "viewer/base/validators.h"
#include "viewer/offline/render_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace viewer {
namespace {

constexpr char const* kVirtualLightGroup = "Methods vpl_*";

struct VirtualLightOption {
    char const* name;
    std::vector<std::string> methods; ///< methods that use it; empty = all
};

std::vector<VirtualLightOption> const& virtual_light_options()
{
    static std::vector<VirtualLightOption> const all{{"--light-paths", {}},
                                                     {"--near", {}},
                                                     {"--points", {"vpl_imperfect"}},
                                                     {"--point-map", {"vpl_imperfect"}},
                                                     {"--ao-radius", {"vpl_ao", "vpl_dao"}}};
    return all;
}

} // namespace

void check_virtual_lights(CLI::App const& command, std::vector<NamedMethod> const& methods)
{
    for (VirtualLightOption const& o : virtual_light_options()) {
        if (command.get_option(o.name)->count() == 0) continue;
        bool const read = std::ranges::any_of(methods, [&](NamedMethod const& m) {
            return o.methods.empty() ? m.method.starts_with("vpl_")
                                     : std::ranges::find(o.methods, m.method) != o.methods.end();
        });
        if (read) continue;
        std::string const readers = o.methods.empty() ? "vpl_*" : fmt::format("{}", fmt::join(o.methods, " and "));
        throw gi::InputError(std::string(o.name) + " with --method " + methods.front().method,
                             "it applies to " + readers, "add such a method, or leave it out");
    }
}

void declare_virtual_lights(CLI::App& c, RenderOptions& o)
{
    auto const option = [&](char const* name, auto& value, char const* meaning) {
        return c.add_option(name, value, meaning)->group(kVirtualLightGroup);
    };
    option("--light-paths", o.vpl.light_paths,
           "light paths per pass (one camera path per pixel); each of their vertices becomes a virtual light")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    option("--near", o.vpl.near_m,
           "m; below about this distance, camera paths replace virtual lights, in all vpl_* methods "
           "alike (default: 2 % of the scene's radius)")
        ->check(in_range(1e-9, 1e9));
    option("--points", o.points,
           "vpl_imperfect: points per shadow map, e.g. 1024, or 30% of its texels (default 1024)");
    option("--point-map", o.vpl.point_map, "vpl_imperfect: size of a shadow map, texels on a side, a power of two")
        ->check(CLI::Range(8, 1024))
        ->capture_default_str();
    option("--ao-radius", o.vpl.ao_radius_m, "vpl_ao, vpl_dao: m; farther surfaces do not occlude")
        ->check(in_range(0, 1e9))
        ->capture_default_str();
}

} // namespace viewer
