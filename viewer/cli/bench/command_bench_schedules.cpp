#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/text.h"
#include "gi/metrics/metrics.h"
#include "viewer/base/arguments.h"
#include "viewer/base/report_json.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/bench_session.h"
#include "viewer/cli/commands.h"
#include "viewer/engine/quality.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/report/table_file.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <memory>

namespace viewer {
namespace {

struct SchedulesOptions {
    std::vector<std::string> scenes{"atrium"}, settings;
    std::vector<std::string> schedules{"stored", "stored/32", "stored/16", "stored/8", "temporal", "streamed"};
    std::vector<int> paths{1, 2};
    std::string size = "320x240", out;
    int frames = 20, judged = 2, reference_paths = 160;
    double rate_hz = 20;
    bool json = false;
};

struct Variant {
    std::string schedule;
    int paths;
    std::unique_ptr<gi::Report> report = std::make_unique<gi::Report>();
    std::unique_ptr<RenderSession> session{};
    std::vector<double> ms{}, following_ms{};
    double relmse = 0;
};

/// Settings of a schedule; "stored/16" updates 16 of the stored directions of each bounce per frame.
std::vector<Change> changes_of(std::string const& text)
{
    std::size_t const slash = text.find('/');
    if (slash == std::string::npos) return {{"method", "slhb"}, {"schedule", text}};
    auto const updated = gi::parse_number<int>(std::string_view(text).substr(slash + 1));
    if (text.substr(0, slash) != "stored" || !updated)
        throw gi::InputError("'" + text + "' is no schedule",
                             "only the stored schedule can update a part of its directions",
                             "give stored, stored/16, temporal or streamed");
    return {{"method", "slhb"}, {"schedule", "auto"}, {"updated_axes", *updated}};
}

constexpr int kFirstMeasured = 4; ///< earlier frames build lasting structures and are not measured

class Measurement {
public:
    Measurement(SchedulesOptions const& o, std::string const& scene) : o_(o), scene_(scene)
    {
        std::vector<Change> const settings = parse_changes(o.settings);
        for (std::string const& schedule : o.schedules)
            for (int const paths : o.paths) {
                Variant& v = variants_.emplace_back(Variant{schedule, paths});
                std::vector<Change> all = settings;
                for (Change const& change : changes_of(schedule)) all.push_back(change);
                v.session = bench_session(scene, all, *v.report);
            }
        start_ = choose_camera(variants_[0].session->world(), {}).camera;
    }

    void run()
    {
        for (int f = 0; f < o_.frames; ++f) {
            std::vector<gi::Layer> pictures;
            for (Variant& v : variants_) pictures.push_back(frame(f, v)); // variants take turns
            if (f < o_.frames - o_.judged) continue;
            gi::Layer const truth =
                reference_of(*variants_[0].session, command(f, 1).views[0], o_.reference_paths, reference_report_);
            for (std::size_t k = 0; k < variants_.size(); ++k) {
                auto const errors = gi::measure_errors(pictures[k].data, truth.data, 3);
                variants_[k].relmse += errors.relmse / o_.judged;
                if (errors.not_finite > 0)
                    variants_[k].report->lose("values that are not finite, left out of the error",
                                              errors.not_finite);
            }
        }
    }

    void add_to(BenchTable& table) const
    {
        gi::World const& world = variants_[0].session->world();
        table.facts.emplace_back(
            scene_ + ", triangles that can move",
            fmt::format("{} of {}", world.triangles.size() - world.static_triangles, world.triangles.size()));
        print_losses(reference_report_);
        for (Variant const& v : variants_) {
            print_losses(*v.report, fmt::format("{}, {} paths: ", v.schedule, v.paths));
            table.add({scene_, v.schedule, double(v.paths), summarise(v.ms), summarise(v.following_ms), v.relmse});
        }
    }

private:
    FrameCommand command(int f, int paths) const
    {
        auto const [width, height] = parse_size(o_.size);
        gi::Camera camera = start_;
        camera.world_from_camera =
            camera.world_from_camera * glm::translate(gi::dmat4(1), gi::dvec3{0.01 * f, 0, 0});
        FrameCommand command;
        command.frame = std::uint64_t(f);
        command.scene_s = f / o_.rate_hz;
        command.paths = paths;
        command.views.push_back({"view", camera, width, height, -1});
        return command;
    }

