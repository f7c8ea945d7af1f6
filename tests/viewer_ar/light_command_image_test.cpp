// lightwell ar light, and a session that takes its light from its first frame.

#include "ar/light/lat_long.h"
#include "ar/light/map_file.h"
#include "ar/runtime/light_check.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

/// A blue sky over dark ground, and a sun.
cv::Mat sunny(double sun)
{
    cv::Mat map(32, 64, CV_32FC3);
    for (int j = 0; j < map.rows; ++j)
        map.row(j).setTo(j < 16 ? cv::Scalar(0.5, 0.7, 1.1) : cv::Scalar(0.2, 0.17, 0.15));
    map.at<cv::Vec3f>(6, 22) = cv::Vec3f(float(sun), float(0.95 * sun), float(0.85 * sun));
    return map;
}

ar::LightCheckSettings quick()
{
    ar::LightCheckSettings s;
    s.size_px = {240, 180};
    s.paths = 24;
    s.composites = false;
    return s;
}

TEST(LightFromFrame, FindsTheSunOfASyntheticDesk)
{
    gi::Report report;
    ar::LightChecked const c = ar::check_light(sunny(300), quick(), {}, report);
    EXPECT_LT(c.lamp_deg, 3); // the sun's texel is 5.6 degrees wide
    EXPECT_GE(c.lamp_deg, 0);
    EXPECT_NEAR(c.up_ratio, 1, 0.03);
    EXPECT_LT(c.white_deg, 2.5);
    EXPECT_LT(c.irradiance_rms, 0.1);
    EXPECT_TRUE(c.light.scale_is_known);
    EXPECT_GT(c.light.counts.used, 1000u);
    EXPECT_GT(c.light.faces[3].sigma, 3 * c.light.faces[2].sigma); // nothing shows what comes from below
}

TEST(LightFromFrame, FindsAlbedosWithIt)
{
    gi::Report report;
    ar::LightCheckSettings s = quick();
    s.unknown_albedo = true;
    ar::LightChecked const c = ar::check_light(sunny(300), s, {}, report);
    EXPECT_GE(c.lamp_deg, 0);
    EXPECT_LT(c.lamp_deg, 4);
    EXPECT_NEAR(c.up_ratio, 1, 0.12);
    EXPECT_LT(c.irradiance_rms, 0.2);
    for (auto const& a : c.light.albedos) {
        if (a.name == "table") {
            EXPECT_NEAR(a.albedo[1], 0.3, 0.04);
        }
        if (a.name == "box") {
            EXPECT_NEAR(a.albedo[0], 0.7, 0.15);
        }
    }
}

TEST(ArLight, WritesAMapThatTheSessionTakes)
{
    TemporaryFolder const folder;
    run_well("ar synthesize desk --frames 2 --size 160x120 --paths 4 --no-truth", folder.path());
    Outcome const o =
        run_well("ar light desk/session.yaml --poses desk/poses.csv --views 2 --out light.exr --stats s.json",
                 folder.path());
    EXPECT_NE(o.out.find("irradiance of surfaces facing"), std::string::npos);
    EXPECT_NE(o.out.find("not to be trusted: irradiance of faces -y"), std::string::npos) << o.out;
    auto const stats = nlohmann::json::parse(file_text(folder / "s.json"));
    EXPECT_EQ(stats["frames"]["compared"], 2);
    EXPECT_EQ(stats["faces"].size(), 6u);
    EXPECT_FALSE(stats["warnings"].empty());
    cv::Vec3d const up = ar::irradiance_exact(ar::read_map(folder / "light.exr"), {0, 1, 0}),
                    truth = ar::irradiance_exact(ar::read_map(folder / "desk/probe.exr"), {0, 1, 0});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(up[c] / truth[c], 1, 0.25); // the window is near: light is not even
    Outcome const json =
        run_well("ar light desk/session.yaml --poses desk/poses.csv --frame 1 --out l2.exr --json", folder.path());
    EXPECT_EQ(nlohmann::json::parse(json.out)["frames"]["compared"], 1);

    std::string text = file_text(folder / "desk/session.yaml");
    text.replace(text.find("{map: probe.exr}"), 16, "{from: frame}");
    std::ofstream(folder / "desk/frame.yaml") << text;
    Outcome const ran =
        run_well("ar run desk/frame.yaml --poses desk/poses.csv --fast --out out --stats r.json", folder.path());
    std::string const counts = file_text(folder / "r.json");
    EXPECT_NE(counts.find("unexplained shading of the frame"), std::string::npos) << counts;
    Outcome const albedo = run("ar albedo desk/frame.yaml --poses desk/poses.csv --scene", folder.path());
    EXPECT_EQ(albedo.code, 2);
    EXPECT_NE(albedo.err.find("run lightwell ar light first"), std::string::npos) << albedo.err;
}

TEST(ArLight, RefusesWhatItCannotUse)
{
    TemporaryFolder const folder;
    run_well("ar synthesize desk --quick --frames 2 --size 160x120", folder.path());
    std::string const poses = " --poses desk/poses.csv";
    auto const refusal = [&](std::string const& rest) {
        Outcome const o = run("ar light " + rest, folder.path());
        EXPECT_EQ(o.code, 2) << o.out;
        EXPECT_FALSE(std::filesystem::exists(folder / "x.exr"));
        return o.err;
    };
    EXPECT_NE(refusal("desk/session.yaml --out x.png" + poses).find(".exr"), std::string::npos);
    EXPECT_NE(refusal("desk/session.yaml --out desk/near.glb" + poses).find("also an input"), std::string::npos);
    EXPECT_NE(refusal("desk/session.yaml --frame 9 --out x.exr" + poses).find("--frame 9"), std::string::npos);
    std::string text = file_text(folder / "desk/session.yaml");
    text.erase(text.find("real: "), text.find("virtual: ") - text.find("real: "));
    std::ofstream(folder / "desk/bare.yaml") << text;
    EXPECT_NE(refusal("desk/bare.yaml --out x.exr" + poses).find("models no real surface"), std::string::npos);
}

} // namespace
} // namespace viewer::test
