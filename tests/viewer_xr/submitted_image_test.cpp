// What a runtime gets of each picture, kept by an API layer before it (layers/recorder_layer.cpp): depths beside the
// colours, and insets where the runtime has them (layers/quad_layer.cpp).

#include "tests/viewer_xr/monado.h"
#include "tests/viewer_xr/remote_driver.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <glm/gtc/quaternion.hpp>

namespace viewer::test {
namespace {

using nlohmann::json;

/// One view of a submitted picture. Rows from the bottom.
struct Submitted {
    json about;
    int width = 0, height = 0;
    std::vector<unsigned char> rgba;
    std::vector<float> depths; ///< empty: none were submitted

    glm::dvec3 position() const
    {
        json const& p = about.at("position");
        return {p[0], p[1], p[2]};
    }
    double edge(int k) const { return std::tan(double(about.at("fov_rad")[std::size_t(k)])); }
    /// To the right and up, of the middle of a pixel.
    glm::dvec2 tangents(int x, int y) const
    {
        double const u = (x + 0.5) / width, v = (y + 0.5) / height;
        return {edge(0) + u * (edge(1) - edge(0)), edge(3) + v * (edge(2) - edge(3))};
    }
    glm::ivec2 pixel_of(glm::dvec2 t) const
    {
        return {int(width * (t.x - edge(0)) / (edge(1) - edge(0))),
                int(height * (t.y - edge(3)) / (edge(2) - edge(3)))};
    }
    /// In the runtime's space, of the middle of a pixel, 1 m ahead.
    glm::dvec3 direction(int x, int y) const
    {
        json const& q = about.at("rotation");
        return glm::dquat(q[3], q[0], q[1], q[2]) * glm::dvec3(tangents(x, y), -1);
    }
    float depth(int x, int y) const { return depths[std::size_t(y * width + x)]; }
    glm::dvec3 color(int x, int y) const
    {
        unsigned char const* const p = &rgba[4 * std::size_t(y * width + x)];
        return {p[0], p[1], p[2]};
    }
};

template <class Value>
std::vector<Value> values(std::filesystem::path const& file)
{
    std::string const bytes = file_text(file);
    std::vector<Value> all(bytes.size() / sizeof(Value));
    std::memcpy(all.data(), bytes.data(), all.size() * sizeof(Value));
    return all;
}

using Frame = std::vector<Submitted>;

class SubmittedTest : public Monado {
protected:
    void SetUp() override
    {
        Monado::SetUp();
        if (IsSkipped()) return;
        std::filesystem::create_directory(folder / "frames");
    }

