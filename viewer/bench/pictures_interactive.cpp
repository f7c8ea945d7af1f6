// `lightwell bench pictures --interactive`: compares methods by interactive frames of moving scenes.

#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/base/arguments.h"
#include "viewer/base/interrupt.h"
#include "viewer/base/report_json.h"
#include "viewer/bench/bench_record.h"
#include "viewer/bench/pictures_filtered.h"
#include "viewer/bench/pictures_score.h"
#include "viewer/offline/frame_follower.h"
#include "viewer/offline/frame_options.h"
#include "viewer/offline/load_world.h"
#include "viewer/report/page.h"
#include "viewer/report/picture_summary.h"
#include "viewer/report/table_file.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;

/// Scores of one method, one value per scored frame.
struct FrameScores {
    std::vector<double> paths, filter_s, relmse, flip, correlation;
};

/// A moving scene, its cameras, and references of the scored frames.
class SequenceOfFrames {
public:
    SequenceOfFrames(ListedScene const& listed, PicturesOptions const& o, gi::Report& report)
        : o_(o), listed_(listed), scene_(load_lit_scene(listed.options, report))
    {
        gi::World const first = gi::build_world(scene_, time_s(0), report);
        origin_ = first.origin;
        camera_.emplace(first, camera_choice(listed.options), make_motion(listed.options));
    }

    std::string const& name() const { return listed_.name; }
    std::shared_ptr<gi::Scene const> const& scene() const { return scene_; }
    gi::dvec3 origin() const { return origin_; }
    double time_s(int frame) const { return listed_.options.time_s.value_or(frame / o_.fps); }
    gi::Camera camera(gi::World const& world, int frame) const
    {
        return camera_->of(world, frame / o_.fps, frame / double(o_.frames));
    }
    /// @return false if it was interrupted
    bool find_references(gi::RenderSettings const& settings, gi::StopRequest const& stop, gi::Report& report)
    {
        fs::path const folder = reference_folder(o_);
        for (int const number : o_.scored_frames) {
            gi::World world = gi::build_world(scene_, time_s(number - 1), report, origin_);
            gi::Camera const eye = camera(world, number - 1);
            SweepScene const at{listed_.options, fmt::format("{}_{}", listed_.name, number), std::move(world),
                                eye};
            auto found =
                find_reference(at, settings, o_.reference_paths, folder, stop, report, ReferenceOf::any_program);
            if (!found) return false;
            references_.push_back(keep_reference(std::move(found->picture), o_.out, "reference_" + at.name));
        }
        return true;
    }
    /// Reference of a frame; null if it is not scored. @param frame  counted from 0
    SweepReference const* reference(int frame) const
    {
        auto const at = std::ranges::find(o_.scored_frames, frame + 1);
        return at == o_.scored_frames.end() ? nullptr : &references_[std::size_t(at - o_.scored_frames.begin())];
    }

private:
    PicturesOptions const& o_;
    ListedScene const& listed_;
    std::shared_ptr<gi::Scene const> scene_;
    gi::dvec3 origin_{0};
    std::optional<FrameCamera> camera_;
    std::vector<SweepReference> references_;
};

class InteractivePictures {
public:
    InteractivePictures(PicturesOptions const& o, PicturesPlan const& plan, gi::StopRequest const& stop,
                        gi::Report& report, BenchTable& table)
        : o_(o), plan_(plan), stop_(stop), report_(report), table_(table)
    {
    }

    /// @return false if it was interrupted
    bool run(ListedScene const& listed)
    {
        SequenceOfFrames sequence(listed, o_, report_);
        if (!sequence.find_references(plan_.settings, stop_, report_)) return false;
        for (SweepMethod const& method : plan_.methods)
            if (!run(sequence, method)) return false;
        return true;
    }

private:
    bool run(SequenceOfFrames const& sequence, SweepMethod const& method)
    {
        gi::RenderSettings settings = settings_of(method, plan_.settings);
        settings.budget_s = parse_duration("--frame-budget", o_.frame_budget);
        settings.seed = o_.render.settings.seed;
        FrameFollower follower(sequence.scene(), sequence.time_s(0), method.method, settings, o_.reuse,
                               sequence.origin());
        std::vector<FrameScores> scores(plan_.filters.size());
        std::vector<double> all_s;
        gi::ProgressBar bar("frames", !o_.render.quiet);
        for (int k = 0; k < o_.frames; ++k) {
            bar.update(k / double(o_.frames), fmt::format("{}, {}", sequence.name(), method.name));
            gi::Report report;
            FrameFollower::Frame frame;
            double const frame_s = seconds_of([&] {
                gi::World const& world = follower.go_to(sequence.time_s(k));
                frame = follower.render(sequence.camera(world, k), stop_, {}, report);
            });
            for (auto const& [what, loss] : report.losses())
                report_.lose(what, loss.count, fmt::format("{}, frame {}", sequence.name(), k + 1));
            if (frame.result.end == gi::RenderEnd::interrupted || stop_.requested()) return false;
            if (k > 0 || o_.frames == 1) all_s.push_back(frame_s);
            SweepReference const* const reference = sequence.reference(k);
            if (reference == nullptr) continue;
            for (std::size_t f = 0; f < plan_.filters.size(); ++f)
                score_frame(sequence, method, plan_.filters[f], k, frame.result, frame_s, *reference, scores[f]);
        }
        for (std::size_t f = 0; f < plan_.filters.size(); ++f)
            add_mean(sequence, method, plan_.filters[f], scores[f], all_s);
        write(table_, o_.out);
        return true;
    }

