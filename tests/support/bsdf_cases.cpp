#include "tests/support/bsdf_cases.h"

#include "tests/support/scenes.h"

namespace gi::test {
namespace {

Material metal_rough(vec3 color, float metallic, float roughness)
{
    Material m;
    m.base_color = color;
    m.metallic = metallic;
    m.roughness = roughness;
    return m;
}

Material phong(vec3 diffuse, vec3 specular, float exponent)
{
    Material m;
    m.model = MaterialModel::phong;
    m.base_color = diffuse;
    m.phong_specular = specular;
    m.phong_exponent = exponent;
    return m;
}

Material part_glass(float transmission, bool thin, float specular)
{
    Material m = glass(1.5f, thin);
    m.transmission = transmission;
    m.specular = specular;
    return m;
}

Material tinted_coat(float factor, vec3 color)
{
    Material m = metal_rough({0.9f, 0.5f, 0.2f}, 0, 0.4f);
    m.specular = factor;
    m.specular_color = color;
    return m;
}

} // namespace

std::vector<BsdfCase> scattering_materials()
{
    vec3 const white{1};
    return {{"lambert", lambert({0.9f, 0.5f, 0.1f})},
            {"smooth plastic", metal_rough(white, 0, 0)},
            {"plastic 0.2", metal_rough({0.8f, 0.1f, 0.1f}, 0, 0.2f)},
            {"plastic 1", metal_rough(white, 0, 1)},
            {"plastic, half coat", tinted_coat(0.5f, white)},
            {"plastic, tinted coat", tinted_coat(1, {0.2f, 8, 3})},
            {"plastic, white coat", tinted_coat(1, vec3{30})},
            {"metal 0.1", metal_rough(white, 1, 0.1f)},
            {"metal 0.3", metal_rough({1, 0.8f, 0.3f}, 1, 0.3f)},
            {"metal 0.7", metal_rough(white, 1, 0.7f)},
            {"metal 1", metal_rough(white, 1, 1)},
            {"half metal 0.4", metal_rough({0.9f, 0.6f, 0.3f}, 0.5f, 0.4f)},
            {"phong 0", phong(vec3{0.3f}, vec3{0.6f}, 0)},
            {"phong 1", phong(vec3{0}, vec3{1}, 1)},
            {"phong 20", phong({0.5f, 0.3f, 0.1f}, {0.2f, 0.4f, 0.5f}, 20)},
            {"phong 1000", phong(vec3{0.1f}, vec3{0.9f}, 1000)},
            {"half glass, solid", part_glass(0.5f, false, 1)},
            {"half glass, thin", part_glass(0.5f, true, 1)},
            {"half glass without coat", part_glass(0.5f, true, 0)}};
}

std::vector<BsdfCase> delta_materials()
{
    return {{"white mirror", mirror(vec3{1})}, {"gold mirror", mirror({1, 0.8f, 0.3f})},
            {"glass", glass(1.5f, false)},     {"diamond", glass(2.42f, false)},
            {"thin glass", glass(1.5f, true)}, {"nothing", glass(1, false)}};
}

vec3 seen_at(double degrees, double azimuth_degrees)
{
    double const theta = glm::radians(degrees), phi = glm::radians(azimuth_degrees);
    return vec3(dvec3{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)});
}

std::vector<double> const& view_angles()
{
    static std::vector<double> const angles{0, 30, 60, 80, 89.5};
    return angles;
}

} // namespace gi::test
