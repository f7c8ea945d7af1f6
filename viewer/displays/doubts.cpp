// What works but was probably not meant: report_doubts() of check.h.

#include "viewer/displays/check.h"
#include "viewer/displays/views.h"

#include <array>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <tuple>

namespace viewer {
namespace {

constexpr double kLargestWall_m = 30; ///< larger ones are probably written in other units
constexpr double kFarHead = 6;        ///< diagonals of a wall from its middle: nobody looks at it from there

/// Width by which walls that lie side by side in one plane overlap along `right` of the first; otherwise 0.
double overlap_m(WallFrame const& a, WallFrame const& b)
{
    if (glm::dot(a.normal, b.normal) < 0.9999 || glm::dot(a.right, b.right) < 0.9999) return 0;
    gi::dvec3 const to = b.lower_left - a.lower_left;
    double const across = glm::dot(to, a.right), upward = glm::dot(to, a.up);
    if (std::abs(glm::dot(to, a.normal)) > 0.01 * a.width_m || std::abs(upward) > 0.5 * a.height_m) return 0;
    return across > 0 && across < a.width_m ? a.width_m - across : 0;
}

struct Edge {
    char const* name;
    gi::dvec3 from{0}, to{0};
};

std::array<Edge, 4> edges_of(WallFrame const& f)
{
    auto const p = [&](double u, double v) { return f.point(u, v); };
    return {Edge{"left", p(0, 0), p(0, 1)}, Edge{"right", p(1, 0), p(1, 1)}, Edge{"lower", p(0, 0), p(1, 0)},
            Edge{"upper", p(0, 1), p(1, 1)}};
}

double length_m(Edge const& e) { return glm::distance(e.from, e.to); }

double distance_m(gi::dvec3 p, Edge const& e)
{
    gi::dvec3 const along = e.to - e.from;
    double const t = glm::clamp(glm::dot(p - e.from, along) / glm::dot(along, along), 0.0, 1.0);
    return glm::distance(p, e.from + t * along);
}

/// The larger distance of the ends of the shorter edge from the longer one.
double apart_m(Edge const& a, Edge const& b)
{
    auto const& [s, l] = length_m(a) < length_m(b) ? std::tie(a, b) : std::tie(b, a);
    return std::max(distance_m(s.from, l), distance_m(s.to, l));
}

/// True if the rectangle about `b`, seen along the normal of `a`, covers a part of `a`.
bool overlap_upright(WallFrame const& a, WallFrame const& b)
{
    gi::dvec3 const p = b.point(0, 0) - a.lower_left, q = b.point(1, 1) - a.lower_left;
    auto const is_shared = [](double x, double y, double size) {
        return std::min(x, y) < size && std::max(x, y) > 0;
    };
    return is_shared(glm::dot(p, a.right), glm::dot(q, a.right), a.width_m) &&
           is_shared(glm::dot(p, a.up), glm::dot(q, a.up), a.height_m);
}

/// Edges of two walls that nearly meet. Gaps within a plane are bezels up to 5 cm.
void report_gaps(std::vector<Wall const*> const& walls, std::vector<WallFrame> const& frames, gi::Report& report)
{
    constexpr double kTouch_m = 0.002, kBezel_m = 0.05, kNearly = 0.3;
    for (std::size_t i = 0; i < walls.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            if (glm::distance(frames[i].point(0, 0), frames[j].point(0, 0)) +
                    glm::distance(frames[i].point(1, 1), frames[j].point(1, 1)) <
                kTouch_m) {
                if (walls[i]->eye == walls[j]->eye && walls[i]->user == walls[j]->user && !is_warped(*walls[i]))
                    report.lose("walls in one place: is one of them copied?", 1,
                                fmt::format("'{}' and '{}'", walls[j]->name, walls[i]->name));
                continue;
            }
            bool const is_plane = glm::dot(frames[i].normal, frames[j].normal) > 0.9999;
            if (is_plane && overlap_upright(frames[i], frames[j])) continue; // blended
            double nearest_m = INFINITY;
            std::string text;
            for (Edge const& a : edges_of(frames[i]))
                for (Edge const& b : edges_of(frames[j])) {
                    double const d = apart_m(a, b);
                    if (d > kNearly * std::min(length_m(a), length_m(b)) || d >= nearest_m) continue;
                    nearest_m = d;
                    text = fmt::format("the {} edge of '{}' and the {} edge of '{}' are up to {:.3g} m apart",
                                       b.name, walls[j]->name, a.name, walls[i]->name, d);
                }
            if (std::isfinite(nearest_m) && nearest_m > (is_plane ? kBezel_m : kTouch_m))
                report.lose("walls that nearly meet: measure their corners again if they touch", 1, text);
        }
}

void report_sizes(std::vector<Wall const*> const& walls, std::vector<WallFrame> const& frames, Display const& d,
                  gi::Report& report)
{
    for (std::size_t i = 0; i < walls.size(); ++i) {
        WallFrame const& f = frames[i];
        if (std::max(f.width_m, f.height_m) > kLargestWall_m)
            report.lose("walls of more than 30 m: are their corners in metres?", 1,
                        fmt::format("'{}', {:.4g} x {:.4g} m", walls[i]->name, f.width_m, f.height_m));
        if (f.up.y < -0.7)
            report.lose("walls upside down: corners are given as seen by the viewer", 1,
                        "'" + walls[i]->name + "'");
        PixelRectangle const px = viewport_px(*walls[i], d.windows[std::size_t(walls[i]->window)]);
        double const shape = double(px.width) / f.width_m / (double(px.height) / f.height_m);
        bool const is_halved =
            walls[i]->stereo == StereoMode::side_by_side || walls[i]->stereo == StereoMode::top_bottom;
        if (!is_halved && !is_warped(*walls[i]) && (shape > 1.25 || shape < 0.8))
            report.lose("walls whose pixels are far from square", 1,
                        fmt::format("'{}', {:.3g} x {:.3g} m by {} x {} pixels", walls[i]->name, f.width_m,
                                    f.height_m, px.width, px.height));
        User const& user = d.users[std::size_t(walls[i]->user)];
        gi::dvec3 const eye = eyes_of(user, resting_head(user)).middle;
        double const away_m = glm::distance(eye, f.point(0.5, 0.5));
        if (place_of(eye, f) == EyePlace::behind)
            report.lose(
                "walls that the resting head is behind, dark until it moves: corners are given as seen by the "
                "viewer, lower left, lower right, upper left",
                1, fmt::format("'{}', user '{}'", walls[i]->name, user.name));
        else if (away_m > kFarHead * std::hypot(f.width_m, f.height_m))
            report.lose("resting heads far from a wall: are both in metres?", 1,
                        fmt::format("user '{}', {:.4g} m from '{}', which is {:.4g} x {:.4g} m", user.name, away_m,
                                    walls[i]->name, f.width_m, f.height_m));
    }
}

/// Windows of one process that cover each other on the desktop or on a monitor.
void report_covered_windows(Display const& d, gi::Report& report)
{
    std::set<std::array<int, 2>> opened; // rank, window
    for (Wall const& wall : d.walls)
        for (int const w : {wall.window, wall.second_window})
            if (w >= 0) opened.insert({wall.rank, w});
    for (auto a = opened.begin(); a != opened.end(); ++a)
        for (auto b = std::next(a); b != opened.end() && (*b)[0] == (*a)[0]; ++b) {
            DisplayWindow const &first = d.windows[std::size_t((*a)[1])],
                                &second = d.windows[std::size_t((*b)[1])];
            bool const is_covered =
                first.x_px < second.x_px + second.width_px && second.x_px < first.x_px + first.width_px &&
                first.y_px < second.y_px + second.height_px && second.y_px < first.y_px + first.height_px;
            if (first.monitor == second.monitor && is_covered)
                report.lose("windows that cover each other: give them other position_px or monitor", 1,
                            fmt::format("'{}' at ({}, {}) and '{}' at ({}, {})", first.name, first.x_px,
                                        first.y_px, second.name, second.x_px, second.y_px));
        }
}

} // namespace

void report_doubts(Display const& d, gi::Report& report)
{
    for (User const& u : d.users)
        if (u.interpupillary_m < kFewNarrower_m || u.interpupillary_m > kFewWider_m)
            report.lose("unusual interpupillary distances: most people's are 0.050 to 0.075 m", 1,
                        fmt::format("user '{}', {} m", u.name, u.interpupillary_m));
    std::set<int> used;
    for (Wall const& wall : d.walls) used.insert({wall.window, wall.second_window});
    for (std::size_t i = 0; i < d.windows.size(); ++i)
        if (!used.contains(int(i))) report.lose("windows without a wall, which stay dark", 1, d.windows[i].name);
    for (Wall const& wall : d.walls)
        if (wall.warp)
            if (MeshFlaws const flaws = find_flaws(*wall.warp); flaws.folded > 0)
                report.lose("meshes that fold over: a part is drawn twice", 1,
                            fmt::format("'{}', {} triangles, first in cell {} of row {}", wall.name, flaws.folded,
                                        flaws.first_fold.x, flaws.first_fold.y));
    report_covered_windows(d, report);
    std::vector<WallFrame> frames;
    std::vector<Wall const*> flat;
    for (Wall const& wall : d.walls)
        if (!wall.surface && !wall.warp_map) { // whose corners are those of its picture, not of the screen
            frames.push_back(wall_frame(wall.corners));
            flat.push_back(&wall);
        }
    report_sizes(flat, frames, d, report);
    report_gaps(flat, frames, report);
    for (std::size_t i = 0; i < frames.size(); ++i)
        if (frames[i].skew_deg > 0.01)
            report.lose("walls not quite rectangular, made rectangular", 1,
                        fmt::format("'{}', {:.3g} degrees", flat[i]->name, frames[i].skew_deg));
    for (std::size_t i = 0; i < frames.size(); ++i)
        for (std::size_t j = 0; j < frames.size(); ++j) {
            double const overlap_width = i == j ? 0 : overlap_m(frames[i], frames[j]);
            if (overlap_width < 1e-3 || flat[i]->blend_picture || flat[j]->blend_picture) continue;
            double const slack = 0.01 + 0.02 * overlap_width;
            if (std::abs(flat[i]->blend.right_m - overlap_width) > slack ||
                std::abs(flat[j]->blend.left_m - overlap_width) > slack)
                report.lose(
                    "walls whose overlap differs from their blend width", 1,
                    fmt::format("'{}' and '{}' overlap by {:.4g} m", flat[i]->name, flat[j]->name, overlap_width));
        }
}

} // namespace viewer
