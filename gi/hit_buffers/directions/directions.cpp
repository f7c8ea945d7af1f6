#include "gi/hit_buffers/directions/directions.h"

#include "gi/core/error.h"
#include "gi/core/radical_inverse.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <fmt/format.h>
#include <functional>

namespace gi {
namespace {

constexpr std::size_t kMostDirections = 1u << 16;

using Triangle = std::array<dvec3, 3>;

/// The winding of the corners does not matter, as only centres are used.
std::vector<Triangle> subdivide(std::vector<Triangle> faces, int levels)
{
    for (int level = 0; level < levels; ++level) {
        std::vector<Triangle> finer;
        for (auto const& [a, b, c] : faces) {
            dvec3 const ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        faces = std::move(finer);
    }
    return faces;
}

std::vector<dvec3> centers(std::vector<Triangle> const& faces)
{
    std::vector<dvec3> out;
    for (auto const& [a, b, c] : faces) out.push_back(glm::normalize(a + b + c));
    return out;
}

/// Keeps one of each two opposite directions: the one that points up (then right, then forwards).
std::vector<dvec3> fold(std::vector<dvec3> const& directions)
{
    std::vector<dvec3> axes;
    for (dvec3 const d : directions) {
        constexpr double kZero = 1e-12;
        double const sign = std::abs(d.z) > kZero ? d.z : std::abs(d.x) > kZero ? d.x : d.y;
        if (sign > 0) axes.push_back(d);
    }
    return axes;
}

std::vector<Triangle> octahedron()
{
    std::vector<Triangle> faces;
    for (int x : {1, -1})
        for (int y : {1, -1})
            for (int z : {1, -1}) faces.push_back({dvec3(x, 0, 0), dvec3(0, y, 0), dvec3(0, 0, z)});
    return faces;
}

std::vector<Triangle> tetrahedron()
{
    double const s = 1 / std::sqrt(3.0);
    std::array<dvec3, 4> const v{dvec3(s, s, s), dvec3(s, -s, -s), dvec3(-s, s, -s), dvec3(-s, -s, s)};
    return {{v[0], v[1], v[2]}, {v[0], v[1], v[3]}, {v[0], v[2], v[3]}, {v[1], v[2], v[3]}};
}

std::vector<Triangle> icosahedron()
{
    // Corners are the cyclic permutations of (0, +-1, +-golden);
    // three of them form a face if they are nearest neighbours.
    double const golden = 0.5 * (1 + std::sqrt(5.0));
    std::vector<dvec3> v;
    for (double const a : {1.0, -1.0})
        for (double const b : {golden, -golden})
            v.insert(v.end(), {glm::normalize(dvec3(0, a, b)), glm::normalize(dvec3(a, b, 0)),
                               glm::normalize(dvec3(b, 0, a))});
    double const edge = 2 / std::sqrt(1 + golden * golden) * 1.001;
    auto const near = [&](std::size_t i, std::size_t j) { return glm::distance(v[i], v[j]) < edge; };
    std::vector<Triangle> faces;
    for (std::size_t i = 0; i < v.size(); ++i)
        for (std::size_t j = i + 1; j < v.size(); ++j)
            for (std::size_t k = j + 1; k < v.size(); ++k)
                if (near(i, j) && near(j, k) && near(i, k)) faces.push_back({v[i], v[j], v[k]});
    return faces;
}

/// A quadrant of the hemisphere in `rows` bands of equal latitude; band i has 2 i + 1 triangles (fig. 3.4).
std::vector<dvec3> uv_grid(int rows)
{
    auto const corner = [&](int row, int column) {
        double const theta = 0.5 * kPiD * row / rows;
        double const phi = row > 0 ? 0.5 * kPiD * column / row : 0;
        return dvec3(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
    };
    std::vector<dvec3> out;
    for (int quadrant = 0; quadrant < 4; ++quadrant) {
        std::vector<Triangle> faces;
        for (int i = 0; i < rows; ++i) {
            for (int k = 0; k <= i; ++k) faces.push_back({corner(i, k), corner(i + 1, k), corner(i + 1, k + 1)});
            for (int k = 0; k < i; ++k) faces.push_back({corner(i, k), corner(i, k + 1), corner(i + 1, k + 1)});
        }
        for (dvec3 const d : centers(faces)) {
            std::array<dvec3, 4> const turned{d, {-d.y, d.x, d.z}, {-d.x, -d.y, d.z}, {d.y, -d.x, d.z}};
            out.push_back(turned[std::size_t(quadrant)]);
        }
    }
    return out;
}

dvec3 on_half_sphere(double u, double v)
{
    double const r = std::sqrt(std::max(0.0, 1 - u * u));
    return {r * std::cos(2 * kPiD * v), r * std::sin(2 * kPiD * v), u};
}

std::vector<dvec3> halton(std::size_t axes)
{
    std::vector<dvec3> out;
    for (std::size_t i = 1; i <= axes; ++i)
        out.push_back(on_half_sphere(radical_inverse(i, 2), radical_inverse(i, 3)));
    return out;
}

/// Keinert et al. 2015, "Spherical Fibonacci Mapping", on a hemisphere.
std::vector<dvec3> fibonacci(std::size_t axes)
{
    double const golden = 0.5 * (1 + std::sqrt(5.0));
    std::vector<dvec3> out;
    for (std::size_t i = 0; i < axes; ++i) {
        double const turns = double(i) / golden;
        out.push_back(on_half_sphere((double(i) + 0.5) / double(axes), turns - std::floor(turns)));
    }
    return out;
}

struct Family {
    char const* name;
    std::vector<std::size_t> counts; ///< empty = all even counts
    std::function<std::vector<dvec3>(std::size_t count, int step)> axes;
};

std::vector<std::size_t> powers(std::size_t base)
{
    std::vector<std::size_t> counts;
    for (std::size_t n = base; n <= kMostDirections; n *= 4) counts.push_back(n);
    return counts;
}

std::vector<std::size_t> squares()
{
    std::vector<std::size_t> counts;
    for (std::size_t l = 1; 8 * l * l <= kMostDirections; ++l) counts.push_back(8 * l * l);
    return counts;
}

std::vector<Family> families()
{
    auto const solid = [](std::vector<Triangle> (*faces)()) {
        return [faces](std::size_t, int level) { return fold(centers(subdivide(faces(), level))); };
    };
    return {{"icosahedron", powers(20), solid(icosahedron)},
            {"octahedron", powers(8), solid(octahedron)},
            // No two faces of a tetrahedron are opposite to each other, so each direction is an axis.
            {"tetrahedron", powers(8),
             [](std::size_t, int level) { return centers(subdivide(tetrahedron(), level)); }},
            {"uv_grid", squares(), [](std::size_t, int row) { return uv_grid(row + 1); }},
            {"halton", {}, [](std::size_t count, int) { return halton(count / 2); }},
            {"fibonacci", {}, [](std::size_t count, int) { return fibonacci(count / 2); }}};
}

} // namespace

DirectionSet make_directions(std::string const& name)
{
    auto const bad = [&](std::string const& why, std::string const& suggestion) {
        return InputError("there are no directions '" + name.substr(0, 64) + "'", why, suggestion);
    };
    std::size_t const colon = name.find(':');
    std::size_t count = 0;
    if (colon != std::string::npos) {
        auto const [end, error] = std::from_chars(name.data() + colon + 1, name.data() + name.size(), count);
        if (error != std::errc{} || end != name.data() + name.size()) count = 0;
    }
    if (count < 2 || count > kMostDirections)
        throw bad(fmt::format("a set is FAMILY:COUNT with 2 to {} directions", kMostDirections),
                  "try icosahedron:320");
    for (Family const& family : families()) {
        if (name.substr(0, colon) != family.name) continue;
        int step = 0;
        if (family.counts.empty()) {
            if (count % 2 != 0) throw bad("every direction needs its opposite", "choose an even count");
        } else {
            auto const nearest = std::ranges::min_element(
                family.counts, {}, [&](std::size_t c) { return std::abs(double(c) - double(count)); });
            if (*nearest != count)
                throw bad("that family has other counts",
                          fmt::format("the nearest is {}:{}", family.name, *nearest));
            step = int(nearest - family.counts.begin());
        }
        return {name, family.axes(count, step)};
    }
    std::string known;
    for (Family const& family : families()) known += (known.empty() ? "" : ", ") + std::string(family.name);
    throw bad("no family has that name", "choose " + known);
}

} // namespace gi
