#include "ar/calibration/stmap.h"

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ar {
namespace {

CameraModel straight(CameraModel const& camera)
{
    CameraModel pinhole = camera;
    pinhole.lens = LensModel::pinhole;
    pinhole.distortion = {};
    pinhole.table = nullptr;
    return pinhole;
}

} // namespace

cv::Mat stmap_of(CameraModel const& camera, StMap which)
{
    CameraModel const pinhole = straight(camera);
    CameraModel const &to = which == StMap::distort ? camera : pinhole,
                      &source = which == StMap::distort ? pinhole : camera;
    cv::Mat st(camera.size_px.y, camera.size_px.x, CV_32FC2);
    st.forEach<cv::Vec2f>([&](cv::Vec2f& v, int const* at) {
        auto const d = direction_of(to, {at[1], at[0]});
        auto const p = d ? project(source, *d) : std::nullopt;
        v = p ? cv::Vec2f(float((p->x + 0.5) / camera.size_px.x), float(1 - (p->y + 0.5) / camera.size_px.y))
              : cv::Vec2f(-1, -1);
    });
    return st;
}

int placeless_px(cv::Mat const& st)
{
    cv::Mat is_placeless;
    cv::inRange(st, cv::Scalar(-1, -1), cv::Scalar(-1, -1), is_placeless);
    return cv::countNonZero(is_placeless);
}

void write_stmap(std::filesystem::path const& file, cv::Mat const& st)
{
    gi::Picture picture{st.cols, st.rows, {}, {}};
    gi::Layer& layer = picture.add("color", 2);
    std::copy_n(st.ptr<float>(), layer.data.size(), layer.data.begin());
    picture.metadata["convention"] = "s to the right, t up, 0..1, pixel centres";
    gi::Report none_lost; // single precision
    gi::write_exr(file, picture, gi::PixelType::single, none_lost);
}

CameraModel with_stmap(CameraModel const& camera, std::filesystem::path const& file, gi::Report* report)
{
    gi::Picture const picture = gi::read_exr(file);
    if (report != nullptr)
        for (std::string const& note : picture.notes)
            report->lose("STMaps not used as they are", 1, file.string() + ": " + note);
    std::string const name = "'" + file.string() + "'";
    gi::Layer const* st = picture.find("RG");
    if (!st) st = picture.find("color");
    if (!st || st->channels < 2) {
        std::vector<std::string> layers;
        for (gi::Layer const& layer : picture.layers) layers.push_back(layer.name);
        throw gi::InputError(name + " has no channels R and G without a layer",
                             fmt::format("they hold s and t of an STMap; its layers: {}", fmt::join(layers, ", ")),
                             "write one by lightwell ar lens CALIBRATION --stmap FILE");
    }
    if (picture.width != camera.size_px.x || picture.height != camera.size_px.y)
        throw gi::InputError(fmt::format("{} has {} x {} pixels", name, picture.width, picture.height),
                             fmt::format("the calibration is of {} x {}", camera.size_px.x, camera.size_px.y),
                             "write the map that distorts pictures at the camera's size");
    CameraModel out = straight(camera);
    cv::Mat plane(picture.height, picture.width, CV_64FC2);
    plane.forEach<cv::Vec2d>([&](cv::Vec2d& v, int const* at) {
        float const* const p = &st->data[(std::size_t(at[0]) * std::size_t(picture.width) + std::size_t(at[1])) *
                                         std::size_t(st->channels)];
        double const x = p[0] * double(picture.width) - 0.5, y = (1 - double(p[1])) * picture.height - 0.5;
        v = {(x - camera.cx) / camera.fx, (y - camera.cy) / camera.fy};
    });
    try {
        out.table = std::make_shared<LensTable const>(std::move(plane));
    } catch (gi::InputError const& e) {
        std::string const notes = fmt::format("{}", fmt::join(picture.notes, "; "));
        throw gi::InputError(name + ": " + e.problem(), notes.empty() ? e.why() : e.why() + "; " + notes,
                             e.suggestion());
    }
    out.lens = LensModel::stmap;
    check(out, file.string());
    return out;
}

} // namespace ar
