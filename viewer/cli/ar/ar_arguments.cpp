#include "viewer/cli/ar/ar_arguments.h"

#include "ar/capture/whole_picture.h"
#include "ar/markers/map_doubts.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"
#include "viewer/base/arguments.h"
#include "viewer/base/validators.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

constexpr ar::PixelFormat kFormats[] = {ar::PixelFormat::rgb8, ar::PixelFormat::bgr8, ar::PixelFormat::gray8,
                                        ar::PixelFormat::nv12, ar::PixelFormat::yuyv, ar::PixelFormat::mjpeg};

std::vector<std::string> format_names()
{
    std::vector<std::string> names;
    for (ar::PixelFormat const f : kFormats) names.push_back(name_of(f));
    return names;
}

} // namespace

void declare_source_arguments(CLI::App& c, SourceArguments& a)
{
    c.add_option(
         "SOURCE", a.source,
         "camera, camera:ID, device:0, gstreamer:PIPELINE, counter, a recorded session, a folder of pictures, "
         "names with %04d, a video")
        ->required();
    c.add_option("--size", a.size, "size of camera frames, px")->capture_default_str();
    c.add_option("--rate", a.rate_hz, "frame rate of cameras and pictures, Hz")
        ->check(in_range(0.01, 10000))
        ->capture_default_str();
    c.add_option("--format", a.format, "pixel format of cameras (default: the camera's preference)")
        ->check(CLI::IsMember(format_names()));
    c.add_option("--exposure", a.exposure_ms, "exposure of cameras, ms (default: automatic)")
        ->check(in_range(1e-3, 1e5));
    c.add_option("--gain", a.gain, "gain of cameras, 1 = none (default: automatic)")->check(in_range(0.01, 1e4));
}

ar::OpenOptions open_options(SourceArguments const& a, ar::Pace pace, ar::Delivery delivery)
{
    auto const [width, height] = parse_size(a.size);
    ar::OpenOptions o{.size_px = {width, height}, .frames_per_s = a.rate_hz, .pace = pace, .delivery = delivery};
    for (ar::PixelFormat const f : kFormats)
        if (name_of(f) == a.format) o.format = f;
    return o;
}

ar::Controls controls_of(SourceArguments const& a)
{
    ar::Controls c;
    if (a.exposure_ms > 0) c.exposure_time_s = 1e-3 * a.exposure_ms;
    if (a.gain > 0) c.gain = a.gain;
    return c;
}

std::unique_ptr<ar::FrameSource> open(SourceArguments const& a, ar::Pace pace, ar::Delivery delivery)
{
    auto source = ar::open_source(a.source, open_options(a, pace, delivery));
    if (ar::Controls const controls = controls_of(a); controls != ar::Controls{})
        for (std::string const& problem : source->set(controls)) fmt::print(stderr, "{}: {}\n", a.source, problem);
    return source;
}

void declare_board_arguments(CLI::App& c, BoardArguments& a)
{
    c.add_option("--squares", a.squares, "squares of a ChArUco board, across x upwards, e.g. 7x5");
    c.add_option("--square", a.square_m, "side of a square, m")->check(in_range(1e-4, 100))->capture_default_str();
    c.add_option("--marker", a.marker_m, "side of a marker in a white square, m")
        ->check(in_range(1e-4, 100))
        ->capture_default_str();
    c.add_option("--dictionary", a.dictionary, "of its markers, as named by OpenCV")->capture_default_str();
    c.add_option("--first-id", a.first_id, "id of its first marker")->check(CLI::Range(0, 100000));
    c.add_flag("--legacy-pattern", a.legacy_pattern,
               "upper left square white if the number of rows is even, as printed by OpenCV before 4.6");
}

glm::ivec2 parse_squares(std::string const& option, std::string const& text)
{
    auto const cross = text.find('x');
    auto const number = [&](std::string_view part) {
        auto const v = gi::parse_finite(part);
        return v && *v >= 2 && *v <= 200 && *v == std::floor(*v) ? int(*v) : 0;
    };
    if (cross != std::string::npos) {
        glm::ivec2 const n(number(std::string_view(text).substr(0, cross)),
                           number(std::string_view(text).substr(cross + 1)));
        if (n.x > 0 && n.y > 0) return n;
    }
    throw gi::InputError(option + " '" + text + "' is not understood",
                         "two whole numbers from 2 to 200 are needed, across and upwards", "write 7x5");
}

void say_doubts(ar::MarkerMap const& map, std::string const& where)
{
    for (std::string const& doubt : ar::doubts_about(map)) fmt::print(stderr, "in doubt: {}: {}\n", where, doubt);
}

ar::CharucoBoard board_of(BoardArguments const& a)
{
    glm::ivec2 const n = parse_squares("--squares", a.squares);
    ar::CharucoBoard board{n.x, n.y, a.square_m, a.marker_m, a.dictionary, a.first_id, a.legacy_pattern, {}};
    ar::MarkerMap const map{{}, {board}, {}};
    ar::check(map, "--squares " + a.squares);
    say_doubts(map, "--squares " + a.squares);
    return board;
}

cv::Mat read_rgb(std::string const& file)
{
    std::vector<unsigned char> const bytes = gi::read_bytes(file, std::size_t(1) << 30);
    std::string problem = ar::is_picture(bytes) ? ar::what_is_missing(bytes) : "it is not a known picture format";
    cv::Mat picture;
    if (problem.empty()) {
        try {
            picture = cv::imdecode(bytes, cv::IMREAD_COLOR);
        } catch (cv::Exception const& e) {
            problem = e.err;
        }
        if (problem.empty() && picture.empty()) problem = "it cannot be decoded";
    }
    if (!problem.empty())
        throw gi::InputError("cannot read '" + file + "'", problem, "give PNG, JPEG or TIFF, 8 bits a channel");
    cv::cvtColor(picture, picture, cv::COLOR_BGR2RGB);
    return picture;
}

std::vector<double> parse_exposures(std::string const& text)
{
    std::vector<double> seconds;
    for (std::size_t at = 0; at <= text.size();) {
        std::size_t const comma = std::min(text.find(',', at), text.size());
        std::string_view const one = std::string_view(text).substr(at, comma - at);
        std::size_t const slash = one.find('/');
        auto const above = gi::parse_finite(one.substr(0, slash));
        auto const below =
            slash == std::string_view::npos ? std::optional(1.0) : gi::parse_finite(one.substr(slash + 1));
        double const value = above && below && *below > 0 ? *above / *below : 0;
        if (!(value > 0 && std::isfinite(value)))
            throw gi::InputError("--exposures '" + text + "' is not understood",
                                 fmt::format("'{}' is no time above 0", one), "write seconds, as 1/30,1/60,0.004");
        seconds.push_back(value);
        at = comma + 1;
    }
    return seconds;
}

} // namespace viewer
