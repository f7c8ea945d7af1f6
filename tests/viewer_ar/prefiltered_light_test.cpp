// Prefiltered light: exact where nothing is in the way, near closed forms where something is, the same every time.

#include "ar/light/lat_long.h"
#include "ar/light/map_file.h"
#include "ar/pipeline/local_scene.h"
#include "ar/pipeline/prefiltered/prefiltered_light.h"
#include "gi/core/rng.h"
#include "gi/scene/motion/moving_world.h"
#include "gi/scene/shading/warp.h"
#include "tests/support/data.h"
#include "tests/viewer_ar/lit_places.h"

#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

/// Virtual objects on real ones, under a map.
struct Place {
    Place(gi::Scene real, gi::Scene things, std::shared_ptr<gi::EnvironmentMap const> map)
        : local(ar::join_scenes(std::move(real), std::move(things), gi::dmat4(1))), moving(local.scene, 0, report)
    {
        moving.set_environment(std::move(map));
    }
    gi::World const& world() const { return moving.world(); }
    /// The point where a line along -normal meets the first triangle that faces it.
    ar::LitPoint point(gi::vec3 at, gi::vec3 normal) const
    {
        ar::LitPoint p{at, normal, normal, gi::kNoPrimitive, {}, {}};
        float nearest = gi::kInf;
        for (std::size_t t = 0; t < world().triangles.size(); ++t) {
            gi::Surface const& s = world().surfaces[t];
            gi::vec3 const n = gi::shading_detail::triangle_normal(s);
            gi::vec2 const b = gi::barycentric_at(s, at);
            gi::vec3 const on = s.corner + b.x * s.edge1 + b.y * s.edge2;
            if (std::abs(glm::dot(n, normal)) > 0.99f && glm::distance(on, at) < nearest) {
                nearest = glm::distance(on, at);
                p.triangle = std::uint32_t(t);
                p.position = on;
            }
        }
        return p;
    }

    gi::Report report;
    ar::LocalScene local;
    gi::MovingWorld moving;
};

/// Largest relative difference of a free box's faces from the irradiance summed over the map; of the darkest ones,
/// relative to a twentieth of the brightest.
double worst_face(cv::Mat const& map)
{
    Place const place({}, box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, matt(0.5f)), environment(map));
    ar::PrefilteredLight const light(place.world());
    std::vector<cv::Vec3d> wanted;
    std::vector<gi::vec3> got;
    for (gi::vec3 const n : kAxes) {
        gi::vec3 const at = 0.5f * n + gi::vec3(-0.4f, 0.3f, 0.42f) * (1.0f - glm::abs(n));
        wanted.push_back(ar::irradiance_exact(map, gi::dvec3(n)));
        got.push_back(light.on_moving(place.point(at, n)).irradiance);
    }
    gi::Pcg32 rng = gi::Pcg32::for_path(1, 2, 3);
    for (int k = 0; k < 4; ++k) { // faces of boxes that lie anyhow
        float const y = 2 * rng.uniform() - 1;
        gi::vec3 const n(std::sqrt(1 - y * y) * gi::azimuth(rng.uniform()), y);
        wanted.push_back(ar::irradiance_exact(map, gi::dvec3(n)));
        got.push_back(light.open(n));
    }
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        double brightest = 0;
        for (cv::Vec3d const& w : wanted) brightest = std::max(brightest, w[c]);
        for (std::size_t k = 0; k < got.size(); ++k)
            worst = std::max(worst, std::abs(double(got[k][c]) - wanted[k][c]) /
                                        std::max(wanted[k][c], 0.05 * brightest));
    }
    return worst;
}

TEST(PrefilteredLights, FacesOfABoxHaveTheIrradianceOfTheMap)
{
    EXPECT_LT(worst_face(uniform(2)), 0.002);
    cv::Mat lamps = uniform(0.1);
    cv::rectangle(lamps, {50, 8, 2, 2}, cv::Scalar(300, 200, 100), cv::FILLED);
    cv::rectangle(lamps, {10, 20, 3, 1}, cv::Scalar(20, 100, 200), cv::FILLED);
    EXPECT_LT(worst_face(lamps), 0.01);
}

TEST(PrefilteredLights, FacesOfABoxUnderRealMaps)
{
    LIGHTWELL_NEED_DATA("envmaps");
    for (char const* const name :
         {"dancing_hall_1k.hdr", "autoshop_01_1k.hdr", "kloppenheim_05_1k.hdr", "hilly_terrain_01_1k.hdr",
          "st_peters_square_night_1k.hdr", "dresden_square_1k.hdr"}) {
        double const worst = worst_face(ar::read_map(gi::test::shared_data() / "envmaps" / name));
        std::printf("%s: %.4f\n", name, worst);
        EXPECT_LT(worst, 0.02) << name;
    }
}

