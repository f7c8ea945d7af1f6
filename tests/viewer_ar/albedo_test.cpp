// Albedos found again in pictures of a place lit from far away, where they are known.

#include "ar/pipeline/bridge.h"
#include "ar/pipeline/estimate_albedo.h"
#include "ar/pipeline/synthetic.h"
#include "ar/runtime/frames_apart.h"
#include "gi/core/error.h"

#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

ar::RealPlace place(gi::dvec3 table, gi::dvec3 block, bool is_estimated)
{
    ar::ProxySurface top, side;
    top.albedo = table;
    side.albedo = block;
    if (is_estimated) {
        top.from = ar::AlbedoFrom::estimate_texture;
        top.texels = 16;
        side.from = ar::AlbedoFrom::estimate;
    }
    ar::RealPlace real;
    real.proxies.push_back({"table", top, ar::ProxyPlane{{-0.6, 0, 0.5}, {1.2, 0, 0}, {0, 0, -1}}});
    real.proxies.push_back({"block", side, ar::ProxyBox{{0.2, 0.15, 0.2}, {{0.1, 0.075, 0}, {1, 0, 0, 0}}}});
    return real;
}

class Albedos : public testing::Test {
protected:
    Albedos()
    {
        cv::Mat map(16, 32, CV_32FC3, cv::Scalar(0.5, 0.45, 0.4));
        cv::rectangle(map, {18, 2, 3, 3}, cv::Scalar(6, 6, 5), cv::FILLED);
        light_ = std::make_shared<gi::EnvironmentMap const>(ar::environment_of(map));
    }

    std::vector<ar::PosedFrame> frames(gi::Scene scene)
    {
        scene.environment = *light_;
        ar::SyntheticQuality quality;
        quality.paths = 48;
        std::vector<ar::PosedFrame> out;
        for (double const t : {0.1, 0.8}) {
            gi::RigidPose const pose = ar::synthetic_pose(t);
            cv::Mat const radiance =
                ar::synthetic_radiance(scene, std::nullopt, camera_.model, pose, quality, 5, {}, report_);
            out.push_back({ar::synthetic_frame(radiance, camera_, out.size()), {}, pose, 1});
        }
        return out;
    }

    ar::AlbedoEstimate estimate(std::span<ar::PosedFrame const> seen)
    {
        ar::EstimateSettings s;
        s.resolution = 1;
        return ar::estimate_albedos(model_of(place({}, {}, true), report_), light_,
                                    {camera_.model, camera_.photometry, {}}, seen, s, {}, report_);
    }

    ar::SyntheticCamera camera_ = ar::synthetic_camera({96, 72});
    std::shared_ptr<gi::EnvironmentMap const> light_;
    gi::Report report_;
};

TEST_F(Albedos, AreThoseOfThePlace)
{
    gi::dvec3 const table(0.42, 0.3, 0.2), block(0.15, 0.25, 0.5);
    ar::AlbedoEstimate const e = estimate(frames(model_of(place(table, block, false), report_).scene));
    ASSERT_EQ(e.entries.size(), 2u);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(e.entries[0].albedo[c] / table[c], 1, 0.04) << c;
        EXPECT_NEAR(e.entries[1].albedo[c] / block[c], 1, 0.06) << c;
    }
    EXPECT_TRUE(e.solution.converged);
    EXPECT_EQ(e.textures[0].size(), cv::Size(16, 13));
    EXPECT_TRUE(e.textures[1].empty());
    cv::Scalar const mean = cv::mean(e.textures[0]);
    EXPECT_NEAR(mean[0] / table.x, 1, 0.05);
    EXPECT_LT(e.filled, e.texels);
}

TEST_F(Albedos, WithNothingToGoByAreRefused)
{
    EXPECT_THROW(estimate({}), gi::InputError) << "no frame";
    std::vector<ar::PosedFrame> const one{
        {cv::Mat(72, 96, CV_8UC3, cv::Scalar::all(90)), {}, ar::synthetic_pose(0), 1}};
    light_ = nullptr;
    EXPECT_THROW(estimate(one), gi::InputError) << "no light";
}

TEST(FramesApart, AreSpreadOverAll)
{
    ar::SpacedFrames<int> kept(4);
    for (int i = 0; i < 1000; ++i)
        if (kept.wants_next())
            kept.add(i);
        else
            kept.skip();
    std::vector<int> const some = kept.take();
    ASSERT_EQ(some.size(), 4u);
    EXPECT_EQ(some.front(), 0);
    EXPECT_GE(some.back(), 600);
    for (std::size_t i = 1; i < some.size(); ++i) EXPECT_GT(some[i] - some[i - 1], 100);
    ar::SpacedFrames<int> few(4);
    few.add(7);
    EXPECT_EQ(few.take(), std::vector<int>{7});
}

} // namespace
} // namespace viewer::test
