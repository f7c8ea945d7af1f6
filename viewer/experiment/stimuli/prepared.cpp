#include "viewer/experiment/stimuli/prepared.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "gi/image_io/picture_file.h"
#include "viewer/experiment/stimuli/ar_content_hash.h"
#include "viewer/experiment/stimuli/ar_source.h"
#include "viewer/experiment/stimuli/prepared_files.h"
#include "viewer/experiment/stimuli/stimulus_place.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>

namespace viewer {
namespace {

constexpr int kPathsWithoutSetting = 64; ///< per pixel, if the script sets no quality

/// Hash of a scene's file; other scenes are identified by their names, which the settings' hash includes.
std::string scene_hash(std::string const& scene)
{
    static std::map<std::pair<std::string, std::filesystem::file_time_type>, std::string> known;
    std::error_code none;
    if (!std::filesystem::is_regular_file(scene, none)) return "";
    auto& hash = known[{scene, std::filesystem::last_write_time(scene)}];
    if (hash.empty()) {
        auto const bytes = gi::read_bytes(scene);
        hash = gi::sha256({reinterpret_cast<char const*>(bytes.data()), bytes.size()});
    }
    return hash;
}

std::string file_name(int frame, int view) { return fmt::format("{:05}_{}.exr", frame, view); }

/// Keeps only the displayed layers.
gi::Picture shown_part(gi::Picture const& picture)
{
    gi::Picture out;
    out.width = picture.width;
    out.height = picture.height;
    out.layers.push_back(*picture.find("color"));
    return out;
}

} // namespace

std::string prepared_key(PreparedStimulus const& w, std::string const& version)
{
    return gi::sha256(fmt::format("{} {} {}x{} {} {:.6g} {} {}", w.stimulus.sha256,
                                  w.stimulus.ar ? content_hash(*w.stimulus.ar) : scene_hash(w.stimulus.scene),
                                  w.view.size_px.x, w.view.size_px.y, name_of(w.view.stereo), w.view.duration_s,
                                  w.view.warmup_frames, version));
}

bool prepare_stimulus(PreparedStimulus const& wanted, std::filesystem::path const& folder, std::string const& key,
                      SceneAccess const& scenes, int threads, gi::StopRequest const& stop, gi::Report& report)
{
    if (prepared_flaw(folder / key).empty()) return false;
    StimulusSettings const& s = wanted.stimulus;
    if (s.ar) return prepare_ar_stimulus(s, wanted.view, folder, key, stop, report);
    RenderSession session(scenes.load, threads, report);
    for (Change const& c : differences(session.settings(), s.settings)) session.apply(c);
    session.apply({"scene", s.scene});
    for (Change const& c : s.edits) session.apply(c);
    StimulusPlace const place = place_of(session.world(), scenes.camera(session.world(), s.camera));
    bool const moves = s.path != StimulusPath::none || (s.settings.play && session.moves());
    int const frames = moves ? std::max(1, int(std::lround(wanted.view.duration_s * s.settings.rate_hz))) : 1;
    write_prepared(folder / key, [&](std::filesystem::path const& into) -> nlohmann::json {
        FrameCommand order;
        order.paths = s.settings.paths > 0 ? s.settings.paths : kPathsWithoutSetting;
        for (int f = -wanted.view.warmup_frames; f < frames; ++f) {
            if (stop.requested())
                throw gi::InputError("preparing stimuli", "it was interrupted", "start it again");
            order.frame = std::uint64_t(f + wanted.view.warmup_frames);
            double const seconds = std::max(0, f) / s.settings.rate_hz;
            order.scene_s = s.settings.play ? s.settings.speed * seconds : 0;
            order.views = stimulus_views(place, s, wanted.view, seconds);
            SessionFrame const frame = session.render(order, {});
            for (std::size_t v = 0; f >= 0 && v < frame.views.size(); ++v)
                gi::write_exr(into / file_name(f, int(v)), shown_part(frame.views[v].picture), gi::PixelType::half,
                              report);
        }
        return {{"exposure", s.settings.exposure_ev}, {"tone", s.settings.tone},
                {"swap_eyes", s.settings.swap_eyes},  {"frames", frames},
                {"views", order.views.size()},        {"sha256", s.sha256}};
    });
    return true;
}

void PreparedSource::prepare(StimulusSettings const& stimulus, StimulusView const& view)
{
    frames_.clear();
    std::filesystem::path const folder = folder_ / prepared_key({stimulus, view}, version_);
    if (!std::filesystem::exists(folder / "stimulus.json"))
        throw gi::InputError(fmt::format("a stimulus of {} is not in '{}'", name_of(stimulus), folder_.string()),
                             fmt::format("nothing was prepared for a place of {} x {} px by this version",
                                         view.size_px.x, view.size_px.y),
                             "run lightwell study prepare with the same script and --size");
    nlohmann::json const about = read_prepared(folder);
    duration_s_ = view.duration_s;
    int const views = about.at("views").get<int>();
    for (int f = 0; f < about.at("frames").get<int>(); ++f) {
        auto frame = std::make_shared<LiveFrame>();
        frame->settings = stimulus.settings;
        for (int v = 0; v < views; ++v) {
            gi::Picture picture = gi::read_exr(folder / file_name(f, v));
            ViewCommand order;
            order.width = picture.width;
            order.height = picture.height;
            frame->command.views.push_back(order);
            frame->result.views.push_back({std::move(picture), {}});
        }
        frames_.push_back(std::move(frame));
    }
}

void PreparedSource::at(double seconds) { at_s_ = std::max(0.0, seconds); }

void PreparedSource::change(StimulusSettings const&)
{
    throw gi::InputError("an adjustment of prepared stimuli", "only planned levels have pictures",
                         "write stimuli: live in the block");
}

void PreparedSource::walk(NavigationInput const&, double)
{
    throw gi::InputError("a walk through prepared stimuli", "they are pictures", "write stimuli: live");
}

std::shared_ptr<LiveFrame const> PreparedSource::newest()
{
    if (frames_.empty()) return nullptr;
    double const round = std::fmod(at_s_, duration_s_) / duration_s_;
    return frames_[std::min(frames_.size() - 1, std::size_t(round * double(frames_.size())))];
}

} // namespace viewer
