#include "viewer/displays/test_pattern.h"

#include "viewer/displays/blend.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

using Colour = cv::Scalar; // red, green, blue
Colour const kBlack{0, 0, 0}, kWhite{255, 255, 255}, kGrey{110, 110, 110}, kRed{255, 0, 0}, kGreen{0, 200, 0},
    kBlue{60, 90, 255}, kYellow{240, 220, 0}, kCyan{0, 230, 230};

/// Canvas in wall coordinates: (u, v) from the lower left corner.
struct Canvas {
    cv::Mat image;
    Wall const& wall;
    WallFrame frame;
    DisplayView const& view;

    int width() const { return image.cols; }
    int height() const { return image.rows; }
    int unit() const { return std::max(1, std::min(width(), height()) / 400); } ///< width of a line, px
    cv::Point at(double u, double v) const
    {
        auto const pixel = [](double t, int size) {
            return std::clamp(int(std::floor(t * size)), 0, size - 1); // keep the last line inside
        };
        return {pixel(u, width()), pixel(1 - v, height())};
    }
    /// Letters of size 1 have a height of 4.5 % of the shorter side;
    /// text wider than the share `room` of the width is reduced.
    void text(std::string const& words, double u, double v, double size, Colour colour, double room = 0.9) const
    {
        double const scale = size * 0.045 * std::min(width(), height()) / 22.0;
        int const thickness = std::max(1, int(scale * 2));
        int base = 0;
        cv::Size box = cv::getTextSize(words, cv::FONT_HERSHEY_SIMPLEX, scale, thickness, &base);
        double const fit = std::min(1.0, room * width() / std::max(1, box.width));
        cv::Point const middle = at(u, v);
        cv::putText(image, words, {middle.x - int(box.width * fit) / 2, middle.y + int(box.height * fit) / 2},
                    cv::FONT_HERSHEY_SIMPLEX, scale * fit, colour, std::max(1, int(thickness * fit)), cv::LINE_AA);
    }
    void box(double u0, double v0, double u1, double v1, Colour colour) const
    {
        cv::Point const a = at(u0, v1), b = at(u1, v0);
        cv::rectangle(image, a, b, colour, cv::FILLED);
    }
};

Colour colour_of(Eye eye) { return eye == Eye::left ? kRed : eye == Eye::right ? kCyan : kWhite; }

void draw_border(Canvas const& c, Colour colour)
{
    cv::rectangle(c.image, {0, 0}, {c.width() - 1, c.height() - 1}, colour, 1);
}

void draw_grid(Canvas const& c)
{
    double const step = grid_step_m(c.frame);
    auto const lines = [&](double length, auto const& draw) {
        for (int i = 1; i * step < length * (1 - 1e-9); ++i) draw(i * step / length, i % 5 == 0);
    };
    lines(c.frame.width_m, [&](double u, bool fifth) {
        cv::line(c.image, c.at(u, 0), c.at(u, 1), fifth ? kWhite : kGrey, fifth ? 2 * c.unit() : c.unit());
    });
    lines(c.frame.height_m, [&](double v, bool fifth) {
        cv::line(c.image, c.at(0, v), c.at(1, v), fifth ? kWhite : kGrey, fifth ? 2 * c.unit() : c.unit());
    });
    double const radius_m = 0.35 * std::min(c.frame.width_m, c.frame.height_m);
    cv::ellipse(c.image, c.at(0.5, 0.5),
                {int(radius_m / c.frame.width_m * c.width()), int(radius_m / c.frame.height_m * c.height())}, 0, 0,
                360, kYellow, 2 * c.unit(), cv::LINE_AA);
    cv::line(c.image, c.at(0.47, 0.5), c.at(0.53, 0.5), kYellow, c.unit());
    cv::line(c.image, c.at(0.5, 0.47), c.at(0.5, 0.53), kYellow, c.unit());
    draw_border(c, kGreen);
    c.box(0.28, 0.58, 0.72, 0.76, kBlack);
    c.text(c.view.name, 0.5, 0.7, 1.1, kWhite, 0.4);
    c.text(fmt::format("{:.4g} x {:.4g} m, a line every {:.4g} m", c.frame.width_m, c.frame.height_m, step), 0.5,
           0.62, 0.7, kWhite, 0.42);
}

