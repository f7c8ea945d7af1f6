#include "viewer/cli/ar/ar_posed_frames.h"

#include "ar/capture/frame_source.h"
#include "ar/runtime/frame_clock.h"
#include "ar/runtime/frames_apart.h"
#include "gi/core/error.h"
#include "viewer/cli/ar/ar_camera_path.h"

namespace viewer {

PosedFrames read_posed_frames(PosedFrameChoice const& a, ar::Session const& session,
                              ar::CalibratedCamera const& camera, gi::StopRequest const& stop, gi::Report& report)
{
    CameraPath path(a.poses, session, camera, report);
    ar::OpenOptions open = session.frames.options;
    open.pace = ar::Pace::fastest;
    auto const source = ar::open_source(session.frames.source, open);
    if (a.frames == 0 && (source->description().is_live || session.frames.source == "counter"))
        throw gi::InputError("frames of '" + session.frames.source + "', all of them", "the source never ends",
                             "limit their number: --frames 300");
    ar::FrameClock clock(session.frames.source, source->description(), false);
    PosedFrames seen;
    ar::SpacedFrames<ar::PosedFrame> kept(std::size_t(a.views));
    for (int n = 0; !stop.requested() && (a.frames == 0 || n < a.frames);) {
        std::optional<ar::Frame> const frame = source->next(std::chrono::milliseconds(200));
        if (!frame) {
            if (source->state().kind != ar::SourceState::Kind::running) break;
            continue;
        }
        ++n;
        if (a.only >= 0 && std::int64_t(frame->sequence) > a.only) break;
        double const time_s = clock(*frame);
        try {
            auto const pose = path.at(*frame, time_s, stop);
            if (!pose) {
                ++seen.without_pose;
                continue;
            }
            ++seen.found;
            if (a.only >= 0 && std::int64_t(frame->sequence) != a.only) continue;
            if (!kept.wants_next()) {
                kept.skip();
                continue;
            }
            cv::Mat const rgb = ar::picture_of(*frame);
            if (rgb.size() != cv::Size(camera.model.size_px.x, camera.model.size_px.y))
                throw gi::InputError("a frame of another size", "the calibration differs", "calibrate again");
            kept.add({rgb.clone(), frame->exposure, pose->first, pose->second});
        } catch (gi::InputError const& e) {
            ++seen.refused;
            report.lose("frames that could not be used", 1, e.what());
        }
    }
    ar::report_losses(source->counts(), source->state(), report);
    seen.refused += int(source->counts().refused);
    seen.kept = kept.take();
    return seen;
}

} // namespace viewer
