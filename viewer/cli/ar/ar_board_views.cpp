#include "viewer/cli/ar/ar_board_views.h"

#include "ar/calibration/calibration_file.h"
#include "ar/markers/draw.h"
#include "gi/core/error.h"
#include "gi/core/file.h"

#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

constexpr int kFiner = 2; ///< rays per pixel in x and in y

ar::CameraModel camera()
{
    return {ar::LensModel::radial_tangential, {480, 360}, 394, 396, 238.5, 182.25, {-0.2, 0.06, 6e-4, -9e-4}};
}

/// Rays (x, y at z = 1) of the picture at kFiner times its size, CV_64FC2; far outside if the lens sees nothing.
cv::Mat rays(ar::CameraModel const& c)
{
    cv::Mat out(kFiner * c.size_px.y, kFiner * c.size_px.x, CV_64FC2, cv::Scalar::all(1e6));
    cv::parallel_for_({0, out.rows}, [&](cv::Range const& rows) {
        for (int y = rows.start; y < rows.end; ++y)
            for (int x = 0; x < out.cols; ++x)
                if (auto const d = direction_of(c, (glm::dvec2(x, y) + 0.5) / double(kFiner) - 0.5); d && d->z > 0)
                    out.at<cv::Vec2d>(y, x) = {d->x / d->z, d->y / d->z};
    });
    return out;
}

/// Random pose in front of the board, up to 35 degrees off its normal, with the board anywhere in the picture.
gi::RigidPose board_from_camera(cv::RNG& rng, glm::dvec2 size_m)
{
    glm::dvec3 const middle(0.5 * size_m, 0);
    double const a = rng.uniform(-0.6, 0.6), b = rng.uniform(-0.6, 0.6);
    double const distance = rng.uniform(1.1, 2.1) * std::max(size_m.x, size_m.y);
    glm::dvec3 const eye = middle + distance * glm::normalize(glm::dvec3(std::sin(a), std::sin(b), std::cos(a)));
    glm::dvec3 const target =
        middle + 0.3 * distance * glm::dvec3(rng.uniform(-1.0, 1.0), rng.uniform(-0.8, 0.8), 0);
    glm::dvec3 const z = glm::normalize(target - eye), x = glm::normalize(glm::cross(z, glm::dvec3(0, 1, 0)));
    glm::dquat const level = glm::quat_cast(glm::dmat3(x, glm::cross(z, x), z));
    return {eye, glm::normalize(level * glm::angleAxis(rng.uniform(-0.3, 0.3), glm::dvec3(0, 0, 1)))};
}

} // namespace

void write_board_views(std::filesystem::path const& folder, ar::CharucoBoard board, int count)
{
    std::error_code error;
    if (!std::filesystem::create_directory(folder, error))
        throw gi::InputError("cannot make the folder '" + folder.string() + "'",
                             error ? error.message() : "it exists", "choose another name");
    board.world_from_board = {};
    ar::Sheet const sheet = ar::sheet_of({{}, {board}, {}}, 0);
    double const dots_per_m = 800 / std::max(sheet.width_m, sheet.height_m);
    cv::Mat light;
    draw(sheet, dots_per_m).convertTo(light, CV_32F, 0.76 / 255, 0.04);
    ar::CameraModel const c = camera();
    cv::Mat const ray = rays(c);
    cv::RNG rng(20261122);
    for (int i = 1; i <= count; ++i) {
        gi::RigidPose const pose = board_from_camera(rng, {sheet.width_m, sheet.height_m});
        cv::Mat at(ray.size(), CV_32FC2);
        ray.forEach<cv::Vec2d>([&](cv::Vec2d const& r, int const* yx) {
            glm::dvec3 const d = pose.rotation * glm::dvec3(r[0], r[1], 1);
            glm::dvec3 const p = pose.position - pose.position.z / d.z * d;
            bool const seen = d.z < 0 && std::abs(r[0]) < 1e5;
            at.at<cv::Vec2f>(yx[0], yx[1]) =
                seen ? cv::Vec2f(float((p.x + sheet.origin_m.x) * dots_per_m - 0.5),
                                 float((sheet.height_m - p.y - sheet.origin_m.y) * dots_per_m - 0.5))
                     : cv::Vec2f(-10, -10);
        });
        cv::Mat picture, noise(c.size_px.y, c.size_px.x, CV_32F);
        cv::remap(light, picture, at, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0.2));
        cv::resize(picture, picture, noise.size(), 0, 0, cv::INTER_AREA);
        cv::GaussianBlur(picture, picture, {}, 0.4);
        cv::pow(picture, 1 / 2.2, picture);
        rng.fill(noise, cv::RNG::NORMAL, 0, 0.006);
        picture = 255 * (picture + noise);
        picture.convertTo(picture, CV_8U);
        std::vector<unsigned char> bytes;
        cv::imencode(".png", picture, bytes);
        gi::write_text(folder / fmt::format("{:02}.png", i),
                       {reinterpret_cast<char const*>(bytes.data()), bytes.size()});
    }
    ar::Calibration truth;
    truth.camera = c;
    truth.provenance = {{"made_by", "lightwell ar board"}};
    ar::write_calibration(folder / "truth.yaml", truth);
}

} // namespace viewer
