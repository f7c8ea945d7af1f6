#include "viewer/experiment/stimuli/ar_pictures.h"

#include "ar/capture/frame_source.h"
#include "ar/capture/open_source.h"
#include "ar/markers/marker_map_file.h"
#include "ar/runtime/frame_clock.h"
#include "ar/runtime/runner.h"
#include "ar/scene/camera_poses.h"
#include "ar/scene/read_values.h"
#include "gi/core/error.h"
#include "viewer/camera_view/camera_tracker.h"
#include "viewer/experiment/screens/screen.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

/// Tolerance for rounded times in files.
constexpr double kRounding_s = 2e-6;

/// Numbered frames of files, each with its time in the session.
class Frames {
public:
    Frames(ar::Session const& session, gi::Report& report) : name_(session.frames.source), report_(report)
    {
        if (ar::is_device(name_))
            throw gi::InputError("frames of '" + name_ + "' as a stimulus",
                                 name_ == "counter" ? "they never end" : "live frames cannot be repeated",
                                 "record them (lightwell ar record) and name the recording");
        ar::OpenOptions open = session.frames.options;
        open.pace = ar::Pace::fastest;
        open.delivery = ar::Delivery::every;
        source_ = ar::open_source(name_, open);
        clock_.emplace(name_, source_->description(), false);
    }

    ~Frames()
    {
        if (source_ && !was_told_) ar::report_losses(source_->counts(), {}, report_);
    }
    Frames(Frames const&) = delete;
    Frames& operator=(Frames const&) = delete;

    struct Timed {
        ar::Frame frame;
        double time_s;
    };
    std::optional<Timed> next()
    {
        std::optional<ar::Frame> frame;
        while (!(frame = source_->next(std::chrono::milliseconds(200))))
            if (source_->state().kind != ar::SourceState::Kind::running) {
                was_told_ = true;
                ar::report_losses(source_->counts(), source_->state(), report_);
                return std::nullopt;
            }
        if (!first_) first_ = frame->sequence;
        double const time_s = (*clock_)(*frame);
        last_ = frame->sequence;
        return Timed{std::move(*frame), time_s};
    }
    std::string describe() const
    {
        return first_ ? fmt::format("'{}' has frames {} to {}", name_, *first_, last_)
                      : fmt::format("'{}' has none", name_);
    }

private:
    std::string name_;
    gi::Report& report_;
    std::unique_ptr<ar::FrameSource> source_;
    std::optional<ar::FrameClock> clock_;
    bool was_told_ = false;
    std::optional<std::uint64_t> first_;
    std::uint64_t last_ = 0;
};

bool is_first_shown(ArStimulus const& s, Frames::Timed const& f)
{
    return s.frame ? f.frame.sequence == *s.frame : f.time_s >= s.from_s - kRounding_s;
}

ArSettingError no_such_frame(ArStimulus const& s, std::string const& what_there_is)
{
    return s.frame ? ArSettingError("ar.frame", std::to_string(*s.frame),
                                    fmt::format("there is no frame {}", *s.frame), what_there_is,
                                    "choose another number")
                   : ArSettingError("ar.from_s", fmt::format("{:g}", s.from_s),
                                    fmt::format("the frames end before {:g} s", s.from_s), what_there_is,
                                    "begin earlier");
}

cv::Mat read_truth(ArStimulus const& s, ar::Frame const& frame)
{
    std::filesystem::path const file = s.truth / fmt::format("{:06}.png", frame.sequence);
    cv::Mat truth;
    if (std::filesystem::exists(file)) truth = cv::imread(file.string(), cv::IMREAD_COLOR);
    if (truth.empty() || glm::ivec2(truth.cols, truth.rows) != frame.size_px)
        throw ArSettingError("ar.show", "truth",
                             truth.empty() ? "there is no picture '" + file.string() + "'"
                                           : "'" + file.string() + "' and its frame differ in size",
                             fmt::format("it is the truth of frame {}", frame.sequence),
                             "let `lightwell ar synthesize` make it, or name the folder by ar.truth");
    cv::cvtColor(truth, truth, cv::COLOR_BGR2RGB);
    return truth;
}

std::vector<ar::TimedPose> poses_of(ArStimulus const& s, ar::SessionFrames const& frames, gi::Report& report)
{
    try {
        return ar::read_camera_poses(s.poses, {ar::frames_per_s_of(frames), {}}, report).poses;
    } catch (gi::InputError const& e) {
        throw ArSettingError("ar.poses", s.poses.filename().string(), "the camera's poses", e.what(),
                             "name a file of a format in docs/ar.md (Poses)");
    }
}

/// Makes the pictures frame by frame.
class Maker {
public:
    Maker(ArStimulus const& stimulus, gi::StopRequest const& stop, gi::Report& report)
        : stimulus_(stimulus), stop_(stop), report_(report)
    {
        ar::Session const session = session_of(stimulus);
        if (!stimulus.poses.empty()) poses_ = poses_of(stimulus, session.frames, report);
        if (stimulus.show != ArShow::composite) return;
        if (poses_.empty() && session.tracked) poses_ = recorded_poses(*session.tracked, report);
        pipeline_.emplace(session, ar::load_camera(session.camera, &report), ar::read_marker_map(session.markers),
                          report);
    }

