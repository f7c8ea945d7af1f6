// How much of the light of a uniform sky a surface sends on: directional albedo
// by quadrature and its closed forms.

#include "tests/support/bsdf_cases.h"
#include "tests/support/scenes.h"
#include "tests/support/sphere_chi2.h"

#include <cmath>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// Share of the light that leaves through delta lobes, over all numbers that choose the lobe. Light that changes
/// its medium is counted as power: without the eta^2 of radiance.
struct DeltaAlbedo {
    dvec3 reflected{0}, transmitted{0};
};

DeltaAlbedo delta_albedo(Bsdf const& b, vec3 wo, bool front)
{
    constexpr int kSteps = 1 << 15;
    DeltaAlbedo a;
    for (int i = 0; i < kSteps; ++i) {
        BsdfSample const s = sample(b, wo, front, (float(i) + 0.5f) / kSteps, vec2{0.5f});
        if (!s.delta) continue;
        bool const refracted = s.transmitted && !b.thin;
        double const eta = front ? 1 / double(b.ior) : double(b.ior);
        dvec3 const power = dvec3(s.weight) / (refracted ? eta * eta : 1.0) / double(kSteps);
        (s.transmitted ? a.transmitted : a.reflected) += power;
    }
    return a;
}

/// f cos, integrated over all directions, of one channel.
double rough_albedo(Bsdf const& b, vec3 wo, int channel)
{
    SphereBins bins;
    bins.rows = 16;
    bins.columns = 8;
    return integrate_all(
        bins, [&](vec3 wi) { return wi.z > 0 ? double(evaluate(b, wo, wi).f[channel] * wi.z) : 0.0; }, 1e-6);
}

Material white_metal(float roughness)
{
    Material m = mirror(vec3{1});
    m.roughness = roughness;
    return m;
}

/// Unpolarised reflectance of a smooth interface, n = n_transmitted / n_incident (Fresnel).
double fresnel(double angle, double n)
{
    double const s = std::sin(angle) / n;
    if (s >= 1) return 1;
    double const c = std::cos(angle), t = std::sqrt(1 - s * s);
    double const across = (c - n * t) / (c + n * t), along = (n * c - t) / (n * c + t);
    return 0.5 * (across * across + along * along);
}

TEST(BsdfFurnace, NoMaterialMakesLight)
{
    std::vector<BsdfCase> all = scattering_materials();
    for (BsdfCase const& c : delta_materials()) all.push_back(c);
    for (BsdfCase const& c : all)
        for (double const angle : view_angles()) {
            Bsdf const b = make_bsdf(c.material);
            vec3 const wo = seen_at(angle);
            DeltaAlbedo const front = delta_albedo(b, wo, true), back = delta_albedo(b, wo, false);
            for (int k = 0; k < 3; ++k) {
                double const rough = rough_albedo(b, wo, k);
                // Tables tell what rough lobes leave to others.
                double const most = b.f90.x > 0 && b.alpha >= kSmoothAlpha ? 1.003 : 1.0001;
                EXPECT_LE(rough + front.reflected[k] + front.transmitted[k], most) << c.name << " from " << angle;
                EXPECT_LE(rough + back.reflected[k] + back.transmitted[k], most) << c.name << " behind " << angle;
            }
        }
}

TEST(BsdfFurnace, LambertReflectsItsAlbedo)
{
    Bsdf const b = make_bsdf(lambert({0.9f, 0.5f, 0.1f}));
    for (double const angle : view_angles())
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(rough_albedo(b, seen_at(angle), c), double(b.diffuse[c]), 1e-5) << angle;
}

Material coated(float base, float roughness)
{
    Material m;
    m.base_color = vec3{base};
    m.roughness = roughness;
    return m;
}

/// With what passes the coat twice, and what facets reflect more than once, nothing is lost at any angle.
TEST(BsdfFurnace, WhiteSurfacesReflectEverything)
{
    for (float const roughness : {0.0f, 0.1f, 0.2f, 0.447f, 0.6f, 0.8f, 1.0f})
        for (double const angle : {0.0, 30.0, 60.0, 75.0, 80.0, 85.0, 88.0})
            for (float const specular : {0.0f, 0.5f, 1.0f})
                for (float const metallic : {0.0f, 0.5f, 1.0f}) {
                    Material m = coated(1, roughness);
                    m.specular = specular;
                    m.metallic = metallic;
                    Bsdf const b = make_bsdf(m);
                    vec3 const wo = seen_at(angle);
                    EXPECT_NEAR(rough_albedo(b, wo, 0) + delta_albedo(b, wo, true).reflected.x, 1,
                                roughness > 0 ? 4e-3 : 2e-4)
                        << "roughness " << roughness << ", specular " << specular << ", metallic " << metallic
                        << ", " << angle << " degrees";
                }
}

