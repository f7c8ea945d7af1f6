#include "gi/hit_buffers/directions/direction_picture.h"

#include "gi/hit_buffers/directions/direction_quality.h"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace gi {
namespace {

constexpr int kMapHeight = 480, kMapWidth = 2 * kMapHeight, kStrip = 320, kMargin = 40;
cv::Scalar const kInk(40, 40, 40);

struct Cells {
    DirectionSet const& directions;
    std::vector<double> relative; ///< solid angle per axis, divided by the mean

    cv::Vec3b color(std::uint32_t direction) const
    {
        double const t = std::clamp((relative[direction / 2] - 0.5), 0.0, 1.0); // 0.5 is the mean
        double const low = std::min(1.0, 2 * t), high = std::min(1.0, 2 - 2 * t);
        // Small differences in brightness separate neighbours of equal size.
        double const shade = 235 - 7 * double(direction * 7 % 5);
        return {std::uint8_t(shade * low), std::uint8_t(shade * std::min(low, high)), std::uint8_t(shade * high)};
    }
};

/// Colours every pixel for which `direction_at` returns a direction; borders between cells are dark.
template <class DirectionAt>
void fill(cv::Mat& image, cv::Rect const& where, Cells const& cells, DirectionAt const& direction_at)
{
    cv::Mat nearest(where.height, where.width, CV_32S, cv::Scalar(-1));
    for (int y = 0; y < where.height; ++y)
        for (int x = 0; x < where.width; ++x) {
            dvec3 d;
            if (direction_at(x + 0.5, y + 0.5, d))
                nearest.at<int>(y, x) = int(nearest_direction(cells.directions, d));
        }
    for (int y = 0; y < where.height; ++y)
        for (int x = 0; x < where.width; ++x) {
            int const here = nearest.at<int>(y, x);
            if (here < 0) continue;
            bool const border =
                (x > 0 && nearest.at<int>(y, x - 1) != here) || (y > 0 && nearest.at<int>(y - 1, x) != here);
            image.at<cv::Vec3b>(where.y + y, where.x + x) =
                border ? cv::Vec3b(90, 90, 90) : cells.color(std::uint32_t(here));
        }
}

dvec3 from_lat_long(double u, double v)
{
    double const phi = 2 * kPiD * (u - 0.5), theta = kPiD * v;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

void draw_map(cv::Mat& image, Cells const& cells)
{
    fill(image, {0, 0, kMapWidth, kMapHeight}, cells, [](double x, double y, dvec3& d) {
        d = from_lat_long(x / kMapWidth, y / kMapHeight);
        return true;
    });
    for (std::size_t i = 0; i < cells.directions.size(); ++i) {
        dvec3 const d = cells.directions.direction(i);
        double const u = 0.5 + std::atan2(d.x, -d.z) / (2 * kPiD), v = std::acos(d.y) / kPiD;
        cv::circle(image, {int(u * kMapWidth), int(v * kMapHeight)}, 2, kInk, cv::FILLED, cv::LINE_AA);
    }
}

void draw_half_sphere(cv::Mat& image, Cells const& cells)
{
    double const radius = 0.5 * kStrip - 8;
    fill(image, {0, kMapHeight, kStrip, kStrip}, cells, [&](double x, double y, dvec3& d) {
        double const px = (x - 0.5 * kStrip) / radius, pz = (y - 0.5 * kStrip) / radius, r2 = px * px + pz * pz;
        if (r2 >= 1) return false;
        d = {px, std::sqrt(1 - r2), pz};
        return true;
    });
}

void draw_profile(cv::Mat& image, DirectionSet const& directions)
{
    cv::Rect const box(kStrip + kMargin + 10, kMapHeight + 20, kMapWidth - kStrip - 2 * kMargin, kStrip - 60);
    std::vector<double> cosines;
    double least = 1;
    for (int x = 0; x < box.width; ++x) {
        dvec3 const d = from_lat_long((x + 0.5) / box.width, 0.5);
        cosines.push_back(glm::dot(d, directions.direction(nearest_direction(directions, d))));
        least = std::min(least, cosines.back());
    }
    double const bottom = std::max(-1.0, 1 - 1.1 * (1 - least));
    auto const row = [&](double c) { return box.y + int((1 - c) / (1 - bottom) * box.height); };
    cv::rectangle(image, box, kInk, 1);
    for (int i = 0; i + 1 < box.width; ++i)
        cv::line(image, {box.x + i, row(cosines[std::size_t(i)])},
                 {box.x + i + 1, row(cosines[std::size_t(i) + 1])}, {180, 60, 30}, 1, cv::LINE_AA);
    auto const label = [&](std::string const& text, int x, int y) {
        cv::putText(image, text, {x, y}, cv::FONT_HERSHEY_SIMPLEX, 0.4, kInk, 1, cv::LINE_AA);
    };
    for (int degrees = 0; degrees <= 360; degrees += 90)
        label(std::to_string(degrees), box.x + box.width * degrees / 360 - 10, box.y + box.height + 16);
    label("1", box.x - 14, box.y + 6);
    label(fmt::format("{:.4f}", bottom), box.x - 48, box.y + box.height);
    label("cosine of the angle to the nearest direction, along the equator, over degrees", box.x + 20,
          box.y + box.height + 32);
}

} // namespace

DirectionPicture draw(DirectionSet const& directions)
{
    Cells cells{directions, solid_angles(directions, std::size_t(1) << 19)};
    double const mean = 2 * kPiD / double(directions.axes.size());
    for (double& s : cells.relative) s /= mean;
    cv::Mat image(kMapHeight + kStrip, kMapWidth, CV_8UC3, cv::Scalar(255, 255, 255));
    draw_map(image, cells);
    draw_half_sphere(image, cells);
    draw_profile(image, directions);
    DirectionPicture picture{image.cols, image.rows, {}};
    for (int y = 0; y < image.rows; ++y) {
        auto const* const row = image.ptr<std::uint8_t>(y);
        picture.rgb.insert(picture.rgb.end(), row, row + 3 * image.cols);
    }
    return picture;
}

} // namespace gi
