#include "viewer/video_writer.h"

#include "gi/base/error.h"

#include <fmt/format.h>
#include <opencv2/core/utils/logger.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

namespace viewer {
namespace {

namespace fs = std::filesystem;

struct Codec {
    char const* extension;
    char const* name;
    int code;
};
int const kFfv1 = cv::VideoWriter::fourcc('F', 'F', 'V', '1'), kH264 = cv::VideoWriter::fourcc('a', 'v', 'c', '1');
Codec const kCodecs[]{{".mkv", "FFV1", kFfv1}, {".mp4", "H.264", kH264}};

gi::InputError cannot(fs::path const& file, std::string const& why, std::string const& suggestion)
{
    return {"cannot write '" + file.string() + "'", why, suggestion};
}

Codec const& codec_of(fs::path const& file)
{
    for (Codec const& codec : kCodecs)
        if (file.extension() == codec.extension) return codec;
    throw cannot(file, "its ending names no video that is written here", "choose .mkv (lossless) or .mp4 (H.264)");
}

} // namespace

void check_video(fs::path const& file, int width, int height, double fps)
{
    codec_of(file);
    if (width % 2 != 0 || height % 2 != 0)
        throw cannot(file, fmt::format("{} x {} pixels: width and height of a video are even", width, height),
                     "change --size by one pixel");
    if (!(fps >= 0.01) || !(fps <= 1000))
        throw cannot(file, fmt::format("{:g} frames per second: videos have 0.01 to 1000", fps),
                     "change --frames");
}

struct VideoWriter::Stream {
    cv::VideoWriter out;
};

VideoWriter::VideoWriter(fs::path const& file, int width, int height, double fps)
    : file_(file),
      temporary_(fs::absolute(file).parent_path() / // absolute, or FFmpeg takes "a:" for a protocol
                 ("." + file.stem().string() + ".unfinished" + file.extension().string())),
      width_(width),
      height_(height),
      stream_(std::make_unique<Stream>())
{
    check_video(file, width, height, fps);
    Codec const& codec = codec_of(file);
    cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT); // the message below says it
    bool const open = stream_->out.open(temporary_.string(), cv::CAP_FFMPEG, codec.code, fps, {width, height});
    if (open) return;
    std::error_code ignored;
    fs::remove(temporary_, ignored);
    throw cannot(file,
                 fmt::format("OpenCV and FFmpeg have no encoder for {} here, or the folder is full", codec.name),
                 "choose .mkv or .mp4, or save --png frames");
}

VideoWriter::~VideoWriter()
{
    stream_.reset();
    std::error_code ignored;
    fs::remove(temporary_, ignored);
}

void VideoWriter::add(std::span<unsigned char const> rgb8)
{
    cv::Mat const rgb(height_, width_, CV_8UC3, const_cast<unsigned char*>(rgb8.data()));
    cv::Mat bgr;
    cv::cvtColor(rgb, bgr, cv::COLOR_RGB2BGR);
    stream_->out.write(bgr);
    ++frames_;
}

void VideoWriter::finish()
{
    stream_->out.release();
    int read = 0;
    cv::VideoCapture in(temporary_.string(), cv::CAP_FFMPEG);
    while (read <= frames_ && in.isOpened() && in.grab()) ++read;
    if (read != frames_)
        throw cannot(file_, fmt::format("read back it has {} of {} frames", read, frames_),
                     "free some space or choose another folder");
    fs::rename(temporary_, file_);
}

} // namespace viewer
