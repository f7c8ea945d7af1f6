#include "viewer/app/replay.h"

#include "gi/image_io/picture_file.h"
#include "viewer/app/frame_hash.h"
#include "viewer/app/shown_views.h"
#include "viewer/base/frame_range.h"
#include "viewer/devices/gl/context.h"
#include "viewer/engine/picture_margin.h"
#include "viewer/offline/video_writer.h"

#include <algorithm>
#include <deque>
#include <epoxy/gl.h>
#include <fmt/format.h>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <set>

namespace viewer {
namespace {

/// Largest size of the first view, rounded down to even numbers, as videos have one size.
std::pair<int, int> largest_view(RecordingReader& reader)
{
    std::pair<int, int> size{0, 0};
    while (auto const frame = reader.next())
        if (!frame->command.views.empty())
            size = std::max(size, {frame->command.views[0].width, frame->command.views[0].height});
    reader.rewind();
    return {size.first / 2 * 2, size.second / 2 * 2};
}

/// Resamples frames at irregular times to a constant frame rate; each video frame shows the last due frame.
class TimedVideo {
public:
    TimedVideo(std::string const& file, std::pair<int, int> size, double fps)
        : size_(size), fps_(fps), writer_(file, size.first, size.second, fps)
    {
    }
    void show(gi::Picture const& picture, gi::ToneMapSettings const& tone, double time_s)
    {
        if (!first_s_) first_s_ = time_s;
        repeat_until(time_s - *first_s_);
        std::vector<unsigned char> const bytes = gi::tone_map_bytes(*picture.find("color"), tone);
        cv::Mat const in(picture.height, picture.width, CV_8UC3, const_cast<unsigned char*>(bytes.data()));
        cv::Mat out;
        cv::resize(in, out, {size_.first, size_.second}, 0, 0, cv::INTER_LINEAR);
        shown_.assign(out.data, out.data + out.total() * 3);
    }
    void finish()
    {
        if (!shown_.empty()) writer_.add(shown_);
        writer_.finish();
    }

private:
    void repeat_until(double time_s)
    {
        while (!shown_.empty() && writer_.frames() < std::int64_t(std::floor(time_s * fps_))) writer_.add(shown_);
    }
    std::pair<int, int> size_;
    double fps_;
    VideoWriter writer_;
    std::vector<unsigned char> shown_;
    std::optional<double> first_s_;
};

void save(std::string const& pattern, std::uint64_t frame, gi::Picture const& picture,
          gi::ToneMapSettings const& tone, gi::Report& report)
{
    std::string const file = parse_frame_name("--out", pattern).of(int(frame));
    if (file.ends_with(".exr"))
        gi::write_exr(file, picture, gi::PixelType::single, report);
    else
        gi::write_png(file, picture.width, picture.height, gi::tone_map_bytes(*picture.find("color"), tone));
}

/// Draws again what people saw.
class ShownReplay {
public:
    ShownReplay(DriveBodies drive, gi::Report& report)
        : gl_(GlContext::surfaceless(report)), drive_(std::move(drive))
    {
    }
    void keep(FrameCommand const& command, SessionFrame result)
    {
        auto const frame = std::make_shared<LiveFrame>();
        frame->command = command;
        frame->result = std::move(result);
        constexpr std::size_t kMost = 64; // far more than are finished while a picture is drawn
        waiting_.push_back(frame);
        if (waiting_.size() > kMost) waiting_.pop_front();
    }
    /// The linear picture of the first view. Throws InputError if the frame that it shows is not in the recording.
    gi::Picture draw(ShownFrame const& shown)
    {
        FrameCommand const& moment = shown.moment;
        // The next frame may have been finished while this one was drawn for the first time.
        while (!waiting_.empty() && waiting_.front()->command.frame < moment.frame) waiting_.pop_front();
        bool const fresh = !waiting_.empty() && waiting_.front()->command.frame == moment.frame;
        if (fresh) {
            taken_ = waiting_.front();
            waiting_.pop_front();
        }
        if (!taken_ || taken_->command.frame != moment.frame)
            throw gi::InputError("the recording shows a frame that it does not have",
                                 fmt::format("frame {}", moment.frame), "record the walk again");
        std::vector<WindowShown> parts = shown.windows;
        if (parts.empty()) {
            parts.push_back({shown.surfaces_scale, std::vector<int>(moment.views.size())});
            std::iota(parts[0].views.begin(), parts[0].views.end(), 0);
        }
        while (windows_.size() < parts.size()) windows_.emplace_back().hash_pictures();
        gi::Picture first;
        for (std::size_t w = 0; w < parts.size(); ++w) {
            ShownViews& views = windows_[w];
            if (fresh || !views.has_frame()) views.take(taken_, parts[w].views);
            if (parts[w].surfaces_scale > 0 && !views.make_ready())
                throw gi::InputError("surfaces cannot be drawn again", views.why_no_surfaces(),
                                     "replay without --shown");
            views.begin(parts[w].surfaces_scale, &moment, drive_);
            for (int const k : parts[w].views) {
                EyeView const eye = views.eye(k, &moment.views[std::size_t(k)].camera);
                if (k == 0 && first.width == 0) first = read(eye.picture);
            }
        }
        return first;
    }
    std::uint64_t hash() const
    {
        std::vector<ShownViews const*> all;
        for (ShownViews const& w : windows_) all.push_back(&w);
        return shown_hash(all);
    }

private:
    static gi::Picture read(ShownPicture const& shown)
    {
        gi::Picture p{shown.size_px.x, shown.size_px.y, {}, {}};
        if (shown.texture == 0) return {};
        std::vector<float>& rgb = p.add("color", 3).data;
        glPixelStorei(GL_PACK_ALIGNMENT, 4);
        glGetTextureImage(shown.texture, 0, GL_RGB, GL_FLOAT, GLsizei(rgb.size() * sizeof(float)), rgb.data());
        return p;
    }

