#include "ar/scene/session_file.h"

#include "gi/core/error.h"
#include "gi/hit_buffers/settings.h"
#include "gi/methods/paths/settings.h"
#include "gi/methods/slhb_0_1/slhb_0_1.h"
#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

std::string const kLeastSession =
    "schema: ar/1\nframes: {source: frames}\ncamera: camera.yaml\nmarkers: markers.yaml\n";

std::string session_refusal(std::string const& text)
{
    try {
        ar::parse_session(text, "folder/s.yaml");
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "";
}

TEST(ArSessions, SayWhatTheyAreMadeOf)
{
    ar::Session const s =
        ar::parse_session(kLeastSession + R"(light: {map: probe.exr, turn_deg: 30, scale: 2, live: 10}
real: {scene: near.glb}
virtual: {scene: statue.glb, at: [0, 0, -0.1], turn_deg: 90, scale: 0.5}
render: {paths: 4, resolution: 0.75, bounces: 2, seed: 9}
composite: {blend: ratio, clipped: as_measured, largest_ratio: 4, smoothing: 0.3}
)",
                          "folder/s.yaml");
    EXPECT_EQ(s.frames.source, "folder/frames");
    EXPECT_EQ(s.camera, "folder/camera.yaml");
    EXPECT_EQ(s.light, "folder/probe.exr");
    EXPECT_EQ(s.light_turn_deg, 30);
    EXPECT_EQ(s.live_light, 10);
    EXPECT_EQ(s.virtual_things.at_m, gi::dvec3(0, 0, -0.1));
    EXPECT_EQ(s.virtual_things.scale, 0.5);
    EXPECT_EQ(s.render.paths, 4u);
    EXPECT_EQ(s.render.resolution, 0.75);
    EXPECT_EQ(s.composite.blend, ar::Blend::ratio);
    EXPECT_EQ(s.composite.clipped, ar::ClippedBytes::as_measured);
    EXPECT_EQ(s.smoothing, 0.3);
    ar::Session const least = ar::parse_session(kLeastSession, "s.yaml");
    EXPECT_TRUE(least.real.scene.empty());
    EXPECT_TRUE(least.light.empty());
}

/// The example of the documentation of an earlier version: its keys are still understood.
TEST(ArSessions, OfAnEarlierVersionAreRead)
{
    ar::Session const s = ar::parse_session(
        file_text(std::filesystem::path(LIGHTWELL_SOURCE_DIR) / "tests/data/old/0d0c255/ar_session.yaml"),
        "s.yaml");
    EXPECT_EQ(s.render.paths, 4u);
    EXPECT_EQ(s.render.settings.of<gi::SlhbSettings>().light_samples, 8);
    EXPECT_EQ(s.render.settings.of<gi::SlhbSettings>().fresh_light_samples, 2);
    EXPECT_EQ(s.composite.clipped, ar::ClippedBytes::model);
    ASSERT_TRUE(s.hmd);
    EXPECT_EQ(s.hmd->plane_m, 1);
}

TEST(ArSessions, TakeOptionsOfSlhb)
{
    gi::RenderSettings const s =
        ar::parse_session(kLeastSession +
                              "render: {bounces: 2, seed: 9, directions: 'icosahedron:80', hit_buffer: 64, "
                              "lamps: 8, fresh_light_samples: 2, shadow_map: 128, roulette: 0.5, "
                              "packed: true, shadows: maps}\n",
                          "s.yaml")
            .render.settings;
    EXPECT_EQ(s.bounces, 2);
    EXPECT_EQ(s.seed, 9u);
    EXPECT_EQ(s.of<gi::SlhbSettings>().directions, "icosahedron:80");
    EXPECT_EQ(s.of<gi::SlhbSettings>().resolution, 64);
    EXPECT_EQ(s.of<gi::SlhbSettings>().light_samples, 8);
    EXPECT_EQ(s.of<gi::SlhbSettings>().fresh_light_samples, 2);
    EXPECT_EQ(s.of<gi::SlhbSettings>().shadow_resolution, 128);
    EXPECT_EQ(s.of<gi::PathsSettings>().roulette, 0.5f);
    EXPECT_TRUE(s.of<gi::SlhbSettings>().packed);
    EXPECT_EQ(s.of<gi::FormerSlhbSettings>().shadows, gi::FormerShadows::maps);
    EXPECT_EQ(ar::parse_session(kLeastSession, "s.yaml").render.settings.bounces, 3);
    for (char const* wrong : {"hit_buffer: 1e9", "directions: 'cube:6'", "shadows: some", "packed: 1"})
        EXPECT_NE(session_refusal(kLeastSession + "render: {" + wrong + "}\n").find("s.yaml:5:"),
                  std::string::npos)
            << wrong;
    for (char const* unknown : {"threads: 2", "device: cuda", "light_paths: 8", "hit-buffer: 64"})
        EXPECT_NE(session_refusal(kLeastSession + "render: {" + unknown + "}\n").find("s.yaml:5:"),
                  std::string::npos)
            << unknown;
}

