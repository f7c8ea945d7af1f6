// Direction sets: how many, how even, each with its opposite; the map against brute force; axes by cosine.

#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "gi/hit_buffers/directions/cosine_tables.h"
#include "gi/hit_buffers/directions/direction_picture.h"
#include "gi/hit_buffers/directions/direction_quality.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr std::size_t kSamples = std::size_t(1) << 17;

std::vector<std::string> const kSets{"icosahedron:20", "icosahedron:80", "icosahedron:320", "octahedron:8",
                                     "octahedron:32",  "octahedron:128", "tetrahedron:8",   "tetrahedron:128",
                                     "uv_grid:8",      "uv_grid:128",    "uv_grid:200",     "halton:144",
                                     "halton:256",     "halton:320",     "fibonacci:2",     "fibonacci:320"};

TEST(Directions, HaveTheCountAskedForAndAreDifferentUnitVectors)
{
    for (std::string const& name : kSets) {
        DirectionSet const set = make_directions(name);
        EXPECT_EQ(std::to_string(set.size()), name.substr(name.find(':') + 1));
        for (std::size_t i = 0; i < set.size(); ++i) {
            EXPECT_NEAR(glm::length(set.direction(i)), 1, 1e-14) << name;
            EXPECT_EQ(set.direction(i), -set.direction(i ^ 1)) << name;
        }
        for (std::size_t i = 0; i < set.axes.size(); ++i)
            for (std::size_t k = 0; k < i; ++k)
                ASSERT_LT(std::abs(glm::dot(set.axes[i], set.axes[k])), 1 - 1e-6) << name << " " << i << " " << k;
    }
}

/// The dodecahedron's corners are the icosahedron's face centres: every one 41.81 degrees from three others.
TEST(Directions, TheIcosahedronIsOne)
{
    DirectionSet const set = make_directions("icosahedron:20");
    for (std::size_t i = 0; i < set.size(); ++i) {
        int neighbours = 0;
        for (std::size_t k = 0; k < set.size(); ++k)
            neighbours += std::abs(glm::dot(set.direction(i), set.direction(k)) - std::sqrt(5.0) / 3) < 1e-12;
        EXPECT_EQ(neighbours, 3);
    }
}

/// Symmetric sets integrate linear functions to zero; even ones also quadratic functions nearly right.
TEST(Directions, SecondMomentsAreThoseOfTheSphere)
{
    for (char const* name :
         {"icosahedron:20", "icosahedron:320", "octahedron:8", "octahedron:128", "fibonacci:320"}) {
        DirectionSet const set = make_directions(name);
        for (int a = 0; a < 3; ++a)
            for (int b = 0; b <= a; ++b) {
                double sum = 0;
                for (dvec3 const d : set.axes) sum += d[a] * d[b];
                EXPECT_NEAR(sum / double(set.axes.size()), a == b ? 1.0 / 3 : 0.0, 0.01) << name;
            }
    }
}

TEST(Directions, OtherNamesAndCountsAreRefusedWithTheNearest)
{
    for (auto const& [name, hint] : {std::pair<std::string, std::string>{"icosahedron:321", "icosahedron:320"},
                                     {"octahedron:100", "octahedron:128"},
                                     {"uv_grid:300", "uv_grid:288"},
                                     {"halton:3", "even"},
                                     {"cube:6", "icosahedron"},
                                     {"halton", "COUNT"},
                                     {"halton:", "COUNT"},
                                     {"halton:12x", "COUNT"},
                                     {"halton:-2", "COUNT"},
                                     {"halton:1000000", "65536"},
                                     {"", "COUNT"}})
        try {
            make_directions(name);
            ADD_FAILURE() << name << " was accepted";
        } catch (InputError const& e) {
            EXPECT_NE(std::string(e.what()).find(hint), std::string::npos) << e.what();
        }
}

TEST(DirectionQuality, KnowsTheOctahedron)
{
    // Its faces' centres are a cube's corners: cells are equal, and the farthest points are the axes.
    DirectionQuality const q = measure(make_directions("octahedron:8"), kSamples);
    EXPECT_NEAR(q.largest_gap_rad, std::acos(1 / std::sqrt(3.0)), 0.01);
    EXPECT_NEAR(q.smallest_solid_angle, 1, 0.01);
    EXPECT_NEAR(q.largest_solid_angle, 1, 0.01);
    EXPECT_LT(q.solid_angle_deviation, 0.01);
}

TEST(DirectionQuality, MoreDirectionsLeaveSmallerGaps)
{
    double before = 10;
    for (char const* name : {"icosahedron:20", "icosahedron:80", "icosahedron:320", "icosahedron:1280"}) {
        double const gap = measure(make_directions(name), kSamples).largest_gap_rad;
        EXPECT_LT(gap, 0.65 * before) << name;
        before = gap;
    }
}

TEST(DirectionMap, RoundTripsThroughTheOctahedralSquare)
{
    Pcg32 rng(1, 0);
    for (int i = 0; i < 100000; ++i) {
        vec3 const d = direction_from_octahedral(rng.uniform2());
        EXPECT_LT(glm::distance(d, direction_from_octahedral(octahedral_from_direction(d))), 1e-6f);
    }
    for (vec3 const d : {vec3{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}})
        EXPECT_LT(glm::distance(d, direction_from_octahedral(octahedral_from_direction(d))), 1e-6f);
}

