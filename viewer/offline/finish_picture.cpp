#include "viewer/offline/finish_picture.h"

#include "gi/filter/tone_map.h"
#include "viewer/base/standard_streams.h"
#include "viewer/offline/empty_view.h"
#include "viewer/offline/shown_range.h"

#include <algorithm>

namespace viewer {

std::string denoise(gi::Picture& picture, gi::DenoiseSettings const& settings, gi::Report& report)
{
    if (settings.denoiser == gi::Denoiser::none) return {};
    gi::StageTimer const timer(report, "denoise");
    gi::DenoiseReport const done = gi::denoise(picture, settings);
    report.count("pixels without a surface to filter on", double(done.without_surface));
    if (done.not_finite > 0) report.lose("pixels not filtered, as a value is not finite", done.not_finite);
    return done.no_variance ? "--denoise atrous does nothing: the picture has no variance" : "";
}

namespace {

/// Makes alpha the fourth channel of color.
void join_alpha(gi::Picture& picture)
{
    gi::Layer const* const alpha = picture.find("alpha");
    if (alpha == nullptr) return;
    gi::Layer& color = *picture.find("color");
    std::vector<float> joined;
    joined.reserve(4 * alpha->data.size());
    for (std::size_t p = 0; p < alpha->data.size(); ++p) {
        joined.insert(joined.end(), color.data.begin() + std::ptrdiff_t(3 * p),
                      color.data.begin() + std::ptrdiff_t(3 * p + 3));
        joined.push_back(alpha->data[p]);
    }
    color.channels = 4;
    color.data = std::move(joined);
    std::erase_if(picture.layers, [](gi::Layer const& l) { return l.name == "alpha"; });
}

/// Inverse of join_alpha.
std::pair<gi::Layer, gi::Layer> without_alpha(gi::Layer const& joined)
{
    gi::Layer color{"color", 3, {}}, alpha{"alpha", 1, {}};
    for (std::size_t k = 0; k < joined.data.size(); ++k)
        (k % 4 == 3 ? alpha : color).data.push_back(joined.data[k]);
    return {color, alpha};
}

} // namespace

void split_alpha(gi::Picture& picture)
{
    gi::Layer* const joined = picture.find("color");
    if (joined == nullptr || joined->channels != 4) return;
    auto [color, alpha] = without_alpha(*joined);
    *joined = std::move(color);
    picture.layers.push_back(std::move(alpha));
}

void keep_layers(RenderOptions const& o, gi::Picture& picture)
{
    join_alpha(picture);
    if (o.layers.empty()) return;
    std::erase_if(picture.layers, [&](gi::Layer const& l) {
        return l.name != "color" && std::find(o.layers.begin(), o.layers.end(), l.name) == o.layers.end();
    });
}

void save_exr(RenderOptions const& o, std::string const& file, gi::PictureRows const& picture, gi::Report& report,
              gi::ExrAttributes const& attributes)
{
    gi::write_exr(file, picture, o.half ? gi::PixelType::half : gi::PixelType::single, report, attributes);
}

std::vector<unsigned char> display_bytes(RenderOptions const& o, gi::Picture const& picture)
{
    gi::ToneMapSettings const tone{float(o.exposure_ev),
                                   o.tone == "filmic" ? gi::ToneCurve::filmic : gi::ToneCurve::srgb};
    gi::Layer const &color = *picture.find("color"), *const alpha = picture.find("alpha");
    if (alpha != nullptr) return gi::tone_map_bytes(color, *alpha, tone);
    if (color.channels != 4) return gi::tone_map_bytes(color, tone);
    auto const [plain, apart] = without_alpha(color);
    return gi::tone_map_bytes(plain, apart, tone);
}

void write_files(RenderOptions const& o, gi::PictureRows const& picture, gi::StopRequest const* stop,
                 gi::Report& report)
{
    gi::StageTimer const timer(report, "save");
    if (!o.png.empty()) {
        ShownRange range;
        gi::write_png(o.png, picture.width, picture.height, [&](int first, int count) {
            if (stop != nullptr && stop->requested()) throw gi::Interrupted();
            gi::Picture const rows = picture.read(first, count);
            std::vector<unsigned char> bytes = display_bytes(o, rows);
            range.add(*rows.find("color"), bytes);
            return bytes;
        });
        std::string const problem = range.problem(o.png, o.exposure_ev);
        bool const is_explained = report.losses().contains(std::string(kSeesNothing)) ||
                                  report.losses().contains(std::string(kSeesSpeck));
        if (!problem.empty() && !is_explained) say(problem);
    }
    if (o.out.empty()) return;
    gi::PictureRows kept = picture;
    kept.read = [&](int first, int count) {
        gi::Picture rows = picture.read(first, count);
        keep_layers(o, rows);
        return rows;
    };
    save_exr(o, o.out, kept, report,
             {.compression = stop != nullptr ? gi::ExrCompression::zip : gi::ExrCompression::none, .stop = stop});
}

} // namespace viewer