/// Sessions of schema ar/1 were written for version 0.1, whose slhb was rays or look-ups by its options.
TEST(ArSessions, NameTheirMethod)
{
    std::string const present = "schema: ar/2" + kLeastSession.substr(kLeastSession.find('\n'));
    auto const render = [](std::string const& text) { return ar::parse_session(text, "s.yaml").render; };
    EXPECT_EQ(render(kLeastSession).method, "slhb_0_1");
    EXPECT_EQ(render(present).method, "auto");
    EXPECT_EQ(render(present + "render: {method: slhb, hit_buffer: 64}\n").settings.of<gi::SlhbSettings>().resolution, 64);
    for (char const* wrong : {"method: slhp", "method: paths, hit_buffer: 64", "hit_buffer: 64", "shadows: maps"})
        EXPECT_NE(session_refusal(present + "render: {" + wrong + "}\n").find("s.yaml:5:"), std::string::npos) << wrong;
    std::string const refusal = session_refusal(present + "render: {method: reference}\n");
    EXPECT_NE(refusal.find("s.yaml:5:"), std::string::npos) << refusal;
    EXPECT_NE(refusal.find("auto, paths, slhb"), std::string::npos) << refusal;
    EXPECT_NE(session_refusal(kLeastSession + "render: {method: slhb}\n").find("s.yaml:5:"), std::string::npos);
}

TEST(ArSessions, SayHowPairsAreFinishedAndPosesUsed)
{
    ar::Session const s = ar::parse_session(
        kLeastSession + R"(composite: {upsample: false, mattes: true, match_blur: true, noise: false}
pose: {smoothing: {position: {min_cutoff_hz: 2, beta: 3}}, predict_s: 0.4}
)",
        "s.yaml");
    EXPECT_FALSE(s.finish.upsample);
    EXPECT_TRUE(s.finish.mattes && s.finish.match_blur);
    EXPECT_FALSE(s.match_noise);
    EXPECT_TRUE(s.pose.filtered);
    EXPECT_EQ(s.pose.tracker.position.min_cutoff_hz, 2);
    EXPECT_EQ(s.pose.tracker.position.beta, 3);
    EXPECT_EQ(s.pose.predict_s, 0.4);
    EXPECT_GE(s.pose.tracker.lost_after_s, 0.8);
    ar::Session const still = ar::parse_session(kLeastSession + "pose: {tripod: true}\n", "s.yaml");
    EXPECT_EQ(still.pose.tracker.motion, ar::CameraMotion::tripod);
    ar::Session const averaged =
        ar::parse_session(kLeastSession + "pose: {tripod: true, smoothing: false}\n", "s.yaml");
    EXPECT_EQ(averaged.pose.tracker.motion, ar::CameraMotion::tripod);
    EXPECT_TRUE(averaged.pose.filtered);
    ar::Session const least = ar::parse_session(kLeastSession, "s.yaml");
    EXPECT_FALSE(least.pose.filtered || least.finish.mattes || least.finish.match_blur);
    EXPECT_TRUE(least.match_noise);
    EXPECT_EQ(least.pose.trust.least_confidence, 0.5);
    ar::Session const cautious =
        ar::parse_session(kLeastSession + "pose: {least_confidence: 0.6, hold_s: 0.5, fade_s: 0}\n", "s.yaml");
    EXPECT_EQ(cautious.pose.trust.least_confidence, 0.6);
    EXPECT_EQ(cautious.pose.trust.hold_s, 0.5);
    EXPECT_EQ(cautious.pose.trust.fade_s, 0);
    EXPECT_EQ(
        ar::parse_session(kLeastSession + "pose: {tracker: head, hold_s: 0.2}\n", "s.yaml").pose.trust.hold_s,
        0.2);
    EXPECT_EQ(ar::parse_session(kLeastSession + "pose: {features: maps/m.txt}\n", "there/s.yaml").pose.features,
              "there/maps/m.txt");
    EXPECT_TRUE(ar::parse_session(kLeastSession + "pose: {smoothing: true, fuse: true}\n", "s.yaml").pose.fused);
    EXPECT_TRUE(least.pose.fused);
    EXPECT_FALSE(still.pose.fused);
    EXPECT_FALSE(ar::parse_session(kLeastSession + "pose: {fuse: false}\n", "s.yaml").pose.fused);
    EXPECT_NE(session_refusal(kLeastSession + "pose: {tripod: true, fuse: true}\n").find("averaged"),
              std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "pose: {tracker: head, fuse: true}\n").find("tracker"),
              std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "pose: {hold_s: -1}\n").find("hold_s"), std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "pose: {least_confidence: 2}\n").find("least_confidence"),
              std::string::npos);
    EXPECT_NE(
        session_refusal(kLeastSession + "pose: {tracker: head, least_confidence: 0.2}\n").find("no confidence"),
        std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "pose: {tripod: true, smoothing: true}\n").find("averaged"),
              std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "composite: {mattes: 3}\n").find("s.yaml:5:"), std::string::npos);
}