TEST(DirectionMap, ErrorIsThatOfItsTexels)
{
    DirectionSet const set = make_directions("icosahedron:320");
    for (SphereMapping const mapping : {SphereMapping::octahedral, SphereMapping::lat_long}) {
        double before = 1;
        for (std::uint32_t const size : {32u, 128u, 512u}) {
            DirectionMap const map = make_direction_map(set, mapping, size);
            MapQuality const q = measure(view(map), set, kSamples);
            EXPECT_LT(q.wrong_share, 0.4 * before);
            EXPECT_LT(q.largest_excess_rad, 2 * 5.0 / size); // a texel spans at most some 5 / size rad
            before = q.wrong_share;
        }
    }
    // Whatever the direction, the answer is one of the set.
    DirectionMap const map = make_direction_map(set, SphereMapping::lat_long, 16);
    for (vec3 const d : {vec3{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {-0.0f, 0, 1}, {0, 0, -1}})
        EXPECT_LT(view(map).look_up(d), 320u);
}

TEST(NearestDirections, AnswerAsAllOfThemDo)
{
    Pcg32 rng(2, 0);
    for (std::string const name :
         {"octahedron:8", "halton:2", "tetrahedron:32", "icosahedron:320", "fibonacci:5000"}) {
        DirectionSet const set = make_directions(name);
        NearestDirections const nearest(set);
        for (int i = 0; i < 50000; ++i) {
            dvec3 d(direction_from_octahedral(rng.uniform2()));
            if (i % 4 == 0) d[i / 4 % 3] *= 1e-6; // near the borders of the octants
            if (i % 5 == 0) d = set.direction(std::size_t(i) % set.size());
            d = glm::normalize(d);
            ASSERT_EQ(nearest(d), nearest_direction(set, d)) << name << " " << d.x << " " << d.y << " " << d.z;
        }
        // As near to several axes of the regular sets: the first one.
        for (int x = -1; x <= 1; ++x)
            for (int y = -1; y <= 1; ++y)
                for (int z = -1; z <= 1; ++z) {
                    if (x == 0 && y == 0 && z == 0) continue;
                    dvec3 const d = glm::normalize(dvec3(x, y, z));
                    ASSERT_EQ(nearest(d), nearest_direction(set, d)) << name << " " << x << " " << y << " " << z;
                }
    }
}

/// sum over axes of |cos| times solid angle: the table's estimate of it has to be
/// right for every normal, by its mean.
TEST(CosineTables, EstimatesAreThoseOfTheDiscreteSet)
{
    for (char const* name : {"icosahedron:80", "halton:144", "uv_grid:128"}) {
        CosineTables const tables = make_cosine_tables(make_directions(name), 16);
        Pcg32 rng(5, 0);
        for (int n = 0; n < 20; ++n) {
            vec3 const normal = direction_from_octahedral(rng.uniform2());
            vec3 const lobe = direction_from_octahedral(rng.uniform2());
            double expected = 0;
            for (std::size_t a = 0; a < tables.axes.size(); ++a) {
                float const cosine = glm::dot(tables.axes[a], normal);
                double const value = 1 + double(glm::dot(cosine < 0 ? -tables.axes[a] : tables.axes[a], lobe));
                expected += double(tables.solid_angles[a] * std::abs(cosine)) * value / glm::pi<double>();
            }
            constexpr int kDraws = 40000;
            double sum = 0, squares = 0, least = 1e9, most = 0;
            for (int i = 0; i < kDraws; ++i) {
                AxisSample const s = view(tables).sample(normal, rng.uniform_double());
                EXPECT_GE(glm::dot(s.direction, normal), 0);
                double const value = double(s.weight) * (1 + double(glm::dot(s.direction, lobe)));
                sum += value;
                squares += value * value;
                least = std::min(least, double(s.weight));
                most = std::max(most, double(s.weight));
            }
            double const mean = sum / kDraws, sigma = std::sqrt((squares / kDraws - mean * mean) / kDraws);
            EXPECT_LT(std::abs(mean - expected), 4 * sigma) << name;
            EXPECT_LT(most, 4) << name << ": axes that the normals of a bin see at grazing angles";
        }
    }
}

TEST(CosineTables, WeightsAreNearlyOneWhereBinsAreSmall)
{
    CosineTables const tables = make_cosine_tables(make_directions("icosahedron:320"), 64);
    Pcg32 rng(6, 0);
    double deviation = 0;
    for (int i = 0; i < 20000; ++i) {
        double const weight =
            double(view(tables).sample(direction_from_octahedral(rng.uniform2()), rng.uniform_double()).weight);
        deviation += (weight - 1) * (weight - 1);
    }
    EXPECT_LT(std::sqrt(deviation / 20000), 0.06);
}

TEST(DirectionPicture, IsDrawnForEverySet)
{
    for (char const* name : {"fibonacci:2", "octahedron:8", "halton:144"}) {
        DirectionPicture const p = draw(make_directions(name));
        EXPECT_EQ(p.rgb.size(), std::size_t(p.width) * std::size_t(p.height) * 3);
    }
}

} // namespace
} // namespace gi::test
