// The light of the synthetic desk under measured environment maps, estimated from one noisy frame.

#include "ar/light/map_file.h"
#include "ar/runtime/light_check.h"
#include "tests/support/data.h"

#include <fmt/format.h>

namespace viewer::test {
namespace {

struct Limits {
    char const* map;
    double irradiance_rms, lamp_deg; ///< lamp: -1 = the map has no dominant one
};

TEST(LightOfSharedMaps, AgreesWithTheMapThatLitTheFrame)
{
    LIGHTWELL_NEED_DATA("envmaps/hilly_terrain_01_1k.hdr");
    for (Limits const& l : {Limits{"hilly_terrain_01_1k", 0.06, 0.6},
                            {"kloppenheim_05_1k", 0.06, 4},
                            {"dancing_hall_1k", 0.12, -1}}) {
        ar::LightCheckSettings s;
        s.paths = 32;
        gi::Report report;
        ar::LightChecked const c = ar::check_light(
            ar::read_map(gi::test::shared_data() / "envmaps" / fmt::format("{}.hdr", l.map)), s, {}, report);
        fmt::print(
            "{}: irradiance {:.3f} rms, up {:.3f}, white {:.2f} deg, lamp {:.2f} deg, FLIP {:.4f} ({:.4f} even "
            "light)\n",
            l.map, c.irradiance_rms, c.up_ratio, c.white_deg, c.lamp_deg, c.flip, c.flip_even);
        EXPECT_LT(c.irradiance_rms, l.irradiance_rms) << l.map;
        EXPECT_NEAR(c.up_ratio, 1, 0.03) << l.map;
        EXPECT_LT(c.white_deg, 3) << l.map;
        EXPECT_LT(c.up_sigmas, 2) << l.map;
        EXPECT_LT(c.flip, 0.6 * c.flip_even) << l.map;
        if (l.lamp_deg > 0) {
            EXPECT_GE(c.lamp_deg, 0) << l.map;
            EXPECT_LT(c.lamp_deg, l.lamp_deg) << l.map;
        }
    }
}

} // namespace
} // namespace viewer::test