/// Lobes too narrow for the quadrature, and the most grazing angles, by samples.
TEST(BsdfFurnace, WhiteSurfacesWithNarrowLobesReflectEverything)
{
    constexpr int kSamples = 1 << 17;
    for (float const roughness : {0.02f, 0.05f, 0.07f, 0.3f})
        for (double const angle : {60.0, 85.0, 89.5})
            for (float const metallic : {0.0f, 1.0f}) {
                Material m = coated(1, roughness);
                m.metallic = metallic;
                Bsdf const b = make_bsdf(m);
                double sum = 0;
                for (int k = 0; k < kSamples; ++k) {
                    vec2 const u{std::fmod(k * 0.7548776662466927, 1.0), std::fmod(k * 0.5698402909980532, 1.0)};
                    sum += double(sample(b, seen_at(angle), true, (float(k) + 0.5f) / kSamples, u).weight.x) /
                           kSamples;
                }
                EXPECT_NEAR(sum, 1, 8e-3)
                    << "roughness " << roughness << ", metallic " << metallic << ", " << angle << " degrees";
            }
}

/// A base of 0.8 under a coat: what Blender's Cycles 5.0 rendered in a white furnace, by hand.
TEST(BsdfFurnace, CoatsAgreeWithAnotherRenderer)
{
    for (auto const& [roughness, angle, cycles] :
         {std::tuple{0.447f, 80.0, 0.828}, {0.9f, 60.0, 0.806}, {0.9f, 80.0, 0.810}})
        EXPECT_NEAR(rough_albedo(make_bsdf(coated(0.8f, roughness)), seen_at(angle), 0), cycles, 0.01)
            << "roughness " << roughness << ", " << angle << " degrees";
}

/// Integral of k_s (n + 1) / 2 pi cos^(n + 1) over the hemisphere = k_s (n + 1) / (n + 2).
TEST(BsdfFurnace, PhongFromAboveHasItsClosedForm)
{
    Material m;
    m.model = MaterialModel::phong;
    m.base_color = {0.1f, 0.2f, 0.3f};
    m.phong_specular = {0.5f, 0.6f, 0.7f};
    for (float const n : {0.0f, 1.0f, 5.0f, 50.0f, 1000.0f}) {
        m.phong_exponent = n;
        Bsdf const b = make_bsdf(m);
        for (int c = 0; c < 3; ++c) {
            double const closed = double(m.base_color[c]) + double(m.phong_specular[c] * (n + 1) / (n + 2));
            EXPECT_NEAR(rough_albedo(b, vec3{0, 0, 1}, c), closed, 1e-4) << "exponent " << n;
        }
    }
}

/// f cos = c / 2 pi (1 + c) for alpha = 1 seen from above; its integral is 1 - ln 2.
TEST(BsdfFurnace, RoughestLobeFromAboveHasItsClosedForm)
{
    EXPECT_NEAR(rough_albedo(glossy_lobe(make_bsdf(white_metal(1))), {0, 0, 1}, 0), 1 - std::log(2.0), 1e-5);
}

/// What facets that reflect everything reflect once of the light along a direction, and the share of it that Schlick's
/// grazing term has: an independent quadrature over microfacet normals.
glm::dvec2 reflected_once(double alpha, double cos_o, int steps)
{
    double const a2 = alpha * alpha;
    auto const lambda = [a2](double c) { return 0.5 * (std::sqrt(1 + a2 * (1 - c * c) / (c * c)) - 1); };
    dvec3 const wo{std::sqrt(1 - cos_o * cos_o), 0, cos_o};
    // f cos_i dwi = G2 (wo.h) / (cos_o cos_h) D cos_h dh, and h is spread as D cos_h.
    glm::dvec2 sum{0};
    for (int i = 0; i < steps; ++i)
        for (int j = 0; j < steps; ++j) {
            double const u = (i + 0.5) / steps, phi = kPiD * (j + 0.5) / steps;
            double const tan2 = a2 * u / (1 - u), c = 1 / std::sqrt(1 + tan2), s = std::sqrt(1 - c * c);
            dvec3 const h{s * std::cos(phi), s * std::sin(phi), c};
            double const along = glm::dot(wo, h), cos_i = 2 * along * h.z - wo.z;
            if (along <= 0 || cos_i <= 0) continue;
            double const passes = along / (cos_o * h.z) / (1 + lambda(cos_o) + lambda(cos_i));
            sum += passes * glm::dvec2{1, std::pow(1 - along, 5)};
        }
    return sum / double(steps * steps);
}