TEST(PrefilteredLights, ASquareAboveTheFloorHidesItsFormFactor)
{
    // A black square of 1 m, 0.5 m above a floor under a uniform sky:
    // beneath its middle remains 1 - F of the light.
    gi::SceneBuilder b;
    b.quad(b.add_material("square", matt(0)), {-0.5f, 0.5f, 0.5f}, {1, 0, 0}, {0, 0, -1});
    Place const place(floor(4, matt(0.5f)), b.finish("square"), environment(uniform(1)));
    ar::PrefilteredLight const light(place.world());
    for (double const off : {0.0, 0.25, 0.5}) {
        ar::LitPoint const at = place.point({float(off), 0, 0}, {0, 1, 0});
        // Differential area to parallel rectangle with a corner above it (Howell, B-3), for four quarters.
        auto const corner = [](double a, double c) {
            double const x = a / 0.5, y = c / 0.5;
            return (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                    y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                   (2 * gi::kPiD);
        };
        double const f = 2 * (corner(0.5 - off, 0.5) + corner(0.5 + off, 0.5));
        double const got = -double(light.change_on_still(at).irradiance.x) / gi::kPiD;
        std::printf("%.2f m beside the middle: hidden %.4f, closed form %.4f\n", off, got, f);
        EXPECT_NEAR(got, f, 0.03);
    }
    ar::LitPoint const far = place.point({3.9f, 0, 3.9f}, {0, 1, 0});
    EXPECT_GT(light.change_on_still(far).irradiance.x, -0.02f);
}

TEST(PrefilteredLights, AWhiteRoomCornerUnderAWhiteSkyIsWhite)
{
    // Furnace: with an albedo of 1 everywhere, every surface has the radiance of the sky, hidden or not. What is
    // beyond the second bounce is lost.
    Place const place(floor(2, matt(1)), box({-0.2f, 0.001f, -0.2f}, {0.2f, 0.4f, 0.2f}, matt(1)),
                      environment(uniform(1)));
    ar::PrefilteredLight const light(place.world());
    for (gi::vec3 const n : {kAxes[0], kAxes[2], kAxes[4]}) {
        gi::vec3 const at = gi::vec3(0, 0.2f, 0) + 0.2f * n;
        double const radiance = double(light.on_moving(place.point(at, n)).irradiance.x) / gi::kPiD;
        std::printf("side %g %g %g: %.4f\n", double(n.x), double(n.y), double(n.z), radiance);
        EXPECT_NEAR(radiance, 1, 0.06);
    }
    ar::LitPoint const beside = place.point({0.3f, 0, 0}, {0, 1, 0});
    double const radiance =
        double((light.on_still(beside).irradiance + light.change_on_still(beside).irradiance).x) / gi::kPiD;
    std::printf("floor beside it: %.4f\n", radiance);
    EXPECT_NEAR(radiance, 1, 0.08);
}

TEST(EnvironmentCells, KeepAllLightAndAngle)
{
    cv::Mat map = uniform(0.2);
    cv::rectangle(map, {40, 5, 1, 1}, cv::Scalar(5000, 4000, 3000), cv::FILLED);
    cv::rectangle(map, {2, 12, 6, 8}, cv::Scalar(3, 4, 5), cv::FILLED);
    Place place({}, {}, environment(map));
    ar::EnvironmentTexels const texels = ar::environment_texels(place.world());
    ar::EnvironmentCells cells;
    EXPECT_TRUE(cells.update(texels));
    EXPECT_EQ(cells.cells().size(), 128u);
    gi::dvec3 light(0);
    double sr = 0, share = 0;
    for (ar::EnvironmentCell const& c : cells.cells()) {
        light += gi::dvec3(c.light);
        sr += double(c.solid_angle_sr);
        share += double(c.share);
        EXPECT_NEAR(glm::length(c.direction), 1, 1e-5);
    }
    EXPECT_NEAR(sr, 4 * gi::kPiD, 1e-4);
    EXPECT_NEAR(share, 1, 1e-5);
    cv::Vec3d const wanted = ar::integral(map);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c] / wanted[c], 1, 1e-5);
    EXPECT_FALSE(cells.update(texels)) << "the same light, the same parts";
    cv::Mat moved = uniform(0.2);
    cv::rectangle(moved, {10, 25, 1, 1}, cv::Scalar(5000, 4000, 3000), cv::FILLED);
    place.moving.set_environment(environment(moved));
    EXPECT_TRUE(cells.update(ar::environment_texels(place.world()))) << "the lamp has moved";
    place.moving.set_environment(nullptr);
    EXPECT_TRUE(cells.update(ar::environment_texels(place.world())));
    EXPECT_TRUE(cells.cells().empty());
}

