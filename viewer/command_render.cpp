#include "gi/base/error.h"
#include "gi/base/file.h"
#include "gi/base/picture_file.h"
#include "gi/image/tone_map.h"
#include "gi/registry/registry.h"
#include "viewer/commands.h"
#include "viewer/interrupt.h"
#include "viewer/load_world.h"
#include "viewer/outputs.h"
#include "viewer/render_record.h"
#include "viewer/report_json.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

constexpr int kInterrupted = 130;

void say(std::string const& text) { std::fputs(("note: " + text + "\n").c_str(), stderr); }

gi::RenderResult trace(RenderOptions const& o, gi::RenderSettings const& settings, gi::World const& world,
                       gi::Camera const& camera, gi::Report& report)
{
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    gi::ProgressBar bar("render " + std::filesystem::path(o.scene).filename().string(), !o.quiet);
    auto const show = [&](gi::RenderStatus const& s) {
        bar.update(s.fraction, fmt::format("{} paths, relMSE {:.2g}", s.paths, s.relmse));
    };
    return gi::find_method(o.method).render(world, camera, settings, stop, show, report);
}

void denoise(gi::Picture& picture, gi::DenoiseSettings const& settings, gi::Report& report)
{
    if (settings.denoiser == gi::Denoiser::none) return;
    gi::StageTimer const timer(report, "denoise");
    gi::DenoiseReport const done = gi::denoise(picture, settings);
    if (done.no_variance) say("--denoise atrous does nothing: nothing in the picture has a variance");
    report.count("pixels without a surface to filter on", double(done.without_surface));
    if (done.not_finite > 0) report.lose("pixels not filtered, as a value is not finite", done.not_finite);
}

/// The alpha channel goes with the colours.
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

std::vector<unsigned char> display_bytes(gi::Picture const& picture, gi::ToneMapSettings const& tone)
{
    gi::Layer const &color = *picture.find("color"), *const alpha = picture.find("alpha");
    return alpha != nullptr ? gi::tone_map_bytes(color, *alpha, tone) : gi::tone_map_bytes(color, tone);
}

void save(RenderOptions const& o, gi::RenderSettings const& settings, gi::RenderResult& result, gi::Report& report)
{
    gi::StageTimer const timer(report, "save");
    gi::Picture& picture = result.picture;
    picture.metadata = make_metadata(o, settings, result);
    if (!o.png.empty()) {
        gi::ToneMapSettings const tone{float(o.exposure_ev),
                                       o.tone == "filmic" ? gi::ToneCurve::filmic : gi::ToneCurve::srgb};
        gi::write_png(o.png, picture.width, picture.height, display_bytes(picture, tone));
    }
    join_alpha(picture);
    if (!o.out.empty()) {
        if (!o.layers.empty())
            std::erase_if(picture.layers, [&](gi::Layer const& l) {
                return l.name != "color" && std::find(o.layers.begin(), o.layers.end(), l.name) == o.layers.end();
            });
        gi::write_exr(o.out, picture, o.half ? gi::PixelType::half : gi::PixelType::single, report);
    }
}

int run(RenderOptions o)
{
    gi::find_method(o.method);
    gi::RenderSettings const settings = make_settings(o);
    gi::DenoiseSettings const denoise_settings = make_denoise_settings(o, settings);
    CameraChoice const choice = camera_choice(o);
    if (!o.background.empty()) parse_background(o.background); // before any work
    check_outputs({o.out, o.png, o.stats, settings.checkpoint.string()}, {o.scene, o.environment});
    bool const has_state = !settings.checkpoint.empty() && std::filesystem::exists(settings.checkpoint);
    if (o.resume && !has_state) say("there is no '" + settings.checkpoint.string() + "': starting afresh");
    if (!o.resume && has_state)
        throw gi::InputError("'" + settings.checkpoint.string() + "' holds an unfinished render",
                             "a new one would replace it", "add --resume to go on, or delete it");

    gi::Report report;
    gi::World const world = load_world(o, report);
    ChosenCamera const chosen = choose_camera(world, choice);
    if (!chosen.note.empty()) say(chosen.note);
    gi::RenderResult result = trace(o, settings, world, chosen.camera, report);
    denoise(result.picture, denoise_settings, report);
    save(o, settings, result, report);
    if (!settings.checkpoint.empty() && !result.resumable) std::filesystem::remove(settings.checkpoint);

    nlohmann::ordered_json const stats = make_stats(o, settings, gi::plan_scene(world), result, report);
    if (!o.stats.empty()) gi::write_text(o.stats, to_text(stats));
    if (o.json) {
        std::fputs(to_text(stats).c_str(), stdout);
    } else {
        for (std::string const& file : {o.out, o.png, o.stats})
            if (!file.empty()) fmt::print("{}\n", file);
        fmt::print("{}\n", summary_line(o, settings, result));
    }
    std::fflush(stdout);
    print_losses(report);
    if (result.end != gi::RenderEnd::interrupted) return 0;
    say(settings.checkpoint.empty()
            ? "interrupted: the picture so far is saved; with --out it could be resumed"
            : "interrupted: the picture so far is saved; the same command with --resume goes on");
    return kInterrupted;
}

} // namespace

void add_render(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<RenderOptions>();
    CLI::App* const c = app.add_subcommand("render", "Render a scene to a picture with its error.");
    declare_options(*c, *o);
    c->callback([o, c, &exit_code] {
        check_slhb(*c, *o);
        exit_code = run(*o);
    });
}

} // namespace viewer
