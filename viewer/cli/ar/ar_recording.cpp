#include "viewer/cli/ar/ar_recording.h"

#include <cmath>
#include <exception>
#include <fmt/format.h>

namespace viewer {
namespace {

std::span<unsigned char const> bytes_of(cv::Mat const& rgb) { return {rgb.ptr(), rgb.total() * rgb.elemSize()}; }

} // namespace

ArRecording::ArRecording(ArRecordingSettings settings) : settings_(std::move(settings))
{
    if (settings_.pictures.empty()) return;
    folder_.emplace(settings_.pictures);
    to_folder_ = std::make_unique<ar::PictureThread>(
        [this](ar::KeptPicture const& p) { folder_->add(p.sequence, p.rgb); }, settings_.when_full);
}

void ArRecording::begin(ar::SourceDescription const& source, ar::CameraModel const& camera,
                        ar::Compositor const& compositor, gi::Report& report)
{
    if (source.frames_per_s > 0) video_hz_ = source.frames_per_s;
    if (!settings_.passes.folder.empty())
        passes_ = std::make_unique<ar::PassFolder>(settings_.passes, camera, compositor, source.frames_per_s,
                                                   settings_.when_full, report);
    if (!settings_.video.empty()) {
        video_ = std::make_unique<VideoWriter>(settings_.video, source.size_px.x, source.size_px.y, video_hz_);
        to_video_ = std::make_unique<ar::PictureThread>([this](ar::KeptPicture const& p) { add_to_video(p); },
                                                        settings_.when_full);
    }
    if (settings_.input.empty()) return;
    ar::SessionHeader header;
    header.camera = source;
    header.calibration = settings_.calibration;
    input_ = std::make_unique<ar::SessionWriter>(settings_.input, header);
}

void ArRecording::add_input(ar::Frame const& frame)
{
    if (input_) input_->append(frame);
}

/// Videos have a constant frame rate: each picture is repeated until the next one is due.
void ArRecording::add_to_video(ar::KeptPicture const& p)
{
    constexpr double longest_s = 10; // longest time that one picture is shown, even if the clock jumps
    cv::Mat const bytes = ar::eight_bits_of(p.rgb), rgb = bytes.isContinuous() ? bytes : bytes.clone();
    if (p.rgb.depth() != CV_8U) ++reduced_;
    double const early_s = video_->frames() / video_hz_ - (p.time_s - cut_s_);
    if (early_s > 1.25 / video_hz_) { // tolerates jitter of about one picture
        ++left_out_;
        return;
    }
    if (-early_s > longest_s) cut_s_ += -early_s - longest_s;
    auto const due = int(std::lround((p.time_s - cut_s_) * video_hz_));
    for (; !held_.empty() && video_->frames() < due; ++repeated_) video_->add(bytes_of(held_));
    video_->add(bytes_of(rgb));
    held_ = rgb;
}

void ArRecording::add(ar::RunFrame const& record, ar::FrameResult const& result)
{
    if (passes_) passes_->add(record, result);
    for (ar::PictureThread* const t : {to_folder_.get(), to_video_.get()})
        if (t != nullptr) t->add({record.sequence, record.captured_s, result.rgb});
}

void ArRecording::finish()
{
    std::exception_ptr first;
    auto const attempt = [&](auto const& what) {
        try {
            what();
        } catch (...) {
            if (!first) first = std::current_exception();
        }
    };
    if (to_folder_) attempt([&] { to_folder_->finish(); });
    if (to_video_) attempt([&] { to_video_->finish(); });
    if (passes_) attempt([&] { passes_->finish(); });
    if (video_ && video_->frames() > 0 && !is_video_done_) {
        is_video_done_ = is_video_lost_ = true;
        attempt([&] {
            video_->finish();
            is_video_lost_ = false;
        });
    }
    if (input_) attempt([&] { input_->finish(); });
    if (first) std::rethrow_exception(first);
}

std::string ArRecording::text() const
{
    std::string text;
    if (to_folder_ && to_folder_->lost() > 0)
        text += fmt::format("{}: {} composites were not written (the disk was too slow)\n", settings_.pictures,
                            to_folder_->lost());
    if (passes_ && passes_->lost() > 0)
        text += fmt::format("{}: the passes of {} frames were not written (the disk was too slow)\n",
                            settings_.passes.folder.string(), passes_->lost());
    if (video_)
        text += fmt::format("{}: {} pictures at {:g} Hz, {} of them repeated for missing frames; {} "
                            "composites lost to a slow encoder\n",
                            settings_.video, video_->frames(), video_hz_, repeated_, to_video_->lost());
    if (reduced_ > 0)
        text += fmt::format("{}: {} composites reduced to 8 bits, as videos have them (--out keeps all)\n",
                            settings_.video, reduced_);
    if (is_video_lost_) text += fmt::format("{}: the video could not be saved\n", settings_.video);
    if (left_out_ > 0)
        text += fmt::format("{}: {} composites left out (faster than this rate)\n", settings_.video, left_out_);
    if (cut_s_ > 0) text += fmt::format("{}: {:.1f} s without frames were cut\n", settings_.video, cut_s_);
    if (input_)
        text += fmt::format("{}: {} frames; {} lost by the queue to the disk\n", settings_.input,
                            input_->written(), input_->lost());
    return text;
}

} // namespace viewer
