#include "ar/markers/marker_map.h"

#include "gi/core/error.h"

#include <cmath>
#include <fmt/format.h>
#include <set>

namespace ar {
namespace {

struct DictionarySize {
    char const* name;
    int size;
};
constexpr DictionarySize kDictionaries[] = {
    {"DICT_4X4_50", 50},        {"DICT_4X4_100", 100},         {"DICT_4X4_250", 250},
    {"DICT_4X4_1000", 1000},    {"DICT_5X5_50", 50},           {"DICT_5X5_100", 100},
    {"DICT_5X5_250", 250},      {"DICT_5X5_1000", 1000},       {"DICT_6X6_50", 50},
    {"DICT_6X6_100", 100},      {"DICT_6X6_250", 250},         {"DICT_6X6_1000", 1000},
    {"DICT_7X7_50", 50},        {"DICT_7X7_100", 100},         {"DICT_7X7_250", 250},
    {"DICT_7X7_1000", 1000},    {"DICT_ARUCO_ORIGINAL", 1024}, {"DICT_APRILTAG_16h5", 30},
    {"DICT_APRILTAG_25h9", 35}, {"DICT_APRILTAG_36h10", 2320}, {"DICT_APRILTAG_36h11", 587},
};

constexpr double kLongest_m = 1000;

/// The corners of a square whose upper left corner is given: upper left, upper right, lower right, lower left.
std::array<glm::dvec3, 4> square_at(double left, double top, double side)
{
    return {{{left, top, 0}, {left + side, top, 0}, {left + side, top - side, 0}, {left, top - side, 0}}};
}

class Checker {
public:
    explicit Checker(std::string where) : where_(std::move(where)) {}
    void length(std::string const& what, double v_m) const
    {
        if (!(v_m > 0 && v_m <= kLongest_m))
            refuse(fmt::format("{} is {} m", what, v_m),
                   fmt::format("lengths are positive and at most {:g} m", kLongest_m), "measure it with a ruler");
    }
    void count(std::string const& what, int v, int least) const
    {
        if (v < least || v > kMostSquares)
            refuse(fmt::format("{} is {}", what, v), fmt::format("{} to {} are possible", least, kMostSquares),
                   "write how many are printed");
    }
    void pose(std::string const& what, gi::RigidPose const& p) const
    {
        if (!(std::abs(glm::length(p.rotation) - 1) < 1e-6))
            refuse(what + " has a rotation that is none", "the length of its quaternion is not 1", "normalise it");
        for (int i = 0; i < 3; ++i)
            if (!(std::abs(p.position[i]) <= kLongest_m))
                refuse(fmt::format("{} is {} m from the origin", what, p.position[i]),
                       fmt::format("at most {:g} m are possible", kLongest_m), "write metres");
    }
    void identifiers(std::string const& what, std::string const& dictionary, int first, int count)
    {
        int const size = dictionary_size(dictionary);
        if (size == 0)
            refuse(fmt::format("'{}' is no dictionary", dictionary.substr(0, 64)), "its codes are not known",
                   "write one of OpenCV's, such as DICT_4X4_50 or DICT_APRILTAG_36h11");
        if (first < 0 || first > size - count)
            refuse(fmt::format("{} has the identifiers {} to {}", what, first, first + count - 1),
                   fmt::format("{} has 0 to {}", dictionary, size - 1), "choose others or a larger dictionary");
        for (int id = first; id < first + count; ++id)
            if (!used_.insert({dictionary, id}).second)
                refuse(fmt::format("marker {} of {} is there twice", id, dictionary),
                       "a picture does not tell which of the two it shows", "print another identifier");
    }
    [[noreturn]] void refuse(std::string const& problem, std::string const& why, std::string const& do_this) const
    {
        throw gi::InputError(where_ + ": " + problem, why, do_this);
    }

private:
    std::string where_;
    std::set<std::pair<std::string, int>> used_;
};

} // namespace

int count_of(MarkerMap const& map) { return int(map.markers.size() + map.boards.size() + map.grids.size()); }

std::string describe(MarkerMap const& map, int thing)
{
    auto i = std::size_t(thing);
    if (i < map.markers.size())
        return fmt::format("marker {} of {}", map.markers[i].id, map.markers[i].dictionary);
    i -= map.markers.size();
    if (i < map.boards.size())
        return fmt::format("board {} ({} x {} squares)", i + 1, map.boards[i].squares_x, map.boards[i].squares_y);
    i -= map.boards.size();
    return fmt::format("grid {} ({} x {} markers)", i + 1, map.grids.at(i).markers_x, map.grids.at(i).markers_y);
}

gi::RigidPose world_from_thing(MarkerMap const& map, int thing)
{
    auto i = std::size_t(thing);
    if (i < map.markers.size()) return map.markers[i].world_from_marker;
    i -= map.markers.size();
    if (i < map.boards.size()) return map.boards[i].world_from_board;
    return map.grids.at(i - map.boards.size()).world_from_grid;
}

std::vector<std::string> const& dictionary_names()
{
    static std::vector<std::string> const names = [] {
        std::vector<std::string> all;
        for (auto const& d : kDictionaries) all.emplace_back(d.name);
        return all;
    }();
    return names;
}

int dictionary_size(std::string const& name)
{
    for (auto const& d : kDictionaries)
        if (name == d.name) return d.size;
    return 0;
}

bool is_black(CharucoBoard const& b, int column, int row)
{
    bool const white_first = b.legacy_pattern && b.squares_y % 2 == 0;
    return ((column + row) % 2 == 0) != white_first;
}

int marker_count(CharucoBoard const& b)
{
    int const all = b.squares_x * b.squares_y;
    return is_black(b, 0, 0) ? all / 2 : all - all / 2;
}

std::vector<glm::dvec3> inner_corners(CharucoBoard const& b)
{
    std::vector<glm::dvec3> corners;
    for (int row = 1; row < b.squares_y; ++row)
        for (int column = 1; column < b.squares_x; ++column)
            corners.emplace_back(column * b.square_m, (b.squares_y - row) * b.square_m, 0);
    return corners;
}

std::vector<PlacedMarker> placed_markers(MarkerMap const& map)
{
    std::vector<PlacedMarker> all;
    int thing = 0;
    for (Marker const& m : map.markers)
        all.push_back({thing++, m.dictionary, m.id, square_at(-0.5 * m.side_m, 0.5 * m.side_m, m.side_m)});
    for (CharucoBoard const& b : map.boards) {
        double const margin = 0.5 * (b.square_m - b.marker_m);
        int id = b.first_id;
        for (int row = 0; row < b.squares_y; ++row)
            for (int column = 0; column < b.squares_x; ++column)
                if (!is_black(b, column, row))
                    all.push_back({thing, b.dictionary, id++,
                                   square_at(column * b.square_m + margin,
                                             (b.squares_y - row) * b.square_m - margin, b.marker_m)});
        ++thing;
    }
    for (MarkerGrid const& g : map.grids) {
        double const step = g.marker_m + g.gap_m;
        int id = g.first_id;
        for (int row = 0; row < g.markers_y; ++row)
            for (int column = 0; column < g.markers_x; ++column)
                all.push_back({thing, g.dictionary, id++,
                               square_at(column * step, (g.markers_y - 1 - row) * step + g.marker_m, g.marker_m)});
        ++thing;
    }
    return all;
}

void check(MarkerMap const& map, std::string const& where)
{
    Checker checker(where);
    if (count_of(map) == 0)
        checker.refuse("there is no marker", "nothing can be recognised", "add a marker, a board or a grid");
    int thing = 0;
    for (Marker const& m : map.markers) {
        std::string const what = describe(map, thing++);
        checker.identifiers(what, m.dictionary, m.id, 1);
        checker.length("the side of " + what, m.side_m);
        checker.pose(what, m.world_from_marker);
    }
    for (CharucoBoard const& b : map.boards) {
        std::string const what = describe(map, thing++);
        checker.count("squares_x of " + what, b.squares_x, 2);
        checker.count("squares_y of " + what, b.squares_y, 2);
        checker.length("the squares' side of " + what, b.square_m);
        checker.length("the markers' side of " + what, b.marker_m);
        if (!(b.marker_m < b.square_m))
            checker.refuse(fmt::format("{} has markers of {} m in squares of {} m", what, b.marker_m, b.square_m),
                           "markers need white around them", "exchange the two or measure again");
        checker.identifiers(what, b.dictionary, b.first_id, marker_count(b));
        checker.pose(what, b.world_from_board);
    }
    for (MarkerGrid const& g : map.grids) {
        std::string const what = describe(map, thing++);
        checker.count("markers_x of " + what, g.markers_x, 1);
        checker.count("markers_y of " + what, g.markers_y, 1);
        checker.length("the markers' side of " + what, g.marker_m);
        checker.length("the gap of " + what, g.gap_m);
        checker.identifiers(what, g.dictionary, g.first_id, g.markers_x * g.markers_y);
        checker.pose(what, g.world_from_grid);
    }
}

} // namespace ar
