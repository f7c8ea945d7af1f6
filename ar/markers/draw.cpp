#include "ar/markers/draw.h"

#include "ar/markers/aruco.h"
#include "gi/core/crc32.h"
#include "gi/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

namespace ar {
namespace {

constexpr int kMostDots = 20000;

/// Black cells of a marker; neighbours in a row are one rectangle, so that no seam is printed between them.
void add_marker(Sheet& sheet, PlacedMarker const& m)
{
    auto const cells = cells_of(m.dictionary, m.id);
    double const cell = (m.corners_m[1].x - m.corners_m[0].x) / double(cells.size());
    glm::dvec2 const top_left = sheet.origin_m + glm::dvec2(m.corners_m[0]);
    for (std::size_t y = 0; y < cells.size(); ++y)
        for (std::size_t x = 0; x < cells.size(); ++x) {
            if (!cells[y][x]) continue;
            std::size_t end = x;
            while (end < cells.size() && cells[y][end]) ++end;
            sheet.black.push_back(
                {top_left.x + double(x) * cell, top_left.y - double(y + 1) * cell, double(end - x) * cell, cell});
            x = end;
        }
}

std::string big_endian(std::uint32_t v) { return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)}; }

} // namespace

Sheet sheet_of(MarkerMap const& map, int thing, double margin_m)
{
    std::vector<PlacedMarker> markers;
    for (PlacedMarker const& m : placed_markers(map))
        if (m.thing == thing) markers.push_back(m);
    if (markers.empty())
        throw gi::InputError(fmt::format("thing {} is not in the map", thing), "it is counted from 0",
                             fmt::format("there are {}", count_of(map)));
    glm::dvec2 low(markers[0].corners_m[3]), high(markers[0].corners_m[1]);
    for (PlacedMarker const& m : markers) {
        low = glm::min(low, glm::dvec2(m.corners_m[3]));
        high = glm::max(high, glm::dvec2(m.corners_m[1]));
    }
    auto const board = std::size_t(thing) - map.markers.size(); // wraps around for lone markers
    bool const is_board = board < map.boards.size();
    if (is_board) {
        low = glm::dvec2(0);
        high = map.boards[board].square_m * glm::dvec2(map.boards[board].squares_x, map.boards[board].squares_y);
    }
    double const cell = (markers[0].corners_m[1].x - markers[0].corners_m[0].x) /
                        double(cells_of(markers[0].dictionary, markers[0].id).size());
    double const margin = margin_m >= 0 ? margin_m : cell;

    Sheet sheet;
    sheet.width_m = high.x - low.x + 2 * margin;
    sheet.height_m = high.y - low.y + 2 * margin;
    sheet.origin_m = glm::dvec2(margin) - low;
    if (is_board) {
        CharucoBoard const& b = map.boards[board];
        for (int row = 0; row < b.squares_y; ++row)
            for (int column = 0; column < b.squares_x; ++column)
                if (is_black(b, column, row))
                    sheet.black.push_back({margin + column * b.square_m,
                                           margin + (b.squares_y - 1 - row) * b.square_m, b.square_m, b.square_m});
    }
    for (PlacedMarker const& m : markers) add_marker(sheet, m);
    return sheet;
}

cv::Mat draw(Sheet const& sheet, double dots_per_m)
{
    double const width = sheet.width_m * dots_per_m, height = sheet.height_m * dots_per_m;
    if (!(width >= 1 && height >= 1 && width <= kMostDots && height <= kMostDots))
        throw gi::InputError(fmt::format("a drawing of {:g} x {:g} dots", width, height),
                             fmt::format("1 to {} each way are possible", kMostDots),
                             "choose other dots per metre");
    // A little less than a whole dot is no dot: 0.1 m at 10,000 dots per metre is 1000, not 1001.
    cv::Mat ink = cv::Mat::zeros(int(std::ceil(height - 1e-6)), int(std::ceil(width - 1e-6)), CV_32F);
    auto const covered = [](double low, double high, int dot) {
        return float(std::max(0., std::min(high, dot + 1.) - std::max(low, double(dot))));
    };
    for (PrintedRectangle const& r : sheet.black) {
        double const left = r.left_m * dots_per_m, right = left + r.width_m * dots_per_m;
        double const top = (sheet.height_m - r.bottom_m - r.height_m) * dots_per_m;
        double const bottom = top + r.height_m * dots_per_m;
        for (int y = std::max(0, int(top)); y < std::min(ink.rows, int(std::ceil(bottom))); ++y)
            for (int x = std::max(0, int(left)); x < std::min(ink.cols, int(std::ceil(right))); ++x)
                ink.at<float>(y, x) += covered(left, right, x) * covered(top, bottom, y);
    }
    cv::Mat picture;
    ink.convertTo(picture, CV_8U, -255, 255);
    return picture;
}

std::string to_svg(Sheet const& sheet)
{
    double const width = 1e3 * sheet.width_m, height = 1e3 * sheet.height_m;
    std::string svg =
        fmt::format("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.4f}mm\" height=\"{1:.4f}mm\" "
                    "viewBox=\"0 0 {0:.4f} {1:.4f}\">\n"
                    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n<path d=\"",
                    width, height);
    for (PrintedRectangle const& r : sheet.black)
        svg += fmt::format("M{:.4f} {:.4f}h{:.4f}v{:.4f}h{:.4f}z", 1e3 * r.left_m,
                           height - 1e3 * (r.bottom_m + r.height_m), 1e3 * r.width_m, 1e3 * r.height_m,
                           -1e3 * r.width_m);
    return svg + "\"/>\n</svg>\n";
}

void write_png(std::filesystem::path const& file, cv::Mat const& drawing, double dots_per_m)
{
    std::vector<std::uint8_t> png;
    cv::imencode(".png", drawing, png);
    // After the signature (8 bytes) and IHDR (25): pHYs, dots per metre both ways.
    std::string const density = big_endian(std::uint32_t(std::lround(dots_per_m)));
    std::string const body = "pHYs" + density + density + '\1';
    std::string const chunk = big_endian(9) + body + big_endian(gi::crc32(body));
    png.insert(png.begin() + 33, chunk.begin(), chunk.end());
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<char const*>(png.data()), std::streamsize(png.size()));
    if (!out.flush())
        throw gi::InputError("'" + file.string() + "' cannot be written", "its folder is missing or full",
                             "choose another");
}

} // namespace ar
