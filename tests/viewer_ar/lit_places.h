#pragma once
// Boxes, floors and maps for tests of prefiltered light.

#include "ar/pipeline/bridge.h"
#include "gi/scene/generate/builder.h"

#include <memory>

namespace viewer::test {

inline gi::Material matt(float albedo)
{
    gi::Material m;
    m.base_color = gi::vec3(albedo);
    m.specular = 0;
    return m;
}

inline std::shared_ptr<gi::EnvironmentMap const> environment(cv::Mat const& map)
{
    return std::make_shared<gi::EnvironmentMap const>(ar::environment_of(map));
}

inline cv::Mat uniform(double radiance) { return cv::Mat(32, 64, CV_32FC3, cv::Scalar::all(radiance)); }

inline gi::Scene box(gi::vec3 low, gi::vec3 high, gi::Material const& material)
{
    gi::SceneBuilder b;
    b.box(b.add_material("box", material), low, high);
    return b.finish("box");
}

inline gi::Scene floor(float half_m, gi::Material const& material)
{
    gi::SceneBuilder b;
    b.quad(b.add_material("floor", material), {-half_m, 0, half_m}, {2 * half_m, 0, 0}, {0, 0, -2 * half_m});
    return b.finish("floor");
}

inline constexpr gi::vec3 kAxes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

} // namespace viewer::test