    void score_frame(SequenceOfFrames const& sequence, SweepMethod const& method, PictureFilter const& filter,
                     int frame, gi::RenderResult const& result, double frame_s, SweepReference const& reference,
                     FrameScores& into)
    {
        FilteredPicture const done = filtered(result.picture, filter);
        PictureScore const judged = score(done.picture, reference);
        std::string const name = fmt::format("frame {}", frame + 1);
        PictureFiles const files = save_pictures(
            done.picture, reference, o_.out,
            picture_stem(sequence.name(), method.name, fmt::format("frame{}", frame + 1)) + "_" + filter.name);
        table_.add({sequence.name(), name, method.name, filter.name, double(result.paths), frame_s, done.seconds,
                    frame_s + done.seconds, judged.relmse, reference.relmse, judged.flip,
                    judged.neighbour_correlation, files.picture, files.flip_map, reference.png_file});
        into.paths.push_back(result.paths);
        into.filter_s.push_back(done.seconds);
        into.relmse.push_back(judged.relmse);
        into.flip.push_back(judged.flip);
        into.correlation.push_back(judged.neighbour_correlation);
    }

    /// @param all_s  times of all frames except the first, which builds lasting structures
    void add_mean(SequenceOfFrames const& sequence, SweepMethod const& method, PictureFilter const& filter,
                  FrameScores const& s, std::vector<double> const& all_s)
    {
        auto const mean = [](std::vector<double> const& values) { return mean_of(values, 0).value; };
        Measured const frame_s = summarise(all_s);
        Cell const filter_s = mean(s.filter_s);
        table_.add({sequence.name(), std::string("mean"), method.name, filter.name, mean(s.paths), frame_s,
                    filter_s, frame_s.median + number(filter_s), mean(s.relmse), Cell(), mean(s.flip),
                    mean(s.correlation), Cell(), Cell(), Cell()});
    }

    PicturesOptions const& o_;
    PicturesPlan const& plan_;
    gi::StopRequest const& stop_;
    gi::Report& report_;
    BenchTable& table_;
};

void check_interactive(PicturesOptions const& o)
{
    for (int const frame : o.scored_frames)
        if (frame < 1 || frame > o.frames)
            throw gi::InputError(fmt::format("--scored-frames {}", frame),
                                 fmt::format("there are frames 1 to {}", o.frames),
                                 "choose others, or increase --frames");
    refuse_twins("--scored-frames", o.scored_frames, [&] {
        std::vector<std::string> texts;
        for (int const frame : o.scored_frames) texts.push_back(std::to_string(frame));
        return texts;
    }());
}

/// Times at equal error have no meaning here, as all frames have the same budget.
BenchTable frame_summary_of(BenchTable const& frames)
{
    std::string const peer = kPeer;
    BenchTable summary = start_table("interactive_summary", "Frames against " + peer + ", worst first",
                                     {"scene", "budget", "filter", "method", "relmse_over_" + peer,
                                      "flip_over_" + peer, "time_over_" + peer, "lost"});
    summary.facts = frames.facts;
    std::vector<PictureContest> const all = contests(frames, peer);
    add_lost_rows(all, peer, summary);
    for (PictureContest const& c : all)
        summary.add({c.scene, c.budget, c.filter, c.method, c.relmse_ratio, c.flip_ratio, c.time_ratio,
                     std::string(c.lost() ? "lost" : "")});
    return summary;
}

} // namespace

PicturesResult run_interactive_pictures(PicturesOptions const& o)
{
    PicturesPlan const plan = plan_pictures(o);
    check_interactive(o);
    PicturesResult result{start_table("interactive", "Consecutive frames",
                                      {"scene", "budget", "method", "filter", "paths", "frame_s", "filter_s",
                                       "total_s", "relmse", "relmse_of_reference", "flip", "neighbour_correlation",
                                       "picture_file", "flip_file", "reference_file"}),
                          {},
                          false};
    result.pictures.facts = common_facts(o, plan);
    for (auto const& [what, value] : {std::pair{"budget of a frame, without filter", o.frame_budget},
                                      {"reuse, frames", std::to_string(o.reuse)},
                                      {"frames", std::to_string(o.frames)},
                                      {"frames per second", fmt::format("{}", o.fps)}})
        result.pictures.facts.emplace_back(what, value);
    gi::make_folder(o.out);
    for (Skipped const& s : plan.skipped) skip(s, result.pictures);
    gi::Report report;
    gi::StopRequest stop;
    InterruptGuard const guard(stop);
    InteractivePictures pictures(o, plan, stop, report, result.pictures);
    for (ListedScene const& sequence : plan.scenes)
        if (result.interrupted = !pictures.run(sequence); result.interrupted) break;
    if (result.interrupted) result.pictures.facts.emplace_back("interrupted", "rows are missing");
    write(result.pictures, o.out);
    result.summary = frame_summary_of(result.pictures);
    write(result.summary, o.out);
    Page page;
    page.title = "Lightwell bench pictures --interactive";
    page.pictures = PagePictures::linked;
    page.folders.push_back({o.out, {result.summary, result.pictures}, {}});
    gi::write_text(fs::path(o.out) / "interactive.html", make_page(page));
    print_losses(report);
    return result;
}

} // namespace viewer