    GlContext gl_;
    DriveBodies drive_;
    std::deque<ShownViews> windows_;                       ///< as many as there were
    std::deque<std::shared_ptr<LiveFrame const>> waiting_; ///< newer than the one that was taken
    std::shared_ptr<LiveFrame const> taken_;
};

bool is_known(std::string const& key)
{
    return key == "scene" || is_setting(key) || is_scene_edit(key) || is_hidden_mask(key);
}

/// Applies what another version may have recorded.
void apply_recorded(RenderSession& session, Change const& c, gi::Report& report)
{
    if (!is_known(c.key))
        return report.lose("recorded settings that this version does not know: pixels may differ", 1, c.key);
    try {
        session.apply(c);
    } catch (gi::InputError const& e) { // e.g. a device that is missing here
        if (!is_setting(c.key)) throw;
        throw gi::InputError("the recorded setting '" + c.key + "' is refused", e.what(),
                             "choose another value with --set " + c.key + "=VALUE");
    }
}

} // namespace

bool as_recorded(ReplayOptions const& o) { return o.settings.empty() && o.paths == 0 && !o.size; }

ReplaySummary replay(ReplayOptions const& o, LoadRecorded const& load, gi::StopRequest const& stop,
                     gi::Report& report)
{
    RecordingReader reader(o.file);
    RecordingHeader const& header = reader.header();
    std::optional<TimedVideo> video;
    if (!o.video.empty()) video.emplace(o.video, o.size.value_or(largest_view(reader)), o.fps);
    RecordedScenes const scenes = load(header.settings.value("load", nlohmann::json::object()));
    RenderSession session(scenes.load, o.threads, report);
    session.drive_bodies(scenes.drive);
    bool const shows = !o.out.empty() || !o.video.empty();
    if (shows && !o.shown) session.draw_all_surfaces();
    std::set<std::string> overridden;
    nlohmann::json const settings = header.settings.value("settings", nlohmann::json::object());
    for (Change const& c : o.settings) overridden.insert(current_key(c.key));
    if (!settings.contains("first_surfaces") && !overridden.contains("first_surfaces"))
        session.apply({"first_surfaces", false}); // recorded before there were any
    MadeFor const made = made_for(header.program);
    // First, as other settings may be those of one method.
    if (!overridden.contains("method"))
        session.apply(current({"method", settings.value("method", first_settings(made).method)}, made));
    for (auto const& [key, value] : settings.items())
        if (!overridden.contains(current_key(key))) apply_recorded(session, current({key, value}, made), report);
    for (Change const& c : o.settings) {
        check_offered(session.settings(), c.key);
        session.apply(c);
    }
    SceneChange scene{header.scene, {}};
    if (header.settings.contains("start")) scene.start = start_from_json(header.settings.at("start"));
    session.apply(to_change(scene));
    ReplaySummary summary;
    gi::ProgressBar bar("replay " + o.file);
    std::optional<ShownReplay> shown;
    if (o.shown) shown.emplace(scenes.drive, report);
    auto const put_out = [&](gi::Picture const& picture, std::uint64_t number, double time_s) {
        gi::ToneMapSettings const tone = tone_settings(session.settings());
        if (!o.out.empty()) save(o.out, number, picture, tone, report);
        if (video) video->show(picture, tone, time_s);
    };
    while (auto record = reader.next_record()) {
        if (stop.requested()) {
            summary.interrupted = true;
            break;
        }
        if (auto const* const s = std::get_if<ShownFrame>(&*record)) {
            if (!shown) continue;
            gi::Picture const picture = shown->draw(*s);
            if (s->pixel_hash && as_recorded(o)) {
                bool const same = shown->hash() == *s->pixel_hash;
                ++(same ? summary.shown_same : summary.shown_other);
                if (!same && !summary.first_shown_other) summary.first_shown_other = summary.shown;
            }
            if (picture.width > 0) put_out(picture, summary.shown, s->moment.display_s);
            ++summary.shown;
            continue;
        }
        auto* const frame = std::get_if<RecordedFrame>(&*record);
        FrameCommand& command = frame->command;
        for (Change const& c : command.changes)
            if (!overridden.contains(current_key(c.key))) apply_recorded(session, current(c, made), report);
        if (o.paths > 0) command.paths = o.paths;
        for (ViewCommand& v : command.views)
            if (o.size) {
                std::tie(v.width, v.height) = *o.size;
                v.margin_x = v.margin_y = 0;
            }
        SessionFrame result = session.render(command, {});
        ++summary.frames;
        bar.update(0, fmt::format("{} frames", summary.frames));
        if (frame->pixel_hash && as_recorded(o) && !(command.only_light && shows && !o.shown)) {
            bool const same = frame_hash(result) == *frame->pixel_hash;
            ++(same ? summary.same : summary.other);
            if (!same && !summary.first_other) summary.first_other = command.frame;
        } else {
            ++summary.unknown;
        }
        if (shown)
            shown->keep(command, std::move(result));
        else if (!result.views.empty())
            put_out(without_margin(result.views[0].picture, result.views[0].margin_px), command.frame,
                    command.display_s);
    }
    if (video && summary.frames > 0) video->finish();
    summary.end = reader.end();
    return summary;
}

} // namespace viewer
