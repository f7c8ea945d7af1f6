#include "viewer/offline/frame_sequence.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "gi/methods/registry.h"
#include "gi/render/fingerprint.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/base/standard_streams.h"
#include "viewer/offline/exposure.h"
#include "viewer/offline/finish_picture.h"
#include "viewer/offline/frame_follower.h"
#include "viewer/offline/frame_record.h"
#include "viewer/offline/render_record.h"
#include "viewer/offline/video_writer.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>

namespace viewer {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void add_losses(gi::Report& sum, std::map<std::string, gi::Report::Loss> const& losses, int frame)
{
    for (auto const& [what, loss] : losses)
        sum.lose(what, loss.count, fmt::format("frame {}{}", frame, loss.first.empty() ? "" : ", " + loss.first));
}

class Sequence {
public:
    Sequence(RenderOptions const& o, gi::RenderSettings const& settings,
             gi::DenoiseSettings const& denoise_settings, CameraChoice const& choice, RankWork& work,
             gi::Report& report)
        : o_(o),
          settings_(settings),
          denoise_(denoise_settings),
          f_(make_frame_settings(o, settings)),
          work_(work),
          report_(report)
    {
        denoise_.stop = &stop_;
        if (work.leads()) refuse_to_replace();
        if (!f_.video.empty() && work.leads())
            video_ = std::make_unique<VideoWriter>(f_.video, settings.width, settings.height, f_.range.fps());
        scene_ = load_lit_scene(o_, report_);
        check_outputs(f_.files, scene_->files);
        gi::Report unused; // losses of the world are reported with the frame
        gi::World const first = world_of(f_.range.first, unused);
        if (o.reuse > 1) origin_ = first.origin; // one world advances through all frames
        plan_ = to_json(gi::plan_scene(first).items);
        camera_ = std::make_unique<FrameCamera>(first, choice, f_.motion);
        if (!camera_->note().empty()) say(camera_->note());
        blurs_ = o.shutter_s > 0 && depends_on_time(*scene_, o.time_s.has_value(), f_.motion);
        if (o.shutter_s > 0 && !blurs_) say(kNothingMoves);
        loaded_ = report_.losses();
    }

    FramesEnd run()
    {
        std::vector<char> const there =
            o_.resume ? find_frames() : std::vector<char>(std::size_t(f_.range.count()));
        bool const begins = !f_.state.empty() && work_.leads() && !fs::exists(f_.state);
        if (!f_.state.empty() && work_.leads()) gi::write_text(f_.state, stats_command() + "\n");
        for (int k = f_.range.first; k < f_.range.end; ++k)
            missing_ += is_mine(k) && there[std::size_t(k - f_.range.first)] == 0;
        say_what_is_rendered_again(there);
        bar_.emplace("render " + fs::path(o_.scene).filename().string(), !o_.quiet && work_.leads());
        try {
            render_all(there);
        } catch (gi::InputError const&) {
            if (begins && records_.empty()) fs::remove(f_.state); // otherwise the next call would be refused
            throw;
        }
        bar_.reset();
        if (!work_.alone()) gather();
        return work_.leads() ? finish() : FramesEnd{};
    }

private:
    bool is_mine(int frame) const { return (frame - f_.range.first) % work_.size() == work_.rank(); }

    void render_all(std::vector<char> const& there)
    {
        for (int k = f_.range.first; k < f_.range.end && !stop_.requested(); ++k) {
            if (!is_mine(k)) continue;
            bool const kept = there[std::size_t(k - f_.range.first)] != 0;
            try {
                if (kept && is_history(there, k) && !remember(k)) break;
                if (kept ? !reuse(k) : !render(k)) break;
            } catch (gi::Interrupted const&) { // this frame is not complete
                break;
            }
        }
    }

    /// Builds the world of a frame.
    gi::World world_of(int frame, gi::Report& report) const
    {
        gi::StageTimer const timer(report, "world");
        return gi::build_world(scene_, f_.scene_time_s(o_, frame), report, origin_);
    }

    /// Returns the world of a frame, advanced from the previous frame.
    gi::World const& advance(int frame, gi::Report& report)
    {
        gi::StageTimer const timer(report, "world");
        double const time_s = f_.scene_time_s(o_, frame);
        if (!follower_)
            follower_ = std::make_unique<FrameFollower>(scene_, time_s, gi::find_method(o_.method), settings_,
                                                        o_.reuse, origin_);
        return follower_->go_to(time_s);
    }

    gi::Camera camera_of(gi::World const& world, int frame, double after_s = 0) const
    {
        return camera_->of(world, f_.range.time_s(frame) + after_s, f_.fraction(frame, after_s));
    }

