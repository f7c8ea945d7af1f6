// For every material and direction, values are finite and not negative, and no more light leaves than arrives.

#include "gi/core/rng.h"
#include "tests/support/bsdf_cases.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// How far the fields of a material stray.
enum class Fields { in_range, slightly_out };

class RandomMaterials {
public:
    RandomMaterials(std::uint64_t seed, Fields fields) : rng_(seed, 0), fields_(fields) {}

    Material next()
    {
        Material m;
        m.model = rng_.uniform() < 0.3f ? MaterialModel::phong : MaterialModel::metal_rough;
        m.thin = rng_.uniform() < 0.5f;
        m.base_color = {share(), share(), share()};
        m.metallic = share();
        m.roughness = share();
        m.specular = share();
        m.specular_color = vec3{share(), share(), share()} * (rng_.uniform() < 0.5f ? 1.0f : 30.0f);
        m.ior = 1 + 2 * share() * share();
        m.transmission = rng_.uniform() < 0.5f ? 0.0f : share();
        m.phong_specular = (1 - max_component(m.base_color)) * vec3{share(), share(), share()};
        m.phong_exponent = std::pow(10.0f, 4 * rng_.uniform()) - 1;
        return m;
    }
    /// Grazing ones more often than chance would have it.
    vec3 direction()
    {
        vec3 d = square_to_cosine_hemisphere(rng_.uniform2());
        if (rng_.uniform() < 0.3f) d.z *= std::pow(10.0f, -7 * rng_.uniform());
        if (rng_.uniform() < 0.1f) d.z = -d.z;
        return glm::length(d) > 0 ? glm::normalize(d) : vec3{0, 0, 1};
    }
    Pcg32& rng() { return rng_; }

private:
    /// 0, 1 and what lies between, each often.
    float share()
    {
        float const u = rng_.uniform() * 1.4f - 0.2f;
        if (fields_ == Fields::slightly_out && rng_.uniform() < 0.3f) return glm::clamp(u, -1e-3f, 1 + 1e-3f);
        return glm::clamp(u, 0.0f, 1.0f);
    }
    Pcg32 rng_;
    Fields fields_;
};

std::string describe(Material const& m, vec3 wo, vec3 wi)
{
    return fmt::format("model {} thin {} base ({} {} {}) metallic {} roughness {} specular {} ({} {} {}) ior {} "
                       "transmission {} phong ({} {} {})^{} wo ({} {} {}) wi ({} {} {})",
                       int(m.model), m.thin, m.base_color.x, m.base_color.y, m.base_color.z, m.metallic,
                       m.roughness, m.specular, m.specular_color.x, m.specular_color.y, m.specular_color.z, m.ior,
                       m.transmission, m.phong_specular.x, m.phong_specular.y, m.phong_specular.z,
                       m.phong_exponent, wo.x, wo.y, wo.z, wi.x, wi.y, wi.z);
}

bool sound(vec3 v) { return all_finite(v) && v.x >= 0 && v.y >= 0 && v.z >= 0; }

void expect_sound_bsdf(Material const& m, RandomMaterials& random, bool front)
{
    Bsdf const b = make_bsdf(m);
    for (int i = 0; i < 30; ++i) {
        vec3 const wo = random.direction(), wi = random.direction();
        ASSERT_TRUE(sound(evaluate(b, wo, wi).f)) << describe(m, wo, wi);
        float const density = evaluate(b, wo, wi).pdf;
        ASSERT_TRUE(std::isfinite(density) && density >= 0) << density << " " << describe(m, wo, wi);
        float const u_lobe = random.rng().uniform();
        BsdfSample const s = sample(b, wo, front, u_lobe, random.rng().uniform2());
        ASSERT_TRUE(sound(s.weight)) << describe(m, wo, s.wi);
        ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0) << describe(m, wo, s.wi);
        if (max_component(s.weight) > 0) {
            ASSERT_NEAR(glm::length(s.wi), 1, 1e-5) << describe(m, wo, s.wi);
        }
    }
}

TEST(BsdfProperty, EverythingIsFiniteAndNotNegative)
{
    RandomMaterials random(2033, Fields::in_range);
    for (int i = 0; i < 10000; ++i) {
        expect_sound_bsdf(random.next(), random, i % 2 == 0);
        if (HasFatalFailure()) return;
    }
}

TEST(BsdfProperty, FieldsSlightlyOutOfRangeGiveFiniteNumbers)
{
    RandomMaterials random(2034, Fields::slightly_out);
    for (int i = 0; i < 10000; ++i) {
        Material const m = random.next();
        Bsdf const b = make_bsdf(m);
        vec3 const wo = random.direction(), wi = random.direction();
        ASSERT_TRUE(all_finite(evaluate(b, wo, wi).f)) << describe(m, wo, wi);
        ASSERT_TRUE(std::isfinite(evaluate(b, wo, wi).pdf)) << describe(m, wo, wi);
        float const u_lobe = random.rng().uniform();
        BsdfSample const s = sample(b, wo, true, u_lobe, random.rng().uniform2());
        ASSERT_TRUE(all_finite(s.weight) && std::isfinite(s.pdf)) << describe(m, wo, s.wi);
    }
}

/// One lobe alone (of metals the one of what facets reflect once): no sample weighs more than 1. Several lobes share
/// samples, so that only the mean is bounded.
TEST(BsdfProperty, SamplesOfOneLobeWeighAtMostOne)
{
    RandomMaterials random(2035, Fields::in_range);
    for (int i = 0; i < 10000; ++i) {
        Material m = random.next();
        if (m.model == MaterialModel::phong)
            (i % 2 == 0 ? m.phong_specular : m.base_color) = vec3{0};
        else if (i % 2 == 0)
            m.specular = m.metallic = m.transmission = 0;
        else
            m.metallic = 1;
        Bsdf b = make_bsdf(m);
        b.again = vec3{0};
        for (int k = 0; k < 10; ++k) {
            vec3 const wo = random.direction();
            float const u_lobe = random.rng().uniform();
            BsdfSample const s = sample(b, wo, true, u_lobe, random.rng().uniform2());
            ASSERT_LE(max_component(s.weight), 1.0001f) << describe(m, wo, s.wi);
        }
    }
}

/// The mean weight is the directional albedo.
TEST(BsdfProperty, MeanWeightIsAtMostOne)
{
    constexpr int kSide = 40, kLobes = 40;
    RandomMaterials random(2036, Fields::in_range);
    for (int i = 0; i < 1500; ++i) {
        Material const m = random.next();
        Bsdf b = make_bsdf(m);
        vec3 wo = random.direction();
        wo.z = std::abs(wo.z);
        dvec3 sum{0};
        for (int k = 0; k < kSide * kSide; ++k) { // a jittered lattice; lobes in an order unrelated to it
            vec2 const u = (vec2{float(k % kSide), float(k / kSide)} + random.rng().uniform2()) / float(kSide);
            float const u_lobe = (float((k * 7 + k / kSide) % kLobes) + random.rng().uniform()) / kLobes;
            BsdfSample const s = sample(b, wo, true, u_lobe, u);
            float const eta = 1 / b.ior;
            sum += dvec3(s.weight / (s.transmitted && !b.thin ? eta * eta : 1.0f)) / double(kSide * kSide);
        }
        for (int c = 0; c < 3; ++c) ASSERT_LE(sum[c], 1.01) << describe(m, wo, vec3{0});
    }
}

} // namespace
} // namespace gi::test
