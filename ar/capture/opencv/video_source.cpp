#include "ar/capture/opencv/opencv_sources.h"

#include "ar/capture/player.h"
#include "ar/capture/tally.h"
#include "gi/core/error.h"

#include <fmt/format.h>
#include <opencv2/videoio.hpp>

namespace ar::opencv {
namespace {

class VideoSource final : public FrameSource {
public:
    VideoSource(std::filesystem::path const& file, Pace pace) : name_(file.string()), player_(pace)
    {
        std::error_code error;
        if (!std::filesystem::exists(file, error))
            throw gi::InputError("no video '" + name_ + "'", error ? error.message() : "there is no such file",
                                 "name another file");
        // Pass an absolute path, so that the name cannot be parsed as a stream address.
        std::string const path = std::filesystem::absolute(file).string();
        if (!capture_.open(path, cv::CAP_FFMPEG) || !grab())
            throw gi::InputError("'" + name_ + "' has no frame", "it is no video, or nothing of it can be decoded",
                                 "name another file");
        frames_per_s_ = capture_.get(cv::CAP_PROP_FPS);
        if (!(frames_per_s_ > 0 && frames_per_s_ < 1e5)) frames_per_s_ = 0;
        size_px_ = {ready_.cols, ready_.rows};
    }

    std::optional<Frame> next(std::chrono::milliseconds wait) override
    {
        double const until = until_s(wait);
        for (; !ready_.empty(); grab()) {
            if (glm::ivec2(ready_.cols, ready_.rows) != size_px_ || ready_.type() != CV_8UC3) {
                tally_.refuse(sequence_, fmt::format("frame {}: it has {} x {} pixels, the first one had {} x {}",
                                                     sequence_, ready_.cols, ready_.rows, size_px_.x, size_px_.y));
                continue;
            }
            auto const due_s = player_.wait_for(film_s_, until);
            if (!due_s) return std::nullopt;
            Frame f;
            f.sequence = sequence_;
            f.captured_s = *due_s;
            f.origin = TimestampOrigin::file;
            f.format = PixelFormat::bgr8;
            f.size_px = size_px_;
            f.planes[0] = std::exchange(ready_, cv::Mat());
            f.arrived_s = steady_now_s();
            tally_.deliver(sequence_);
            grab();
            return f;
        }
        return std::nullopt;
    }

    SourceState state() const override
    {
        if (!ready_.empty()) return {};
        return {SourceState::Kind::ended, "that was the last frame that can be decoded"};
    }
    SourceDescription description() const override
    {
        return {.name = name_,
                .id = name_,
                .size_px = size_px_,
                .format = PixelFormat::bgr8,
                .frames_per_s = frames_per_s_,
                .is_live = false,
                .controls = {}};
    }
    SourceCounts counts() const override { return tally_.counts(); }
    std::vector<std::string> set(Controls const& controls) override
    {
        check(controls);
        return cannot_set(controls, "this is a video");
    }

private:
    /// The next one into ready_, or the end.
    bool grab()
    {
        ready_ = cv::Mat();
        if (has_ended_) return false;
        bool good = false;
        try {
            good = capture_.read(ready_) && !ready_.empty();
        } catch (cv::Exception const&) {
            ready_ = cv::Mat();
        }
        if (!good) {
            end();
            return false;
        }
        sequence_ = read_++;
        double const at_s = capture_.get(cv::CAP_PROP_POS_MSEC) / 1000;
        film_s_ = read_ == 1 || at_s > film_s_ ? at_s : film_s_ + (frames_per_s_ > 0 ? 1 / frames_per_s_ : 0);
        return true;
    }

    void end()
    {
        has_ended_ = true;
        double const said = capture_.get(cv::CAP_PROP_FRAME_COUNT);
        if (!(said > double(read_) + 1 && said < 1e9)) return;
        for (std::uint64_t i = read_; i < std::uint64_t(said); ++i)
            tally_.refuse(i, fmt::format("the video says that it has {} frames, {} can be decoded", said, read_));
    }

    std::string name_;
    cv::VideoCapture capture_;
    cv::Mat ready_; ///< decoded, not yet due
    double film_s_ = 0, frames_per_s_ = 0;
    std::uint64_t read_ = 0, sequence_ = 0;
    bool has_ended_ = false;
    glm::ivec2 size_px_{0};
    Tally tally_;
    Player player_;
};

} // namespace

std::unique_ptr<FrameSource> open_video(std::filesystem::path const& file, Pace pace)
{
    return std::make_unique<VideoSource>(file, pace);
}

} // namespace ar::opencv