TEST(PrefilteredLights, HardCases)
{
    gi::Scene const things = box({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f));
    cv::Mat const black = uniform(0);
    cv::Mat sun = uniform(0);
    sun.at<cv::Vec3f>(6, 20) = cv::Vec3f(1e6f, 1e6f, 1e6f);
    auto const lit = [&](gi::Scene real, gi::Scene virtual_things, std::shared_ptr<gi::EnvironmentMap const> map) {
        Place const place(std::move(real), std::move(virtual_things), std::move(map));
        ar::PrefilteredLight light(place.world());
        light.moved();
        ar::ReceivedLight sum;
        for (std::size_t t = 0; t < place.world().triangles.size(); ++t) {
            gi::Surface const& s = place.world().surfaces[t];
            gi::vec3 const n = gi::shading_detail::triangle_normal(s);
            ar::LitPoint const at{
                s.corner + (s.edge1 + s.edge2) / 3.0f, n, n, std::uint32_t(t), n, {0.3f, gi::vec3(0.1f)}};
            for (ar::ReceivedLight const& r :
                 {light.on_moving(at), light.change_on_still(at), light.on_still(at), light.on_still(at, 8, 7)}) {
                EXPECT_TRUE(gi::all_finite(r.irradiance) && gi::all_finite(r.glossy));
                sum.irradiance += r.irradiance;
            }
        }
        return sum.irradiance;
    };
    EXPECT_EQ(lit(floor(1, matt(0.5f)), things, nullptr), gi::vec3(0));
    EXPECT_EQ(lit(floor(1, matt(0.5f)), things, environment(black)), gi::vec3(0));
    EXPECT_GT(lit(floor(1, matt(0.5f)), things, environment(sun)).x, 0);
    EXPECT_GT(lit({}, things, environment(uniform(1))).x, 0) << "nothing real";
    EXPECT_GT(lit(floor(1, matt(0.5f)), {}, environment(uniform(1))).x, 0) << "nothing virtual";
    EXPECT_EQ(lit({}, {}, environment(uniform(1))), gi::vec3(0));
    EXPECT_GT(lit(floor(1e4f, matt(0.5f)), things, environment(uniform(1))).x, 0) << "a wide plain";
    EXPECT_GT(
        lit(floor(1e-3f, matt(0.5f)), box(gi::vec3(-1e-4f), gi::vec3(1e-4f), matt(0.5f)), environment(uniform(1)))
            .x,
        0);
    EXPECT_GT(lit(floor(1, matt(0.5f)), box({-0.1f, 0, -0.1f}, {0.1f, 0, 0.1f}, matt(0.5f)),
                  environment(cv::Mat(1, 2, CV_32FC3, cv::Scalar::all(1))))
                  .x,
              0)
        << "flat, coplanar with the floor, under a map of two texels";
}

/// Radiance that a glossy surface with this normal reflects of a map, summed over its texels.
gi::dvec3 reflected(cv::Mat const& map, gi::Bsdf const& lobe, gi::vec3 normal, gi::vec3 to_viewer)
{
    gi::Frame const frame = gi::Frame::about(normal);
    gi::dvec3 sum(0);
    for (int j = 0; j < map.rows; ++j)
        for (int i = 0; i < map.cols; ++i) {
            glm::vec3 const d(ar::texel_direction(map.size(), i, j));
            float const c = glm::dot(d, normal);
            if (!(c > 0)) continue;
            cv::Vec3f const l = map.at<cv::Vec3f>(j, i);
            sum += double(c) * ar::texel_sr(map.size(), j) *
                   gi::dvec3(gi::evaluate(lobe, frame.to_local(to_viewer), frame.to_local(d)).f) *
                   gi::dvec3(l[0], l[1], l[2]);
        }
    return sum;
}