/// A lobe alone loses what bounces twice among the microfacets:
/// from above a white metal of roughness 0.3 keeps 0.991, of 0.5 0.916, of 0.7 0.698, of 1 0.307.
TEST(BsdfFurnace, LobesLoseWhatIsMultiplyScattered)
{
    for (float const roughness : {0.1f, 0.3f, 0.5f, 0.7f, 1.0f})
        for (double const angle : {0.0, 45.0, 80.0}) {
            Bsdf const b = make_bsdf(white_metal(roughness));
            double const cosine = std::cos(glm::radians(angle));
            glm::dvec2 const truth = reflected_once(double(b.alpha), cosine, 800);
            EXPECT_NEAR(rough_albedo(glossy_lobe(b), seen_at(angle), 0), truth.x, 1e-3)
                << "roughness " << roughness << ", " << angle << " degrees";
            GgxAlbedo const table = ggx_albedo(float(cosine), b.alpha);
            EXPECT_NEAR(table.sum(), truth.x, 3e-3) << "roughness " << roughness << ", " << angle << " degrees";
            EXPECT_NEAR(table.grazing, truth.y, 4e-3) << "roughness " << roughness << ", " << angle << " degrees";
        }
    for (float const nowhere : {-1.0f, 2.0f, std::nanf(""), float(kInf)})
        EXPECT_TRUE(std::isfinite(ggx_albedo(nowhere, 0.3f).sum()) &&
                    std::isfinite(ggx_albedo(0.5f, nowhere).sum()));
}

/// Kulla and Conty 2017: (1 - E(o)) (1 - E(i)) / (pi (1 - mean E)) F^2 mean E / (1 - F (1 - mean E)), F the mean of
/// Schlick's term.
TEST(BsdfFurnace, ColouredMetalsReflectAgainInTheirColour)
{
    for (float const roughness : {0.7f, 1.0f}) {
        Material m = mirror({1, 0.8f, 0.3f});
        m.roughness = roughness;
        Bsdf const b = make_bsdf(m);
        constexpr int kSteps = 40;
        double mean = 0;
        for (int k = 0; k < kSteps; ++k) {
            double const cosine = (k + 0.5) / kSteps;
            mean += 2 * cosine * reflected_once(double(b.alpha), cosine, 200).x / kSteps;
        }
        for (double const out : {0.0, 40.0, 75.0})
            for (double const in : {10.0, 60.0}) {
                auto const rest = [&](double angle) {
                    return 1 - reflected_once(double(b.alpha), std::cos(glm::radians(angle)), 400).x;
                };
                vec3 const wo = seen_at(out), wi{-seen_at(in).y, seen_at(in).x, seen_at(in).z},
                           again = evaluate(b, wo, wi).f - evaluate(glossy_lobe(b), wo, wi).f;
                for (int c = 0; c < 3; ++c) {
                    double const f = double(m.base_color[c]) * 20 / 21 + 1.0 / 21,
                                 expected = rest(out) * rest(in) / (kPiD * (1 - mean)) * f * f * mean /
                                            (1 - f * (1 - mean));
                    EXPECT_NEAR(double(again[c]), expected, 0.02 * expected + 5e-4)
                        << roughness << " " << out << " " << in;
                }
            }
    }
}

