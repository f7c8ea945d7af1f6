#include "ar/pipeline/live_occluders.h"

#include "ar/calibration/calibration_file.h"
#include "ar/capture/decode_picture.h"
#include "ar/capture/picture_source.h"
#include "ar/scene/depth_map.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"

#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

namespace fs = std::filesystem;

/// The last digits of a name without its ending.
std::optional<std::int64_t> number_in(fs::path const& file)
{
    std::string const stem = file.stem().string();
    std::size_t end = stem.find_last_of("0123456789");
    if (end == std::string::npos) return std::nullopt;
    std::size_t first = end;
    while (first > 0 && stem[first - 1] >= '0' && stem[first - 1] <= '9') --first;
    return gi::parse_number<std::int64_t>(stem.substr(first, end + 1 - first));
}

std::map<std::int64_t, fs::path> numbered(fs::path const& source)
{
    std::map<std::int64_t, fs::path> files;
    std::error_code error;
    bool const is_folder = fs::is_directory(source, error);
    auto const add = [&](std::int64_t number, fs::path const& file) {
        if (!files.emplace(number, file).second)
            throw gi::InputError(fmt::format("two pictures of '{}' have the number {}", source.string(), number),
                                 "a frame has one", "remove one of the two");
    };
    if (is_folder) {
        for (fs::path const& file : picture_files(source)) {
            auto const number = number_in(file);
            if (!number)
                throw gi::InputError("'" + file.string() + "' has no number in its name",
                                     "it says which frame the picture belongs to", "name the pictures 000012.png");
            add(*number, file);
        }
    } else {
        for (NumberedPicture const& p : find_pictures(source).pictures) add(std::int64_t(p.number), p.file);
    }
    if (files.empty())
        throw gi::InputError("no pictures in '" + source.string() + "'", "nothing says what is in front",
                             "name a folder of pictures, or a name like depth_%04d.png");
    return files;
}

gi::InputError other_size(fs::path const& file, cv::Size is, glm::ivec2 needed)
{
    return {fmt::format("'{}' has {} x {} pixels", file.string(), is.width, is.height),
            fmt::format("{} x {} are needed", needed.x, needed.y),
            "write it at the size of its camera's pictures"};
}

} // namespace

LiveOccluders::LiveOccluders(OcclusionPictures const& settings, CameraModel const& camera, gi::Report& report)
    : settings_(settings), camera_(camera), report_(&report)
{
    if (!settings.camera.empty()) depth_camera_ = read_calibration(settings.camera, std::nullopt, report_).camera;
    if (settings.depth) {
        depths_ = numbered(settings.depth->source);
        depth(depths_.begin()->second, nullptr); // says at once what is wrong with all
    }
    if (settings.matte) {
        mattes_ = numbered(settings.matte->source);
        matte(mattes_.begin()->second);
    }
}

/// Metres along the axis in the camera's picture; 0 = hole.
cv::Mat LiveOccluders::depth(fs::path const& file, gi::Report* report) const
{
    cv::Mat const map = read_depth_map(file, settings_.metres_per_unit, report);
    cv::Size const size(camera_.size_px.x, camera_.size_px.y);
    if (!depth_camera_) {
        if (map.size() == size) return map;
        if (std::abs(double(map.cols) * size.height - double(map.rows) * size.width) > size.width)
            throw other_size(file, map.size(), camera_.size_px);
        cv::Mat fitted;
        cv::resize(map, fitted, size, 0, 0, cv::INTER_NEAREST);
        return fitted;
    }
    CameraModel const& from = *depth_camera_;
    if (glm::ivec2(map.cols, map.rows) != from.size_px) throw other_size(file, map.size(), from.size_px);
    cv::Mat seen(size, CV_32FC1, cv::Scalar(0));
    // Each depth covers a square as large as its pixel appears, so that there are no gaps.
    double const half = 0.5 * std::max(1.0, std::max(camera_.fx / from.fx, camera_.fy / from.fy)) + 0.5;
    for (int y = 0; y < map.rows; ++y)
        for (int x = 0; x < map.cols; ++x) {
            float const z = map.at<float>(y, x);
            if (!(z > 0) || !std::isfinite(z)) continue;
            auto const d = direction_of(from, {x, y});
            if (!d || !(d->z > 1e-3)) continue;
            glm::dvec3 const point = settings_.camera_from_depth * (*d * (double(z) / d->z));
            auto const p = project(camera_, point);
            if (!p || !(point.z > 0)) continue;
            int const left = std::max(0, int(std::ceil(p->x - half))),
                      top = std::max(0, int(std::ceil(p->y - half)));
            int const right = std::min(size.width - 1, int(std::floor(p->x + half))),
                      bottom = std::min(size.height - 1, int(std::floor(p->y + half)));
            for (int j = top; j <= bottom; ++j)
                for (int i = left; i <= right; ++i) {
                    float& to = seen.at<float>(j, i);
                    if (to == 0 || point.z < to) to = float(point.z);
                }
        }
    return seen;
}

/// CV_32FC1, 0..1.
cv::Mat LiveOccluders::matte(fs::path const& file) const
{
    std::vector<unsigned char> const bytes = gi::read_bytes(file, std::size_t(1) << 30);
    DecodedPicture const picture = decoded_picture(bytes, true);
    if (!picture.problem.empty())
        throw gi::InputError("'" + file.string() + "' is no matte", picture.problem,
                             "mattes are pictures of 8 or 16 bits or EXR, white where real objects are in front");
    if (glm::ivec2(picture.pixels.cols, picture.pixels.rows) != camera_.size_px)
        throw other_size(file, picture.pixels.size(), camera_.size_px);
    cv::Mat one, share;
    cv::extractChannel(picture.pixels, one, picture.pixels.channels() == 1 ? 0 : 1);
    one.convertTo(share, CV_32F, one.depth() == CV_8U ? 1 / 255.0 : one.depth() == CV_16U ? 1 / 65535.0 : 1.0);
    cv::patchNaNs(share, 0);
    return cv::max(cv::min(share, 1.0f), 0.0f);
}

template <typename Read>
cv::Mat LiveOccluders::of_frame(std::optional<FramePictures> const& which, Files const& files, std::uint64_t frame,
                                double time_s, std::uint64_t& missing, Read const& read)
{
    if (!which) return {};
    std::int64_t const n = which->rate_hz > 0 ? std::llround(time_s * which->rate_hz) : std::int64_t(frame);
    auto const found = files.find(which->first + n);
    if (found == files.end()) {
        ++missing;
        return {};
    }
    try {
        return read(found->second);
    } catch (gi::InputError const& e) {
        ++counts_.unusable;
        counts_.last_problem = e.what();
        return {};
    }
}

void LiveOccluders::hide(RenderedPair& pair, cv::Mat const& modelled_m, std::uint64_t frame, double time_s)
{
    cv::Mat const measured = of_frame(settings_.depth, depths_, frame, time_s, counts_.without_depth,
                                      [&](fs::path const& file) { return depth(file, report_); });
    cv::Mat const real = of_frame(settings_.matte, mattes_, frame, time_s, counts_.without_matte,
                                  [&](fs::path const& file) { return matte(file); });
    if (measured.empty() && real.empty()) return;
    ++counts_.frames;
    cv::Mat share;
    if (!measured.empty()) share = share_of_nearer(measured, modelled_m, settings_.settings);
    if (!real.empty()) share = share.empty() ? real : cv::Mat(cv::max(share, real));
    occlude(pair, share, measured, counts_.pixels);
}

} // namespace ar
