#include "gi/core/error.h"
#include "gi/core/huge_pages.h"
#include "gi/image_io/picture_file.h"
#include "gi/scene/load/load.h"

#include <fmt/format.h>

namespace gi {

EnvironmentMap load_environment(std::filesystem::path const& file, Report& report)
{
    constexpr int kWidest = 32768;
    Picture const picture = read_picture(file);
    auto const bad = [&](std::string const& why) {
        return InputError(fmt::format("'{}' is not an environment map", file.string()), why,
                          "give a lat-long panorama as HDR or EXR, twice as wide as high");
    };
    Layer const& color = color_of(picture, file.string());
    if (picture.is_cube) throw bad("it holds the six faces of a cube");
    if (picture.width < 2 || picture.height < 1)
        throw bad(fmt::format("it has {} x {} pixels, at least 2 x 1 are needed", picture.width, picture.height));
    if (picture.width > kWidest || picture.height > kWidest)
        throw bad(fmt::format("it has {} x {} pixels, at most {} per side work", picture.width, picture.height,
                              kWidest));

    EnvironmentMap map;
    map.width = std::uint32_t(picture.width);
    map.height = std::uint32_t(picture.height);
    resize_on_huge_pages(map.radiance, picture.pixels());
    std::uint64_t bad_texels = 0;
    for (std::size_t i = 0; i < map.radiance.size(); ++i) {
        vec3 const v = rgb(color, i);
        bool good = true;
        for (int c = 0; c < 3; ++c) {
            bool const usable = std::isfinite(v[c]) && v[c] >= 0;
            map.radiance[i][c] = usable ? v[c] : 0.0f;
            good &= usable;
        }
        bad_texels += !good;
    }
    for (std::string const& note : picture.notes)
        report.lose("environment maps not used as they are", 1, file.string() + ": " + note);
    report.lose("environment texels that are negative or not finite, set to 0", bad_texels, file.string());
    if (picture.width != 2 * picture.height)
        report.lose("environment maps that are not twice as wide as high, stretched over the sphere", 1,
                    fmt::format("{}: {} x {}", file.string(), picture.width, picture.height));
    return map;
}

} // namespace gi
