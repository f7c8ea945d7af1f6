#include "ar/light/map_file.h"

#include "ar/camera/photometry.h"
#include "ar/light/lat_long.h"
#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr int kWidest = 16384;

[[noreturn]] void refuse(std::filesystem::path const& file, std::string const& problem, std::string const& why)
{
    throw gi::InputError(fmt::format("'{}': {}", file.string(), problem), why,
                         "give an OpenEXR, Radiance or PNG file of RGB");
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

} // namespace

cv::Mat read_radiance(std::filesystem::path const& file, gi::Report* report)
{
    gi::Picture const picture = gi::read_picture(file);
    if (report != nullptr)
        for (std::string const& note : picture.notes)
            report->lose("maps not used as they are", 1, file.string() + ": " + note);
    if (picture.width > kWidest || picture.height > kWidest)
        refuse(file, fmt::format("{} x {} texels", picture.width, picture.height),
               fmt::format("1 to {} are read", kWidest));
    gi::Layer const& color = gi::color_of(picture, file.string());
    if (picture.is_cube) refuse(file, "it holds the six faces of a cube", "maps are lat-long panoramas");
    cv::Mat map(picture.height, picture.width, CV_32FC3);
    auto* const texels = map.ptr<cv::Vec3f>();
    for (std::size_t i = 0; i < picture.pixels(); ++i) {
        gi::vec3 const v = gi::rgb(color, i);
        texels[i] = {v.x, v.y, v.z};
    }
    return map;
}

cv::Mat read_map(std::filesystem::path const& file, gi::Report* report)
{
    cv::Mat const map = read_radiance(file, report);
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