TEST(ArSessions, OfDevicesKeepTheirNames)
{
    ar::Session const s =
        ar::parse_session("schema: ar/1\nframes: {source: 'camera:/base/cam0', size: [1280, 720], "
                          "format: mjpeg}\ncamera: c.yaml\nmarkers: m.yaml\n",
                          "folder/s.yaml");
    EXPECT_EQ(s.frames.source, "camera:/base/cam0");
    EXPECT_EQ(s.frames.options.size_px, glm::ivec2(1280, 720));
    EXPECT_EQ(s.frames.options.format, ar::PixelFormat::mjpeg);
}

TEST(ArSessions, SayWhatOccludesAndWhichPassesAreWritten)
{
    ar::Session const s = ar::parse_session(kLeastSession + R"(occlusion:
  depth: {source: d_%04d.png, first: 5, rate_hz: 15}
  matte: mattes
  camera: depth.yaml
  camera_from_depth: {position_m: [0.02, 0, 0]}
  metres_per_unit: 0.0002
  margin_m: 0.03
  soft_m: 0
  soft_px: 2
passes: {folder: parts, bits: 32, undistorted: true}
)",
                                            "/home/s.yaml");
    ASSERT_TRUE(s.occlusion && s.occlusion->depth && s.occlusion->matte);
    EXPECT_EQ(s.occlusion->depth->source, "/home/d_%04d.png");
    EXPECT_EQ(s.occlusion->depth->first, 5);
    EXPECT_EQ(s.occlusion->depth->rate_hz, 15);
    EXPECT_EQ(s.occlusion->matte->source, "/home/mattes");
    EXPECT_EQ(s.occlusion->camera, "/home/depth.yaml");
    EXPECT_EQ(s.occlusion->camera_from_depth.position.x, 0.02);
    EXPECT_EQ(s.occlusion->metres_per_unit, 0.0002);
    EXPECT_EQ(s.occlusion->settings.margin_m, 0.03);
    EXPECT_EQ(s.occlusion->settings.soft_m, 0);
    EXPECT_EQ(s.occlusion->settings.soft_px, 2);
    EXPECT_EQ(s.passes.folder, "/home/parts");
    EXPECT_EQ(s.passes.bits, 32);
    EXPECT_TRUE(s.passes.is_undistorted);
    EXPECT_FALSE(ar::parse_session(kLeastSession, "s.yaml").occlusion);
    EXPECT_NE(session_refusal(kLeastSession + "occlusion: {depth: {first: 3}}\n").find("source"),
              std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "occlusion: {matte: m, soft_m: 1}\n").find("s.yaml:5:"),
              std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "passes: {folder: p, bits: 8}\n").find("16, 32"), std::string::npos);
}

TEST(ArSessions, ThatAreWrongAreRefusedWithTheirPlace)
{
    EXPECT_NE(session_refusal("frames: {source: x}\ncamera: c\nmarkers: m\n").find("schema: ar/2"),
              std::string::npos);
    EXPECT_NE(session_refusal("schema: ar/1\nframes: {source: x}\ncamera: c\n").find("no 'markers'"),
              std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "lihgt: {map: x}\n").find("s.yaml:5:1"), std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "light: {turn_deg: 3}\n").find("no 'map'"), std::string::npos);
    std::string const real = "real: {scene: near.glb}\n";
    EXPECT_TRUE(
        ar::parse_session(kLeastSession + real + "light: {from: frame, live: 5}\n", "s.yaml").light_from_frame);
    EXPECT_NE(session_refusal(kLeastSession + "light: {from: frame}\n").find("'from: frame' without 'real'"),
              std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + real + "light: {from: frame, map: p.exr}\n")
                  .find("s.yaml:6:27: 'map' beside 'from: frame'"),
              std::string::npos)
        << session_refusal(kLeastSession + real + "light: {from: frame, map: p.exr}\n");
    EXPECT_NE(session_refusal(kLeastSession + real + "light: {from: video}\n").find("s.yaml:6:15"),
              std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "render: {paths: 0}\n").find("s.yaml:5:"), std::string::npos);
    EXPECT_NE(session_refusal(kLeastSession + "composite: {blend: add}\n").find("difference, ratio"),
              std::string::npos);
    EXPECT_NE(session_refusal("schema: ar/1\nframes: {}\ncamera: c\nmarkers: m\n").find("no 'source'"),
              std::string::npos);
    EXPECT_NE(session_refusal("schema: ar/1\nframes: {source: x, size: [640]}\ncamera: c\nmarkers: m\n")
                  .find("[640, 480]"),
              std::string::npos);
    EXPECT_NE(session_refusal("schema: [").find("s.yaml"), std::string::npos);
}

} // namespace
} // namespace viewer::test
