#include "ar/capture/counter_source.h"

#include "ar/capture/clock.h"
#include "gi/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr int kCells = 52;
constexpr int kLeastWidth = 4 * kCells, kLeastHeight = 20;
constexpr double kLeastContrast = 48; // of 255, between white and black cells

std::uint16_t crc16(std::uint32_t number)
{
    std::uint16_t crc = 0xffff;
    for (int bit = 31; bit >= 0; --bit) {
        bool const flip = ((crc >> 15) ^ (number >> bit)) & 1;
        crc = std::uint16_t((crc << 1) ^ (flip ? 0x1021 : 0));
    }
    return crc;
}

std::array<bool, kCells> cells_of(std::uint32_t number)
{
    std::uint64_t const bits = std::uint64_t(number) << 16 | crc16(number);
    std::array<bool, kCells> cells{};
    cells.front() = cells.back() = true;
    for (int i = 0; i < 48; ++i) cells[std::size_t(i) + 2] = (bits >> (47 - i)) & 1;
    return cells;
}

cv::Rect cell(cv::Size size, int i)
{
    int const from = i * size.width / kCells, to = (i + 1) * size.width / kCells;
    return {from, 0, to - from, size.height / 10};
}

/// The cell's inner part, unaffected by its neighbours.
cv::Rect core(cv::Rect r)
{
    int const dx = r.width / 4, dy = r.height / 4;
    return {r.x + dx, r.y + dy, std::max(1, r.width - 2 * dx), std::max(1, r.height - 2 * dy)};
}

cv::Mat pattern(glm::ivec2 size_px, std::uint64_t number)
{
    cv::Mat picture(size_px.y, size_px.x, CV_8UC3);
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x)
            picture.at<cv::Vec3b>(y, x) = {uchar(255 * x / picture.cols), uchar(255 * y / picture.rows), 96};
    int const radius = std::max(2, size_px.y / 8);
    int const x = int((number * 7) % std::uint64_t(size_px.x));
    cv::circle(picture, {x, size_px.y / 2}, radius, {240, 200, 40}, cv::FILLED);
    return picture;
}

} // namespace

void draw_counter(cv::Mat& picture, std::uint32_t number)
{
    auto const cells = cells_of(number);
    for (int i = 0; i < kCells; ++i)
        picture(cell(picture.size(), i)).setTo(cv::Scalar::all(cells[std::size_t(i)] ? 235 : 20));
}

std::optional<std::uint32_t> read_counter(cv::Mat const& picture)
{
    if (picture.cols < kLeastWidth || picture.rows < kLeastHeight) return std::nullopt;
    if (picture.type() != CV_8UC1 && picture.type() != CV_8UC3) return std::nullopt;
    std::array<double, kCells> light{};
    for (int i = 0; i < kCells; ++i) {
        cv::Scalar const mean = cv::mean(picture(core(cell(picture.size(), i))));
        light[std::size_t(i)] = picture.channels() == 1 ? mean[0] : (mean[0] + mean[1] + mean[2]) / 3;
    }
    double const white = std::min(light[0], light[kCells - 1]), black = std::max(light[1], light[kCells - 2]);
    if (white - black < kLeastContrast) return std::nullopt;
    std::uint64_t bits = 0;
    for (std::size_t i = 2; i < kCells - 2; ++i) bits = bits << 1 | (light[i] > 0.5 * (white + black) ? 1 : 0);
    auto const number = std::uint32_t(bits >> 16);
    return crc16(number) == (bits & 0xffff) ? std::optional(number) : std::nullopt;
}

CounterSource::CounterSource(CounterOptions const& options) : options_(options)
{
    if (options.size_px.x < kLeastWidth || options.size_px.y < kLeastHeight || options.size_px.x > 16384 ||
        options.size_px.y > 16384)
        throw gi::InputError(fmt::format("a counter in {} x {} pixels", options.size_px.x, options.size_px.y),
                             fmt::format("its cells need at least {} x {}, and 16384 are the most each way",
                                         kLeastWidth, kLeastHeight),
                             "choose another size");
    if (!(options.frames_per_s > 0 && options.frames_per_s <= 10000))
        throw gi::InputError(fmt::format("{} frames per second", options.frames_per_s), "0 to 10000 are possible",
                             "choose another rate");
    if (options.format != PixelFormat::rgb8 && options.format != PixelFormat::gray8 &&
        options.format != PixelFormat::mjpeg)
        throw gi::InputError("a counter as " + name_of(options.format), "it is made as rgb8, gray8 or mjpeg",
                             "choose one of these");
}

std::uint64_t CounterSource::number_due() const
{
    if (options_.pace == Pace::fastest) return next_;
    return std::max(next_, std::uint64_t((steady_now_s() - *start_s_) * options_.frames_per_s));
}

std::optional<Frame> CounterSource::next(std::chrono::milliseconds wait)
{
    if (!start_s_) start_s_ = steady_now_s();
    if (state().kind != SourceState::Kind::running) return std::nullopt;
    Frame f;
    f.sequence = number_due();
    if (options_.frames > 0 && f.sequence >= options_.frames) f.sequence = std::max(next_, options_.frames - 1);
    f.captured_s =
        options_.pace == Pace::own ? *start_s_ + double(f.sequence) / options_.frames_per_s : steady_now_s();
    double const limit_s = steady_now_s() + std::chrono::duration<double>(wait).count();
    sleep_until_s(std::min(f.captured_s, limit_s));
    if (f.captured_s > limit_s) return std::nullopt;

    cv::Mat picture = pattern(options_.size_px, f.sequence);
    draw_counter(picture, std::uint32_t(f.sequence));
    f.origin = TimestampOrigin::sensor;
    f.format = options_.format;
    f.size_px = options_.size_px;
    if (f.format == PixelFormat::mjpeg) {
        std::vector<uchar> bytes;
        cv::cvtColor(picture, picture, cv::COLOR_RGB2BGR);
        cv::imencode(".jpg", picture, bytes, {cv::IMWRITE_JPEG_QUALITY, 85});
        picture = cv::Mat(bytes, true).reshape(1, 1);
    } else if (f.format == PixelFormat::gray8) {
        cv::cvtColor(picture, picture, cv::COLOR_RGB2GRAY);
    }
    f.planes[0] = picture;
    f.arrived_s = steady_now_s();
    next_ = f.sequence + 1;
    tally_.deliver(f.sequence);
    return f;
}

SourceState CounterSource::state() const
{
    if (options_.frames > 0 && next_ >= options_.frames)
        return {SourceState::Kind::ended, fmt::format("all {} frames were made", options_.frames)};
    return {};
}

SourceDescription CounterSource::description() const
{
    return {.name = "generated counter",
            .id = "counter",
            .size_px = options_.size_px,
            .format = options_.format,
            .frames_per_s = options_.frames_per_s,
            .is_live = options_.pace == Pace::own,
            .controls = {}};
}

std::vector<std::string> CounterSource::set(Controls const& controls)
{
    check(controls);
    return cannot_set(controls, "the frames are generated");
}

} // namespace ar
