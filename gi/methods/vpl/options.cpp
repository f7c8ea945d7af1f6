#include "gi/methods/vpl/options.h"

#include "gi/core/error.h"
#include "gi/core/to_number.h"

#include <fmt/format.h>

namespace gi {
namespace {

template <class T>
RenderOption virtual_lights(OptionFacts facts, T VirtualLightSettings::*member,
                            std::vector<std::string_view> methods = {"vpl_*"})
{
    return {make_option<RenderSettings>(
                std::move(facts), [member](auto& s) -> auto& { return s.vpl.*member; }),
            "Methods vpl_*",
            {.methods = std::move(methods), .unused_by = {}}};
}

void set_points(RenderSettings& s, std::string const& text, std::string const& given)
{
    VirtualLightSettings vpl = s.vpl;
    bool const is_share = text.ends_with('%');
    double const v = to_number(std::string_view(text).substr(0, text.size() - is_share)).value_or(0);
    vpl.points_percent = is_share ? v : 0;
    if (!is_share) vpl.points = int(std::round(std::clamp(v, 0.0, 1e9)));
    int const points = is_share && !(v > 0) ? 0 : vpl.points_per_map();
    if (points < 1 || points > kMostPoints)
        throw InputError(given,
                         fmt::format("it takes 1 to {} points, or a share of the {} texels of a map", kMostPoints,
                                     vpl.point_map * vpl.point_map),
                         "write 1024, or 30%");
    s.vpl = vpl;
}

std::string points_text(RenderSettings const& s)
{
    return s.vpl.points_percent > 0 ? fmt::format("{}%", s.vpl.points_percent) : std::to_string(s.vpl.points);
}

RenderOption points()
{
    RenderOption o =
        virtual_lights(word_option("points", {"5%", "30%", "100%", "256", "1024", "4096", "16384"},
                                   "vpl_imperfect: points per shadow map, e.g. 1024, or 30% of its texels"),
                       &VirtualLightSettings::points_percent, {"vpl_imperfect"});
    o.takes_other_words = true;
    o.set = set_points;
    o.get = points_text;
    return o;
}

} // namespace

RenderOptionTable const& virtual_light_options()
{
    using V = VirtualLightSettings;
    static RenderOptionTable const all{
        virtual_lights(whole_option("light-paths", 1, 1 << 20,
                                    "light paths per pass (one camera path per pixel); each of their vertices "
                                    "becomes a virtual light"),
                       &V::light_paths),
        virtual_lights(number_option("near", 0, 1e9,
                                     "m; below about this distance, camera paths replace virtual lights, in all "
                                     "vpl_* methods alike (default: 2 % of the scene's radius)"),
                       &V::near_m),
        virtual_lights(whole_option("point-map", 8, 1024,
                                    "vpl_imperfect: size of a shadow map, texels on a side, a power of two"),
                       &V::point_map, {"vpl_imperfect"}),
        points(), // after the size of the map, of which it may be a share
        virtual_lights(number_option("ao-radius", 0, 1e9, "vpl_ao, vpl_dao: m; farther surfaces do not occlude"),
                       &V::ao_radius_m, {"vpl_ao", "vpl_dao"}),
    };
    return all;
}

} // namespace gi
