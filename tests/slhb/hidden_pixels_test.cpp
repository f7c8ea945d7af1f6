// Pixels that nobody sees cost nothing, and what is seen is what it would be without them.

#include "gi/hit_buffers/settings.h"
#include "gi/metrics/metrics.h"
#include "tests/slhb/slhb_render.h"

#include <glm/gtc/matrix_transform.hpp>
#include <numeric>

namespace gi::test {
namespace {

constexpr int kSize = 96;

/// Outside of a circle that is as wide as the picture.
std::vector<std::uint8_t> around_a_lens()
{
    std::vector<std::uint8_t> hidden;
    for (int y = 0; y < kSize; ++y)
        for (int x = 0; x < kSize; ++x)
            hidden.push_back(std::hypot(x + 0.5 - 0.5 * kSize, y + 0.5 - 0.5 * kSize) > 0.5 * kSize);
    return hidden;
}

Camera eye(double aside = 0)
{
    Camera camera = look_at({-0.6, 0.1, 0.9}, {0.1, -0.4, 0}, 80);
    camera.world_from_camera = camera.world_from_camera * glm::translate(dmat4(1), dvec3{aside, 0, 0});
    return camera;
}

class HiddenPixels : public ::testing::Test {
protected:
    HiddenPixels()
    {
        s.of<SlhbSettings>().schedule = Schedule::stored;
        s.of<SlhbSettings>().directions = "icosahedron:80";
        s.of<SlhbSettings>().resolution = 64;
    }

    std::vector<RenderResult> render(bool hides, int partner, VertexSharing sharing, std::uint32_t paths)
    {
        std::vector<FrameView> views{{eye(), kSize, kSize}, {eye(0.06), kSize, kSize, partner}};
        if (hides) views[0].hidden = views[1].hidden = hidden;
        Report report;
        auto results = start_frames_as_set(world, eye(), s, report)->views(views, paths, sharing, {});
        counts = report.counts();
        return results;
    }
    double share() const { return double(std::ranges::count(hidden, 1)) / double(hidden.size()); }
    double lookups() const { return counts.at("hit-buffer queries") + counts.at("shadow-map look-ups"); }

    void expect_black(Picture const& picture) const
    {
        for (Layer const& layer : picture.layers) {
            if (layer.name == "motion") continue;
            for (std::size_t i = 0; i < layer.data.size(); ++i)
                if (hidden[i / std::size_t(layer.channels)] != 0) {
                    ASSERT_EQ(layer.data[i], 0) << layer.name << ' ' << i / std::size_t(layer.channels);
                }
        }
    }

    Report load_report;
    MovingWorld const world{std::make_shared<Scene const>(box_with_block_and_lamp()), 0, load_report};
    RenderSettings s = small_settings(kSize, 1, 2);
    std::vector<std::uint8_t> const hidden = around_a_lens();
    std::map<std::string, double> counts;
};

TEST_F(HiddenPixels, AreBlackAndAllOthersAreTheSame)
{
    auto const all = render(false, -1, VertexSharing::none, 3);
    EXPECT_FALSE(counts.contains("share of pixels not rendered"));
    double const before = lookups();
    auto const some = render(true, -1, VertexSharing::none, 3);
    for (std::size_t k = 0; k < 2; ++k) {
        expect_black(some[k].picture);
        for (Layer const& layer : some[k].picture.layers) {
            Layer const& whole = *all[k].picture.find(layer.name);
            for (std::size_t i = 0; i < layer.data.size(); ++i)
                if (hidden[i / std::size_t(layer.channels)] == 0) {
                    ASSERT_EQ(layer.data[i], whole.data[i]) << layer.name << ' ' << i;
                }
        }
    }
    EXPECT_NEAR(share(), 0.215, 0.01);
    EXPECT_DOUBLE_EQ(counts.at("share of pixels not rendered"), share());
    EXPECT_EQ(counts.at("pixels not rendered, as nobody sees them"), share() * 3 * 2 * kSize * kSize);
    std::printf("look-ups: %.0f of %.0f, %.1f %% less; hidden: %.1f %%\n", lookups(), before,
                100 * (1 - lookups() / before), 100 * share());
    EXPECT_NEAR(1 - lookups() / before, share(), 0.05);
}

/// With a partner and shared vertices light comes from fewer pixels: the same picture, other noise.
TEST_F(HiddenPixels, GiveNoLightToOthers)
{
    constexpr std::uint32_t kPaths = 128;
    auto const all = render(false, 0, VertexSharing::cached, kPaths);
    double const before = lookups(), taken = counts.at("share of pixels lit by a partner view");
    auto const some = render(true, 0, VertexSharing::cached, kPaths);
    EXPECT_NEAR(counts.at("share of pixels lit by a partner view"), taken, 0.05);
    for (std::size_t k = 0; k < 2; ++k) {
        expect_black(some[k].picture);
        std::vector<float> seen, right;
        for (std::size_t i = 0; i < hidden.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c)
                if (hidden[i] == 0) {
                    seen.push_back(some[k].picture.find("color")->data[3 * i + c]);
                    right.push_back(all[k].picture.find("color")->data[3 * i + c]);
                }
        double const relmse = measure_errors(seen, right, 3).relmse;
        EXPECT_LT(relmse, 4e-3) << k;
        double const mean = std::accumulate(seen.begin(), seen.end(), 0.0),
                     other = std::accumulate(right.begin(), right.end(), 0.0);
        EXPECT_NEAR(mean / other, 1, 0.005) << k;
    }
    std::printf("look-ups: %.1f %% less\n", 100 * (1 - lookups() / before));
    EXPECT_GT(1 - lookups() / before, 0.5 * share());
}

/// A single picture and one of a pair are whole: nobody says what hides them.
TEST_F(HiddenPixels, OfAnEarlierCallAreForgotten)
{
    Report report;
    auto const frames = start_frames_as_set(world, eye(), s, report);
    FrameView view{eye(), kSize, kSize};
    view.hidden = hidden;
    frames->views({&view, 1}, 1, VertexSharing::exact, {});
    RenderResult const whole = frames->frame(eye(), {}, {});
    EXPECT_GT(whole.picture.find("depth")->data[0], 0);
}

} // namespace
} // namespace gi::test