void draw_corners(Canvas const& c)
{
    struct Corner {
        char const* name;
        double u, v;
        Colour colour;
    };
    for (Corner const& k : {Corner{"lower left", 0, 0, kRed}, Corner{"lower right", 1, 0, kGreen},
                            Corner{"upper left", 0, 1, kBlue}, Corner{"upper right", 1, 1, kYellow}}) {
        double const inner_u = k.u == 0 ? 0.12 : 0.88, inner_v = k.v == 0 ? 0.12 : 0.88;
        c.box(std::min(k.u, inner_u), std::min(k.v, inner_v), std::max(k.u, inner_u), std::max(k.v, inner_v),
              k.colour);
        gi::dvec3 const p = c.frame.point(k.u, k.v);
        double const text_u = k.u == 0 ? 0.26 : 0.74, text_v = k.v == 0 ? 0.22 : 0.82;
        c.text(k.name, text_u, text_v, 1, k.colour, 0.4);
        c.text(fmt::format("({:.3g}, {:.3g}, {:.3g}) m", p.x, p.y, p.z), text_u, text_v - 0.07, 0.7, k.colour,
               0.4);
    }
    cv::arrowedLine(c.image, c.at(0.5, 0.3), c.at(0.5, 0.45), kWhite, 2 * c.unit(), cv::LINE_AA, 0, 0.3);
    c.text("up", 0.5, 0.26, 0.9, kWhite);
    c.text(c.view.name, 0.5, 0.58, 1.2, kWhite);
    draw_border(c, kWhite);
}

/// Crosses on the line through the wall's centre along its normal, at the positions where this eye sees them.
void draw_eyes(Canvas const& c)
{
    Colour const mine = colour_of(c.view.eye);
    c.text(c.view.eye == Eye::left    ? "L"
           : c.view.eye == Eye::right ? "R"
                                      : "one eye",
           c.view.eye == Eye::left    ? 0.18
           : c.view.eye == Eye::right ? 0.82
                                      : 0.5,
           0.8, 5, mine);
    if (!c.view.camera) {
        c.text(fmt::format("this eye sees nothing: it is {} the wall", name_of(c.view.place)), 0.5, 0.4, 0.8,
               kWhite);
        return;
    }
    gi::dmat4 const& m = c.view.camera->world_from_camera;
    gi::dvec3 const eye(m[3]);
    gi::ViewTangents const t = *c.view.camera->off_axis;
    double const distance = glm::dot(eye - c.frame.lower_left, c.frame.normal);
    struct Mark {
        double toward; ///< share of the way from the wall to the eye; negative: behind the wall
        double v;
        char const* words;
    };
    for (Mark const& mark : {Mark{0.5, 0.55, "half way to you"}, Mark{0, 0.4, "on the wall"},
                             Mark{-1, 0.25, "twice as far as the wall"}, Mark{-1e6, 0.1, "at infinity"}}) {
        // Intersection of the wall with the line from this eye to the point.
        gi::dvec3 const point = c.frame.point(0.5, mark.v) + mark.toward * distance * c.frame.normal;
        gi::dvec3 const to = point - eye;
        double const depth = -glm::dot(to, gi::dvec3(m[2]));
        double const u = (glm::dot(to, gi::dvec3(m[0])) / depth - t.left) / (t.right - t.left);
        // Use a fixed height per mark, so that the rows stay apart: only the disparity matters.
        if (!(u >= 0 && u <= 1)) {
            c.text(fmt::format("{}: outside", mark.words), 0.5, mark.v, 0.5, mine);
            continue;
        }
        cv::drawMarker(c.image, c.at(u, mark.v), mine, cv::MARKER_CROSS, 18 * c.unit(), 2 * c.unit());
        double const shift_mm = 1000 * (u - 0.5) * c.frame.width_m;
        c.text(fmt::format("{}: {:+.1f} mm", mark.words, shift_mm), c.view.eye == Eye::left ? 0.22 : 0.78, mark.v,
               0.7, mine, 0.38);
    }
    draw_border(c, mine);
}