/// The split sum is exact under an even sky seen from in front, and near where light varies over the lobe.
TEST(PrefilteredLights, GlossyLobesReflectWhatTheBsdfDoes)
{
    cv::Mat lamp(128, 256, CV_32FC3, cv::Scalar::all(0.3));
    cv::rectangle(lamp, {5, 45, 25, 18}, cv::Scalar(6, 5, 4), cv::FILLED); // about +z
    for (auto const& [name, map, tolerance] :
         {std::tuple{"even", cv::Mat(128, 256, CV_32FC3, cv::Scalar::all(1)), 0.015}, {"lamp", lamp, 0.2}})
        for (float const roughness : {0.3f, 0.5f, 0.8f}) {
            gi::Material m = matt(0.9f);
            m.metallic = 1;
            m.roughness = roughness;
            Place const place({}, box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, m), environment(map));
            ar::PrefilteredLight const light(place.world());
            gi::Bsdf const bsdf = gi::make_bsdf(m);
            for (gi::vec3 const& to_viewer : {gi::vec3(0, 0, 1), glm::normalize(gi::vec3(0.5f, 0.3f, 1))}) {
                ar::LitPoint at = place.point({0.1f, 0.1f, 0.5f}, {0, 0, 1});
                at.to_viewer = to_viewer;
                at.lobe = ar::glossy_lobe_of(bsdf, to_viewer.z);
                double const got = double(light.on_moving(at).glossy.y);
                double const wanted = reflected(map, gi::glossy_lobe(bsdf), {0, 0, 1}, to_viewer).y;
                std::printf("%s, roughness %.1f: %.4f, by the BSDF %.4f\n", name, double(roughness), got, wanted);
                EXPECT_NEAR(got / wanted, 1, tolerance);
            }
        }
}

TEST(PrefilteredLights, DrawMapsOfManyTrianglesOverSeveralFrames)
{
    gi::Scene things = box({-0.1f, 0.1f, -0.1f}, {0.1f, 0.3f, 0.1f}, matt(0.5f));
    Place place(floor(1, matt(0.5f)), things, environment(uniform(1)));
    ar::PrefilteredLight whole(place.world()), parts(place.world(), {}, {.triangles_at_once = 1});
    gi::Pose pose = ar::local_pose(place.local, std::nullopt, gi::PairSide::with);
    for (std::size_t n = place.local.first_virtual_node; n < pose.world_from_node.size(); ++n)
        pose.world_from_node[n][3].x += 0.02;
    place.moving.advance(pose);
    whole.moved();
    parts.moved();
    auto const on_floor = [&](ar::PrefilteredLight const& light) {
        std::vector<float> changes;
        for (float x = -0.5f; x < 0.5f; x += 0.05f)
            changes.push_back(light.change_on_still(place.point({x, 0, 0.02f}, {0, 1, 0})).irradiance.x);
        return changes;
    };
    std::vector<float> const late = on_floor(parts), current = on_floor(whole);
    float largest = 0;
    for (std::size_t i = 0; i < late.size(); ++i) largest = std::max(largest, std::abs(late[i] - current[i]));
    EXPECT_GT(largest, 0.01f); // not by rounding
    int frames = 0;
    while (parts.settle()) ++frames;
    EXPECT_GT(frames, 50);
    EXPECT_LT(frames, 200);
    EXPECT_EQ(on_floor(parts), on_floor(whole));
    EXPECT_EQ(parts.on_moving(place.point({0.02f, 0.2f, 0.1f}, {0, 0, 1})).irradiance,
              whole.on_moving(place.point({0.02f, 0.2f, 0.1f}, {0, 0, 1})).irradiance);
}

/// Objects that appear: patches suit their size.
TEST(PrefilteredLights, FitPatchesToObjectsThatGrow)
{
    Place place(floor(1, matt(0.5f)), box({-0.1f, 0.1f, -0.1f}, {0.1f, 0.3f, 0.1f}, matt(0.5f)),
                environment(uniform(1)));
    ar::PrefilteredLight const grown(place.world());
    gi::Pose const pose = ar::local_pose(place.local, std::nullopt, gi::PairSide::with);
    place.moving.advance(ar::local_pose(place.local, std::nullopt, gi::PairSide::without));
    ar::PrefilteredLight light(place.world());
    place.moving.advance(pose);
    light.moved();
    EXPECT_GT(light.counts().patches, grown.counts().patches / 2);
    ar::LitPoint const below = place.point({0, 0.1f, 0}, {0, -1, 0});
    EXPECT_NEAR(light.on_moving(below).irradiance.x / grown.on_moving(below).irradiance.x, 1, 0.05);
}

} // namespace
} // namespace viewer::test
