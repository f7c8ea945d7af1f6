#include "ar/scene/depth_map.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <opencv2/imgcodecs.hpp>

namespace ar {
namespace {

cv::Mat decoded_exr(std::filesystem::path const& file, gi::Report* report)
{
    gi::Picture const picture = gi::read_exr(file);
    if (report != nullptr && !picture.notes.empty())
        report->lose("depth maps not used as they are", 1,
                     fmt::format("{}: {}{}", file.string(), fmt::join(picture.notes, "; "),
                                 picture.has_gaps ? ": depth is unknown outside of the data window" : ""));
    gi::Layer const* depth = nullptr;
    for (char const* name : {"depth", "Z", "Y", "color"}) // a channel Y without a layer is read as "color"
        if (gi::Layer const* const layer = picture.find(name); depth == nullptr && layer && layer->channels == 1)
            depth = layer;
    gi::Layer const& only = picture.layers.front();
    if (depth == nullptr && picture.layers.size() == 1 && only.channels == 1 && only.name != "A") depth = &only;
    if (depth == nullptr)
        throw gi::InputError("'" + file.string() + "' has no layer 'depth', 'Z' or 'Y' of one channel",
                             "the depth channel cannot be identified",
                             "write a file whose only channel without a layer is Z or Y, or name it depth.V");
    cv::Mat map(picture.height, picture.width, CV_32FC1);
    std::copy_n(depth->data.data(), depth->data.size(), map.ptr<float>());
    return map;
}

cv::Mat decoded_png(std::filesystem::path const& file)
{
    auto const bad = [&](std::string const& problem) {
        return gi::InputError("'" + file.string() + "' " + problem, "depth maps have one channel of 16 bits",
                              "save it as PNG of 16 bits, or as EXR in metres");
    };
    std::vector<unsigned char> const bytes = gi::read_bytes(file, std::size_t(1) << 30);
    cv::Mat map;
    try {
        map = cv::imdecode(bytes, cv::IMREAD_UNCHANGED);
    } catch (cv::Exception const&) {
        throw bad("cannot be decoded");
    }
    if (map.empty()) throw bad("cannot be decoded");
    if (map.type() != CV_16UC1) throw bad(fmt::format("has pixels of {}", cv::typeToString(map.type())));
    map.convertTo(map, CV_32F);
    return map;
}

} // namespace

cv::Mat read_depth_map(std::filesystem::path const& file, double metres_per_unit, gi::Report* report)
{
    bool const is_exr = gi::lower_extension(file) == ".exr";
    cv::Mat const map = is_exr ? decoded_exr(file, report) : decoded_png(file);
    return map * (metres_per_unit > 0 ? metres_per_unit : is_exr ? 1 : 1e-3);
}

} // namespace ar