    std::vector<std::string> with_layers(std::string const& layers) const
    {
        return {"XR_API_LAYER_PATH=" XR_LAYERS, "XR_ENABLE_API_LAYERS=" + layers,
                "DISPLAY=", "LIGHTWELL_TEST_FRAMES=" + (folder / "frames").string()};
    }
    std::size_t kept() const
    {
        std::size_t count = 0;
        for (auto const& file : std::filesystem::directory_iterator(folder / "frames"))
            count += file.path().extension() == ".json";
        return count;
    }
    std::vector<Frame> frames() const
    {
        std::vector<Frame> all;
        for (auto const& file : std::filesystem::directory_iterator(folder / "frames")) {
            if (file.path().extension() != ".json") continue;
            Frame& frame = all.emplace_back();
            for (json const& view : json::parse(file_text(file.path()))) {
                std::string const name = file.path().stem().string() + "_" + std::to_string(frame.size());
                Submitted s{view,
                            view["width"],
                            view["height"],
                            values<unsigned char>(folder / "frames" / (name + ".color")),
                            {}};
                if (view.contains("depth")) s.depths = values<float>(folder / "frames" / (name + ".depth"));
                frame.push_back(std::move(s));
            }
        }
        return all;
    }
    /// As XR_KHR_composition_layer_depth has reversed depths whose far end is infinite.
    static void expect_reversed(Submitted const& s)
    {
        json const& depth = s.about.at("depth");
        EXPECT_EQ(depth["least"], 0.0);
        EXPECT_EQ(depth["most"], 1.0);
        EXPECT_EQ(depth["m_at_least"], "infinite");
        EXPECT_NEAR(double(depth["m_at_most"]), 0.05, 1e-6);
        EXPECT_EQ(depth["width"], s.width);
        EXPECT_EQ(depth["height"], s.height);
        EXPECT_EQ(s.depths.size(), std::size_t(s.width * s.height));
    }
};

constexpr char const *kRecorder = "XR_APILAYER_LIGHTWELL_test_recorder",
                     *kWithInsets = "XR_APILAYER_LIGHTWELL_test_recorder:XR_APILAYER_LIGHTWELL_test_quad";

/// The client's ball of radius 0.25 m at (0, 1.6, -2), and nothing else at a finite depth.
void expect_ball(Submitted const& s)
{
    int on_ball = 0, wrong = 0;
    for (int y = 0; y < s.height; ++y)
        for (int x = 0; x < s.width; ++x) {
            glm::dvec3 const d = s.direction(x, y), to = glm::dvec3(0, 1.6, -2) - s.position();
            double const along = glm::dot(to, d) / glm::dot(d, d);
            double const left = 0.25 * 0.25 - glm::dot(to - along * d, to - along * d);
            if (std::abs(left) < 0.01) continue; // the edge
            double const depth = along - std::sqrt(std::max(left, 0.0) / glm::dot(d, d));
            double const wanted = left > 0 ? 0.05 / depth : 0;
            on_ball += left > 0;
            wrong += std::abs(double(s.depth(x, y)) - wanted) > 1e-5;
        }
    EXPECT_GT(on_ball, 100);
    EXPECT_EQ(wrong, 0);
}

TEST_F(SubmittedTest, DepthsAreThoseOfThePicture)
{
    int const port = free_port();
    start_service({"--remote", std::to_string(port)});
    RemoteDriver remote(port);
    remote.set_head({{0.1f, 0, 0.2f, 0.9747f}, {0.1f, 1.75f, 0.3f}});
    remote.set_eyes({RemoteEye{{-0.9f, 0.7f, 0.8f, -0.6f}, {{0, 0, 0, 1}, {-0.03f, 0, 0}}},
                     RemoteEye{{-0.7f, 0.9f, 0.75f, -0.65f}, {{0, 0, 0, 1}, {0.03f, 0, 0}}}});
    remote.send_all();
    auto const r = run_client("--graphics egl --frames 60 --depths", with_layers(kRecorder));
    EXPECT_EQ(r["takes_depths"], true) << r;
    EXPECT_EQ(r["with_depth"], r["pictures"]);
    EXPECT_EQ(r["gl_errors"], 0);
    std::vector<Frame> const all = frames();
    ASSERT_FALSE(all.empty());
    for (Frame const& frame : all) {
        ASSERT_EQ(frame.size(), 2u);
        for (Submitted const& s : frame) {
            expect_reversed(s);
            expect_ball(s);
        }
    }
}

TEST_F(SubmittedTest, NoDepthsUnlessTheyAreWished)
{
    start_service();
    auto const r = run_client("--graphics egl --frames 30", with_layers(kRecorder));
    EXPECT_EQ(r["takes_depths"], false) << r;
    EXPECT_EQ(r["with_depth"], 0);
    std::vector<Frame> const all = frames();
    ASSERT_FALSE(all.empty());
    for (Frame const& frame : all)
        for (Submitted const& s : frame) EXPECT_FALSE(s.about.contains("depth"));
}

TEST_F(SubmittedTest, InsetsShowTheMiddle)
{
    start_service();
    auto const r = run_client("--graphics egl --frames 40 --depths --insets", with_layers(kWithInsets));
    EXPECT_EQ(r["inset_width"], 240) << r;
    EXPECT_EQ(r["with_depth"], r["pictures"]);
    EXPECT_EQ(r["gl_errors"], 0);
    EXPECT_EQ(r["ended"], "the runtime has ended the session");
    std::vector<Frame> const all = frames();
    ASSERT_FALSE(all.empty());
    for (Frame const& frame : all) {
        ASSERT_EQ(frame.size(), 4u);
        for (std::size_t v = 0; v < 4; ++v) {
            EXPECT_EQ(frame[v].width, v < 2 ? 320 : 240);
            expect_reversed(frame[v]);
            expect_ball(frame[v]);
        }
    }
    // A runtime that has them does not get them unwished.
    EXPECT_EQ(run_client("--graphics egl --frames 5", with_layers(kWithInsets))["inset_width"], 0);
}

/// A floor 1.5 m below the eyes and a ceiling 2.5 m above them, much wider than high.
class InAHall : public SubmittedTest {
protected:
    void write_hall() const
    {
        std::ofstream(folder / "hall.obj") << "v -400 0 -400\nv -400 0 400\nv 400 0 400\nv 400 0 -400\n"
                                              "v -400 4 -400\nv 400 4 -400\nv 400 4 400\nv -400 4 400\n"
                                              "f 1 2 3 4\nf 5 6 7 8\n";
        std::ofstream(folder / "hall.yaml") << "models:\n  - {name: hall, file: hall.obj}\n"
                                               "environment: {color: [0.5, 0.6, 0.7]}\n"
                                               "lights:\n  - {type: point, position: [0, 2, -1], intensity: 20}\n"
                                               "cameras:\n  - {name: in, from: [0, 1.5, 0], at: [0, 1.5, -1]}\n";
    }

    static RemotePose head_at(double heading_rad, glm::dvec3 at)
    {
        glm::dquat const turn = glm::angleAxis(heading_rad, glm::dvec3(0, 1, 0)) *
                                glm::angleAxis(0.2, glm::dvec3(1, 0, 0)) *
                                glm::angleAxis(0.3, glm::dvec3(0, 0, 1));
        return {{float(turn.x), float(turn.y), float(turn.z), float(turn.w)},
                {float(at.x), float(at.y), float(at.z)}};
    }

