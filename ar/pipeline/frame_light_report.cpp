#include "ar/light/lamps.h"
#include "ar/pipeline/frame_light.h"
#include "gi/image_io/picture_file.h"

#include <algorithm>
#include <fmt/format.h>

namespace ar {

std::vector<std::string> warnings_of(FrameLight const& light)
{
    std::vector<std::string> out;
    if (!light.scale_is_known)
        out.push_back(
            "no albedo is known: scale and white balance are those of surfaces that are grey in the mean "
            "(give the albedo of one surface, e.g. white paper: 0.8)");
    std::string doubtful;
    for (FrameLight::Face const& f : light.faces)
        if (f.sigma > 0.25) doubtful += (doubtful.empty() ? "" : ", ") + std::string(f.name);
    if (!doubtful.empty()) out.push_back("irradiance of faces " + doubtful + " is mostly a guess");
    if (light.undetermined_share > 0.5)
        out.push_back(fmt::format("{:.0f} % of all directions are not determined by the frames (no surface faces "
                                  "them, no shadow tells)",
                                  100 * light.undetermined_share));
    if (light.fit.lamps.empty()) out.push_back("no lamp or sun was found: shadows are those of wide light");
    if (light.fit.residual > 0.15)
        out.push_back(fmt::format("the model leaves {:.0f} % of the shading unexplained (geometry or albedos are "
                                  "wrong, or light comes from near)",
                                  100 * light.fit.residual));
    std::size_t const usable = light.counts.used + light.counts.clipped;
    if (light.counts.clipped > usable / 10)
        out.push_back(fmt::format("{:.0f} % of the surfaces' pixels are clipped: the brightest parts do not count",
                                  100.0 * double(light.counts.clipped) / double(usable)));
    return out;
}

std::string describe(FrameLight const& light)
{
    FrameLightCounts const& n = light.counts;
    std::string t =
        fmt::format("{} pixels compared; left out: {} clipped, {} too dark, {} at borders, {} not matt\n", n.used,
                    n.clipped, n.dark, n.border, n.not_matt);
    t += fmt::format("{} pixels of the background show {:.1f} % of all directions ({} clipped)\n", n.background,
                     100 * light.seen_share, n.background_clipped);
    for (auto const& a : light.albedos)
        t += a.samples == 0 ? fmt::format("albedo of {}: not seen\n", a.name)
                            : fmt::format("albedo of {}: {:.3f} {:.3f} {:.3f} ({} pixels)\n", a.name, a.albedo[0],
                                          a.albedo[1], a.albedo[2], a.samples);
    t += "irradiance of surfaces facing (red, green, blue; standard deviation)\n";
    for (FrameLight::Face const& f : light.faces)
        t += fmt::format("  {:<12} {:>10.4f} {:>10.4f} {:>10.4f}  +- {:.0f} %\n", f.name, f.irradiance[0],
                         f.irradiance[1], f.irradiance[2], 100 * f.sigma);
    t += fmt::format("{} lights\n", light.fit.lamps.size());
    for (FittedLamp const& l : light.fit.lamps)
        t += fmt::format("  towards {:.4f}, {:.4f}, {:.4f}: half angle {:.1f} degrees, irradiance {:.4f} {:.4f} "
                         "{:.4f} +- {:.4f}\n",
                         l.direction.x, l.direction.y, l.direction.z, glm::degrees(l.half_angle_rad),
                         l.irradiance[0], l.irradiance[1], l.irradiance[2], l.sigma[1]);
    t += fmt::format(
        "unexplained shading {:.1f} % ({:.1f} % without lights); {} outliers; not determined: {:.0f} % of "
        "all directions, {:.0f} % of those above the horizon\n",
        100 * light.fit.residual, 100 * light.fit.residual_without_lamps, light.fit.outliers,
        100 * light.undetermined_share, 100 * light.undetermined_above);
    return t;
}

void write_light(std::filesystem::path const& file, FrameLight const& light, gi::Report& report)
{
    gi::Picture picture;
    picture.width = light.map.cols;
    picture.height = light.map.rows;
    auto const copy = [&](char const* name, cv::Mat const& from) {
        gi::Layer& layer = picture.add(name, from.channels());
        CV_Assert(from.isContinuous() && from.size() == light.map.size());
        std::copy_n(from.ptr<float>(), layer.data.size(), layer.data.begin());
    };
    copy("color", light.map);
    copy("known", light.known);
    picture.metadata["light"] = "estimated from frames";
    gi::write_exr(file, picture, gi::PixelType::single, report);
}

} // namespace ar