void draw_colours(Canvas const& c)
{
    std::array const bars = {Colour{255, 255, 255}, Colour{255, 255, 0}, Colour{0, 255, 255}, Colour{0, 255, 0},
                             Colour{255, 0, 255},   Colour{255, 0, 0},   Colour{0, 0, 255},   Colour{0, 0, 0}};
    for (std::size_t i = 0; i < bars.size(); ++i)
        c.box(double(i) / bars.size(), 0.55, double(i + 1) / bars.size(), 1, bars[i]);
    for (int i = 0; i <= 16; ++i) {
        double const grey = std::min(255, i * 16);
        c.box(i / 17.0, 0.4, (i + 1) / 17.0, 0.55, {grey, grey, grey});
    }
    for (int x = 0; x < c.width(); ++x) {
        double const grey = std::floor(256.0 * x / c.width());
        cv::line(c.image, {x, c.at(0, 0.4).y}, {x, c.at(0, 0.25).y}, {grey, grey, grey});
    }
    int const top = c.at(0, 0.25).y;
    for (int y = top; y < c.height(); ++y) cv::line(c.image, {0, y}, {c.width(), y}, y % 2 ? kWhite : kBlack);
    double const half = std::round(255 * std::pow(0.5, 1 / 2.2));
    c.box(0.35, 0.05, 0.65, 0.2, {half, half, half});
    c.text("as bright as the lines: gamma 2.2", 0.5, 0.125, 0.6, kBlack, 0.28);
}

/// Rows give this eye's value, columns the other eye's: differences within a row are leakage.
void draw_crosstalk(Canvas const& c)
{
    bool const is_right = c.view.eye == Eye::right;
    for (int left = 0; left < 2; ++left)
        for (int right = 0; right < 2; ++right) {
            double const grey = (is_right ? right : left) ? 255 : 0;
            c.box(0.5 * right, 0.55 - 0.45 * left, 0.5 * right + 0.5, 1.0 - 0.45 * left, {grey, grey, grey});
            c.text(fmt::format("L {} R {}", left ? "white" : "black", right ? "white" : "black"),
                   0.25 + 0.5 * right, 0.95 - 0.45 * left, 0.8, kGrey, 0.45);
        }
    // Greys for this eye against the other eye's black and white: they match where leakage is cancelled.
    for (int i = 0; i < 8; ++i) {
        double const grey = 8 * i;
        c.box(i / 8.0, 0, (i + 1) / 8.0, 0.1, is_right ? Colour{grey, grey, grey} : kWhite);
        c.text(fmt::format("{}", 8 * i), (i + 0.5) / 8, 0.05, 0.7, kGrey, 0.1);
    }
}

void draw_blend(Canvas const& c)
{
    cv::Mat image = c.image; // the same pixels
    for (int y = 0; y < c.height(); ++y)
        for (int x = 0; x < c.width(); ++x) {
            double const weight = blend_weight(c.wall.blend, c.frame.width_m, c.frame.height_m,
                                               (x + 0.5) / c.width(), 1 - (y + 0.5) / c.height());
            auto& pixel = image.at<cv::Vec3b>(y, x);
            for (int k = 0; k < 3; ++k)
                pixel[k] = cv::saturate_cast<unsigned char>(
                    255 * encoded_weight(c.wall.blend, std::min(1.0, weight * c.wall.gain[k])));
        }
}

} // namespace

