// What real proxies catch of virtual objects beside shadows: mirror images and caustics.

#include "ar/pipeline/bridge.h"
#include "ar/pipeline/pair_renderer.h"
#include "ar/pipeline/synthetic.h"
#include "ar/scene/proxy_mesh.h"
#include "gi/scene/generate/builder.h"

#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

/// A dim sky with a small lamp.
std::shared_ptr<gi::EnvironmentMap const> sky(float lamp)
{
    cv::Mat map(32, 64, CV_32FC3, cv::Scalar::all(0.3));
    cv::rectangle(map, {40, 8, 2, 2}, cv::Scalar::all(lamp), cv::FILLED);
    return std::make_shared<gi::EnvironmentMap const>(ar::environment_of(map));
}

gi::Scene ball(gi::Material const& material)
{
    gi::SceneBuilder b;
    b.sphere(b.add_material("ball", material), {0, 0.12f, 0}, 0.1f, 64);
    return b.finish("ball");
}

ar::PairPictures rendered(ar::ProxySurface const& floor, gi::Material const& material, float lamp,
                          std::uint32_t paths)
{
    gi::Report report;
    ar::Proxy const plane{"floor", floor, ar::ProxyPlane{{-0.6, 0, 0.6}, {1.2, 0, 0}, {0, 0, -1.2}}};
    gi::RenderSettings settings;
    settings.bounces = 4;
    settings.of<gi::SlhbSettings>().directions = "icosahedron:80";
    settings.of<gi::SlhbSettings>().resolution = 48;
    settings.of<gi::SlhbSettings>().light_samples = 4;
    settings.of<gi::SlhbSettings>().shadow_resolution = 64;
    ar::PairRenderer renderer(ar::join_scenes(ar::scene_of(plane, report), ball(material), gi::dmat4(1)), settings,
                              report, "slhb");
    renderer.set_environment(sky(lamp));
    ar::CameraModel camera = ar::synthetic_camera({40, 30}).model;
    camera.lens = ar::LensModel::pinhole;
    return renderer.render(ar::gi_camera(camera, ar::synthetic_pose(0.5)), 40, 30, paths, 0,
                           {.denoiser = gi::Denoiser::none}, {});
}

gi::Material red()
{
    gi::Material m;
    m.base_color = {0.8f, 0.05f, 0.05f};
    m.specular = 0;
    return m;
}

/// What is added where no virtual object is seen itself.
cv::Mat added_beside(ar::PairPictures const& p)
{
    cv::Mat added = p.with - p.without;
    added.setTo(cv::Scalar::all(0), p.coverage > 0);
    return added;
}

TEST(Catchers, ThatAreMirrorsShowVirtualThings)
{
    ar::ProxySurface mirror;
    mirror.albedo = gi::dvec3(0.9);
    mirror.metallic = 1;
    mirror.roughness = 0;
    ar::PairPictures const p = rendered(mirror, red(), 0.3f, 4);
    // Grey sky with ball: green goes, red much less.
    cv::Mat channels[3];
    cv::split(added_beside(p), channels);
    int const image = cv::countNonZero((channels[1] < -0.1f) & (channels[0] > 0.5f * channels[1]));
    EXPECT_GT(image, 20);
    ar::ProxySurface glossy = mirror;
    glossy.roughness = 0.3;
    cv::split(added_beside(rendered(glossy, red(), 0.3f, 8)), channels);
    EXPECT_GT(cv::countNonZero((channels[1] < -0.05f) & (channels[0] > 0.6f * channels[1])), 20);
}

TEST(Catchers, OfCausticsOfVirtualMirrorsAndGlass)
{
    ar::ProxySurface matt;
    matt.albedo = gi::dvec3(0.5);
    gi::Material steel, glass;
    steel.metallic = 1;
    steel.roughness = 0;
    steel.base_color = gi::vec3(0.95f);
    glass.transmission = 1;
    glass.thin = false;
    glass.roughness = 0;
    auto const light = [&](gi::Material const& m) {
        cv::Mat gray;
        cv::cvtColor(added_beside(rendered(matt, m, 300, 12)), gray, cv::COLOR_RGB2GRAY);
        return cv::sum(cv::max(gray, 0))[0];
    };
    double const none = light(red());
    EXPECT_GT(light(steel), 5 * none);
    EXPECT_GT(light(glass), 5 * none);
}

} // namespace
} // namespace viewer::test
