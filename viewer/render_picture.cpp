#include "viewer/render_picture.h"

#include "gi/base/picture_file.h"
#include "gi/image/tone_map.h"

#include <algorithm>
#include <cstdio>

namespace viewer {

void say(std::string const& text) { std::fputs(("note: " + text + "\n").c_str(), stderr); }

std::string denoise(gi::Picture& picture, gi::DenoiseSettings const& settings, gi::Report& report)
{
    if (settings.denoiser == gi::Denoiser::none) return {};
    gi::StageTimer const timer(report, "denoise");
    gi::DenoiseReport const done = gi::denoise(picture, settings);
    report.count("pixels without a surface to filter on", double(done.without_surface));
    if (done.not_finite > 0) report.lose("pixels not filtered, as a value is not finite", done.not_finite);
    return done.no_variance ? "--denoise atrous does nothing: nothing in the picture has a variance" : "";
}

void keep_layers(RenderOptions const& o, gi::Picture& picture)
{
    if (o.layers.empty()) return;
    std::erase_if(picture.layers, [&](gi::Layer const& l) {
        return l.name != "color" && std::find(o.layers.begin(), o.layers.end(), l.name) == o.layers.end();
    });
}

void save_exr(RenderOptions const& o, std::string const& file, gi::Picture const& picture, gi::Report& report)
{
    gi::write_exr(file, picture, o.half ? gi::PixelType::half : gi::PixelType::single, report);
}

std::vector<unsigned char> display_bytes(RenderOptions const& o, gi::Picture const& picture)
{
    gi::ToneMapSettings const tone{float(o.exposure_ev),
                                   o.tone == "filmic" ? gi::ToneCurve::filmic : gi::ToneCurve::srgb};
    return gi::tone_map_bytes(*picture.find("color"), tone);
}

} // namespace viewer