char const* name_of(TestPattern pattern)
{
    switch (pattern) {
    case TestPattern::grid:
        return "grid";
    case TestPattern::corners:
        return "corners";
    case TestPattern::eyes:
        return "eyes";
    case TestPattern::colours:
        return "colours";
    case TestPattern::crosstalk:
        return "crosstalk";
    case TestPattern::blend:
        break;
    }
    return "blend";
}

std::optional<TestPattern> test_pattern(std::string_view name)
{
    for (TestPattern const pattern : kTestPatterns)
        if (name == name_of(pattern)) return pattern;
    return {};
}

double grid_step_m(WallFrame const& wall)
{
    double const longer = std::max(wall.width_m, wall.height_m);
    double const decade = std::pow(10.0, std::floor(std::log10(longer / 24)));
    for (double const factor : {1.0, 2.0, 5.0, 10.0})
        if (longer / (factor * decade) <= 24) return factor * decade;
    return 10 * decade;
}

PatternPicture draw_curved_grid(Display const& display, Wall const& wall)
{
    PixelRectangle const area = viewport_px(wall, display.windows[std::size_t(wall.window)]);
    int const width = std::max(1, area.width), height = std::max(1, area.height);
    cv::Mat image(height, width, CV_8UC3, kBlack);
    RoomPose const pose = pose_of(wall.surface->place);
    // Cells of 10 degrees; lines are where neighbouring pixels are in different cells.
    auto const cell = [&](int x, int y) -> std::optional<cv::Point> {
        auto const p =
            surface_point(*wall.surface, double(width) / height, {(x + 0.5) / width, 1 - (y + 0.5) / height});
        if (!p) return {};
        gi::dvec3 const d = glm::conjugate(pose.rotation) * direction_to(*p, pose.position);
        return cv::Point(int(std::floor(glm::degrees(std::atan2(d.x, -d.z)) / 10)),
                         int(std::floor(glm::degrees(std::asin(std::clamp(d.y, -1.0, 1.0))) / 10)));
    };
    auto const colour = [](int line) { return line % 3 == 0 ? kWhite : kGrey; };
    for (int y = 0; y + 1 < height; ++y)
        for (int x = 0; x + 1 < width; ++x) {
            auto const here = cell(x, y), right = cell(x + 1, y), below = cell(x, y + 1);
            if (!here || !right || !below) continue;
            for (auto const& next : {*right, *below}) {
                int const azimuth = std::max(here->x, next.x), elevation = std::max(here->y, next.y);
                std::optional<Colour> line;
                if (next.x != here->x) line = azimuth == 0 ? kGreen : colour(azimuth);
                if (next.y != here->y) line = elevation == 0 ? kYellow : colour(elevation);
                if (!line) continue;
                for (int c = 0; c < 3; ++c) image.at<cv::Vec3b>(y, x)[c] = static_cast<unsigned char>((*line)[c]);
            }
        }
    return {width, height, {image.data, image.data + image.total() * 3}};
}

PatternPicture draw_pattern(TestPattern pattern, Display const& display, DisplayView const& view)
{
    Wall const& wall = display.walls[std::size_t(view.wall)];
    Canvas const c{cv::Mat(view.height_px, view.width_px, CV_8UC3, kBlack), wall, wall_frame(wall.corners), view};
    switch (pattern) {
    case TestPattern::grid:
        draw_grid(c);
        break;
    case TestPattern::corners:
        draw_corners(c);
        break;
    case TestPattern::eyes:
        draw_eyes(c);
        break;
    case TestPattern::colours:
        draw_colours(c);
        break;
    case TestPattern::crosstalk:
        draw_crosstalk(c);
        break;
    case TestPattern::blend:
        draw_blend(c);
        break;
    }
    return {view.width_px, view.height_px, {c.image.data, c.image.data + c.image.total() * 3}};
}

} // namespace viewer