    Exposure exposure_of(int frame) const
    {
        return {f_.scene_time_s(o_, frame), o_.shutter_s, o_.time_s.has_value(),
                [this, frame](gi::World const& now, double after_s) { return camera_of(now, frame, after_s); }};
    }

    /// Options of one frame; those of a single picture with --time if that gives the same picture.
    RenderOptions options_of(int frame) const
    {
        RenderOptions o = o_;
        if (!o_.time_s && !o_.turns && o_.reuse == 1) {
            o.time_s = f_.range.time_s(frame);
            o.frames.clear();
        }
        return o;
    }

    gi::RenderSettings settings_of(int frame) const
    {
        gi::RenderSettings s = settings_;
        if (o_.seed_per_frame) s.seed += std::uint64_t(frame);
        return s;
    }

    std::string stats_command() const
    {
        return describe_call(o_, settings_, stop_option(settings_), {}).at("command").get<std::string>();
    }

    /// @param moving  with motion blur: the world, which is advanced to the closing of the shutter
    std::map<std::string, std::string> metadata(int frame, gi::World const& world, gi::Camera const& camera,
                                                gi::RenderResult const& result, gi::MovingWorld* moving) const
    {
        gi::RenderSettings const s = settings_of(frame);
        std::uint64_t const opening = gi::fingerprint(world, camera, s, o_.method, gi::options_of(o_.method, s));
        return frame_metadata(options_of(frame), s, result, frame, opening,
                              moving ? motion_fingerprint(*moving, exposure_of(frame), s, o_.method) : 0);
    }

    void refuse_to_replace() const
    {
        bool const unfinished = !f_.state.empty() && fs::exists(f_.state);
        if (o_.resume && !unfinished) say("there is no '" + f_.state + "': only missing frames are rendered");
        if (!o_.resume && unfinished)
            throw gi::InputError("'" + f_.state + "' belongs to unfinished frames", "new ones would replace them",
                                 "add --resume to continue, or delete it");
    }

    /// Flags of the frames that are complete on disk. Throws InputError if one is of another render.
    std::vector<char> find_frames()
    {
        std::vector<char> there(std::size_t(f_.range.count()), 0);
        gi::ProgressBar bar("look for frames", !o_.quiet && work_.leads());
        for (int k = f_.range.first; k < f_.range.end && !stop_.requested(); ++k) {
            std::string const file = f_.exr->of(k);
            bar.update(f_.fraction(k), file);
            if (!is_mine(k) || !fs::exists(file)) continue;
            gi::Picture picture;
            try {
                picture = gi::read_exr(file);
            } catch (gi::InputError const&) {
                report_.lose("frames that were damaged, rendered again", 1, file);
                continue;
            }
            gi::Report unused; // its losses were reported when it was rendered
            gi::World own;
            std::optional<gi::MovingWorld> moving;
            if (blurs_)
                moving.emplace(scene_, f_.scene_time_s(o_, k), unused);
            else
                own = world_of(k, unused);
            gi::World const& world = moving ? moving->world() : own;
            std::string const other =
                difference(picture, metadata(k, world, camera_of(world, k), {}, moving ? &*moving : nullptr));
            if (!other.empty())
                throw gi::InputError("'" + file + "' belongs to another render", other,
                                     "delete it, or choose another --out");
            there[std::size_t(k - f_.range.first)] = 1;
        }
        return there;
    }

    /// True if a missing frame reuses the light of this existing frame.
    bool is_history(std::vector<char> const& there, int frame) const
    {
        std::size_t const next = std::size_t(frame - f_.range.first) + 1,
                          end = std::min(there.size(), next + std::size_t(o_.reuse) - 1);
        return std::find(there.begin() + std::ptrdiff_t(next), there.begin() + std::ptrdiff_t(end), 0) !=
               there.begin() + std::ptrdiff_t(end);
    }

    void say_what_is_rendered_again(std::vector<char> const& there) const
    {
        int again = 0;
        for (int k = f_.range.first; k < f_.range.end; ++k)
            again += there[std::size_t(k - f_.range.first)] != 0 && is_history(there, k);
        if (again > 0)
            say(fmt::format("{} existing frames are rendered again but not saved: --reuse {} needs their light. "
                            "Later frames differ in their noise from an uninterrupted render",
                            again, o_.reuse));
    }

    /// Renders an existing frame again for the light that others reuse. @return false if it was interrupted
    bool remember(int frame)
    {
        gi::Report report;
        gi::World const& world = advance(frame, report);
        auto const progress = [&](gi::RenderStatus const&) {
            bar_->update(double(rendered_) / missing_, fmt::format("frame {} again, for reuse", frame));
        };
        FrameFollower::Frame const done = follower_->render(camera_of(world, frame), stop_, progress, report);
        for (auto const& [stage, seconds] : report.times()) report_.add_time(stage, seconds);
        add_losses(report_, report.losses(), frame);
        return done.result.end != gi::RenderEnd::interrupted;
    }

