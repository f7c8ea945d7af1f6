#include "ar/capture/picture_source.h"

#include "ar/capture/decode_picture.h"
#include "gi/core/error.h"

#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <fstream>

namespace ar {
namespace {

constexpr std::uintmax_t kMostBytes = std::uintmax_t(1) << 30;

std::vector<std::uint8_t> bytes_of_file(std::filesystem::path const& file, std::string& problem)
{
    std::error_code error;
    auto const size = std::filesystem::file_size(file, error);
    std::ifstream in(file, std::ios::binary);
    if (error || !in || size > kMostBytes) {
        problem = error ? error.message() : size > kMostBytes ? "it has more than 1 GiB" : "it cannot be read";
        return {};
    }
    std::vector<std::uint8_t> bytes(size);
    in.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size));
    bytes.resize(std::size_t(in.gcount()));
    return bytes;
}

} // namespace

PictureSource::PictureSource(std::filesystem::path const& what, PictureOptions const& options)
    : name_(what.string()),
      options_(options),
      found_(find_pictures(what)),
      pictures_(found_.pictures),
      player_(options.pace)
{
    if (!(options.frames_per_s > 0))
        throw gi::InputError(fmt::format("{} frames per second", options.frames_per_s),
                             "no frame would ever be due", "choose a rate above 0");
    if (pictures_.empty())
        throw gi::InputError("no pictures in '" + name_ + "'", "there is nothing to play",
                             "name a folder of pictures, or a pattern like frame_%04d.png");
    if (options.first && !found_.has_numbers)
        throw gi::InputError(fmt::format("frames.first: {} with pictures that have no numbers", *options.first),
                             "it is the number of the picture at time 0",
                             "name the pictures 000012.png, or leave first out");
    if (options.first && pictures_.front().number > *options.first) tally_.expect(*options.first);
    while (at_ < pictures_.size() && (ready_ = decoded(pictures_[at_])).empty()) ++at_;
    if (ready_.empty())
        throw gi::InputError(
            fmt::format("none of the {} pictures of '{}' can be decoded", pictures_.size(), name_),
            counts().last_refusal, "look at the files");
}

cv::Mat PictureSource::decoded(NumberedPicture const& p)
{
    auto const refuse = [&](std::string const& why) {
        tally_.refuse(p.number, p.file.filename().string() + ": " + why);
        return cv::Mat();
    };
    std::string problem;
    auto const bytes = bytes_of_file(p.file, problem);
    if (problem.empty() && bytes.empty()) problem = "it is empty";
    if (!problem.empty()) return refuse(problem);
    DecodedPicture picture = decoded_picture(bytes);
    if (!picture.problem.empty()) return refuse(picture.problem);
    cv::Mat const& pixels = picture.pixels;
    if (size_px_ == glm::ivec2(0)) {
        size_px_ = {pixels.cols, pixels.rows};
        format_ = picture.format;
    }
    if (glm::ivec2(pixels.cols, pixels.rows) != size_px_)
        return refuse(fmt::format("it has {} x {} pixels, the first one had {} x {}", pixels.cols, pixels.rows,
                                  size_px_.x, size_px_.y));
    auto const has_bytes = [](PixelFormat f) { return f == PixelFormat::gray8 || f == PixelFormat::bgr8; };
    if (picture.format != format_ && has_bytes(picture.format) && has_bytes(format_))
        return refuse("it has colour where the first one had none, or none where it had");
    if (picture.format != format_)
        return refuse(fmt::format("its pixels are {}, those of the first one were {}", name_of(picture.format),
                                  name_of(format_)));
    if (!picture.notes.empty())
        tally_.change(fmt::format("{}: {}", p.file.filename().string(), fmt::join(picture.notes, "; ")));
    return pixels;
}

std::optional<Frame> PictureSource::next(std::chrono::milliseconds wait)
{
    double const until = until_s(wait);
    while (ready_.empty() && at_ < pictures_.size())
        if ((ready_ = decoded(pictures_[at_])).empty()) ++at_;
    if (at_ >= pictures_.size()) return std::nullopt;
    Frame f;
    f.sequence = pictures_[at_].number;
    // Numbers may be larger than those at which a double has fractions of a frame.
    auto const due_s =
        player_.wait_for(double(f.sequence - pictures_.front().number) / options_.frames_per_s, until);
    if (!due_s) return std::nullopt;
    f.captured_s = *due_s;
    f.origin = TimestampOrigin::file;
    f.format = format_;
    f.size_px = size_px_;
    f.planes[0] = std::exchange(ready_, cv::Mat());
    f.arrived_s = steady_now_s();
    ++at_;
    tally_.deliver(f.sequence);
    return f;
}

SourceState PictureSource::state() const
{
    if (at_ >= pictures_.size()) return {SourceState::Kind::ended, "there are no more pictures"};
    return {};
}

SourceCounts PictureSource::counts() const
{
    SourceCounts c = tally_.counts();
    if (!found_.left_out.empty()) {
        c.refused += found_.left_out.size();
        if (c.last_refusal.empty())
            c.last_refusal = found_.left_out.front().filename().string() +
                             ": its name is not numbered like those of the other pictures";
    }
    if (c.dropped > 0) c.missing = missing_numbers(pictures_, options_.first);
    c.unnumbered = found_.why_not;
    return c;
}

SourceDescription PictureSource::description() const
{
    return {.name = name_,
            .id = name_,
            .size_px = size_px_,
            .format = format_,
            .frames_per_s = options_.frames_per_s,
            .is_live = false,
            .controls = {},
            .first = options_.first};
}

std::vector<std::string> PictureSource::set(Controls const& controls)
{
    check(controls);
    return cannot_set(controls, "these are pictures on disk");
}

} // namespace ar
