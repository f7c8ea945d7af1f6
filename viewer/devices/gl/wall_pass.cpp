#include "viewer/devices/gl/wall_pass.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace viewer {
namespace {

void check_mesh(WarpMesh const& mesh)
{
    std::size_t const wanted = std::size_t(std::max(mesh.columns, 0)) * std::size_t(std::max(mesh.rows, 0));
    if (mesh.columns < 2 || mesh.rows < 2 || mesh.vertices.size() != wanted)
        throw gi::InputError(
            fmt::format("a warp mesh of {} x {} with {} vertices", mesh.columns, mesh.rows, mesh.vertices.size()),
            "it needs at least 2 x 2, and columns times rows of them", "give all vertices, rows from the lowest");
    for (WarpVertex const& v : mesh.vertices)
        if (!std::isfinite(v.position.x + v.position.y + v.picture.x + v.picture.y) ||
            !(v.weight >= 0 && v.weight <= 1))
            throw gi::InputError("a vertex of a warp mesh is not finite or its weight is not in 0 to 1",
                                 "such a vertex cannot be drawn", "correct the mesh");
}

void check_blend(WallSettings const& s)
{
    EdgeBlend const& b = s.blend;
    for (auto const& [one, other] : {std::pair{b.left, b.right}, {b.bottom, b.top}})
        if (!(one >= 0 && other >= 0 && one + other <= 1))
            throw gi::InputError(fmt::format("edge blends of {} and {} of the picture", one, other),
                                 "each is at least 0 and both together at most 1", "give the overlaps in parts");
    if (!(b.power > 0) || !std::isfinite(b.power))
        throw gi::InputError(fmt::format("an edge blend with the power {}", b.power), "it defines no fading",
                             "give a positive one; 2 is usual");
    for (int k = 0; k < 3; ++k) {
        if (!(s.gain[k] >= 0) || !std::isfinite(s.gain[k]))
            throw gi::InputError(fmt::format("a colour gain of {}", s.gain[k]), "light is multiplied by it",
                                 "give a number from 0");
        if (!(s.gamma[k] > 0) || !std::isfinite(s.gamma[k]))
            throw gi::InputError(fmt::format("a display gamma of {}", s.gamma[k]), "it is an exponent",
                                 "give a positive number; 2.2 is usual");
    }
    for (auto const& [map, is_light] :
         {std::pair{s.blend_map.get(), true}, {s.black_level.get(), true}, {s.positions.get(), false}}) {
        if (!map) continue;
        bool const fits = map->width > 0 && map->height > 0 &&
                          map->values.size() == std::size_t(map->width) * std::size_t(map->height);
        auto const is_share = [](glm::vec3 const& v) {
            return glm::all(glm::greaterThanEqual(v, glm::vec3(0))) &&
                   glm::all(glm::lessThanEqual(v, glm::vec3(1)));
        };
        if (!fits || (is_light && !std::ranges::all_of(map->values, is_share)))
            throw gi::InputError(
                fmt::format("a map of {} x {} with {} values", map->width, map->height, map->values.size()),
                "it needs one per pixel, shares of light within 0 to 1", "correct the map");
    }
}

/// A texture of a map, or of the single value `otherwise`.
GlObject map_texture(PixelMap const* map, glm::vec3 otherwise)
{
    glm::ivec2 const size = map ? glm::ivec2(map->width, map->height) : glm::ivec2(1);
    GlObject texture = texture_2d(GL_RGB32F, size, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(texture.id(), 0, 0, 0, size.x, size.y, GL_RGB, GL_FLOAT,
                        map ? map->values.data() : &otherwise);
    return texture;
}

/// Places in the picture from its lower left, and 1 where there is one: (0, 0, 0) where there is none, so that the
/// sum of neighbours over the sum of their third numbers is the mean of those that are there.
PixelMap places_of(PixelMap const& positions)
{
    PixelMap places = positions;
    for (glm::vec3& v : places.values) v = has_value(v) ? glm::vec3(v.x, 1 - v.y, 1) : glm::vec3(0);
    return places;
}

std::vector<unsigned> grid_triangles(int columns, int rows)
{
    std::vector<unsigned> out;
    for (int y = 0; y + 1 < rows; ++y)
        for (int x = 0; x + 1 < columns; ++x) {
            auto const a = unsigned(y * columns + x), above = a + unsigned(columns);
            for (unsigned const i : {a, a + 1, above, above, a + 1, above + 1}) out.push_back(i);
        }
    return out;
}

WallSettings const& checked(WallSettings const& settings)
{
    check_mesh(settings.mesh);
    check_blend(settings);
    return settings;
}

} // namespace

WallPass::WallPass(WallSettings const& settings)
    : settings_(checked(settings)),
      program_({"wall.vert"}, {"tone_map.glsl", "bilinear.glsl", "wall.frag"},
               "#define CURVE 0\n#define CURVE_FILMIC 1\n")
{
    auto const& vertices = settings_.mesh.vertices;
    glNamedBufferStorage(buffer_.id(), GLsizeiptr(vertices.size() * sizeof(WarpVertex)), vertices.data(), 0);
    auto const indices = grid_triangles(settings_.mesh.columns, settings_.mesh.rows);
    index_count_ = int(indices.size());
    glNamedBufferStorage(indices_.id(), GLsizeiptr(indices.size() * sizeof(unsigned)), indices.data(), 0);
    glVertexArrayVertexBuffer(vertices_.id(), 0, buffer_.id(), 0, sizeof(WarpVertex));
    glVertexArrayElementBuffer(vertices_.id(), indices_.id());
    auto const attribute = [&](GLuint index, GLint size, std::size_t offset) {
        glEnableVertexArrayAttrib(vertices_.id(), index);
        glVertexArrayAttribFormat(vertices_.id(), index, size, GL_FLOAT, GL_FALSE, GLuint(offset));
        glVertexArrayAttribBinding(vertices_.id(), index, 0);
    };
    attribute(0, 2, offsetof(WarpVertex, position));
    attribute(1, 2, offsetof(WarpVertex, picture));
    attribute(2, 1, offsetof(WarpVertex, weight));

    map_ = map_texture(settings_.blend_map.get(), glm::vec3(1));
    black_ = map_texture(settings_.black_level.get(), glm::vec3(0));
    std::optional<PixelMap> places;
    if (settings_.positions) places = places_of(*settings_.positions);
    positions_ = map_texture(places ? &*places : nullptr, glm::vec3(0));
    program_.set("has_positions", settings_.positions ? 1.0f : 0.0f);
    program_.set("has_black_level", settings_.black_level ? 1.0f : 0.0f);

    EdgeBlend const& b = settings_.blend;
    program_.set("overlap", glm::vec4(b.left, b.right, b.bottom, b.top));
    program_.set("power", b.power);
    program_.set("gain", settings_.gain);
    program_.set("gamma", settings_.gamma);
}

void WallPass::draw(DrawTarget const& target, ShownPicture const& encoded, Outside outside) const
{
    if (encoded.texture == 0)
        throw gi::InputError("a wall has no picture", "there is nothing to warp", "draw the eye's picture first");
    bind(target);
    // Clear only this rectangle, because other walls share the window.
    glEnable(GL_SCISSOR_TEST);
    glScissor(target.corner_px.x, target.corner_px.y, target.size_px.x, target.size_px.y);
    glClearColor(0, 0, 0, 1);
    if (outside == Outside::black) glClear(GL_COLOR_BUFFER_BIT);
    program_.set("up", target.rows == RowOrder::top_last ? 1.0f : -1.0f);
    glBindTextureUnit(0, encoded.texture);
    glBindTextureUnit(1, map_.id());
    glBindTextureUnit(2, black_.id());
    glBindTextureUnit(3, positions_.id());
    program_.use();
    glBindVertexArray(vertices_.id());
    glDrawElements(GL_TRIANGLES, index_count_, GL_UNSIGNED_INT, nullptr);
    glDisable(GL_SCISSOR_TEST);
}

} // namespace viewer
