// The picture of a dome on the GPU against the reference on the CPU, pixel by pixel.

#include "tests/viewer_display/face_pictures.h"
#include "tests/viewer_gl/surfaceless.h"
#include "viewer/devices/gl/surface_pass.h"

#include <epoxy/gl.h>

namespace viewer::test {
namespace {

using SurfaceOnGpu = Surfaceless;
using Format = TextureTarget::Format;

/// Stripes and gradients, so that every displacement shows.
BytePicture pattern(FaceView const& face)
{
    BytePicture p{face.width_px, face.height_px, {}};
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x)
            for (int const v : {x * 3 % 256, y * 5 % 256, int(face.face) * 40 + (x + y) % 32})
                p.rgb.push_back(static_cast<unsigned char>(v));
    return p;
}

GlObject texture_of(BytePicture const& p)
{
    GlObject t = texture_2d(GL_RGBA8, {p.width, p.height}, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTextureSubImage2D(t.id(), 0, 0, 0, p.width, p.height, GL_RGB, GL_UNSIGNED_BYTE, p.rgb.data());
    return t;
}

void expect_as_on_cpu(Surface const& surface, glm::ivec2 px, gi::dvec3 eye)
{
    auto const faces = faces_for(surface, px, std::vector{eye}, 96);
    std::vector<BytePicture> pictures;
    std::vector<GlObject> textures;
    std::vector<ShownFace> shown;
    for (FaceView const& face : faces) {
        pictures.push_back(pattern(face));
        textures.push_back(texture_of(pictures.back()));
        shown.push_back({face.face, face.tangents, {textures.back().id(), {face.width_px, face.height_px}}});
    }
    SurfacePass pass(surface);
    TextureTarget const out(Format::bytes, px);
    pass.draw(out.target(), shown, eye);
    auto const gpu = read_bytes(out.target());
    BytePicture const cpu = resample(surface, px, eye, faces, pictures);
    ASSERT_EQ(gpu.size(), cpu.rgb.size());
    // Patterns wrap around: a pixel beside a jump differs by the jump times the error of the position.
    std::size_t different = 0, lit = 0;
    for (std::size_t i = 0; i < gpu.size(); ++i) {
        different += std::abs(int(gpu[i]) - int(cpu.rgb[i])) > 2;
        lit += cpu.rgb[i] > 0;
    }
    EXPECT_LT(double(different), 0.002 * double(gpu.size())) << name_of(surface.type);
    EXPECT_GT(double(lit), 0.3 * double(gpu.size()));
}

TEST_F(SurfaceOnGpu, IsThatOfTheCpu)
{
    Surface s;
    s.place = {{0.1, 1, 0.2}, {70, 10, 5}};
    s.radius_m = 3;
    s.fov_deg = 220;
    expect_as_on_cpu(s, {160, 120}, {0.5, 1.4, 0});
    s.type = SurfaceType::equirectangular;
    s.radius_m = 0;
    expect_as_on_cpu(s, {160, 80}, {0, 0, 0});
    s.type = SurfaceType::cylindrical;
    s.radius_m = 2;
    expect_as_on_cpu(s, {160, 60}, {0.3, 1, 0.4});
    s.type = SurfaceType::spherical_mirror;
    s.fov_deg = 360;
    s.mirror.radius_m = 0.4;
    s.mirror.projector = {{0, 0, 1.5}, {}};
    s.mirror.projector_tangents = {-0.25, 0.25, -0.2, 0.2};
    expect_as_on_cpu(s, {160, 128}, {0, 1, 0});
}

TEST_F(SurfaceOnGpu, DarkWithoutFaces)
{
    SurfacePass pass(Surface{});
    TextureTarget const out(Format::bytes, {32, 32});
    pass.draw(out.target(), {}, gi::dvec3{0});
    for (unsigned char const b : read_bytes(out.target())) ASSERT_EQ(b, 0);
}

} // namespace
} // namespace viewer::test
