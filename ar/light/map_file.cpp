#include "ar/light/map_file.h"

#include "ar/camera/photometry.h"
#include "ar/light/lat_long.h"
#include "gi/core/error.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr int kWidest = 16384;
constexpr double kMostPerByte = 512; ///< texels that a byte of a compressed file may stand for

[[noreturn]] void refuse(std::filesystem::path const& file, std::string const& problem, std::string const& why)
{
    throw gi::InputError(fmt::format("'{}': {}", file.string(), problem), why,
                         "give an OpenEXR, Radiance or PNG file of RGB");
}

void check_size(std::filesystem::path const& file, std::int64_t width, std::int64_t height)
{
    if (width < 1 || height < 1 || width > kWidest || height > kWidest)
        refuse(file, fmt::format("{} x {} texels", width, height), fmt::format("1 to {} are read", kWidest));
    double const bytes = double(std::filesystem::file_size(file));
    if (double(width) * double(height) > kMostPerByte * bytes)
        refuse(file, fmt::format("{} x {} texels in {} bytes", width, height, bytes),
               "the file is cut or its header lies");
}

cv::Mat read_exr(std::filesystem::path const& file)
{
    Imf::InputFile in(file.string().c_str());
    Imath::Box2i const window = in.header().dataWindow();
    std::int64_t const width = std::int64_t(window.max.x) - window.min.x + 1;
    std::int64_t const height = std::int64_t(window.max.y) - window.min.y + 1;
    check_size(file, width, height);
    auto const& channels = in.header().channels();
    bool const grey = !channels.findChannel("R") && channels.findChannel("Y");
    cv::Mat map(int(height), int(width), CV_32FC3, cv::Scalar(0, 0, 0));
    Imf::FrameBuffer target;
    std::size_t const texel = sizeof(cv::Vec3f), row = texel * std::size_t(width);
    char* const origin = reinterpret_cast<char*>(map.data) - std::ptrdiff_t(texel) * window.min.x -
                         std::ptrdiff_t(row) * window.min.y;
    char const* const names[]{"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        char const* const name = grey ? "Y" : names[c];
        Imf::Channel const* const channel = channels.findChannel(name);
        if (!channel) refuse(file, fmt::format("no channel {}", name), "radiance is red, green and blue");
        if (channel->xSampling != 1 || channel->ySampling != 1)
            refuse(file, "subsampled channels", "every texel needs its own light");
        if (!grey || c == 0) target.insert(name, Imf::Slice(Imf::FLOAT, origin + c * sizeof(float), texel, row));
    }
    in.setFrameBuffer(target);
    in.readPixels(window.min.y, window.max.y);
    if (grey)
        for (int j = 0; j < map.rows; ++j)
            for (int i = 0; i < map.cols; ++i) {
                auto& v = map.at<cv::Vec3f>(j, i);
                v = cv::Vec3f::all(v[0]);
            }
    return map;
}

void write_exr(std::filesystem::path const& file, cv::Mat const& map)
{
    Imf::Header header(map.cols, map.rows);
    Imf::FrameBuffer source;
    char const* const names[]{"R", "G", "B"};
    for (std::size_t c = 0; c < 3; ++c) {
        header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        source.insert(names[c], Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(map.data) + c * sizeof(float),
                                           sizeof(cv::Vec3f), map.step[0]));
    }
    Imf::OutputFile out(file.string().c_str(), header);
    out.setFrameBuffer(source);
    out.writePixels(map.rows);
}

double linear(double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); }

cv::Mat read_by_opencv(std::filesystem::path const& file)
{
    if (!std::filesystem::is_regular_file(file)) refuse(file, "it cannot be read", "it is missing or not a file");
    cv::Mat const bgr = cv::imread(file.string(), cv::IMREAD_COLOR | cv::IMREAD_ANYDEPTH);
    if (bgr.empty()) refuse(file, "it cannot be decoded", "it is missing, damaged or of another format");
    check_size(file, bgr.cols, bgr.rows);
    cv::Mat rgb;
    cv::cvtColor(bgr, rgb, cv::COLOR_BGR2RGB);
    if (rgb.depth() == CV_32F) return rgb;
    cv::Mat map;
    rgb.convertTo(map, CV_32F, rgb.depth() == CV_16U ? 1 / 65535.0 : 1 / 255.0);
    map.forEach<cv::Vec3f>([](cv::Vec3f& v, int const*) {
        for (float& c : v.val) c = float(linear(double(c)));
    });
    return map;
}

} // namespace

cv::Mat read_radiance(std::filesystem::path const& file)
{
    try {
        return file.extension() == ".exr" ? read_exr(file) : read_by_opencv(file);
    } catch (gi::InputError const&) {
        throw;
    } catch (std::exception const& e) { // what OpenEXR and OpenCV throw at damaged files
        refuse(file, "it cannot be decoded", e.what());
    }
}

cv::Mat read_map(std::filesystem::path const& file)
{
    cv::Mat const map = read_radiance(file);
    check_map(map, "'" + file.string() + "'");
    return map;
}

void write_map(std::filesystem::path const& file, cv::Mat const& map)
{
    check_map(map, "'" + file.string() + "'");
    try {
        if (file.extension() == ".exr") {
            write_exr(file, map.isContinuous() ? map : map.clone());
            return;
        }
        cv::Mat out;
        cv::cvtColor(file.extension() == ".hdr" ? map : bytes_of(map, srgb_photometry()), out, cv::COLOR_RGB2BGR);
        if (!cv::imwrite(file.string(), out)) refuse(file, "it cannot be written", "the folder may be missing");
    } catch (gi::InputError const&) {
        throw;
    } catch (std::exception const& e) {
        refuse(file, "it cannot be written", e.what());
    }
}

} // namespace ar