    /// Keeps an existing frame. @return false to stop
    bool reuse(int frame)
    {
        FrameRecord record;
        record.frame = frame;
        record.reused = true;
        gi::Picture picture;
        if (f_.png || (video_ && work_.alone())) picture = gi::read_exr(f_.exr->of(frame));
        show_picture(frame, picture);
        records_.push_back(record);
        return true;
    }

    /// Renders a missing frame. @return false if it was interrupted; it may also throw Interrupted
    bool render(int frame)
    {
        auto const start = std::chrono::steady_clock::now();
        FrameRecord record;
        record.frame = frame;
        gi::Report report;
        gi::World own;
        std::optional<gi::MovingWorld> moving;
        if (blurs_)
            moving.emplace(scene_, f_.scene_time_s(o_, frame), report);
        else if (o_.reuse == 1)
            own = world_of(frame, report);
        gi::World const& world = blurs_ ? moving->world() : o_.reuse == 1 ? own : advance(frame, report);
        gi::Camera const camera = camera_of(world, frame);
        auto const progress = [&](gi::RenderStatus const& s) {
            bar_->update((rendered_ + s.fraction) / missing_,
                         fmt::format("frame {}, {} of {}, {} paths", frame, rendered_ + 1, missing_, s.paths));
        };
        gi::RenderResult result;
        if (blurs_) {
            result = expose(gi::find_method(o_.method), *moving, exposure_of(frame), settings_of(frame), stop_,
                            progress, report);
        } else if (o_.reuse == 1) {
            result = gi::find_method(o_.method).render(world, camera, settings_of(frame), stop_, progress, report);
        } else {
            FrameFollower::Frame updated = follower_->render(camera, stop_, progress, report);
            result = std::move(updated.result);
            record.changes = updated.changes;
            record.reuse = updated.counts;
        }
        if (result.end == gi::RenderEnd::interrupted) return false;
        std::string const remark = denoise(result.picture, denoise_, report);
        if (!remark.empty() && rendered_ == 0) say(remark);
        gi::Picture picture = std::move(result.picture);
        picture.metadata = metadata(frame, world, camera, result, moving ? &*moving : nullptr);
        {
            gi::StageTimer const timer(report, "save");
            keep_layers(o_, picture);
            if (f_.exr) save_exr(o_, f_.exr->of(frame), rows_of(picture), report, {.stop = &stop_});
            show_picture(frame, picture); // once it is complete
        }
        record.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        result.picture = {};
        record.result = result;
        record.losses = report.losses();
        for (auto const& [stage, seconds] : report.times()) report_.add_time(stage, seconds);
        add_losses(report_, record.losses, frame);
        records_.push_back(std::move(record));
        ++rendered_;
        return true;
    }

    /// Writes the frame to its PNG and to the video.
    void show_picture(int frame, gi::Picture const& picture)
    {
        bool const filmed = video_ && work_.alone(); // otherwise the video is made at the end
        if (!f_.png && !filmed) return;
        std::vector<unsigned char> const bytes = display_bytes(o_, picture);
        if (f_.png) gi::write_png(f_.png->of(frame), picture.width, picture.height, bytes);
        if (filmed) film(picture, bytes);
    }

    void film(gi::Picture const& picture, std::vector<unsigned char> bytes)
    {
        if (std::size_t const pixels = picture.pixels(); bytes.size() == 4 * pixels) {
            for (std::size_t p = 0; p < pixels; ++p) // videos have no alpha
                for (std::size_t c = 0; c < 3; ++c) bytes[3 * p + c] = bytes[4 * p + c];
            bytes.resize(3 * pixels);
        }
        video_->add(bytes);
    }

    /// The leading rank collects the records of all frames and makes the video from their files.
    void gather()
    {
        work_.talk([&](Cluster& cluster) {
            if (!work_.leads()) {
                nlohmann::json all = {{"loaded", losses_json(loaded_)}, {"times", report_.times()}};
                for (FrameRecord const& r : records_) all["records"].push_back(to_message(r));
                cluster.give(nlohmann::json::to_cbor(all));
                return;
            }
            for (int r = 1; r < work_.size(); ++r)
                if (auto const bytes = cluster.take(r))
                    add_records(nlohmann::json::from_cbor(*bytes), cluster.name(r));
        });
        if (!work_.leads()) return;
        std::sort(records_.begin(), records_.end(),
                  [](FrameRecord const& a, FrameRecord const& b) { return a.frame < b.frame; });
        rendered_ = int(std::count_if(records_.begin(), records_.end(), [](auto const& r) { return !r.reused; }));
        missing_ = f_.range.count() - int(records_.size()) + rendered_;
        if (!video_) return;
        for (FrameRecord const& r : records_) {
            gi::Picture const picture = gi::read_exr(f_.exr->of(r.frame));
            film(picture, display_bytes(o_, picture));
        }
    }

