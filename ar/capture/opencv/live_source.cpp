// Devices and pipelines do not wait, so a thread reads their frames as they arrive.

#include "ar/capture/clock.h"
#include "ar/capture/opencv/opencv_sources.h"
#include "ar/capture/tally.h"
#include "ar/capture/whole_picture.h"
#include "gi/core/error.h"

#include <cmath>
#include <condition_variable>
#include <deque>
#include <fmt/format.h>
#include <mutex>
#include <opencv2/videoio.hpp>
#include <thread>

namespace ar::opencv {
namespace {

enum class Kind { device, pipeline };

class LiveSource final : public FrameSource {
public:
    LiveSource(Kind kind, std::string name, cv::VideoCapture const& capture, LiveOptions const& options)
        : kind_(kind), name_(std::move(name)), options_(options), capture_(capture)
    {
        set(options.controls);
        while (waiting_.empty() && read_one()) {
        }
        if (waiting_.empty())
            throw gi::InputError("'" + name_ + "' gives no frame", "it was opened, but nothing came of it",
                                 "look whether another program uses it");
        size_px_ = waiting_.front().size_px;
        format_ = waiting_.front().format;
        frames_per_s_ = capture_.get(cv::CAP_PROP_FPS);
        frame_count_ = capture_.get(cv::CAP_PROP_FRAME_COUNT);
        reader_ = std::thread([this] { read_all(); });
    }
    ~LiveSource() override
    {
        {
            std::lock_guard const lock(mutex_);
            closing_ = true;
            changed_.notify_all();
        }
        reader_.join();
    }

    std::optional<Frame> next(std::chrono::milliseconds wait) override
    {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, wait,
                          [&] { return !waiting_.empty() || end_.kind != SourceState::Kind::running; });
        if (waiting_.empty()) return std::nullopt;
        Frame f = std::move(waiting_.front());
        waiting_.pop_front();
        changed_.notify_all();
        tally_.deliver(f.sequence);
        f.arrived_s = steady_now_s();
        return f;
    }

    SourceState state() const override
    {
        std::lock_guard const lock(mutex_);
        return waiting_.empty() ? end_ : SourceState{};
    }

    SourceDescription description() const override
    {
        std::lock_guard const lock(mutex_);
        SourceDescription d{.name = name_,
                            .id = name_,
                            .size_px = size_px_,
                            .format = format_,
                            .frames_per_s = frames_per_s_ > 0 && frames_per_s_ < 1e5 ? frames_per_s_ : 0,
                            .is_live = true,
                            .controls = {}};
        if (kind_ == Kind::device) d.controls = {"exposure_time", "gain", "automatic", "frame_duration"};
        return d;
    }

    SourceCounts counts() const override
    {
        std::lock_guard const lock(mutex_);
        return tally_.counts();
    }

    /// V4L2 through OpenCV 4.6: exposure in units of 0.1 ms, automatic exposure 1 = by hand, 3 = by the camera.
    std::vector<std::string> set(Controls const& c) override
    {
        check(c);
        if (kind_ == Kind::pipeline) return cannot_set(c, "a pipeline has its settings in its text");
        std::vector<std::string> problems;
        Turn const turn(*this);
        auto const put = [&](int property, double value, char const* name) {
            bool good = false;
            try {
                good = capture_.set(property, value);
            } catch (cv::Exception const&) { // same as unsupported
            }
            if (!good) problems.push_back(fmt::format("{} cannot be set: the driver refuses it", name));
        };
        if (c.automatic_exposure)
            put(cv::CAP_PROP_AUTO_EXPOSURE, *c.automatic_exposure ? 3 : 1, "automatic exposure");
        else if (c.exposure_time_s)
            put(cv::CAP_PROP_AUTO_EXPOSURE, 1, "automatic exposure");
        if (c.exposure_time_s)
            put(cv::CAP_PROP_EXPOSURE, std::round(1e4 * *c.exposure_time_s), "the exposure time");
        if (c.gain) put(cv::CAP_PROP_GAIN, *c.gain, "the gain");
        if (c.automatic_white_balance)
            put(cv::CAP_PROP_AUTO_WB, *c.automatic_white_balance ? 1 : 0, "automatic white balance");
        if (c.red_gain) problems.push_back("white balance cannot be set: V4L2 has no gains of colours");
        if (c.frame_duration_s) put(cv::CAP_PROP_FPS, 1 / *c.frame_duration_s, "the frame duration");
        return problems;
    }

private:
    /// The capture allows one thread at a time: the reader yields to threads that
    /// set controls before its next frame.
    class Turn {
    public:
        explicit Turn(LiveSource& source) : source_(source)
        {
            source_.count_setters(1);
            source_.capture_mutex_.lock();
        }
        ~Turn()
        {
            source_.capture_mutex_.unlock();
            source_.count_setters(-1);
        }

