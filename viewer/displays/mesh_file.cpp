#include "viewer/displays/mesh_file.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>
#include <string_view>

namespace viewer {
namespace {

struct MeshLine {
    std::vector<std::string_view> words;
    int number = 0;
};

/// Lines that are neither empty nor comments.
std::vector<MeshLine> lines_of(std::string const& text)
{
    std::vector<MeshLine> lines;
    int number = 0;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t const end = std::min(text.find('\n', at), text.size());
        std::string_view const line = std::string_view(text).substr(at, end - at);
        at = end + 1;
        ++number;
        MeshLine out{{}, number};
        for (std::size_t i = 0; (i = line.find_first_not_of(" \t\r", i)) != std::string_view::npos;) {
            std::size_t const stop = std::min(line.find_first_of(" \t\r", i), line.size());
            out.words.push_back(line.substr(i, stop - i));
            i = stop;
        }
        if (!out.words.empty() && !out.words[0].starts_with('#')) lines.push_back(std::move(out));
    }
    return lines;
}

struct MeshReader {
    std::string name;
    double aspect = 1;

    gi::InputError error(MeshLine const& line, std::string const& problem) const
    {
        return {
            {name, line.number, 0},
            problem,
            "the mesh cannot be read",
            std::filesystem::path(name).extension() == ".obj"
                ? "correct this line: v X Y, vt U V, or f with three vertices or more"
            : std::filesystem::path(name).extension() == ".csv"
                ? "correct this line: X;Y;U;V;COLUMN;ROW"
                : "correct this line: type, then columns and rows, then X Y U V WEIGHT of a node in each line"};
    }
    double number(MeshLine const& line, std::size_t word) const
    {
        auto const value =
            word < line.words.size() ? gi::parse_finite(std::string(line.words[word])) : std::optional<double>();
        if (!value || std::abs(*value) > 1e6)
            throw error(line, fmt::format("number {} of the line is missing or no number", word + 1));
        return *value;
    }
    static double tidy(double t)
    {
        constexpr double kSlack = 2e-3; // exported with few digits
        return t < 0 && t > -kSlack ? 0 : t > 1 && t < 1 + kSlack ? 1 : t;
    }
    WarpNode node(double x, double y, double u, double v, double weight) const
    {
        return {{(x / aspect + 1) / 2, (y + 1) / 2}, {tidy(u), tidy(v)}, weight};
    }
};

WallMesh bourke_mesh(std::vector<MeshLine> const& lines, MeshReader const& r)
{
    if (lines.size() < 2)
        throw gi::InputError({r.name, 1, 0}, "no mesh", "type and size are missing",
                             "begin with a line for the type, and one for columns and rows");
    WallMesh mesh;
    double const columns = r.number(lines[1], 0), rows = r.number(lines[1], 1);
    if (!(columns >= 2 && columns <= kMostWarpNodes && rows >= 2 && rows <= kMostWarpNodes))
        throw r.error(lines[1],
                      fmt::format("a mesh of {} x {} nodes; 2 to {} are handled", columns, rows, kMostWarpNodes));
    mesh.columns = int(columns);
    mesh.rows = int(rows);
    std::size_t const count = std::size_t(mesh.columns) * std::size_t(mesh.rows);
    if (lines.size() != count + 2)
        throw r.error(lines.back(), fmt::format("{} nodes instead of {}", lines.size() - 2, count));
    constexpr double kGamma = 2.2; // its intensities multiply values, ours light
    for (std::size_t i = 2; i < lines.size(); ++i) {
        MeshLine const& l = lines[i];
        double const intensity = std::clamp(l.words.size() > 4 ? r.number(l, 4) : 1.0, 0.0, 1.0);
        mesh.nodes.push_back(r.node(r.number(l, 0), r.number(l, 1), r.number(l, 2), r.number(l, 3),
                                    intensity == 1 ? 1 : std::pow(intensity, kGamma)));
    }
    return mesh;
}

/// Index of the vertex of "12", "12/12" or "12/12/3", from 0.
std::size_t vertex_of(MeshLine const& line, std::size_t word, std::size_t count, MeshReader const& r)
{
    std::string_view const text = line.words[word];
    auto const value = gi::parse_finite(std::string(text.substr(0, text.find('/'))));
    if (!value || *value < 1 || *value > double(count) || *value != std::floor(*value))
        throw r.error(line, fmt::format("'{}' is no vertex", text.substr(0, 32)));
    return std::size_t(*value) - 1;
}

WallMesh obj_mesh(std::vector<MeshLine> const& lines, MeshReader const& r)
{
    std::vector<glm::dvec2> places, pictures;
    std::vector<std::pair<MeshLine const*, std::set<std::size_t>>> faces;
    for (MeshLine const& l : lines) {
        if (l.words[0] == "v") places.push_back({r.number(l, 1), r.number(l, 2)});
        if (l.words[0] == "vt") pictures.push_back({r.number(l, 1), r.number(l, 2)});
        if (l.words[0] != "f") continue;
        std::set<std::size_t> corners;
        for (std::size_t w = 1; w < l.words.size(); ++w) corners.insert(vertex_of(l, w, places.size(), r));
        if (corners.size() < 3) throw r.error(l, "a face with fewer than three vertices");
        faces.push_back({&l, corners});
    }
    if (faces.empty() || places.size() != pictures.size())
        throw gi::InputError({r.name, 1, 0},
                             fmt::format("{} faces, {} vertices, {} places in the picture", faces.size(),
                                         places.size(), pictures.size()),
                             "each vertex of a mesh has one place in the picture",
                             "switch texture coordinates on when it is exported: vt lines, one for each vertex");
    // A face of a grid with c columns joins vertices whose numbers differ by at most c + 1.
    auto const spread = [](std::set<std::size_t> const& s) { return *s.rbegin() - *s.begin(); };
    std::size_t columns = 0;
    for (auto const& [line, corners] : faces) columns = std::max(columns, spread(corners));
    for (std::size_t const c : {columns - 1, columns})
        if (c >= 2 && c <= std::size_t(kMostWarpNodes) && places.size() % c == 0 &&
            places.size() / c <= std::size_t(kMostWarpNodes)) {
            auto const is_cell = [&](std::set<std::size_t> const& corners) {
                std::size_t column = c, row = places.size();
                for (std::size_t const i : corners) {
                    column = std::min(column, i % c);
                    row = std::min(row, i / c);
                }
                return std::ranges::all_of(corners,
                                           [&](std::size_t i) { return i % c - column <= 1 && i / c - row <= 1; });
            };
            auto const odd = std::ranges::find_if(faces, [&](auto const& f) { return !is_cell(f.second); });
            if (odd != faces.end()) continue;
            WallMesh mesh{int(c), int(places.size() / c), {}};
            for (std::size_t i = 0; i < places.size(); ++i)
                mesh.nodes.push_back(r.node(places[i].x, places[i].y, pictures[i].x, pictures[i].y, 1));
            return mesh;
        }
    throw gi::InputError({r.name, faces[0].first->number, 0}, "the faces are no grid",
                         "a warp mesh has columns and rows of nodes", "export a grid, row by row");
}

WallMesh csv_mesh(std::vector<MeshLine> lines, MeshReader const& r)
{
    if (!lines.empty() && !gi::parse_finite(lines[0].words[0])) lines.erase(lines.begin()); // titles
    if (lines.empty())
        throw gi::InputError({r.name, 1, 0}, "no mesh", "it has no nodes", "X;Y;U;V;COLUMN;ROW in each line");
    auto const index = [&](MeshLine const& l, std::size_t word) {
        double const value = r.number(l, word);
        if (!(value >= 0 && value < kMostWarpNodes) || value != std::floor(value))
            throw r.error(l,
                          fmt::format("number {} is no column or row from 0 to {}", word + 1, kMostWarpNodes - 1));
        return int(value);
    };
    WallMesh mesh;
    for (MeshLine const& l : lines) {
        mesh.columns = std::max(mesh.columns, index(l, 4) + 1);
        mesh.rows = std::max(mesh.rows, index(l, 5) + 1);
    }
    std::size_t const count = std::size_t(mesh.columns) * std::size_t(mesh.rows);
    if (lines.size() != count)
        throw r.error(lines.back(), fmt::format("{} nodes; {} columns and {} rows have {}", lines.size(),
                                                mesh.columns, mesh.rows, count));
    mesh.nodes.resize(count);
    std::vector<char> is_there(count);
    for (MeshLine const& l : lines) {
        std::size_t const at =
            std::size_t(mesh.rows - 1 - index(l, 5)) * std::size_t(mesh.columns) + std::size_t(index(l, 4));
        if (is_there[at]) throw r.error(l, "a second node of this column and row");
        is_there[at] = 1;
        mesh.nodes[at] = {{r.number(l, 0), 1 - r.number(l, 1)},
                          {r.tidy(r.number(l, 2)), r.tidy(1 - r.number(l, 3))}};
    }
    return mesh;
}

} // namespace