    gi::Layer frame(int f, Variant& v) const
    {
        SessionFrame done;
        double const s = seconds_of([&] { done = v.session->render(command(f, v.paths), {}); });
        if (f >= kFirstMeasured) {
            v.ms.push_back(1e3 * s);
            v.following_ms.push_back(1e3 * done.dynamic_update.seconds);
        }
        return *done.views[0].picture.find("color");
    }

    SchedulesOptions const& o_;
    std::string scene_;
    gi::Camera start_;
    std::vector<Variant> variants_;
    gi::Report reference_report_;
};

int run(SchedulesOptions const& o)
{
    if (o.judged > o.frames)
        throw gi::InputError(fmt::format("--judged {} of {} frames", o.judged, o.frames), "there are fewer",
                             "judge fewer, or render more");
    for (std::string const& schedule : o.schedules) {
        Settings settings;
        for (Change const& change : changes_of(schedule)) set(settings, change);
    }
    check_folder(o.out);
    gi::make_folder(o.out);
    BenchTable table = start_table("schedules", "Schedules of hit buffers in moving scenes",
                                   {"scene", "schedule", "paths_per_pixel", "frame_ms", "following_ms", "relmse"});
    table.facts = {{"size", o.size},
                   {"frames", std::to_string(o.frames)},
                   {"frames timed", std::to_string(o.frames - kFirstMeasured)},
                   {"rate, Hz", fmt::format("{}", o.rate_hz)},
                   {"frames judged", std::to_string(o.judged)},
                   {"paths of the reference", std::to_string(o.reference_paths)}};
    if (!o.settings.empty()) table.facts.emplace_back("set", fmt::format("{}", fmt::join(o.settings, " ")));
    for (std::string const& scene : o.scenes) {
        Measurement m(o, scene);
        m.run();
        m.add_to(table);
        write(table, o.out);
    }
    show(table, o.out, o.json);
    return 0;
}

} // namespace

void add_bench_schedules(CLI::App& bench, int& exit_code)
{
    auto const o = std::make_shared<SchedulesOptions>();
    CLI::App* const c =
        bench.add_subcommand("schedules", "Compare time and error of hit buffer schedules for moving scenes.");
    c->add_option("--scene", o->scenes, "files or names, comma-separated")
        ->delimiter(',')
        ->capture_default_str()
        ->allow_extra_args(false);
    c->add_option("--schedules", o->schedules,
                  "stored/N: update N stored directions of each bounce per frame; comma-separated")
        ->delimiter(',')
        ->capture_default_str()
        ->allow_extra_args(false);
    c->add_option("--paths", o->paths, "paths per pixel, comma-separated")
        ->delimiter(',')
        ->check(CLI::Range(1, 64))
        ->capture_default_str()
        ->allow_extra_args(false);
    c->add_option("--set", o->settings, "KEY=VALUE as for view; repeatable")->take_all();
    c->add_option("--size", o->size, "width x height, pixels")->capture_default_str();
    c->add_option("--frames", o->frames, "frames per variant; the camera moves by 1 cm per frame")
        ->check(CLI::Range(8, 10000))
        ->capture_default_str();
    c->add_option("--rate", o->rate_hz, "frames per second of scene time")
        ->check(CLI::Range(1.0, 1000.0))
        ->capture_default_str();
    c->add_option("--judged", o->judged, "number of last frames whose errors are averaged")
        ->check(CLI::Range(1, 100))
        ->capture_default_str();
    c->add_option("--reference-paths", o->reference_paths, "paths per pixel of the reference")
        ->check(CLI::Range(1, 1 << 20))
        ->capture_default_str();
    c->add_option("-o,--out", o->out, "folder for schedules.json and schedules.csv")->required();
    c->add_flag("--json", o->json, "print the table as JSON");
    c->footer(R"(Example:
  lightwell bench schedules --schedules stored,stored/16 --paths 1 --size 32x24 --frames 8 --reference-paths 4 --out schedules

Frames are rendered as in view, with reuse and filter; variants take turns. following_ms: time to draw moving
geometry into the layers of stored directions. relmse contains the noise of the reference.)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