    void add_records(nlohmann::json const& all, std::string const& name)
    {
        for (auto const& time : all.at("times")) report_.add_time(time.at(0), time.at(1));
        add_other_losses(report_, loaded_, losses_of(all.at("loaded")), name);
        if (!all.contains("records")) return;
        for (nlohmann::json const& message : all.at("records")) {
            records_.push_back(record_of(message));
            add_losses(report_, records_.back().losses, records_.back().frame);
        }
    }

    FramesEnd finish()
    {
        FramesEnd end;
        end.complete = int(records_.size()) == f_.range.count();
        bool const has_video = video_ && video_->frames() > 0;
        if (has_video) {
            gi::StageTimer const timer(report_, "video");
            video_->finish();
        }
        if (end.complete && !f_.state.empty()) fs::remove(f_.state);
        end.stats = stats();
        for (auto const& name : {f_.exr, f_.png})
            if (name && !records_.empty())
                end.lines.push_back(
                    fmt::format("{} ... {}", name->of(records_.front().frame), name->of(records_.back().frame)));
        for (std::string const& file : {has_video ? f_.video : "", o_.stats})
            if (!file.empty()) end.lines.push_back(file);
        end.lines.push_back(summary(end.stats["frame_seconds"]));
        if (end.complete) return end;
        std::string const done =
            fmt::format("{}: {} of {} frames are complete", stop_.requested() ? "interrupted" : "ranks were lost",
                        f_.range.count() - missing_ + rendered_, f_.range.count());
        end.notes = {
            done + (f_.exr ? "; the same command with --resume continues" : "; with --out they could be resumed")};
        if (has_video) end.notes.push_back(fmt::format("'{}' contains the frames so far", f_.video));
        return end;
    }

    Json stats() const
    {
        Json stats = describe_call(o_, settings_, stop_option(settings_),
                                   rendered_ > 0 ? chosen_of(last_rendered().result) : Chosen{});
        stats["frames"] = to_json(records_, f_);
        stats["frame_seconds"] = frame_seconds(records_);
        stats["plan"] = plan_;
        stats["report"] = to_json(report_);
        return stats;
    }

    FrameRecord const& last_rendered() const
    {
        return *std::find_if(records_.rbegin(), records_.rend(), [](FrameRecord const& r) { return !r.reused; });
    }

    std::string summary(Json const& seconds) const
    {
        std::string line =
            fmt::format("{} frames of {} x {} pixels", records_.size(), settings_.width, settings_.height);
        if (int const kept = int(records_.size()) - rendered_; kept > 0)
            line += fmt::format(", {} existed already", kept);
        if (seconds.is_null()) return line;
        auto const s = [&](char const* key) { return seconds.at(key).get<double>(); };
        return line + fmt::format(", {:.2f} s; per frame: median {:.3f} s, 95 % {:.3f} s, 99 % {:.3f} s",
                                  s("total"), s("median"), s("p95"), s("p99"));
    }

    RenderOptions const& o_;
    gi::RenderSettings const& settings_;
    gi::DenoiseSettings denoise_;
    FrameSettings f_;
    RankWork& work_;
    gi::StopRequest& stop_ = work_.stop();
    gi::Report& report_;                             ///< for all frames together
    std::map<std::string, gi::Report::Loss> loaded_; ///< losses before the first frame
    std::unique_ptr<VideoWriter> video_;
    std::shared_ptr<gi::Scene const> scene_;
    std::unique_ptr<FrameCamera> camera_;
    std::unique_ptr<FrameFollower> follower_; ///< with --reuse
    std::optional<gi::dvec3> origin_;         ///< origin of the worlds of all frames, with --reuse
    Json plan_;
    std::optional<gi::ProgressBar> bar_;
    std::vector<FrameRecord> records_; ///< in frame order
    int missing_ = 0, rendered_ = 0;   ///< frames to render, and rendered so far
    bool blurs_ = false;               ///< with motion blur
};

} // namespace

FramesEnd render_frames(RenderOptions const& o, gi::RenderSettings const& settings,
                        gi::DenoiseSettings const& denoise_settings, CameraChoice const& choice, RankWork& work,
                        gi::Report& report)
{
    return Sequence(o, settings, denoise_settings, choice, work, report).run();
}

} // namespace viewer
