#include "ar/markers/board_check.h"

#include "ar/markers/refine.h"
#include "gi/core/quantile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>
#include <optional>

namespace ar {
namespace {

/// How the markers of a board or grid may be arranged. Cells are squares (of a grid: steps), row by row from the
/// upper left.
struct Arrangement {
    bool is_grid = false;
    int columns = 0, rows = 0; ///< rows 0: unknown
    bool white_first = false;  ///< of boards: the upper left square is white
    std::string difference, remedy;

    /// Cell of the n-th marker.
    cv::Point cell_of(int n) const
    {
        if (is_grid) return {n % columns, n / columns};
        // Two rows have `columns` markers; the first of them has the larger half if it begins with white.
        int const first = white_first ? (columns + 1) / 2 : columns / 2;
        int const pair = n / columns, rest = n % columns;
        bool const second = rest >= first;
        int const begins_black = second == white_first ? 1 : 0;
        return {2 * (second ? rest - first : rest) + begins_black, 2 * pair + second};
    }
    bool has(cv::Point cell) const
    {
        return cell.x >= 0 && cell.y >= 0 && cell.x < columns && (rows == 0 || cell.y < rows);
    }
};

/// A marker seen; its own frame has the origin in its middle, x right, y down, and sides of 1.
struct Seen {
    int number = 0; ///< from the first one of the board
    cv::Matx33d picture_from_own;
    cv::Point2d middle;
    cv::Matx22d own_from_picture; ///< linear, about the middle: homographies of small markers err far outside them
    double side_px = 0;
};

cv::Point2d mapped(cv::Matx33d const& m, cv::Point2d p)
{
    cv::Vec3d const v = m * cv::Vec3d(p.x, p.y, 1);
    return {v[0] / v[2], v[1] / v[2]};
}

/// Mean byte around a point of the marker's frame; nothing outside the picture.
std::optional<double> mean_at(cv::Mat const& gray, Seen const& m, cv::Point2d at, double half)
{
    double sum = 0;
    for (int j = -2; j <= 2; ++j)
        for (int i = -2; i <= 2; ++i) {
            cv::Point2d const p = mapped(m.picture_from_own, at + 0.5 * half * cv::Point2d(i, j));
            int const x = int(std::lround(p.x)), y = int(std::lround(p.y));
            if (!(p.x > -1e6 && p.x < 1e6 && p.y > -1e6 && p.y < 1e6) || x < 0 || y < 0 || x >= gray.cols ||
                y >= gray.rows)
                return std::nullopt;
            sum += gray.at<std::uint8_t>(y, x);
        }
    return sum / 25;
}

Seen seen(FoundMarker const& m, int first_id)
{
    static std::array<cv::Point2f, 4> const own{{{-0.5f, -0.5f}, {0.5f, -0.5f}, {0.5f, 0.5f}, {-0.5f, 0.5f}}};
    auto const& c = m.corners;
    cv::Point2d const right = 0.5 * cv::Point2d(c[1] - c[0] + c[2] - c[3]),
                      down = 0.5 * cv::Point2d(c[3] - c[0] + c[2] - c[1]);
    return {m.id - first_id, cv::getPerspectiveTransform(own.data(), c.data()),
            0.25 * cv::Point2d(c[0] + c[1] + c[2] + c[3]), cv::Matx22d(right.x, down.x, right.y, down.y).inv(),
            shortest_side(c)};
}

/// From the middle of a marker to that of another, in its own frame.
cv::Point2d way_to(Seen const& from, Seen const& to)
{
    cv::Point2d const d = to.middle - from.middle;
    cv::Vec2d const v = from.own_from_picture * cv::Vec2d(d.x, d.y);
    return {v[0], v[1]};
}

/// From one marker to another beside it, in sides of a marker; the mean of both markers' measures, in which the
/// perspective cancels.
struct Step {
    int from = 0, to = 0; ///< numbers of the markers
    cv::Point2d way;
};

std::vector<Step> steps_between(std::vector<Seen> const& markers)
{
    constexpr double kNear = 1.3, kFarthest_sides = 12;
    std::vector<Step> all;
    std::vector<double> nearest(markers.size(), kFarthest_sides);
    for (std::size_t a = 0; a < markers.size(); ++a)
        for (std::size_t b = a + 1; b < markers.size(); ++b) {
            Seen const &m = markers[a], &n = markers[b];
            if (cv::norm(m.middle - n.middle) > kFarthest_sides * 2 * std::max(m.side_px, n.side_px)) continue;
            cv::Point2d const way = 0.5 * (way_to(m, n) - way_to(n, m));
            double const length = cv::norm(way);
            if (!(length < kFarthest_sides)) continue;
            nearest[a] = std::min(nearest[a], length);
            nearest[b] = std::min(nearest[b], length);
            all.push_back({m.number, n.number, way});
        }
    if (all.empty()) return all;
    double const limit = kNear * gi::median(nearest);
    std::erase_if(all, [&](Step const& s) { return !(cv::norm(s.way) < limit); });
    return all;
}

struct Evidence {
    int steps = 0, steps_against = 0;
    int squares = 0, squares_against = 0;
    double sides_per_cell = 0, spread = 0; ///< of a square or step, measured; standard error
    int against() const { return steps_against + squares_against; }
    int all() const { return steps + squares; }
};

Evidence weigh(cv::Mat const& gray, std::vector<Seen> const& markers, std::vector<Step> const& steps,
               Arrangement const& a)
{
    constexpr double kApart = 0.45; // wrong cells are a cell apart or more
    Evidence e;
    std::vector<double> scales;
    auto const expected = [&](Step const& s) { return cv::Point2d(a.cell_of(s.to) - a.cell_of(s.from)); };
    for (Step const& s : steps) {
        cv::Point2d const way = expected(s);
        if (double const scale = way.dot(s.way) / way.dot(way); scale > 0.5) scales.push_back(scale);
    }
    e.steps = int(steps.size());
    e.steps_against = e.steps;
    if (scales.empty()) return e;
    e.sides_per_cell = gi::median(scales);
    e.steps_against = int(std::count_if(steps.begin(), steps.end(), [&](Step const& s) {
        return !(cv::norm(s.way - e.sides_per_cell * expected(s)) < kApart * e.sides_per_cell);
    }));
    std::vector<double> off;
    for (double const s : scales) off.push_back(std::abs(s - e.sides_per_cell));
    e.spread = 1.4826 * gi::median(off) / std::sqrt(double(scales.size()));
    if (a.is_grid) return e;
    double const margin = 0.5 * (e.sides_per_cell - 1);
    if (margin < 0.05) return e;
    for (Seen const& m : markers) {
        cv::Point const cell = a.cell_of(m.number);
        if (!a.has(cell)) continue;
        double black = 0, white = 0;
        bool is_whole = true;
        for (cv::Point2d const way : {cv::Point2d(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
            auto const outside = mean_at(gray, m, (0.5 + 0.5 * margin) * way, 0.2 * margin);
            auto const border = mean_at(gray, m, 0.44 * way, 0.02);
            is_whole = is_whole && outside && border;
            white += 0.25 * outside.value_or(0);
            black += 0.25 * border.value_or(0);
        }
        if (!is_whole || white - black < 25) continue;
        for (cv::Point const way : {cv::Point(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
            if (!a.has(cell + way)) continue;
            auto const square = mean_at(gray, m, e.sides_per_cell * cv::Point2d(way), 0.2 * e.sides_per_cell);
            if (!square) continue;
            ++e.squares;
            e.squares_against += *square > 0.5 * (black + white);
        }
    }
    return e;
}

Arrangement arrangement_of(CharucoBoard const& b)
{
    return {false, b.squares_x, b.squares_y, !is_black(b, 0, 0), {}, {}};
}

/// Other arrangements, the likely ones first. @param any  also with other numbers of columns
std::vector<Arrangement> others(CharucoBoard const& b, bool any)
{
    constexpr int kMostColumns = 60;
    std::vector<Arrangement> all;
    bool const legacy = b.legacy_pattern;
    char const* const toggled = legacy ? "remove legacy_pattern: the upper left square is black"
                                       : "write legacy_pattern: true, as of boards printed by OpenCV before 4.6";
    if (b.squares_y % 2 == 0)
        all.push_back({false, b.squares_x, b.squares_y, !legacy,
                       fmt::format("on one whose upper left square is {}", legacy ? "black" : "white"), toggled});
    std::string const exchange =
        fmt::format("exchange them: squares_x: {}, squares_y: {}", b.squares_y, b.squares_x);
    std::string const turned = fmt::format("on one of {} x {} squares", b.squares_y, b.squares_x);
    if (b.squares_x != b.squares_y) {
        bool const white = legacy && b.squares_x % 2 == 0;
        all.push_back({false, b.squares_y, b.squares_x, white, turned, exchange});
        if (b.squares_x % 2 == 0)
            all.push_back({false, b.squares_y, b.squares_x, !white,
                           turned + ", its upper left square " + (white ? "black" : "white"),
                           fmt::format("{}, and {}", exchange, toggled)});
    }
    for (int columns = 2; any && columns <= kMostColumns; ++columns)
        for (bool const white : {false, true}) {
            if (columns == b.squares_x || columns == b.squares_y) continue;
            all.push_back({false, columns, 0, white, fmt::format("on one of {} squares across", columns),
                           fmt::format("write squares_x: {} and the right squares_y{}", columns,
                                       white ? ", and legacy_pattern: true" : "")});
        }
    return all;
}

std::vector<Arrangement> others(MarkerGrid const& g, bool any)
{
    constexpr int kMostColumns = 60;
    std::vector<Arrangement> all;
    if (g.markers_x != g.markers_y)
        all.push_back({true, g.markers_y, g.markers_x, false,
                       fmt::format("on one of {} x {} markers", g.markers_y, g.markers_x),
                       fmt::format("exchange them: markers_x: {}, markers_y: {}", g.markers_y, g.markers_x)});
    for (int columns = 1; any && columns <= kMostColumns; ++columns)
        if (columns != g.markers_x && columns != g.markers_y)
            all.push_back({true, columns, 0, false, fmt::format("on one of {} markers across", columns),
                           fmt::format("write markers_x: {} and the right markers_y", columns)});
    return all;
}

} // namespace

BoardFinding check_board(cv::Mat const& gray, MarkerMap const& map, int thing,
                         std::vector<FoundMarker> const& found)
{
    constexpr int kFewestAgainst = 2;
    auto const at = std::size_t(thing) - map.markers.size();
    CharucoBoard const* const board = at < map.boards.size() ? &map.boards[at] : nullptr;
    MarkerGrid const* const grid = board ? nullptr : &map.grids.at(at - map.boards.size());
    Arrangement const given =
        board ? arrangement_of(*board) : Arrangement{true, grid->markers_x, grid->markers_y, false, {}, {}};
    std::vector<Seen> markers;
    for (FoundMarker const& m : found) markers.push_back(seen(m, board ? board->first_id : grid->first_id));
    std::vector<Step> const steps = steps_between(markers);
    if (steps.empty()) return {};
    Evidence const own = weigh(gray, markers, steps, given);
    std::string const name = describe(map, thing);

    bool all_differ = true; // the likely ones: else the picture cannot tell
    bool const is_in_doubt = own.against() >= kFewestAgainst;
    for (Arrangement const& other : board ? others(*board, is_in_doubt) : others(*grid, is_in_doubt)) {
        Evidence const e = weigh(gray, markers, steps, other);
        all_differ = all_differ && (other.rows == 0 || e.against() >= kFewestAgainst);
        // Of a wide board few markers tell, but no light or hand makes markers lie otherwise.
        bool const counts = own.steps_against >= kFewestAgainst || 20 * own.squares_against >= own.squares;
        bool const is_right =
            is_in_doubt && counts && 4 * e.against() <= own.against() && 33 * e.against() <= e.all();
        if (!is_right) continue;
        return {own.steps_against >= kFewestAgainst ? BoardVerdict::contradicts : BoardVerdict::doubtful,
                fmt::format("{}: its markers lie as {}", name, other.difference), other.remedy};
    }
    if (own.steps >= 6 && 2 * own.steps_against > own.steps)
        return {BoardVerdict::contradicts,
                fmt::format("{}: {} of {} neighbouring markers do not lie to each other as in the map", name,
                            own.steps_against, own.steps),
                "write the numbers of rows and columns, and the first identifier, of what is printed"};
    if (own.squares >= 8 && 2 * own.squares_against > own.squares)
        return {BoardVerdict::doubtful,
                fmt::format("{}: {} of {} squares beside its markers are white, and black in the map", name,
                            own.squares_against, own.squares),
                "markers without a chessboard are a grid: write it under grids:"};
    double const measured = own.sides_per_cell;
    double const mapped_sides =
        board ? board->square_m / board->marker_m : (grid->marker_m + grid->gap_m) / grid->marker_m;
    std::vector<double> sides_px;
    for (Seen const& m : markers) sides_px.push_back(m.side_px);
    // Corners are known to a tenth of a pixel; ink and blur make markers larger or smaller by more.
    double const tolerance = 0.06 + 1 / gi::median(sides_px) + 4 * own.spread / std::max(1., measured);
    if (own.steps - own.steps_against >= 3 && std::abs(measured / mapped_sides - 1) > tolerance)
        return {BoardVerdict::contradicts,
                fmt::format("{}: its {} are {:.3g} sides of a marker wide, and {:.3g} in the map", name,
                            board ? "squares" : "steps", measured, mapped_sides),
                board ? "measure square_m and marker_m again" : "measure marker_m and gap_m again"};
    return {own.against() == 0 && all_differ ? BoardVerdict::agrees : BoardVerdict::silent, {}, {}};
}

} // namespace ar
