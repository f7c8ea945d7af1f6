#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/generate/write_glb.h"
#include "gi/scene/model/sky.h"
#include "viewer/base/arguments.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/base/standard_streams.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <memory>
#include <tuple>

namespace viewer {
namespace {

struct GenerateOptions {
    gi::AtriumOptions atrium;
    std::uint32_t triangles = 20000;
    std::uint64_t seed = 0;
    bool no_figure = false;
    gi::SkyOptions sky;
    bool no_sun = false;
    std::string sky_size = "1024x512", ground;
    std::string out;
};

/// Throws before anything is written if a file cannot be written or would replace a scene that was not generated.
void check_bundle(gi::Scene const& scene, std::string const& out)
{
    std::vector<std::string> names;
    for (std::filesystem::path const& file : gi::scene_bundle_files(out, scene)) names.push_back(file.string());
    check_outputs(names, {});
    std::string const& last = names.back();
    std::ifstream in(last);
    std::string line;
    if (names.size() > 1 && in && (!std::getline(in, line) || line != gi::kBundleMark))
        throw gi::InputError("'" + last + "' is not replaced", "it was not generated", "choose another --out");
}

int save(gi::Scene const& scene, std::string const& out)
{
    check_bundle(scene, out);
    gi::Report report;
    for (std::filesystem::path const& file : gi::write_scene_bundle(out, scene, report))
        fmt::print("{}\n", file.string());
    std::fflush(stdout);
    print_losses(report);
    return 0;
}

/// Luminance of a white diffuse surface that lies flat under the map, kcd/m2.
double on_flat_white(gi::EnvironmentMap const& map)
{
    double sum = 0;
    for (std::uint32_t y = 0; y < map.height / 2; ++y) {
        double const polar = gi::kPiD * (y + 0.5) / map.height,
                     texel_sr = 2 * gi::kPiD * gi::kPiD / (double(map.width) * map.height) * std::sin(polar);
        for (std::uint32_t x = 0; x < map.width; ++x)
            sum += texel_sr * std::cos(polar) *
                   double(glm::dot(map.radiance[std::size_t(y) * map.width + x], {0.2126f, 0.7152f, 0.0722f}));
    }
    return sum / gi::kPiD;
}

int save_sky(GenerateOptions const& o)
{
    gi::SkyOptions sky = o.sky;
    std::tie(sky.width, sky.height) = parse_size(o.sky_size);
    sky.sun = !o.no_sun;
    if (!o.ground.empty()) sky.ground_albedo = gi::vec3(parse_color("--ground-albedo", o.ground));
    gi::EnvironmentMap const map = gi::sky_map(sky);
    gi::Picture picture;
    picture.width = int(map.width);
    picture.height = int(map.height);
    picture.metadata = {{"units", "kcd/m2, linear Rec. 709"}};
    gi::Layer& color = picture.add("color", 3);
    for (std::size_t i = 0; i < map.radiance.size(); ++i)
        for (int c = 0; c < 3; ++c) color.data[3 * i + std::size_t(c)] = map.radiance[i][c];
    gi::Report report;
    gi::write_exr(o.out, picture, gi::PixelType::single, report);
    fmt::print("{}\n", o.out);
    std::fflush(stdout);
    double const white = on_flat_white(map);
    say(fmt::format(
        "a white floor under it sends {0:.3g} kcd/m2: with --envmap-scale {1:.2g} it is just white in a PNG",
        white, 1 / white));
    print_losses(report);
    return 0;
}

void declare_sky(CLI::App& generate, std::shared_ptr<GenerateOptions> const& o, int& exit_code)
{
    CLI::App* const c = generate.add_subcommand(
        "sky", "a clear sky (Preetham et al. 1999) as a lat-long map, luminance in kcd/m2");
    gi::SkyOptions& s = o->sky;
    c->add_option("--turbidity", s.turbidity, "2 (very clear) to 10 (hazy)")->capture_default_str();
    c->add_option("--sun-elevation", s.sun_elevation_deg, "degrees, 0 to 90")->capture_default_str();
    c->add_option("--sun-azimuth", s.sun_azimuth_deg, "degrees from -Z towards +X")->capture_default_str();
    c->add_flag("--no-sun", o->no_sun, "omit the sun's disc; the ground is still lit by it");
    c->add_option("--ground-albedo", o->ground, "albedo below the horizon: one number or R,G,B (default: 0.2)");
    c->add_option("--size", o->sky_size, "width x height, texels")->capture_default_str();
    c->add_option("-o,--out", o->out, "EXR file to write (.exr)")->required();
    c->callback([o, &exit_code] {
        check_ending(o->out, ".exr", "an OpenEXR picture", "end it with .exr");
        check_outputs({o->out}, {});
        exit_code = save_sky(*o);
    });
}

} // namespace

void add_generate(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<GenerateOptions>();
    CLI::App* const c = app.add_subcommand("generate", about("generate"));
    c->require_subcommand(1);
    c->footer(R"(Examples:
  lightwell generate cornell --out cornell.glb
  lightwell generate atrium --bays 3 --no-figure --out small_atrium.glb
  lightwell generate boxes --triangles 20000 --seed 1 --out boxes.glb
  lightwell generate sphere --triangles 20000 --out sphere.glb
  lightwell generate mirror --out mirror.glb
  lightwell generate ring --out ring.glb
  lightwell generate avatar --out avatar.glb
  lightwell generate sky --turbidity 3 --sun-elevation 40 --sun-azimuth 120 --size 256x128 --out sky.exr

A scene with a sky is saved as three files: F.glb, F_sky.exr and F.yaml, which refers to both.
`lightwell render SCENE --envmap sky.exr --envmap-scale 0.05` lights a scene by a sky.)");
    using Make = std::function<gi::Scene()>;
    auto const add = [&](char const* name, char const* help, Make const& make) {
        CLI::App* const kind = c->add_subcommand(name, help);
        kind->add_option("-o,--out", o->out, "GLB file to write (.glb)")->required();
        kind->callback([o, make, &exit_code] {
            check_ending(o->out, ".glb", "a binary glTF scene", "end it with .glb");
            check_outputs({o->out}, {});
            exit_code = save(make(), o->out);
        });
        return kind;
    };
    CLI::App* const atrium = add("atrium", "a colonnaded gallery, lit from outside", [o] {
        o->atrium.figure = !o->no_figure;
        return gi::generate_atrium(o->atrium);
    });
    atrium->add_option("--bays", o->atrium.bays, "arches along the gallery")->capture_default_str();
    atrium->add_option("--detail", o->atrium.detail, "tessellation; 1 = about 50,000 triangles")
        ->capture_default_str();
    atrium->add_option("--sun-elevation", o->atrium.sun_elevation_deg, "degrees")->capture_default_str();
    atrium->add_option("--sun-azimuth", o->atrium.sun_azimuth_deg, "degrees from -Z towards +X")
        ->capture_default_str();
    atrium->add_flag("--no-figure", o->no_figure, "leave out the walking figure");
    add("cornell", "the Cornell box with its published measurements", [] { return gi::generate_cornell(); });
    add("mirror", "a room with a mirror in front of the camera", [] { return gi::generate_mirror(); });
    add("ring", "a box with a mirroring ring and a glass sphere", [] { return gi::generate_ring(); });
    add("avatar", "a skinned mannequin, for view --avatar", [] { return gi::generate_avatar(); });
    CLI::App* const boxes = add("boxes", "randomly turned boxes on a grid, in a closed room with a lamp",
                                [o] { return gi::generate_boxes(o->triangles, o->seed); });
    CLI::App* const sphere =
        add("sphere", "a displaced sphere", [o] { return gi::generate_sphere(o->triangles, o->seed); });
    for (CLI::App* const kind : {boxes, sphere}) {
        kind->add_option("--triangles", o->triangles, "approximate number of triangles")->capture_default_str();
        kind->add_option("--seed", o->seed, "seed of the random numbers")
            ->check(check_seed)
            ->capture_default_str();
    }
    declare_sky(*c, o, exit_code);
}

} // namespace viewer