TEST(BsdfFurnace, FresnelHasItsKnownValues)
{
    double const brewster = std::atan(1.5);
    EXPECT_NEAR(fresnel_dielectric(1, 1 / 1.5f).reflectance, 0.04, 1e-6);
    EXPECT_NEAR(fresnel_dielectric(float(std::cos(brewster)), 1 / 1.5f).reflectance,
                0.5 * std::pow((1 - 2.25) / (1 + 2.25), 2), 1e-6);
    EXPECT_NEAR(fresnel_dielectric(0, 1 / 1.5f).reflectance, 1, 1e-6);
    for (double const n : {1.0, 1.33, 1.5, 2.42, 1 / 1.5, 1 / 2.42})
        for (int degrees = 0; degrees < 90; ++degrees) {
            double const angle = glm::radians(double(degrees));
            DielectricInterface const face = fresnel_dielectric(float(std::cos(angle)), float(1 / n));
            EXPECT_NEAR(face.reflectance, fresnel(angle, n), 2e-5) << n << " at " << degrees;
            EXPECT_EQ(face.cos_transmitted > 0, std::sin(angle) < n) << n << " at " << degrees;
        }
}

TEST(BsdfFurnace, GlassSplitsLightAsFresnelAndSnellSay)
{
    for (float const ior : {1.0f, 1.33f, 1.5f, 2.42f})
        for (bool const front : {true, false}) {
            Bsdf const b = make_bsdf(glass(ior, false));
            double const n = front ? double(ior) : 1 / double(ior);
            for (double const angle : view_angles()) {
                vec3 const wo = seen_at(angle);
                DeltaAlbedo const a = delta_albedo(b, wo, front);
                double const r = fresnel(glm::radians(angle), n);
                EXPECT_NEAR(a.reflected.x, r, 1e-4) << ior << " from " << angle;
                EXPECT_NEAR(a.transmitted.x, 1 - r, 1e-4) << ior << " from " << angle;
                if (r > 0.99) continue;
                BsdfSample const through = sample(b, wo, front, 0.9999f, vec2{0.5f});
                ASSERT_TRUE(through.transmitted);
                EXPECT_NEAR(through.wi.x, -double(wo.x) / n, 1e-5);
                EXPECT_NEAR(through.wi.y, -double(wo.y) / n, 1e-5);
                EXPECT_LT(through.wi.z, 0);
                EXPECT_NEAR(through.weight.x, 1 / (n * n), 1e-5) << "radiance is larger in the denser medium";
            }
        }
}

TEST(BsdfFurnace, LightBeyondTheCriticalAngleStaysInside)
{
    Bsdf const b = make_bsdf(glass(1.5f, false));
    for (double const angle : {41.9, 60.0, 89.0}) // critical: 41.81 degrees
        for (float const u : {0.0f, 0.5f, 0.99999994f}) {
            BsdfSample const s = sample(b, seen_at(angle), false, u, vec2{0.5f});
            EXPECT_FALSE(s.transmitted);
            EXPECT_NEAR(s.weight.x, 1, 1e-6);
        }
    EXPECT_TRUE(sample(b, seen_at(41.7), false, 0.999f, vec2{0.5f}).transmitted);
}

/// All orders of reflection between two equal faces: R + (1 - R)^2 R + (1 - R)^2 R^3 + ... = 2 R / (1 + R).
TEST(BsdfFurnace, ThinSheetSumsItsInnerReflections)
{
    Bsdf const b = make_bsdf(glass(1.5f, true));
    for (bool const front : {true, false})
        for (double const angle : view_angles()) {
            vec3 const wo = seen_at(angle);
            DeltaAlbedo const a = delta_albedo(b, wo, front);
            double const r = fresnel(glm::radians(angle), 1.5), both = 2 * r / (1 + r);
            EXPECT_NEAR(a.reflected.x, both, 1e-4) << angle;
            EXPECT_NEAR(a.reflected.x + a.transmitted.x, 1, 1e-6) << angle;
            BsdfSample const through = sample(b, wo, front, 0.99999f, vec2{0.5f});
            if (through.transmitted) {
                EXPECT_EQ(through.wi, -wo);
            }
        }
}

TEST(BsdfFurnace, MirrorsFollowSchlick)
{
    for (double const angle : view_angles()) {
        DeltaAlbedo const a = delta_albedo(make_bsdf(mirror({1, 0.8f, 0.3f})), seen_at(angle), true);
        double const w = std::pow(1 - std::cos(glm::radians(angle)), 5);
        EXPECT_NEAR(a.reflected.x, 1, 1e-5);
        EXPECT_NEAR(a.reflected.y, 0.8 + 0.2 * w, 1e-5);
        EXPECT_NEAR(a.reflected.z, 0.3 + 0.7 * w, 1e-5);
    }
}

} // namespace
} // namespace gi::test
