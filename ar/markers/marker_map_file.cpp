#include "ar/markers/marker_map_file.h"

#include "ar/markers/map_doubts.h"
#include "gi/core/durable_file.h"
#include "gi/core/file.h"
#include "gi/core/yaml.h"

#include <cmath>
#include <fmt/format.h>

namespace ar {
namespace {

constexpr double kFar_m = 1000;
constexpr int kMostIds = 100000;

gi::RigidPose read_pose(gi::Yaml const& y)
{
    gi::RigidPose p;
    if (y.has("position_m")) {
        auto const v = y.at("position_m").numbers(3, -kFar_m, kFar_m);
        p.position = {v[0], v[1], v[2]};
    }
    if (y.has("rotation_deg")) {
        gi::Yaml const r = y.at("rotation_deg");
        if (y.has("rotation_xyzw"))
            throw r.error(y.path() + " has rotation_deg and rotation_xyzw", "only one of them can count",
                          "remove one");
        auto const v = r.numbers(3, -360, 360);
        p.rotation = glm::normalize(glm::angleAxis(glm::radians(v[2]), glm::dvec3(0, 0, 1)) *
                                    glm::angleAxis(glm::radians(v[1]), glm::dvec3(0, 1, 0)) *
                                    glm::angleAxis(glm::radians(v[0]), glm::dvec3(1, 0, 0)));
    }
    if (y.has("rotation_xyzw")) {
        gi::Yaml const r = y.at("rotation_xyzw");
        auto const v = r.numbers(4, -1.1, 1.1);
        glm::dquat const q(v[3], v[0], v[1], v[2]);
        if (!(std::abs(glm::length(q) - 1) < 1e-3))
            throw r.error(fmt::format("the quaternion's length is {:g}", glm::length(q)), "that of rotations is 1",
                          "write x, y, z, w with w last; [0, 0, 0, 1] is no rotation");
        p.rotation = std::abs(glm::length(q) - 1) < 1e-12 ? q : glm::normalize(q);
    }
    return p;
}

std::string read_dictionary(gi::Yaml const& y)
{
    gi::Yaml const d = y.needed("dictionary", "DICT_4X4_50");
    std::string const name = d.text();
    if (dictionary_size(name) == 0)
        throw d.error(fmt::format("'{}' is no dictionary", name.substr(0, 64)), "its codes are not known",
                      fmt::format("there are: {}", fmt::join(dictionary_names(), ", ")));
    return name;
}

double read_length(gi::Yaml const& y, std::string const& key, std::string const& example)
{
    return y.needed(key, example).number(1e-6, kFar_m);
}

int read_first_id(gi::Yaml const& y) { return y.has("first_id") ? y.at("first_id").integer(0, kMostIds) : 0; }

/// Where `check` finds something wrong with the map so far, it is what was read last.
template <class Thing>
void add(std::vector<Thing>& things, Thing thing, MarkerMap const& map, gi::Yaml const& y)
{
    things.push_back(std::move(thing));
    gi::TextLocation const at = y.place();
    check(map, fmt::format("{}:{}:{}", at.file, at.line, at.column));
}

std::string text_of(gi::RigidPose const& p)
{
    std::string s;
    if (p.position != glm::dvec3(0))
        s += fmt::format(", position_m: [{}, {}, {}]", p.position.x, p.position.y, p.position.z);
    glm::dquat const q = p.rotation;
    if (q != glm::dquat(1, 0, 0, 0)) s += fmt::format(", rotation_xyzw: [{}, {}, {}, {}]", q.x, q.y, q.z, q.w);
    return s;
}

} // namespace

MarkerMap parse_marker_map(std::string const& text, std::string const& file)
{
    constexpr std::size_t kMostThings = 500;
    gi::Yaml const top = gi::Yaml::parse(text, file);
    top.only_keys({"markers", "boards", "grids"});
    MarkerMap map;
    if (top.has("markers"))
        for (gi::Yaml const& y : top.at("markers").items(0, kMostThings)) {
            y.only_keys({"dictionary", "id", "side_m", "position_m", "rotation_deg", "rotation_xyzw"});
            add(map.markers,
                {read_dictionary(y), int(y.needed("id", "0").integer(0, kMostIds)),
                 read_length(y, "side_m", "0.08"), read_pose(y)},
                map, y);
        }
    if (top.has("boards"))
        for (gi::Yaml const& y : top.at("boards").items(0, kMostThings)) {
            y.only_keys({"squares_x", "squares_y", "square_m", "marker_m", "dictionary", "first_id",
                         "legacy_pattern", "position_m", "rotation_deg", "rotation_xyzw"});
            CharucoBoard b;
            b.squares_x = y.needed("squares_x", "8").integer(2, kMostSquares);
            b.squares_y = y.needed("squares_y", "5").integer(2, kMostSquares);
            b.square_m = read_length(y, "square_m", "0.03");
            b.marker_m = read_length(y, "marker_m", "0.022");
            b.dictionary = read_dictionary(y);
            b.first_id = read_first_id(y);
            if (y.has("legacy_pattern")) b.legacy_pattern = y.at("legacy_pattern").boolean();
            b.world_from_board = read_pose(y);
            add(map.boards, b, map, y);
        }
    if (top.has("grids"))
        for (gi::Yaml const& y : top.at("grids").items(0, kMostThings)) {
            y.only_keys({"markers_x", "markers_y", "marker_m", "gap_m", "dictionary", "first_id", "position_m",
                         "rotation_deg", "rotation_xyzw"});
            MarkerGrid g;
            g.markers_x = y.needed("markers_x", "2").integer(1, kMostSquares);
            g.markers_y = y.needed("markers_y", "3").integer(1, kMostSquares);
            g.marker_m = read_length(y, "marker_m", "0.05");
            g.gap_m = read_length(y, "gap_m", "0.01");
            g.dictionary = read_dictionary(y);
            g.first_id = read_first_id(y);
            g.world_from_grid = read_pose(y);
            add(map.grids, g, map, y);
        }
    if (count_of(map) == 0)
        throw top.error("there is no marker", "nothing can be recognised", "add a marker, a board or a grid");
    return map;
}

std::string format_marker_map(MarkerMap const& map)
{
    std::string s;
    if (!map.markers.empty()) s += "markers:\n";
    for (Marker const& m : map.markers)
        s += fmt::format("  - {{dictionary: {}, id: {}, side_m: {}{}}}\n", m.dictionary, m.id, m.side_m,
                         text_of(m.world_from_marker));
    if (!map.boards.empty()) s += "boards:\n";
    for (CharucoBoard const& b : map.boards)
        s += fmt::format(
            "  - {{squares_x: {}, squares_y: {}, square_m: {}, marker_m: {}, dictionary: {}, first_id: {}, "
            "legacy_pattern: {}{}}}\n",
            b.squares_x, b.squares_y, b.square_m, b.marker_m, b.dictionary, b.first_id, b.legacy_pattern,
            text_of(b.world_from_board));
    if (!map.grids.empty()) s += "grids:\n";
    for (MarkerGrid const& g : map.grids)
        s += fmt::format(
            "  - {{markers_x: {}, markers_y: {}, marker_m: {}, gap_m: {}, dictionary: {}, first_id: {}{}}}\n",
            g.markers_x, g.markers_y, g.marker_m, g.gap_m, g.dictionary, g.first_id, text_of(g.world_from_grid));
    return s;
}

MarkerMap read_marker_map(std::filesystem::path const& file, gi::Report* report)
{
    MarkerMap const map = parse_marker_map(gi::read_text(file), file.string());
    if (report != nullptr) report_doubts(map, file.string(), *report);
    return map;
}

void write_marker_map(std::filesystem::path const& file, MarkerMap const& map)
{
    check(map, file.string());
    gi::write_durably(file, format_marker_map(map));
}

} // namespace ar
