#include "tests/bench/moving_view/score.h"

#include "gi/image_io/picture_file.h"
#include "gi/metrics/flip.h"
#include "gi/scene/model/projection.h"
#include "viewer/engine/render_session.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>

namespace viewer {
namespace {

std::vector<float> decoded(std::vector<unsigned char> const& bytes)
{
    std::vector<float> linear(bytes.size());
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        float const v = float(bytes[i]) / 255;
        linear[i] = v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
    }
    return linear;
}

double mean(std::vector<float> const& v) { return std::accumulate(v.begin(), v.end(), 0.0) / double(v.size()); }

/// Mean difference of the eyes' errors (display-encoded, 0..255) at points that both see.
double rivalry(Seen const& s, std::vector<gi::Picture> const& truth,
               std::vector<std::vector<unsigned char>> const& right, gi::dvec3 origin, int w, int h)
{
    gi::CameraRays const a = gi::camera_rays(s.at.views[0].camera, w, h, origin),
                         b = gi::camera_rays(s.at.views[1].camera, w, h, origin);
    gi::Projection const project(b);
    gi::Layer const &da = *truth[0].find("depth"), &db = *truth[1].find("depth");
    double sum = 0;
    std::size_t n = 0;
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(w) + std::size_t(x);
            if (!(da.data[i] > 0)) continue;
            gi::Ray const ray = a.through({float(x) + 0.5f, float(y) + 0.5f});
            gi::vec3 const at =
                project(ray.origin + ray.direction * (da.data[i] / glm::dot(ray.direction, a.forward)));
            int const u = int(std::floor(at.x)), v = int(std::floor(at.y));
            if (!(at.z > 0) || u < 0 || v < 0 || u >= w || v >= h) continue;
            std::size_t const j = std::size_t(v) * std::size_t(w) + std::size_t(u);
            if (std::abs(db.data[j] - at.z) > 0.02f * at.z) continue;
            for (std::size_t c = 0; c < 3; ++c)
                sum += std::abs((double(s.shown[0][3 * i + c]) - double(right[0][3 * i + c])) -
                                (double(s.shown[1][3 * j + c]) - double(right[1][3 * j + c])));
            n += 3;
        }
    return n > 0 ? sum / double(n) : 0;
}

} // namespace

void score(Options const& o, RecordedScenes const& scenes, std::vector<Seen> const& seen, gi::dvec3 origin)
{
    if (o.truth.empty() || seen.empty()) return;
    fs::create_directories(o.truth);
    std::string asked = o.scene + '\n' + o.head + '\n' + o.avatar;
    for (Change const& c : o.settings) asked += '\n' + c.key + '=' + c.value.dump();
    std::size_t const question = std::hash<std::string>()(asked);
    gi::Report truth_report;
    std::unique_ptr<RenderSession> exact;
    double flip_sum = 0, flip_most = 0, rivalry_sum = 0;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        std::vector<gi::Picture> truth;
        std::vector<std::vector<unsigned char>> right;
        double flip_of_moment = 0;
        for (std::size_t e = 0; e < std::size_t(o.eyes); ++e) {
            // Runs show slightly different moments (by some ms), so each has its own reference picture.
            if (!exact) {
                exact = std::make_unique<RenderSession>(scenes.load, 0, truth_report);
                if (scenes.drive) exact->drive_bodies(scenes.drive);
                for (Change const& c : o.settings) exact->apply(c);
                for (Change const& c : std::vector<Change>{{"method", "reference"},
                                                           {"denoise", o.truth_filter},
                                                           {"reuse", 1},
                                                           {"first_surfaces", false}})
                    exact->apply(c);
                exact->apply({"scene", o.scene});
            }
            FrameCommand command;
            command.frame = k;
            command.scene_s = seen[k].scene_s;
            command.world_from_room = seen[k].at.world_from_room;
            command.tracked = seen[k].at.tracked;
            command.views = {seen[k].at.views[e]};
            command.views[0].partner = -1;
            command.paths = o.truth_paths;
            fs::path const kept =
                o.truth / fmt::format("{}_{:x}_{}_{}x{}_{}_{}_{}_{:.4f}_{}.exr", fs::path(o.scene).stem().string(),
                                      question, fs::path(o.head).stem().string(), o.width, o.height, o.fov_deg,
                                      o.truth_paths, o.truth_filter, seen[k].scene_s, e);
            if (o.offline_hz > 0 && fs::exists(kept)) {
                truth.push_back(gi::read_exr(kept));
            } else {
                truth.push_back(exact->render(command, {}).views[0].picture);
                std::erase_if(truth.back().layers,
                              [](gi::Layer const& l) { return l.name != "color" && l.name != "depth"; });
                if (o.offline_hz > 0) gi::write_exr(kept, truth.back(), gi::PixelType::single, truth_report);
            }
            right.push_back(gi::tone_map_bytes(*truth.back().find("color"), tone_settings(exact->settings())));
            std::vector<float> const error =
                gi::flip(decoded(seen[k].shown[e]), decoded(right.back()), o.width, o.height);
            flip_sum += mean(error) / double(o.eyes) / double(seen.size());
            flip_of_moment += mean(error);
            flip_most = std::max(flip_most, mean(error));
            std::vector<unsigned char> grey;
            for (float const v : error)
                grey.insert(grey.end(), 3, (unsigned char)(255 * std::clamp(v, 0.0f, 1.0f)));
            auto const save = [&](char const* what, std::vector<unsigned char> const& bytes) {
                gi::write_png(o.out / fmt::format("{}_{}_{}.png", what, k, e), o.width, o.height, bytes);
            };
            save("shown", seen[k].shown[e]);
            save("truth", right.back());
            save("error", grey);
        }
        double const rival = o.eyes == 2 ? rivalry(seen[k], truth, right, origin, o.width, o.height) : 0;
        rivalry_sum += rival / double(seen.size());
        if (o.young > 0)
            fmt::print("  frame {}: FLIP {:.4f}, rivalry {:.2f}/255\n", 1 << k, flip_of_moment / o.eyes, rival);
    }
    fmt::print("  FLIP {:.4f} (most of a moment {:.4f}){}\n", flip_sum, flip_most,
               o.eyes == 2 ? fmt::format("; rivalry {:.2f}/255", rivalry_sum) : "");
}

} // namespace viewer
