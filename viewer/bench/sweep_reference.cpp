#include "viewer/bench/sweep_reference.h"

#include "gi/core/rng.h"
#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/metrics/metrics.h"
#include "gi/render/fingerprint.h"
#include "viewer/base/version.h"
#include "viewer/offline/render_record.h"

#include <fmt/format.h>
#include <limits>

namespace viewer {
namespace {

constexpr std::uint64_t kReferenceSeed = 20120301; // differs from those of compared renders, which start at 1

double relative_variance(gi::Picture const& picture)
{
    gi::Layer const *color = picture.find("color"), *variance = picture.find("variance");
    if (variance == nullptr) return std::numeric_limits<double>::quiet_NaN();
    double sum = 0;
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
        gi::vec3 const c = gi::rgb(*color, i), v = gi::rgb(*variance, i);
        for (int k = 0; k < 3; ++k) sum += double(v[k]) / (double(c[k]) * double(c[k]) + gi::kRelativeFloor);
    }
    return sum / (3 * double(picture.pixels()));
}

std::string hash(SweepScene const& scene, gi::RenderSettings const& s, ReferenceOf valid)
{
    std::uint64_t h =
        gi::fingerprint(scene.world, scene.camera, s, "reference",
                        gi::lamp_caustic_options(scene.world, s) + gi::lamp_light_version(scene.world));
    auto const add = [&](std::uint64_t v) { h = gi::mix_bits(h ^ (v + 0x9e3779b97f4a7c15ULL)); };
    add(s.paths);
    std::string const program = valid == ReferenceOf::any_program ? "L1" : scene.options.scene + '\n' + git_hash();
    for (char const c : program) add(static_cast<unsigned char>(c));
    return fmt::format("{:016x}", h);
}

} // namespace

SweepReference keep_reference(gi::Picture picture, std::filesystem::path const& folder, std::string const& stem)
{
    SweepReference reference{std::move(picture), 0, stem + ".png"};
    reference.relmse = relative_variance(reference.picture);
    gi::write_png(folder / reference.png_file, reference.picture.width, reference.picture.height,
                  gi::tone_map_bytes(*reference.picture.find("color"), {}));
    return reference;
}

std::optional<SweepReference> find_reference(SweepScene const& scene, gi::RenderSettings s, std::uint32_t paths,
                                             std::filesystem::path const& folder, gi::StopRequest const& stop,
                                             gi::Report& report, ReferenceOf valid)
{
    s.paths = paths;
    s.budget_s = 0;
    s.seed = kReferenceSeed;
    std::string const stem = fmt::format("reference_{}_{}", scene.name, hash(scene, s, valid));
    std::filesystem::path const file = folder / (stem + ".exr");
    if (std::filesystem::exists(file)) return keep_reference(gi::read_exr(file), folder, stem);

    s.checkpoint = folder / (stem + ".exr.state");
    s.resume = true;
    gi::ProgressBar bar("reference " + scene.name, !scene.options.quiet);
    auto const show = [&](gi::RenderStatus const& status) {
        bar.update(status.fraction, fmt::format("{} paths", status.paths));
    };
    gi::RenderResult result =
        gi::find_method("reference").render(scene.world, scene.camera, s, stop, show, report);
    if (result.end == gi::RenderEnd::interrupted) return std::nullopt;
    RenderOptions options = scene.options;
    options.method = "reference";
    result.picture.metadata = make_metadata(options, s, result);
    std::erase_if(result.picture.layers, [&](gi::Layer const& l) {
        bool const direct = l.name == "L1" && valid == ReferenceOf::any_program;
        return !direct && l.name != "color" && l.name != "variance" && l.name != "L2";
    });
    gi::write_exr(file, result.picture, gi::PixelType::single, report);
    std::filesystem::remove(s.checkpoint);
    return keep_reference(std::move(result.picture), folder, stem);
}

} // namespace viewer
