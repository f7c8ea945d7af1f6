#include "viewer/app/replay.h"

#include "gi/image_io/picture_file.h"
#include "viewer/app/frame_hash.h"
#include "viewer/base/frame_range.h"
#include "viewer/engine/picture_margin.h"
#include "viewer/offline/video_writer.h"

#include <algorithm>
#include <fmt/format.h>
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
    if (shows) session.draw_all_surfaces();
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
    while (auto frame = reader.next()) {
        if (stop.requested()) {
            summary.interrupted = true;
            break;
        }
        FrameCommand& command = frame->command;
        for (Change const& c : command.changes)
            if (!overridden.contains(current_key(c.key))) apply_recorded(session, current(c, made), report);
        if (o.paths > 0) command.paths = o.paths;
        for (ViewCommand& v : command.views)
            if (o.size) {
                std::tie(v.width, v.height) = *o.size;
                v.margin_x = v.margin_y = 0;
            }
        SessionFrame const result = session.render(command, {});
        ++summary.frames;
        bar.update(0, fmt::format("{} frames", summary.frames));
        if (frame->pixel_hash && as_recorded(o) && !(command.only_light && shows)) {
            bool const same = frame_hash(result) == *frame->pixel_hash;
            ++(same ? summary.same : summary.other);
            if (!same && !summary.first_other) summary.first_other = command.frame;
        } else {
            ++summary.unknown;
        }
        if (result.views.empty()) continue;
        gi::ToneMapSettings const tone = tone_settings(session.settings());
        gi::Picture const picture = without_margin(result.views[0].picture, result.views[0].margin_px);
        if (!o.out.empty()) save(o.out, command.frame, picture, tone, report);
        if (video) video->show(picture, tone, command.display_s);
    }
    if (video && summary.frames > 0) video->finish();
    summary.end = reader.end();
    return summary;
}

} // namespace viewer
