#include "viewer/bench/dynamic.h"

#include "gi/core/durable_file.h"
#include "gi/core/quantile.h"
#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "gi/methods/registry.h"
#include "gi/metrics/compare.h"
#include "gi/scene/generate/figure.h"
#include "gi/scene/generate/generate.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/dynamic_sequence.h"
#include "viewer/bench/lag.h"
#include "viewer/offline/frame_record.h"
#include "viewer/offline/load_world.h"
#include "viewer/report/table_file.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>
#include <unistd.h>

namespace viewer {
namespace {

using namespace gi;
namespace fs = std::filesystem;

/// Room with a static displaced sphere and a walking figure of 10,880 triangles.
Scene figure_in_room(std::uint32_t triangles)
{
    Scene scene = generate_sphere(triangles, 0);
    add_figure(scene, glm::translate(dmat4(1), dvec3{3.5, 0, -1.5}), 1);
    return scene;
}

/// Resident memory of this program.
double memory_mib()
{
    std::ifstream statm("/proc/self/statm");
    double size = 0, resident = 0;
    statm >> size >> resident;
    return resident * double(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

struct FrameError {
    double relmse = std::nan(""), flip = std::nan("");
};

FrameError error_of(Picture const& picture, Picture const& truth)
{
    FrameError e;
    for (NamedValue const& v : compare(picture, truth, {"relmse", "flip"}, "color").values)
        (v.name == "flip" ? e.flip : e.relmse) = v.value;
    return e;
}

Cell to_cell(double v) { return std::isnan(v) ? Cell() : Cell(v); }

class Dynamic {
public:
    Dynamic(DynamicOptions const& o, Report& report)
        : o_(o),
          frames_(start_table("dynamic", "Frames of moving scenes, by method slhb: their cost and error",
                              {"scene",      "triangles",   "moving",        "structure",      "frame",
                               "time_s",     "world_ms",    "structures_ms", "shadow_maps_ms", "g_buffer_ms",
                               "direct_ms",  "indirect_ms", "reuse_ms",      "filter_ms",      "frame_ms",
                               "memory_MiB", "paths",       "relmse",        "flip",           "relmse_alone",
                               "flip_alone", "lag_relmse"})),
          summary_(start_table("dynamic_summary", "The same over all frames except the first",
                               {"scene",         "triangles",       "moving",       "structure",
                                "structures_ms", "frame_ms",        "frame_ms_p95", "frame_ms_p99",
                                "frame_ms_most", "memory_MiB",      "paths",        "relmse",
                                "flip",          "flip_most",       "relmse_alone", "raised",
                                "lag_relmse",    "lag_relmse_most", "not_finite",   "picture_file",
                                "flip_file",     "reference_file"})),
          report_(report)
    {
    }

    void run(std::string const& name, std::shared_ptr<Scene const> const& scene)
    {
        RenderOptions options = o_.render;
        RenderSettings settings = make_settings(options);
        settings.checkpoint.clear();
        DenoiseSettings const filter = make_denoise_settings(options, settings);
        references_ = render_references(scene, settings);
        for (std::string const& structure : o_.structures)
            render(name, scene, find_structure(structure), settings, filter);
    }
    DynamicResult result() && { return {std::move(frames_), std::move(summary_)}; }

private:
    std::vector<Picture> render_references(std::shared_ptr<Scene const> const& scene, RenderSettings s) const
    {
        s.paths = o_.reference_paths;
        s.budget_s = 0;
        s.seed += 1000;
        std::vector<Picture> pictures;
        if (o_.reference_paths == 0) return pictures;
        double const first_s = o_.render.time_s.value_or(0);
        MovingWorld world(scene, first_s, report_);
        auto const eye = [&] { return choose_camera(world.world(), camera_choice(o_.render)).camera; };
        auto const reference = find_method("reference").frames(world, eye(), s, report_);
        for (int f = 0; f < o_.frames; ++f) {
            reference->changed(world.advance(first_s + f / o_.fps));
            Picture p = reference->frame(eye(), {}, {}).picture;
            std::erase_if(p.layers, [](Layer const& l) { return l.name != "color"; });
            pictures.push_back(std::move(p));
        }
        return pictures;
    }

    void render(std::string const& name, std::shared_ptr<Scene const> const& scene, Structure const& structure,
                RenderSettings settings, DenoiseSettings const& filter)
    {
        settings.of<gi::SlhbSettings>().schedule = structure.schedule;
        if (structure.schedule != Schedule::stored) settings.of<gi::SlhbSettings>().directions.clear();
        auto const truth = [&](int f) -> Picture const& {
            return references_[structure.moves ? std::size_t(f) : 0];
        };
        LagError lag{std::size_t(o_.frames)};
        bool const judged = !references_.empty(), reuses = o_.most_frames > 1;
        std::vector<FrameSeconds> seconds;
        std::vector<double> memory, paths;
        std::vector<FrameError> errors, alone;
        std::vector<std::string> files(3);
        std::ptrdiff_t not_finite = 0;
        double triangles = 0, moving = 0;
        for (int seed = 0; seed < o_.seeds; ++seed) {
            RenderSettings s = settings;
            s.seed += std::uint64_t(seed);
            DynamicSequence sequence(o_, scene, structure, s, report_);
            triangles = double(sequence.world().triangles.size());
            moving = triangles - double(sequence.world().static_triangles);
            for (int f = 0; f < o_.frames; ++f) {
                DynamicSequence::Frame const frame = sequence.next(filter, judged);
                not_finite += std::ranges::count_if(frame.picture.find("color")->data,
                                                    [](float v) { return !std::isfinite(v); });
                if (judged && reuses) lag.add(std::size_t(seed), std::size_t(f), frame.picture, frame.alone);
                if (seed > 0) continue; // further seeds are only for the lag
                seconds.push_back(frame.seconds);
                memory.push_back(memory_mib());
                paths.push_back(frame.paths);
                errors.push_back(judged ? error_of(frame.picture, truth(f)) : FrameError());
                alone.push_back(judged && reuses ? error_of(frame.alone, truth(f)) : FrameError());
                if (f + 1 == o_.frames && judged) files = save(name, structure, frame.picture, truth(f));
            }
        }

        std::vector<double> lags;
        for (std::size_t f = 0; f < seconds.size(); ++f) {
            FrameSeconds const& s = seconds[f];
            lags.push_back(judged && reuses ? lag.relmse(f, truth(int(f))) : std::nan(""));
            frames_.add({name,
                         triangles,
                         moving,
                         std::string(structure.name),
                         double(f),
                         first_s() + double(f) / o_.fps,
                         1e3 * s.world,
                         1e3 * s.structures,
                         1e3 * s.shadow_maps,
                         1e3 * s.g_buffer,
                         1e3 * s.direct,
                         1e3 * s.indirect,
                         1e3 * s.reuse,
                         1e3 * s.filter,
                         1e3 * s.whole,
                         memory[f],
                         paths[f],
                         to_cell(errors[f].relmse),
                         to_cell(errors[f].flip),
                         to_cell(alone[f].relmse),
                         to_cell(alone[f].flip),
                         to_cell(lags[f])});
        }
        // The first frame builds lasting structures.
        auto const over = [&](double share, auto const& value) {
            std::vector<double> v;
            for (std::size_t f = 1; f < seconds.size(); ++f) v.push_back(value(f));
            return to_cell(gi::quantile(std::move(v), share));
        };
        auto const whole = [&](std::size_t f) { return 1e3 * seconds[f].whole; };
        auto const lag_of = [&](std::size_t f) { return lags[f]; };
        double raised = 0;
        for (std::size_t f = 1; f < seconds.size(); ++f) raised += errors[f].relmse > alone[f].relmse;
        summary_.add({name,
                      triangles,
                      moving,
                      std::string(structure.name),
                      over(0.5, [&](std::size_t f) { return 1e3 * seconds[f].structures; }),
                      over(0.5, whole),
                      over(0.95, whole),
                      over(0.99, whole),
                      over(1, whole),
                      settled(memory),
                      over(0.5, [&](std::size_t f) { return paths[f]; }),
                      over(0.5, [&](std::size_t f) { return errors[f].relmse; }),
                      over(0.5, [&](std::size_t f) { return errors[f].flip; }),
                      over(1, [&](std::size_t f) { return errors[f].flip; }),
                      over(0.5, [&](std::size_t f) { return alone[f].relmse; }),
                      judged && reuses ? Cell(raised) : Cell(),
                      over(0.5, lag_of),
                      over(1, lag_of),
                      double(not_finite),
                      files[0],
                      files[1],
                      files[2]});
        write(frames_, o_.out);
        write(summary_, o_.out);
    }

    double first_s() const { return o_.render.time_s.value_or(0); }

    /// Value of the last frame, with the range since lasting structures were built.
    static Cell settled(std::vector<double> const& memory)
    {
        constexpr std::size_t kSettled = 100;
        std::span const later = std::span(memory).subspan(std::min(kSettled, memory.size() - 1));
        return Measured{later.back(), *std::ranges::min_element(later), *std::ranges::max_element(later),
                        int(later.size())};
    }

    /// Saves the last frame, its FLIP map and its reference.
    std::vector<std::string> save(std::string const& name, Structure const& structure, Picture const& picture,
                                  Picture const& truth) const
    {
        std::string stem = fmt::format("{}_{}", fs::path(name).stem().string(), structure.name);
        std::ranges::replace(stem, ' ', '_');
        int width = 0, height = 0;
        auto const flip = difference_image(picture, truth, "color", width, height);
        std::vector<std::string> files{stem + ".png", stem + "_flip.png", stem + "_reference.png"};
        write_png(fs::path(o_.out) / files[0], picture.width, picture.height,
                  tone_map_bytes(*picture.find("color"), {}));
        write_png(fs::path(o_.out) / files[1], width, height, flip);
        write_png(fs::path(o_.out) / files[2], truth.width, truth.height,
                  tone_map_bytes(*truth.find("color"), {}));
        return files;
    }

    DynamicOptions const& o_;
    BenchTable frames_, summary_;
    Report& report_;
    std::vector<Picture> references_; ///< one per frame
};

} // namespace

DynamicResult run_dynamic(DynamicOptions const& o, Report& report)
{
    check_folder(o.out);
    for (std::string const& s : o.structures) find_structure(s);
    gi::make_folder(o.out);
    Dynamic bench(o, report);
    for (std::string const& scene : o.scenes) {
        RenderOptions options = o.render;
        options.scene = scene;
        bench.run(scene, load_lit_scene(options, report));
    }
    for (std::uint32_t const t : o.triangles)
        bench.run(fmt::format("figure in a room of {}", t), std::make_shared<Scene const>(figure_in_room(t)));
    return std::move(bench).result();
}

} // namespace viewer