bool is_mesh_file(std::filesystem::path const& file)
{
    std::string const kind = file.extension().string();
    return kind == ".data" || kind == ".obj" || kind == ".csv";
}

WallMesh parse_mesh_file(std::string const& text, std::string const& name, double aspect)
{
    std::string const kind = std::filesystem::path(name).extension().string();
    if (!is_mesh_file(name))
        throw gi::InputError({name, 0, 0}, "a mesh of kind '" + kind.substr(0, 16) + "'",
                             "meshes of Bourke (.data) and domeprojection (.csv) and grids in .obj are read",
                             "convert it");
    MeshReader const reader{name, aspect};
    std::string plain = text;
    if (kind == ".csv") std::ranges::replace(plain, ';', ' ');
    WallMesh mesh = kind == ".data"  ? bourke_mesh(lines_of(plain), reader)
                    : kind == ".csv" ? csv_mesh(lines_of(plain), reader)
                                     : obj_mesh(lines_of(plain), reader);
    if (auto const fault = find_fault(mesh))
        throw gi::InputError({name, 0, 0}, *fault, "the picture would be torn",
                             "write nodes row by row from below, each to the right of the one before");
    return mesh;
}

WallMesh load_mesh_file(std::filesystem::path const& file, double aspect)
{
    if (!is_mesh_file(file)) return parse_mesh_file("", file.string(), aspect);
    auto const bytes = gi::read_bytes(file, std::size_t(1) << 24);
    return parse_mesh_file({bytes.begin(), bytes.end()}, file.string(), aspect);
}

} // namespace viewer