    /// Stands, then moves until enough is kept. Returns the statistics.
    json walk(std::string const& layers, std::string const& options)
    {
        write_hall();
        int const port = free_port();
        start_service({"--remote", std::to_string(port)});
        RemoteDriver remote(port);
        remote.set_head(head_at(0, {0, 1.6, 0}));
        remote.set_eyes({RemoteEye{{-0.8f, 0.7f, 0.7f, -0.6f}, {{0, 0, 0, 1}, {-0.03f, 0, 0}}},
                         RemoteEye{{-0.7f, 0.8f, 0.65f, -0.65f}, {{0, 0, 0, 1}, {0.03f, 0, 0}}}});
        remote.send_all();
        std::vector<std::string> call{kScript, "client", "--dir", runtime_folder(), "--", LIGHTWELL_PROGRAM};
        for (std::string const& a :
             words("view hall.yaml --hmd --set method=paths --set paths=1 --stats stats.json "
                   "--remote remote " +
                   options))
            call.push_back(a.find(".yaml") != std::string::npos || a == "stats.json" || a == "remote"
                               ? (folder / a).string()
                               : a);
        Child program(call, folder.path(), "view", with_layers(layers));
        EXPECT_TRUE(wait_for([&] { return kept() >= 3; }, Seconds(90))) << program.out() << program.err();
        for (std::size_t const enough = kept() + 4; kept() < enough && program.is_running();) {
            double const s =
                std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
            remote.set_head(head_at(0.1 * std::sin(s), {0.2 * std::sin(2 * s), 1.6 + 0.1 * std::sin(s), 0}));
            remote.send_all();
            std::this_thread::sleep_for(Seconds(0.02));
        }
        run_well(R"(remote remote {"do":"quit"})", folder.path());
        EXPECT_EQ(program.wait(Seconds(60)), 0) << program.out() << program.err();
        json const all = json::parse(file_text(folder / "stats.json"));
        std::puts(all["headset"].dump().c_str());
        return all;
    }

    /// Depths of floor and ceiling, in the middle of the view, which no lens hides.
    static void expect_hall(Submitted const& s)
    {
        expect_reversed(s);
        double const eye_m = 1.5 + s.position().y - 1.6; // the head begins at 1.6 m, at the scene's camera
        int wrong = 0, checked = 0;
        double worst = 0;
        for (int y = s.height / 4; y < s.height * 3 / 4; ++y)
            for (int x = s.width / 4; x < s.width * 3 / 4; ++x) {
                double const up = s.direction(x, y).y;
                double const wanted = 0.05 * (up < 0 ? -up / eye_m : up / (4 - eye_m));
                double const error = std::abs(double(s.depth(x, y)) - wanted);
                worst = std::max(worst, error);
                wrong += error > 6e-4 + 0.02 * wanted; // pixels of surfaces may be twice as wide
                ++checked;
            }
        EXPECT_EQ(wrong, 0) << "of " << checked << ", worst " << worst;
    }
};

class InAHallEachWay : public InAHall, public ::testing::WithParamInterface<char const*> {};

INSTANTIATE_TEST_SUITE_P(Shown, InAHallEachWay, ::testing::Values("true", "false"), [](auto const& draws) {
    return std::string(draws.param) == "true" ? "AsSurfaces" : "Reprojected";
});

TEST_P(InAHallEachWay, DepthsAreThoseOfTheScene)
{
    json const all = walk(kRecorder, std::string("--set draw_surfaces=") + GetParam());
    json const& headset = all["headset"];
    EXPECT_EQ(headset["depths"], headset["shown"]);
    EXPECT_GT(headset[std::string(GetParam()) == "true" ? "surfaces" : "reprojected"], 10);
    for (Frame const& frame : frames())
        for (Submitted const& s : frame) expect_hall(s);
}

TEST_P(InAHallEachWay, InsetsShowTheSameScene)
{
    json const all = walk(kWithInsets, std::string("--set draw_surfaces=") + GetParam());
    EXPECT_EQ(all["headset"]["views"], 4);
    for (Frame const& frame : frames()) {
        ASSERT_EQ(frame.size(), 4u);
        for (std::size_t eye = 0; eye < 2; ++eye) {
            Submitted const &outer = frame[eye], &inset = frame[2 + eye];
            expect_hall(inset);
            EXPECT_EQ(outer.position(), inset.position());
            // The same light: means over all directions that the inset has.
            glm::dvec3 a{0}, b{0};
            double const pixels = inset.width * inset.height;
            for (int y = 0; y < inset.height; ++y)
                for (int x = 0; x < inset.width; ++x) {
                    glm::ivec2 const there = outer.pixel_of(inset.tangents(x, y));
                    a += outer.color(there.x, there.y) / pixels;
                    b += inset.color(x, y) / pixels;
                }
            EXPECT_LT(glm::distance(a, b), 4) << eye;
            EXPECT_GT(glm::length(a), 30);
        }
    }
}

TEST_F(InAHall, DepthsMayBeLeftOff)
{
    json const all = walk(kRecorder, "--no-depths");
    EXPECT_EQ(all["headset"]["depths"], 0);
    for (Frame const& frame : frames())
        for (Submitted const& s : frame) EXPECT_FALSE(s.about.contains("depth"));
}

} // namespace
} // namespace viewer::test
