#include "viewer/app/replay.h"

#include "gi/image_io/picture_file.h"
#include "viewer/app/frame_hash.h"
#include "viewer/app/replayed_picture.h"
#include "viewer/app/shown_replay.h"
#include "viewer/base/frame_range.h"
#include "viewer/base/standard_streams.h"
#include "viewer/displays/compose.h"
#include "viewer/engine/picture_margin.h"
#include "viewer/offline/video_writer.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <functional>
#include <set>

namespace viewer {
namespace {

/// What has to be known of a whole walk before its pictures are written.
struct Walk {
    RecordedViews largest; ///< of the frame whose picture is largest
    Arrangement whole;     ///< that picture
    bool square = false;   ///< shows_square_pixels() of the size that was asked for
};

/// The mode in which the pictures of the eyes are put together.
StereoMode mode_of(std::string const& name) { return stereo_mode(name).value_or(StereoMode::off); }

std::optional<StereoMode> wanted_mode(ReplayOptions const& o)
{
    std::optional<StereoMode> wanted;
    for (Change const& c : o.settings)
        if (c.key == "stereo" && c.value.is_string()) wanted = stereo_mode(c.value.get<std::string>());
    return wanted;
}

bool is_anaglyph(StereoMode mode)
{
    return mode == StereoMode::anaglyph_red_cyan || mode == StereoMode::anaglyph_dubois;
}

/// The size of a frame's picture within the one that was asked for.
glm::ivec2 size_within(glm::ivec2 size, RecordedViews const& views, Arrangement const& whole, bool square)
{
    if (!views.is_fixed) return size;
    double const aspect = double(whole.size_px.x) / whole.size_px.y;
    return fitted(square ? aspect * views.pixel_aspect : aspect, size);
}

/// Reads the walk once. Throws InputError if its pictures cannot be put together as asked for.
Walk survey(RecordingReader& reader, ReplayOptions const& o)
{
    Walk walk;
    std::optional<StereoMode> const wanted = wanted_mode(o);
    nlohmann::json const settings = reader.header().settings.value("settings", nlohmann::json::object());
    auto const begun = settings.find("stereo");
    StereoMode mode =
        begun != settings.end() && begun->is_string() ? mode_of(begun->get<std::string>()) : StereoMode::off;
    bool has_other_eye = false, has_walls = false, mixes = false;
    while (auto const frame = reader.next()) {
        for (Change const& c : frame->command.changes)
            if (c.key == "stereo" && c.value.is_string()) mode = mode_of(c.value.get<std::string>());
        if (frame->command.views.empty()) continue;
        RecordedViews const views = recorded_views(frame->command);
        Arrangement const a = arrange(views, o.eyes, wanted.value_or(mode));
        has_other_eye |= views.right >= 0;
        has_walls |= views.is_wall;
        mixes |= is_anaglyph(a.mode);
        if (a.size_px.x * a.size_px.y > walk.whole.size_px.x * walk.whole.size_px.y) {
            walk.whole = a;
            walk.largest = views;
        }
    }
    reader.rewind();
    char const* const one_eye = "the recording has the pictures of one eye alone";
    if ((o.eyes == ReplayedEyes::right || o.eyes == ReplayedEyes::both) && !has_other_eye)
        throw gi::InputError(o.eyes == ReplayedEyes::right ? "--eye right" : "--eye both", one_eye,
                             "leave it out, or record with --set stereo=side-by-side");
    if (wanted && has_walls)
        throw gi::InputError("--set stereo",
                             "the recording is of the walls of a display, whose file has their modes",
                             "choose --eye left, right or both");
    if (wanted && *wanted != StereoMode::off && !has_other_eye)
        throw gi::InputError(std::string("--set stereo=") + name_of(*wanted), one_eye,
                             "leave it out, or record with a stereo mode");
    if (wanted && *wanted == StereoMode::off && has_other_eye)
        throw gi::InputError("--set stereo=off",
                             "the recording has two eyes' pictures, and none from between them",
                             "choose --eye left or --eye right");
    if (mixes && o.out.ends_with(".exr"))
        throw gi::InputError("--out " + o.out,
                             "an anaglyph mixes display-encoded colours, and EXR files are linear",
                             "write PNG, or add --eye left, right or both");
    if (!o.size || walk.largest.left < 0) return walk;
    walk.square = shows_square_pixels(walk.largest, o.eyes, walk.whole, *o.size);
    glm::ivec2 const inside = size_within(*o.size, walk.largest, walk.whole, walk.square);
    if (inside != *o.size)
        say(fmt::format(
            "--size {}x{} has another aspect than the recorded pictures ({}x{}): they are in the middle, "
            "black around; --size {}x{} fits",
            o.size->x, o.size->y, walk.whole.size_px.x, walk.whole.size_px.y, inside.x, inside.y));
    return walk;
}

/// The picture of a frame.
Arrangement arranged(RecordedViews const& views, StereoMode mode, Walk const& walk, ReplayOptions const& o)
{
    Arrangement a = arrange(views, o.eyes, mode);
    if (o.size && views.left >= 0) a.size_px = size_within(*o.size, views, a, walk.square);
    return a;
}

/// Gives the eyes the pixels that they have in this picture, and all other views the same factor.
void resize(FrameCommand& command, RecordedViews const& views, Arrangement const& a)
{
    glm::ivec2 const eye = views.right < 0 ? a.size_px : eye_size(a.mode, a.size_px);
    glm::dvec2 const factor = glm::dvec2(eye) / glm::dvec2(views.eye_px);
    for (ViewCommand& v : command.views) {
        v.width = std::max(1, int(std::lround(v.width * factor.x)));
        v.height = std::max(1, int(std::lround(v.height * factor.y)));
        v.margin_x = v.margin_y = 0;
    }
}

/// Resamples frames at irregular times to a constant frame rate; each video frame shows the last due frame.
class TimedVideo {
public:
    TimedVideo(std::string const& file, glm::ivec2 size_px, double fps)
        : size_(size_px), fps_(fps), writer_(file, size_px.x, size_px.y, fps)
    {
    }
    void show(std::vector<unsigned char> bytes, glm::ivec2 size_px, double time_s)
    {
        if (!first_s_) first_s_ = time_s;
        repeat_until(time_s - *first_s_);
        shown_ = on_canvas(std::move(bytes), size_px, size_);
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
    glm::ivec2 size_;
    double fps_;
    VideoWriter writer_;
    std::vector<unsigned char> shown_;
    std::optional<double> first_s_;
};

/// A picture to write, made in the forms that the files need.
struct PictureToWrite {
    Arrangement arrangement;
    std::function<std::vector<unsigned char>()> bytes; ///< of the arrangement's size
    std::function<gi::Picture()> linear;               ///< of the same
    std::uint64_t number = 0;
    double time_s = 0;
};

void write(PictureToWrite const& p, ReplayOptions const& o, std::optional<TimedVideo>& video, gi::Report& report)
{
    bool const is_exr = o.out.ends_with(".exr");
    glm::ivec2 const canvas = o.size.value_or(p.arrangement.size_px);
    std::vector<unsigned char> bytes;
    if (video || (!o.out.empty() && !is_exr)) bytes = on_canvas(p.bytes(), p.arrangement.size_px, canvas);
    std::string const file = o.out.empty() ? "" : parse_frame_name("--out", o.out).of(int(p.number));
    if (is_exr)
        gi::write_exr(file, on_canvas(p.linear(), canvas), gi::PixelType::single, report);
    else if (!o.out.empty())
        gi::write_png(file, canvas.x, canvas.y, bytes);
    if (video) video->show(std::move(bytes), canvas, p.time_s);
}

/// The rendered pictures of a frame.
PictureToWrite rendered_picture(SessionFrame const& frame, FrameCommand const& command, Arrangement const& a,
                                Settings const& settings)
{
    glm::ivec2 const eye = eye_size(a.mode, a.size_px);
    bool const swaps = settings.swap_eyes && a.mode != StereoMode::off;
    auto const view = [&frame, a, swaps](bool right) -> ViewPicture const& {
        return frame.views[std::size_t(a.right >= 0 && right != swaps ? a.right : a.left)];
    };
    auto const linear = [view, eye](bool right) {
        ViewPicture const& v = view(right);
        return resized(without_margin(v.picture, v.margin_px), eye);
    };
    PictureToWrite p{a, {}, {}, command.frame, command.display_s};
    p.bytes = [view, eye, a, settings, time_s = p.time_s] {
        std::vector<unsigned char> const left = shown_bytes(view(false), eye, settings, time_s);
        if (a.mode == StereoMode::off) return left;
        return compose_stereo(a.mode, left, shown_bytes(view(true), eye, settings, time_s), a.size_px);
    };
    p.linear = [linear, a] {
        return a.mode == StereoMode::off ? linear(false) : composed(a, linear(false), linear(true));
    };
    return p;
}

/// What ShownReplay drew last.
PictureToWrite shown_picture(ShownReplay& replay, ShownReplay::Drawn const& drawn, Arrangement const& a,
                             Settings const& s, double time_s)
{
    EyeView left = drawn.eyes[std::size_t(a.left)], right = a.right >= 0 ? drawn.eyes[std::size_t(a.right)] : left;
    if (right.picture.texture == 0) right = left;
    if (s.swap_eyes && a.mode != StereoMode::off) std::swap(left, right);
    DisplaySettings display;
    display.tone = tone_settings(s);
    display.split = float(s.split);
    if (!s.compare.empty())
        display.comparison = s.view == "split"                                   ? Comparison::split
                             : s.view == "difference"                            ? Comparison::difference
                             : s.view == "flicker" && flickers_to_second(time_s) ? Comparison::other
                                                                                 : Comparison::off;
    PictureToWrite p{a, {}, {}, 0, time_s};
    p.bytes = [&replay, left, right, a, display] { return replay.bytes(left, right, a, display); };
    p.linear = [left, right, a] {
        glm::ivec2 const eye = eye_size(a.mode, a.size_px);
        gi::Picture const l = resized(ShownReplay::linear(left.picture), eye);
        return a.mode == StereoMode::off ? l : composed(a, l, resized(ShownReplay::linear(right.picture), eye));
    };
    return p;
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

/// Says which files of a scene are others than when it was recorded.
void tell_changed(FileHashes const& recorded, ReplaySummary& summary)
{
    std::vector<std::string> const changed = changed_files(recorded);
    if (changed.empty()) return;
    constexpr std::size_t kNamed = 5;
    std::size_t const named = std::min(kNamed, changed.size());
    say(fmt::format("the scene has changed since it was recorded, pictures show it as it is now: {}{}",
                    fmt::join(changed.begin(), changed.begin() + std::ptrdiff_t(named), ", "),
                    changed.size() > named ? fmt::format(" and {} more", changed.size() - named) : ""));
    summary.changed_files.insert(summary.changed_files.end(), changed.begin(), changed.end());
}

} // namespace

bool as_recorded(ReplayOptions const& o) { return o.settings.empty() && o.paths == 0 && !o.size; }

ReplaySummary replay(ReplayOptions const& o, LoadRecorded const& load, gi::StopRequest const& stop,
                     gi::Report& report)
{
    RecordingReader reader(o.file);
    RecordingHeader const& header = reader.header();
    bool const shows = !o.out.empty() || !o.video.empty();
    Walk const walk = shows || o.size || wanted_mode(o) ? survey(reader, o) : Walk();
    std::optional<TimedVideo> video;
    // Videos have even sizes.
    if (!o.video.empty()) video.emplace(o.video, o.size.value_or(walk.whole.size_px / 2 * 2), o.fps);
    RecordedScenes const scenes = load(header.settings.value("load", nlohmann::json::object()));
    RenderSession session(scenes.load, o.threads, report);
    session.drive_bodies(scenes.drive);
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
    if (header.settings.contains("files")) scene.files = file_hashes_from_json(header.settings.at("files"));
    ReplaySummary summary;
    summary.program = header.program;
    tell_changed(scene.files, summary);
    session.apply(to_change(scene));
    gi::ProgressBar bar("replay " + o.file);
    std::optional<ShownReplay> shown;
    if (o.shown) shown.emplace(scenes.drive, report);
    bool const rearranged = o.size || wanted_mode(o);
    auto const mode = [&] { return mode_of(session.settings().stereo); };
    while (auto record = reader.next_record()) {
        if (stop.requested()) {
            summary.interrupted = true;
            break;
        }
        if (auto const* const s = std::get_if<ShownFrame>(&*record)) {
            if (!shown) continue;
            ShownReplay::Drawn const& drawn = shown->draw(*s);
            if (s->pixel_hash && as_recorded(o)) {
                bool const same = shown->hash() == *s->pixel_hash;
                ++(same ? summary.shown_same : summary.shown_other);
                if (!same && !summary.first_shown_other) summary.first_shown_other = summary.shown;
            }
            Arrangement const a = arranged(drawn.views, mode(), walk, o);
            bool const is_there = a.left >= 0 && std::size_t(a.left) < drawn.eyes.size() &&
                                  drawn.eyes[std::size_t(a.left)].picture.texture != 0;
            if (shows && is_there) {
                PictureToWrite p = shown_picture(*shown, drawn, a, session.settings(), s->moment.display_s);
                p.number = summary.shown;
                write(p, o, video, report);
            }
            ++summary.shown;
            continue;
        }
        auto* const frame = std::get_if<RecordedFrame>(&*record);
        FrameCommand& command = frame->command;
        for (Change const& c : command.changes) {
            if (c.key == "scene") tell_changed(scene_change_of(c).files, summary);
            if (!overridden.contains(current_key(c.key))) apply_recorded(session, current(c, made), report);
        }
        if (o.paths > 0) command.paths = o.paths;
        RecordedViews const views = recorded_views(command);
        Arrangement const a = arranged(views, mode(), walk, o);
        if (rearranged && views.left >= 0) resize(command, views, a);
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
            shown->keep(command, std::move(result), views);
        else if (shows && !result.views.empty())
            write(rendered_picture(result, command, a, session.settings()), o, video, report);
    }
    if (video && summary.frames > 0) video->finish();
    summary.end = reader.end();
    return summary;
}

} // namespace viewer
