#include "viewer/devices/gl/surface_pass.h"

#include <epoxy/gl.h>
#include <tbb/parallel_for.h>

namespace viewer {

SurfacePass::SurfacePass(Surface const& surface)
    : surface_(surface),
      program_({"full_screen.vert"}, {"tone_map.glsl", "bilinear.glsl", "surface.frag"},
               "#define CURVE 0\n#define CURVE_FILMIC 1\n"),
      points_(texture_2d(GL_RGBA32F, {1, 1}, GL_NEAREST))
{
}

void SurfacePass::find_points(glm::ivec2 px)
{
    std::vector<glm::vec4> points(std::size_t(px.x) * std::size_t(px.y), glm::vec4(0, 0, 0, -1));
    tbb::parallel_for(0, px.y, [&](int y) {
        for (int x = 0; x < px.x; ++x)
            if (auto const p =
                    surface_point(surface_, double(px.x) / px.y, {(x + 0.5) / px.x, 1 - (y + 0.5) / px.y}))
                points[std::size_t(y) * std::size_t(px.x) + std::size_t(x)] =
                    glm::vec4(glm::vec3(p->at), p->is_direction ? 0 : 1);
    });
    points_ = texture_2d(GL_RGBA32F, px, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(points_.id(), 0, 0, 0, px.x, px.y, GL_RGBA, GL_FLOAT, points.data());
    points_px_ = px;
}

void SurfacePass::draw(DrawTarget const& target, std::span<ShownFace const> faces, gi::dvec3 eye)
{
    if (target.size_px.x < 1 || target.size_px.y < 1) return;
    if (points_px_ != target.size_px) find_points(target.size_px);
    bind(target);
    program_.set("eye", glm::vec3(eye));
    program_.set("cube_from_room", glm::mat3(glm::transpose(glm::mat3_cast(pose_of(surface_.place).rotation))));
    program_.set("corner_px", glm::vec2(target.corner_px));
    program_.set("size_px", glm::vec2(target.size_px));
    program_.set("is_top_last", target.rows == RowOrder::top_last ? 1.0f : 0.0f);
    glBindTextureUnit(0, points_.id());
    for (CubeFace const face : kCubeFaces) {
        glm::vec4 tangents(0);
        unsigned texture = 0;
        for (ShownFace const& f : faces)
            if (f.face == face && f.picture.texture != 0) {
                tangents = {float(f.tangents.left), float(f.tangents.right), float(f.tangents.bottom),
                            float(f.tangents.top)};
                texture = f.picture.texture;
            }
        program_.set((std::string("tangents_") + name_of(face)).c_str(), tangents);
        glBindTextureUnit(1 + unsigned(face), texture);
    }
    program_.use();
    glBindVertexArray(vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    for (unsigned unit = 0; unit <= kCubeFaces.size(); ++unit) glBindTextureUnit(unit, 0);
    glBindVertexArray(0);
}

} // namespace viewer
