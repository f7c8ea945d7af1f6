#include "viewer/offline/video_writer.h"

#include "gi/core/error.h"
#include "gi/core/module.h"
#include "viewer/offline/video_codec/video_codec.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

namespace fs = std::filesystem;

struct Codec {
    char const* extension;
    char const* name;
    char const* code; ///< FourCC
};
constexpr Codec kCodecs[]{{".mkv", "FFV1", "FFV1"}, {".mp4", "H.264", "avc1"}};

gi::InputError cannot(fs::path const& file, std::string const& why, std::string const& suggestion)
{
    return {"cannot write '" + file.string() + "'", why, suggestion};
}

Codec const& codec_of(fs::path const& file)
{
    for (Codec const& codec : kCodecs)
        if (file.extension() == codec.extension) return codec;
    throw cannot(file, "its ending is not a supported video format", "choose .mkv (lossless) or .mp4 (H.264)");
}

/// The module that links FFmpeg, loaded for the first video.
VideoCodec& video_codec()
{
    static VideoCodec& codec = [&]() -> VideoCodec& {
        return *reinterpret_cast<decltype(&lightwell_video_codec)>(
            gi::module_function("liblightwell_video.so", "lightwell_video_codec", "videos cannot be written",
                                "install the package lightwell-ar, or build all: scripts/build release"))();
    }();
    return codec;
}

} // namespace

void check_video(fs::path const& file, int width, int height, double fps)
{
    codec_of(file);
    if (width % 2 != 0 || height % 2 != 0)
        throw cannot(file, fmt::format("{} x {} pixels: width and height of a video must be even", width, height),
                     "change --size by one pixel");
    if (!(fps >= 0.01) || !(fps <= 1000))
        throw cannot(file, fmt::format("{:g} frames per second: 0.01 to 1000 are possible", fps),
                     "change --frames");
}

VideoWriter::VideoWriter(fs::path const& file, int width, int height, double fps)
    : file_(file),
      temporary_(fs::absolute(file).parent_path() / // absolute, as FFmpeg reads "a:" as a protocol
                 ("." + file.stem().string() + ".unfinished" + file.extension().string())),
      width_(width),
      height_(height)
{
    check_video(file, width, height, fps);
    Codec const& codec = codec_of(file);
    stream_ = video_codec().open(temporary_, codec.code, fps, width, height);
    if (stream_) return;
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
    stream_->write(bgr);
    ++frames_;
}

void VideoWriter::finish()
{
    stream_.reset();
    int const read = video_codec().count_frames(temporary_, frames_ + 1);
    if (read != frames_)
        throw cannot(file_, fmt::format("only {} of {} frames can be read back", read, frames_),
                     "free some space or choose another folder");
    fs::rename(temporary_, file_);
}

} // namespace viewer