    private:
        LiveSource& source_;
    };
    void count_setters(int change)
    {
        std::lock_guard const lock(mutex_);
        setters_ += change;
        changed_.notify_all();
    }

    void read_all()
    {
        while (read_one()) {
            std::unique_lock lock(mutex_);
            changed_.wait(lock, [&] { return closing_ || setters_ == 0; });
            if (options_.delivery == Delivery::every) // the driver drops what it has no room for
                changed_.wait(lock, [&] { return closing_ || waiting_.size() < kMostWaiting; });
            if (closing_) return;
        }
        std::lock_guard const lock(mutex_);
        end_ = kind_ == Kind::device
                   ? SourceState{SourceState::Kind::lost, "'" + name_ + "' gives no more frames: unplugged?"}
               : frame_count_ > 0 ? SourceState{SourceState::Kind::ended, "the pipeline has ended"}
                                  : SourceState{SourceState::Kind::lost, "the pipeline stopped"};
        changed_.notify_all();
    }

    /// False at the end.
    bool read_one()
    {
        cv::Mat picture;
        double stamp_ms = 0;
        try {
            std::lock_guard const lock(capture_mutex_);
            if (!capture_.grab()) return false;
            if (!capture_.retrieve(picture) || picture.empty()) return refuse("it cannot be decoded");
            if (options_.format == PixelFormat::mjpeg && jpeg_size_px_ == glm::ivec2(0))
                jpeg_size_px_ = {int(capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
                                 int(capture_.get(cv::CAP_PROP_FRAME_HEIGHT))};
            if (kind_ == Kind::device) stamp_ms = capture_.get(cv::CAP_PROP_POS_MSEC);
        } catch (cv::Exception const& e) {
            return refuse("it cannot be decoded: " + e.err);
        }
        Frame f;
        if (std::string const problem = make_frame(picture, f); !problem.empty()) return refuse(problem);
        DriverClocks const now = driver_clocks();
        auto const driver_s = steady_time_of(std::int64_t(1e6 * stamp_ms), now);
        f.captured_s = driver_s.value_or(steady_now_s());
        f.origin = driver_s ? TimestampOrigin::driver : TimestampOrigin::arrival;
        std::lock_guard const lock(mutex_);
        f.sequence = read_++;
        failures_ = 0;
        if (options_.delivery == Delivery::newest)
            for (; !waiting_.empty(); waiting_.pop_front()) tally_.drop(waiting_.front().sequence);
        waiting_.push_back(std::move(f));
        changed_.notify_all();
        return true;
    }

    /// Sets the planes from OpenCV's picture; returns the reason if it is not as expected.
    std::string make_frame(cv::Mat const& picture, Frame& f) const
    {
        bool const is_jpeg_wanted = options_.format == PixelFormat::mjpeg;
        if (is_jpeg_wanted) {
            cv::Mat const bytes = picture.reshape(1, 1);
            std::span<std::uint8_t const> const jpeg(bytes.data, bytes.total());
            if (!is_jpeg(jpeg)) return "it is no JPEG";
            if (std::string missing = what_is_missing(jpeg); !missing.empty()) return missing;
            f.format = PixelFormat::mjpeg;
            f.size_px = jpeg_size_px_;
            f.planes[0] = bytes.clone(); // OpenCV's is the driver's buffer
            return {};
        }
        if (options_.format == PixelFormat::yuyv && picture.type() != CV_8UC2) return "it is no YUYV";
        if (picture.type() != CV_8UC3 && picture.type() != CV_8UC1 && picture.type() != CV_8UC2)
            return "its pixels are not of 8 bits";
        f.format = picture.channels() == 3   ? PixelFormat::bgr8
                   : picture.channels() == 2 ? PixelFormat::yuyv
                                             : PixelFormat::gray8;
        f.size_px = {picture.cols, picture.rows};
        if (size_px_ != glm::ivec2(0) && (f.size_px != size_px_ || f.format != format_))
            return fmt::format("it has {} x {} pixels ({}), the first one had {} x {} ({})", f.size_px.x,
                               f.size_px.y, name_of(f.format), size_px_.x, size_px_.y, name_of(format_));
        f.planes[0] = picture.u != nullptr ? picture : picture.clone();
        return {};
    }

    /// Counts a failure; many in a row end the source.
    bool refuse(std::string const& why)
    {
        std::lock_guard const lock(mutex_);
        tally_.refuse(read_, fmt::format("frame {}: {}", read_, why));
        ++read_;
        return ++failures_ < kMostFailures;
    }

    static constexpr std::size_t kMostWaiting = 4;
    static constexpr int kMostFailures = 100;

    Kind kind_;
    std::string name_;
    LiveOptions options_;
    std::mutex capture_mutex_;
    cv::VideoCapture capture_;
    glm::ivec2 size_px_{0}, jpeg_size_px_{0};
    PixelFormat format_ = PixelFormat::bgr8;
    double frames_per_s_ = 0, frame_count_ = 0;

    mutable std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::deque<Frame> waiting_;
    SourceState end_;
    Tally tally_;
    std::uint64_t read_ = 0;
    int failures_ = 0, setters_ = 0;
    bool closing_ = false;
    std::thread reader_;
};

void check_options(LiveOptions const& o)
{
    check(o.controls);
    if (o.format && *o.format != PixelFormat::yuyv && *o.format != PixelFormat::mjpeg &&
        *o.format != PixelFormat::bgr8)
        throw gi::InputError("frames of a device as " + name_of(*o.format), "OpenCV gives yuyv, mjpeg or bgr8",
                             "choose one of these");
}

} // namespace

std::unique_ptr<FrameSource> open_device(int number, LiveOptions const& o)
{
    check_options(o);
    cv::VideoCapture capture;
    std::string const name = fmt::format("/dev/video{}", number);
    std::error_code error;
    if (number < 0 || !std::filesystem::exists(name, error))
        throw gi::InputError(fmt::format("no camera {}", number), "there is no " + name,
                             "plug it in, or name another number");
    if (!capture.open(number, cv::CAP_V4L2))
        throw gi::InputError("'" + name + "' cannot be opened", "it is no camera, or another program uses it",
                             "close that program, or name another number");
    if (o.format == PixelFormat::mjpeg)
        capture.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'));
    if (o.format == PixelFormat::yuyv)
        capture.set(cv::CAP_PROP_FOURCC, cv::VideoWriter::fourcc('Y', 'U', 'Y', 'V'));
    if (o.size_px.x > 0 && o.size_px.y > 0) {
        capture.set(cv::CAP_PROP_FRAME_WIDTH, o.size_px.x);
        capture.set(cv::CAP_PROP_FRAME_HEIGHT, o.size_px.y);
    }
    if (o.frames_per_s > 0) capture.set(cv::CAP_PROP_FPS, o.frames_per_s);
    if (o.format && *o.format != PixelFormat::bgr8) capture.set(cv::CAP_PROP_CONVERT_RGB, 0);
    return std::make_unique<LiveSource>(Kind::device, name, capture, o);
}

std::unique_ptr<FrameSource> open_pipeline(std::string const& pipeline, LiveOptions const& o)
{
    check_options(o);
    cv::VideoCapture capture;
    if (!capture.open(pipeline, cv::CAP_GSTREAMER))
        throw gi::InputError("the GStreamer pipeline '" + pipeline + "' cannot be built",
                             "an element of it is unknown, or it does not end in an appsink",
                             "try it with gst-launch-1.0, fakesink in place of appsink");
    LiveOptions as_it_comes = o;
    as_it_comes.format.reset();
    return std::make_unique<LiveSource>(Kind::pipeline, pipeline, capture, as_it_comes);
}

} // namespace ar::opencv