    ArPicture operator()(Frames::Timed const& f)
    {
        ArPicture p;
        if (stimulus_.show == ArShow::camera) p.rgb = ar::rgb_of(f.frame).clone();
        if (stimulus_.show == ArShow::truth) p.rgb = read_truth(stimulus_, f.frame);
        if (stimulus_.show != ArShow::composite) return p;
        std::optional<std::optional<gi::RigidPose>> known;
        if (!poses_.empty()) known = ar::recorded_pose(poses_, f.time_s);
        ar::FrameResult r = pipeline_->find(f.frame, f.time_s, known, {}, &stop_);
        pipeline_->add(r, f.frame, f.time_s, stop_);
        p.rgb = ar::eight_bits_of(r.rgb).clone();
        if (r.rgb.depth() != CV_8U)
            report_.lose("frames of stimuli reduced to 8 bits", 1, stimulus_.session.string());
        p.world_from_camera = r.used.world_from_camera;
        if (r.used.state != ar::PoseState::tracked)
            report_.lose("frames of stimuli in which no camera was found", 1,
                         fmt::format("frame {} of {}", f.frame.sequence, stimulus_.session.string()));
        return p;
    }

private:
    ArStimulus const& stimulus_;
    gi::StopRequest const& stop_;
    gi::Report& report_;
    std::optional<ar::Pipeline> pipeline_;
    std::vector<ar::TimedPose> poses_;
};

} // namespace

cv::Mat fitted(cv::Mat const& rgb, glm::ivec2 size_px)
{
    int const grey = int(std::lround(255 * ScreenContent::kGrey));
    cv::Mat place(size_px.y, size_px.x, CV_8UC3, cv::Scalar::all(grey));
    double const scale = std::min(double(size_px.x) / rgb.cols, double(size_px.y) / rgb.rows);
    cv::Size const size(std::clamp(int(std::lround(scale * rgb.cols)), 1, size_px.x),
                        std::clamp(int(std::lround(scale * rgb.rows)), 1, size_px.y));
    cv::Mat part =
        place(cv::Rect((size_px.x - size.width) / 2, (size_px.y - size.height) / 2, size.width, size.height));
    if (size == rgb.size())
        rgb.copyTo(part);
    else
        cv::resize(rgb, part, size, 0, 0, scale < 1 ? cv::INTER_AREA : cv::INTER_LINEAR);
    return place;
}

std::vector<ArPicture> make_ar_pictures(ArStimulus const& s, StimulusView const& view, gi::StopRequest const& stop,
                                        gi::Report& report)
{
    if (view.size_px.x <= 0 || view.size_px.y <= 0)
        throw gi::InputError("a place without pixels", "no frame fits in it", "enlarge the window");
    Frames frames(session_of(s), report);
    Maker make(s, stop, report);
    std::deque<Frames::Timed> before; // warm-up frames, so that filters and light have settled
    std::vector<ArPicture> pictures;
    double begin_s = 0;
    while (auto f = frames.next()) {
        if (stop.requested()) return {};
        if (pictures.empty() && !is_first_shown(s, *f)) {
            before.push_back(std::move(*f));
            if (int(before.size()) > view.warmup_frames) before.pop_front();
            continue;
        }
        if (pictures.empty()) {
            begin_s = f->time_s;
            for (Frames::Timed const& w : before) make(w);
        }
        if (!pictures.empty() && f->time_s - begin_s >= view.duration_s - kRounding_s) break;
        ArPicture p = make(*f);
        if (stop.requested()) return {};
        if (s.frame && s.show == ArShow::composite && !p.world_from_camera)
            throw ArSettingError("ar.frame", std::to_string(*s.frame),
                                 fmt::format("no camera is found in frame {}", *s.frame),
                                 "no virtual object could be placed in it",
                                 "choose another frame, or give the camera's path by ar.poses");
        p.time_s = f->time_s - begin_s;
        p.rgb = fitted(p.rgb, view.size_px);
        pictures.push_back(std::move(p));
        if (s.frame) break;
    }
    if (pictures.empty()) throw no_such_frame(s, frames.describe());
    return pictures;
}

void check_ar_pictures(ArStimulus const& s)
{
    ar::Session const session = session_of(s);
    gi::Report report;
    Frames frames(session, report);
    gi::StopRequest const stop;
    Maker make(s, stop, report);
    ar::CalibratedCamera const camera = ar::load_camera(session.camera);
    while (auto f = frames.next()) {
        ar::check_size(f->frame.size_px, camera);
        if (!is_first_shown(s, *f)) continue;
        if (s.show == ArShow::truth) read_truth(s, f->frame);
        return;
    }
    throw no_such_frame(s, frames.describe());
}

} // namespace viewer
