#include "viewer/offline/video_writer.h"

#include "gi/core/error.h"
#include "viewer/offline/ffmpeg.h"

#include <algorithm>
#include <fmt/format.h>
#include <fstream>
#include <vector>

namespace viewer {
namespace {

namespace fs = std::filesystem;

struct Codec {
    char const* extension;
    std::vector<std::string> options;
};
// FFV1 without loss, with check sums; H.264 that looks the same. Its matrix is BT.601's, and says so: OpenCV and others take no other.
Codec const kCodecs[]{
    {".mkv", {"-c:v", "ffv1", "-level", "3", "-slicecrc", "1", "-pix_fmt", "bgr0"}},
    {".mp4",
     {"-c:v", "libx264", "-crf", "14", "-preset", "fast", "-vf",
      "scale=out_color_matrix=bt601:flags=accurate_rnd+full_chroma_int", "-pix_fmt", "yuv420p", "-colorspace",
      "smpte170m", "-color_primaries", "bt709", "-color_trc", "bt709", "-movflags", "+faststart"}}};

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

/// @param to  what names the output
std::vector<std::string> encoding(fs::path const& file, int width, int height, double fps,
                                  std::vector<std::string> const& to)
{
    std::vector<std::string> all{"-v",          "error",
                                 "-nostdin",    "-y",
                                 "-f",          "rawvideo",
                                 "-pix_fmt",    "rgb24",
                                 "-video_size", fmt::format("{}x{}", width, height),
                                 "-framerate",  fmt::format("{:.9g}", fps),
                                 "-i",          "pipe:0"};
    std::ranges::copy(codec_of(file).options, std::back_inserter(all));
    for (char const* const option : {"-fflags", "+bitexact", "-flags:v", "+bitexact"}) all.emplace_back(option);
    std::ranges::copy(to, std::back_inserter(all));
    return all;
}

/// Encodes one frame to nowhere: whether there is such an encoder.
void try_encoder(fs::path const& file, int width, int height, double fps)
{
    Ffmpeg one(encoding(file, width, height, fps, {"-f", "null", "-"}));
    one.write(std::vector<unsigned char>(3 * std::size_t(width) * std::size_t(height)));
    if (!one.finish())
        throw cannot(file, "ffmpeg cannot encode it: " + one.last_message(),
                     "choose .mkv or .mp4, install another ffmpeg, or save --png frames");
}

/// Frames that decode; 0 if any has errors.
int frames_in(fs::path const& file)
{
    Ffmpeg reads(
        {"-v", "error", "-nostdin", "-i", "file:" + file.string(), "-map", "0:v:0", "-f", "framecrc", "-"});
    if (!reads.finish() || !reads.last_message().empty()) return 0;
    std::string const lines = "\n" + reads.printed(); // one of each frame, after "#..." of the stream
    int frames = 0;
    for (std::size_t at = 0; (at = lines.find("\n0,", at)) != std::string::npos; ++at) ++frames;
    return frames;
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
      temporary_(fs::absolute(file).parent_path() /
                 ("." + file.stem().string() + ".unfinished" + file.extension().string()))
{
    check_video(file, width, height, fps);
    if (!std::ofstream(temporary_))
        throw cannot(file, "its folder cannot be written", "choose another folder, or free some space");
    try {
        try_encoder(file, width, height, fps);
        ffmpeg_ = std::make_unique<Ffmpeg>(encoding(file, width, height, fps, {"file:" + temporary_.string()}));
    } catch (...) {
        remove_unfinished();
        throw;
    }
}

VideoWriter::~VideoWriter()
{
    ffmpeg_.reset();
    remove_unfinished();
}

void VideoWriter::remove_unfinished()
{
    std::error_code ignored;
    fs::remove(temporary_, ignored);
}

void VideoWriter::add(std::span<unsigned char const> rgb8)
{
    if (!ffmpeg_->write(rgb8)) fail();
    ++frames_;
}

void VideoWriter::fail()
{
    ffmpeg_->finish();
    std::string const said = ffmpeg_->last_message();
    throw cannot(file_, "ffmpeg ended early" + (said.empty() ? "" : ": " + said),
                 "free some space, choose another folder or ending, or save --png frames");
}

void VideoWriter::finish()
{
    if (!ffmpeg_->finish()) fail();
    int const read = frames_in(temporary_);
    if (read != frames_)
        throw cannot(file_, fmt::format("only {} of {} frames can be read back", read, frames_),
                     "free some space or choose another folder");
    fs::rename(temporary_, file_);
}

} // namespace viewer
