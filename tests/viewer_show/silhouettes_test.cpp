// How far outlines of drawn surfaces, which are smaller than the view and stretched, are from those of an exact picture of
// the same pose.

#include "gi/scene/generate/generate.h"
#include "gi/surfaces/seen_surfaces.h"
#include "tests/support/scenes.h"
#include "tests/viewer_gl/surfaceless.h"
#include "viewer/app/surface_display.h"
#include "viewer/devices/gl/surface_renderer.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer::test::silhouettes {
namespace {

using gi::dvec3, gi::vec3;

constexpr glm::ivec2 kSize{600, 420};

/// White bodies before black, and black ones before white: no surface needs light.
std::shared_ptr<gi::Scene const> black_and_white()
{
    gi::Scene scene;
    int const white = gi::test::add_material(scene, gi::test::emitter(vec3{1}, true)),
              black = gi::test::add_material(scene, gi::test::emitter(vec3{0}));
    gi::test::add_quad(scene, {0, -1.5f, -1}, {3, 0.2f, 0}, {0, 3, 0.1f}, white);
    for (int side = 0; side < 2; ++side) {
        int const material = side == 0 ? white : black;
        float const x = side == 0 ? -1.6f : 0.5f;
        gi::test::add_sphere(scene, {x + 0.2f, 0.6f, 0}, 0.35f, 4, material, true);
        gi::Scene turned;
        int const own = gi::test::add_material(turned, scene.materials[std::size_t(material)]);
        gi::test::add_box(turned, {-0.3f, -0.3f, -0.3f}, {0.3f, 0.3f, 0.3f}, own, false);
        gi::test::add_box(turned, {0.5f, -0.8f, 0}, {0.55f, 0.8f, 0.05f}, own, false); // a rod
        append(scene, std::move(turned), "turned",
               glm::rotate(glm::translate(gi::dmat4(1), dvec3(double(x) + 0.3, -0.4, 0.2)), 0.6,
                           glm::normalize(dvec3(1, 2, 0.7))));
        gi::Scene figure = gi::generate_avatar();
        for (gi::Material& m : figure.materials) m = scene.materials[std::size_t(material)];
        append(scene, std::move(figure), "figure",
               glm::scale(glm::translate(gi::dmat4(1), dvec3(double(x) + 0.9, -0.9, 0.1)), dvec3(0.9)));
    }
    return std::make_shared<gi::Scene const>(std::move(scene));
}

class Silhouettes : public Surfaceless {
protected:
    /// White or not, as shown.
    std::vector<char> shown(SurfaceRenderer& renderer, gi::Camera const& camera, double scale)
    {
        // Sizes that are powers of two are never drawn (ShownViews), and none of these is one.
        glm::ivec2 const size(glm::round(scale * glm::dvec2(kSize)));
        PictureTexture picture;
        std::vector<float> const none(std::size_t(3 * size.x * size.y)), no_depth(std::size_t(size.x * size.y));
        picture.upload(size, none, no_depth);
        EyeView eye;
        eye.picture = eye.other = renderer.draw(0, 0, camera, size, picture, camera);
        eye.is_drawn = true;
        TextureTarget const to(TextureTarget::Format::bytes, kSize);
        DisplayPass pass;
        SurfaceDisplay display;
        stretch(display.encoded({}, pass, eye, {}).target(), to.target());
        std::vector<char> white;
        std::vector<unsigned char> const rgb = read_bytes(to.target());
        for (std::size_t i = 0; i < rgb.size(); i += 3) white.push_back(rgb[i] > 127);
        return white;
    }
    static std::vector<char> exact(gi::World const& w, gi::Camera const& camera)
    {
        gi::SeenSurfaces seen(w, 0);
        seen.look(gi::camera_rays(camera, kSize.x, kSize.y, w.origin), kSize.x, kSize.y);
        std::vector<char> white;
        std::vector<gi::SeenSurface> row(std::size_t(kSize.x));
        for (int y = 0; y < kSize.y; ++y) {
            seen.row(y, row);
            for (gi::SeenSurface const& s : row) white.push_back(s.emitted.x > 0.5f);
        }
        return white;
    }
    /// Pixels of `a` whose colour `b` does not have within so many pixels.
    static std::size_t farther(std::vector<char> const& a, std::vector<char> const& b, int px)
    {
        std::size_t n = 0;
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x) {
                bool found = false;
                for (int v = std::max(0, y - px); v <= std::min(kSize.y - 1, y + px) && !found; ++v)
                    for (int u = std::max(0, x - px); u <= std::min(kSize.x - 1, x + px) && !found; ++u)
                        found = (u - x) * (u - x) + (v - y) * (v - y) <= px * px + 1 &&
                                b[std::size_t(v * kSize.x + u)] == a[std::size_t(y * kSize.x + x)];
                n += !found;
            }
        return n;
    }
};

TEST_F(Silhouettes, AreNearExactOnes)
{
    auto const world = std::make_shared<gi::MovingWorld>(black_and_white(), 0.0, report);
    SurfaceRenderer renderer;
    renderer.take(gi::shown_scene(world, {}, nullptr));
    while (!renderer.prepare(1)) {
    }
    // Share of the outlines' pixels that may be farther away. Drawn at half the size, a stair is two pixels wide.
    for (auto const& [scale, most] :
         {std::pair(1.0, 0.0), std::pair(0.75, 0.012), std::pair(0.5, 0.06), std::pair(0.4, 0.14)}) {
        std::size_t edges = 0, far = 0, farther_still = 0;
        for (int k = 0; k < 3; ++k) {
            gi::Camera const camera = gi::look_at({0.2 * k - 0.2, 0.1 * k, 3.5}, {0.03 * k, 0, 0}, 50);
            std::vector<char> const truth = exact(world->world(), camera), drawn = shown(renderer, camera, scale);
            for (auto const& [a, b] : {std::pair(&truth, &drawn), std::pair(&drawn, &truth)}) {
                far += farther(*a, *b, 1);
                farther_still += farther(*a, *b, 2);
            }
            for (std::size_t i = 1; i < truth.size(); ++i)
                edges += i % std::size_t(kSize.x) != 0 && truth[i] != truth[i - 1];
        }
        fmt::print("scale {}: of {} pixels of outlines, {} are farther than a pixel, {} than two\n", scale, edges,
                   far, farther_still);
        EXPECT_LE(double(far), most * double(edges)) << scale;
    }
}

} // namespace
} // namespace viewer::test::silhouettes
