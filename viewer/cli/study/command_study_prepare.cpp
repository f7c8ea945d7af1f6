#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/text.h"
#include "study/display/model_file.h"
#include "viewer/base/arguments.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/base/version.h"
#include "viewer/cli/command_table.h"
#include "viewer/experiment/prepared_list.h"
#include "viewer/experiment/stimuli/study_scenes.h"
#include "viewer/offline/rank_options.h"
#include "viewer/offline/rank_work.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct PrepareOptions {
    std::string script, size = "1280x720", out, display_model;
    double font_px = 22;
    int threads = 0;
    std::string part = "1/1";
    RankOptions ranks;
};

/// "2/8": the second of eight parts.
std::pair<std::size_t, std::size_t> parse_part(std::string const& text)
{
    std::size_t const slash = std::min(text.find('/'), text.size());
    auto const part = gi::parse_number<std::size_t>(std::string_view(text).substr(0, slash));
    auto const parts =
        gi::parse_number<std::size_t>(std::string_view(text).substr(std::min(slash + 1, text.size())));
    if (!part || !parts || *part < 1 || *part > *parts)
        throw gi::InputError("--part '" + text + "' is not understood", "it is a part of several, from 1",
                             "write 1/8 to 8/8");
    return {*part, *parts};
}

int run(PrepareOptions const& o)
{
    auto const [part, parts] = parse_part(o.part);
    LoadedScript const loaded = load_script(o.script);
    auto const [width, height] = parse_size(o.size);
    std::optional<study::DisplayModel> model;
    if (!o.display_model.empty()) model = study::load_display_model(o.display_model);
    auto list =
        prepared_list(loaded.script, {width, height}, float(o.font_px), program_text(), model ? &*model : nullptr);
    if (list.empty())
        throw gi::InputError("nothing to prepare in " + o.script, "no block has stimuli: prepared",
                             "add it to a block, or run with live stimuli");
    for (auto [at, number] = std::pair(list.begin(), std::size_t(0)); at != list.end(); ++number)
        at = number % parts == part - 1 ? std::next(at) : list.erase(at);
    gi::make_folder(o.out);
    Cluster cluster(
        {version_text(), "study prepare " + o.size, Cluster::started_by_mpirun() ? file_hash(o.script) : 0},
        cluster_settings(o.ranks));
    gi::Report report;
    std::size_t made = 0, number = 0;
    bool is_interrupted = false;
    try {
        gi::StopRequest stop;
        RankWork work(cluster, stop);
        InterruptGuard const guard(stop);
        gi::ProgressBar bar("prepare " + loaded.script.id, work.leads());
        SceneAccess const scenes = study_scenes();
        for (auto const& [key, wanted] : list) {
            bar.update(double(number) / double(list.size()), name_of(wanted.stimulus));
            if (int(number++ % std::size_t(work.size())) != work.rank()) continue;
            try {
                made += prepare_stimulus(wanted, o.out, key, scenes, o.threads, stop, report);
            } catch (gi::InputError const& e) {
                is_interrupted = stop.requested();
                if (is_interrupted) break;
                throw gi::InputError(wanted.where, e.what(), "complete stimuli are kept");
            }
        }
        work.talk([&](Cluster& c) {
            if (!c.leads()) {
                std::string const count = std::to_string(made);
                return c.give({count.begin(), count.end()});
            }
            for (int rank = 1; rank < c.size(); ++rank)
                if (auto const count = c.take(rank))
                    made += std::size_t(std::stoul(std::string(count->begin(), count->end())));
        });
        if (is_interrupted) throw RankInterrupted();
        bool const leads = work.leads();
        work.finish();
        if (!leads) return 0;
    } catch (RankInterrupted const&) {
        fmt::print(stderr, "interrupted: complete stimuli are kept\n");
        return interrupted_code();
    } catch (RankLoss const& e) {
        fmt::print(stderr, "lightwell: {} stops: {}; complete stimuli are kept\n", cluster.name(), e.what());
        return 1;
    } catch (std::exception const& e) {
        cluster.leave(e.what());
        throw;
    }
    print_losses(report);
    fmt::print("{}: {} stimuli, {} rendered, {} existed already\n", o.out, list.size(), made, list.size() - made);
    return 0;
}

} // namespace

void add_study_prepare(CLI::App& study, int& exit_code)
{
    auto const o = std::make_shared<PrepareOptions>();
    CLI::App* const c = study.add_subcommand("prepare", about("study prepare"));
    c->add_option("SCRIPT", o->script, "experiment (YAML, schema study/2)")->required();
    c->add_option("--size", o->size, "size of the participant's window, px")->capture_default_str();
    c->add_option("--font", o->font_px, "height of text in the window, px")
        ->check(CLI::Range(8, 200))
        ->capture_default_str();
    c->add_option("-o,--out", o->out, "folder for the pictures")->required();
    c->add_option("--display-model", o->display_model, "display model of the monitor, for sizes in degrees");
    c->add_option("--threads", o->threads, "render threads, 0 = all")
        ->check(CLI::Range(0, 1024))
        ->transform(as_many_threads_as_there_are())
        ->capture_default_str();
    c->add_option("--part", o->part, "render only a part of the stimuli, e.g. 2/8")->capture_default_str();
    declare_rank_options(*c, o->ranks);
    c->callback([o, &exit_code] { exit_code = run(*o); });
    c->footer(R"(Example:
  mpirun -n 2 lightwell study prepare faces.yaml --size 1280x720 --out prepared

Stimuli are identified by a hash of scene, settings, size and program version. Under mpirun they are distributed
over the processes, which must share a disk.)");
}

} // namespace viewer
