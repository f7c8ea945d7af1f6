// A box like Cornell's with a mirroring ring, a glass sphere and two matt balls: the caustics and indirect shadows
// by which Norén and Sjölin show their method.

#include "gi/scene/generate/builder.h"
#include "gi/scene/generate/generate.h"

namespace gi {

Scene generate_ring()
{
    constexpr float kSide = 1; // m; the box is open towards the camera, at z = 0
    SceneBuilder b;
    int const white = b.add_material("white", matt(vec3{0.73f, 0.71f, 0.67f}));
    b.quad(white, {0, 0, -kSide}, {0, 0, kSide}, {kSide, 0, 0});     // floor
    b.quad(white, {0, kSide, -kSide}, {kSide, 0, 0}, {0, 0, kSide}); // ceiling
    b.quad(white, {0, 0, -kSide}, {kSide, 0, 0}, {0, kSide, 0});     // back wall
    b.quad(b.add_material("red", matt({0.6f, 0.06f, 0.05f})), {0, 0, 0}, {0, 0, -kSide}, {0, kSide, 0});
    b.quad(b.add_material("green", matt({0.12f, 0.44f, 0.1f})), {kSide, 0, -kSide}, {0, 0, kSide}, {0, kSide, 0});
    Material lamp = matt(vec3{0.78f});
    lamp.emission = vec3{60, 52, 40};
    b.quad(b.add_material("lamp", lamp), {0.68f, 0.999f, -0.4f}, {0.1f, 0, 0}, {0, 0, 0.1f});

    Material polished = matt(vec3{0.95f, 0.93f, 0.88f});
    polished.metallic = 1;
    polished.roughness = 0;
    int const metal = b.add_material("polished metal", polished);
    constexpr float kOuter = 0.2f, kInner = 0.185f, kHigh = 0.09f;
    vec3 const foot{0.34f, 0, -0.42f};
    b.lathe(metal, foot, {{kOuter, 0}, {kOuter, kHigh}}, 128);
    b.lathe(metal, foot, {{kInner, kHigh}, {kInner, 0}}, 128);
    b.lathe(metal, foot, {{kOuter, kHigh}, {kInner, kHigh}}, 128);

    Material clear = matt(vec3{1});
    clear.transmission = 1;
    clear.thin = false;
    clear.roughness = 0;
    clear.specular = 1;
    clear.ior = 1.5f;
    b.sphere(b.add_material("glass", clear), {0.72f, 0.17f, -0.62f}, 0.15f, 96);
    b.sphere(white, {0.3f, 0.13f, -0.78f}, 0.13f, 48);
    b.sphere(white, {0.34f, 0.05f, -0.42f}, 0.05f, 32);
    b.add_camera("camera", {0.5, 0.85, 1.35}, {0.5, 0.34, -0.45}, 37);
    return b.finish("ring");
}

} // namespace gi
