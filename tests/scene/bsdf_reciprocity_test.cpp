// Helmholtz reciprocity, and the value of f against the equations of the papers.

#include "gi/core/rng.h"
#include "tests/support/bsdf_cases.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

vec3 random_direction(Pcg32& rng)
{
    vec3 const d = square_to_cosine_hemisphere(rng.uniform2());
    return glm::normalize(vec3{d.x, d.y, glm::max(d.z, 1e-3f)});
}

/// The delta lobes are left out: evaluate knows nothing of them.
TEST(BsdfReciprocity, ValuesAreTheSameBothWays)
{
    Pcg32 rng(2029, 0);
    for (BsdfCase const& c : scattering_materials()) {
        Bsdf const b = make_bsdf(c.material);
        for (int i = 0; i < 2000; ++i) {
            vec3 const wo = random_direction(rng), wi = random_direction(rng);
            vec3 const there = evaluate(b, wo, wi).f, back = evaluate(b, wi, wo).f;
            // (r . w)^1000 multiplies the rounding of its base by 1000.
            double const tolerance = c.name == "phong 1000" ? 1e-3 : 1e-5;
            for (int k = 0; k < 3; ++k)
                ASSERT_NEAR(there[k], back[k], tolerance * double(glm::max(there[k], back[k])) + 1e-30) << c.name;
        }
    }
}

/// Walter et al. 2007 eq. 33 (D), Heitz 2014 eq. 72 and 99 (Lambda, G2), Schlick 1994.
TEST(BsdfValue, MetalIsGgx)
{
    Pcg32 rng(2030, 0);
    double const pi = glm::pi<double>();
    for (float const roughness : {0.1f, 0.3f, 0.7f, 1.0f}) {
        Material m = mirror({1, 0.8f, 0.3f});
        m.roughness = roughness;
        Bsdf const b = glossy_lobe(make_bsdf(m));
        double const a2 = std::pow(double(roughness), 4);
        auto const lambda = [a2](double c) { return 0.5 * (std::sqrt(1 + a2 * (1 - c * c) / (c * c)) - 1); };
        for (int i = 0; i < 2000; ++i) {
            vec3 const wo = random_direction(rng), wi = random_direction(rng);
            dvec3 const h = glm::normalize(dvec3(wo) + dvec3(wi));
            double const cos_o = double(wo.z), cos_i = double(wi.z);
            double const tan2 = (h.x * h.x + h.y * h.y) / (h.z * h.z);
            double const d = 1 / (pi * a2 * std::pow(h.z, 4) * std::pow(1 + tan2 / a2, 2));
            double const g2 = 1 / (1 + lambda(cos_o) + lambda(cos_i));
            double const weight = std::pow(1 - glm::dot(dvec3(wo), h), 5);
            for (int k = 0; k < 3; ++k) {
                double const f0 = double(m.base_color[k]), f = f0 + (1 - f0) * weight;
                double const expected = d * g2 * f / (4 * cos_o * cos_i);
                ASSERT_NEAR(evaluate(b, wo, wi).f[k], expected, 2e-4 * expected) << roughness;
            }
        }
    }
}

/// Shirley et al. 1997: rho / pi (1 - F(o)) (1 - F(i)) / (1 - mean F), with f0 = 0.04 and f90 = 1.
TEST(BsdfValue, PlasticIsABaseBelowACoat)
{
    Material m;
    m.base_color = {0.8f, 0.4f, 0.2f};
    m.roughness = 0; // the coat is delta, so that only the base is left
    Bsdf const b = make_bsdf(m);
    auto const through = [](double c) { return 0.96 * (1 - std::pow(1 - c, 5)); };
    Pcg32 rng(2031, 0);
    for (int i = 0; i < 1000; ++i) {
        vec3 const wo = random_direction(rng), wi = random_direction(rng);
        double const expected =
            through(double(wo.z)) * through(double(wi.z)) / (0.96 * 20 / 21) / glm::pi<double>();
        for (int k = 0; k < 3; ++k) {
            double const value = expected * double(m.base_color[k]);
            ASSERT_NEAR(evaluate(b, wo, wi).f[k], value, 1e-4 * value);
        }
    }
}

/// k_d / pi + k_s (n + 1) / 2 pi max(0, r . w)^n
TEST(BsdfValue, PhongIsNormalisedAboutTheMirrorDirection)
{
    Pcg32 rng(2032, 0);
    double const pi = glm::pi<double>();
    for (float const n : {0.0f, 0.5f, 1.0f, 20.0f}) {
        Material m;
        m.model = MaterialModel::phong;
        m.base_color = vec3{0.3f};
        m.phong_specular = vec3{0.6f};
        m.phong_exponent = n;
        Bsdf const b = make_bsdf(m);
        for (int i = 0; i < 2000; ++i) {
            vec3 const wo = random_direction(rng), wi = random_direction(rng);
            double const cosine = glm::dot(dvec3{-wo.x, -wo.y, wo.z}, dvec3(wi));
            if (std::abs(cosine) < 1e-3) continue;
            double const lobe = cosine > 0 ? std::pow(cosine, double(n)) : 0;
            ASSERT_NEAR(evaluate(b, wo, wi).f.x, 0.3 / pi + 0.6 * (double(n) + 1) / (2 * pi) * lobe, 1e-4)
                << "exponent " << n << ", cosine " << cosine;
        }
    }
}

} // namespace
} // namespace gi::test
