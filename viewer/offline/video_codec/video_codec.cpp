#include "viewer/offline/video_codec/video_codec.h"

#include <opencv2/core/utils/logger.hpp>
#include <opencv2/videoio.hpp>

namespace viewer {
namespace {

class FfmpegStream final : public VideoStream {
public:
    bool open(std::filesystem::path const& file, char const* code, double fps, cv::Size size)
    {
        return out_.open(file.string(), cv::CAP_FFMPEG,
                         cv::VideoWriter::fourcc(code[0], code[1], code[2], code[3]), fps, size);
    }
    void write(cv::Mat const& bgr) override { out_.write(bgr); }

private:
    cv::VideoWriter out_;
};

class FfmpegCodec final : public VideoCodec {
public:
    std::unique_ptr<VideoStream> open(std::filesystem::path const& file, char const* code, double fps, int width,
                                      int height) override
    {
        cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); // the caller reports errors
        auto stream = std::make_unique<FfmpegStream>();
        if (!stream->open(file, code, fps, {width, height})) return nullptr;
        return stream;
    }

    int count_frames(std::filesystem::path const& file, int most) override
    {
        cv::VideoCapture in(file.string(), cv::CAP_FFMPEG);
        int read = 0;
        while (read < most && in.isOpened() && in.grab()) ++read;
        return read;
    }
};

} // namespace
} // namespace viewer

viewer::VideoCodec* lightwell_video_codec()
{
    static viewer::FfmpegCodec codec;
    return &codec;
}
