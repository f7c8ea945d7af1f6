#include "gi/core/error.h"
#include "gi/core/text.h"
#include "gi/methods/vpl/settings.h"
#include "gi/methods/vpl/visibility.h"

#include <fmt/format.h>

namespace gi {
namespace {

using V = VirtualLightSettings;

template <class T>
RenderOption virtual_lights(char const* name, OptionValues values, char const* meaning, T V::*member,
                            std::vector<std::string_view> methods = {"vpl_*"})
{
    return {make_option<RenderSettings>(
                name, std::move(values), meaning, [member](auto& s) -> auto& { return s.template of<VirtualLightSettings>().*member; }),
            "Methods vpl_*", std::move(methods)};
}

/// A number of points, or "30%" of the texels of a map.
void set_points(RenderSettings& s, std::string const& text, std::string const& given)
{
    V vpl = s.of<VirtualLightSettings>();
    bool const is_share = text.ends_with('%');
    double const v = parse_finite(std::string_view(text).substr(0, text.size() - is_share)).value_or(-1);
    vpl.points_percent = is_share ? v : 0;
    vpl.points = is_share ? 0 : int(std::round(std::clamp(v, -1.0, 1e9)));
    if (vpl.points_per_map() < 1 || vpl.points_per_map() > kMostPoints)
        throw InputError(given,
                         fmt::format("it takes 1 to {} points, or a share of the {} texels of a map", kMostPoints,
                                     vpl.point_map * vpl.point_map),
                         "write 1024, or 30%");
    s.of<VirtualLightSettings>() = vpl;
}

} // namespace

RenderOptionTable const& virtual_light_options()
{
    static RenderOptionTable const all = [] {
        RenderOption points =
            virtual_lights("points", {"5%", "30%", "100%", "256", "1024", "4096", "16384"},
                           "vpl_imperfect: points per shadow map, e.g. 1024, or 30% of its texels",
                           &V::points_percent, {"vpl_imperfect"});
        points.type = OptionType::word;
        points.takes_other_words = true;
        points.set = set_points;
        points.get = [](RenderSettings const& s) {
            return s.of<VirtualLightSettings>().points_percent > 0 ? number_text(s.of<VirtualLightSettings>().points_percent) + "%"
                                            : std::to_string(s.of<VirtualLightSettings>().points);
        };
        return RenderOptionTable{
            virtual_lights("light-paths", {1, 1 << 20},
                           "light paths per pass (one camera path per pixel); each of their vertices becomes a "
                           "virtual light",
                           &V::light_paths),
            virtual_lights("near", {0, 1e9},
                           "m; below about this distance, camera paths replace virtual lights, in all vpl_* "
                           "methods alike (default: 2 % of the scene's radius)",
                           &V::near_m),
            virtual_lights("point-map", {8, 1024},
                           "vpl_imperfect: size of a shadow map, texels on a side, a power of two", &V::point_map,
                           {"vpl_imperfect"}),
            points, // after the size of the map, of which it may be a share
            virtual_lights("ao-radius", {0, 1e9}, "vpl_ao, vpl_dao: m; farther surfaces do not occlude",
                           &V::ao_radius_m, {"vpl_ao", "vpl_dao"}),
        };
    }();
    return all;
}

} // namespace gi
