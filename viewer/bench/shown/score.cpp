#include "viewer/bench/shown/score.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "gi/metrics/flip.h"
#include "gi/scene/model/projection.h"
#include "viewer/engine/quality.h"
#include "viewer/engine/scene_edits.h"

#include <algorithm>
#include <fmt/format.h>
#include <numeric>
#include <sstream>

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

double rivalry(SeenMoment const& s, std::vector<gi::Picture> const& truth,
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

/// Pixels whose surface no picture of light shows, and what they emit as display-linear sums.
struct Unlit {
    double surfaces = 0, unlit = 0, difference = 0, truth = 0;

    /// @param shown, right  display-linear, of size w * h
    void add(LightSources const& light, std::vector<float> const& shown, std::vector<float> const& right, int w,
             int h)
    {
        for (int y = 0; y < h && !light.sources.empty(); ++y)
            for (int x = 0; x < w; ++x) {
                glm::ivec2 const at = glm::ivec2(x, y) * light.size_px / glm::ivec2(w, h);
                LightSource const s = light.sources[std::size_t(at.y * light.size_px.x + at.x)];
                surfaces += s != LightSource::no_surface;
                if (s != LightSource::cells && s != LightSource::nowhere) continue;
                ++unlit;
                for (std::size_t c = 0; c < 3; ++c) {
                    std::size_t const i = 3 * (std::size_t(y) * std::size_t(w) + std::size_t(x)) + c;
                    difference += std::abs(double(shown[i]) - double(right[i]));
                    truth += double(right[i]);
                }
            }
    }
};

/// R, G, B bytes, as ShownOptions says.
std::vector<unsigned char> greys(LightSources const& light)
{
    constexpr std::array<unsigned char, 4> kGreys{255, 160, 80, 0};
    std::vector<unsigned char> rgb;
    for (LightSource const s : light.sources) rgb.insert(rgb.end(), 3, kGreys[std::size_t(s)]);
    return rgb;
}

/// @param what  it is called in errors
PathChange path_change(std::string const& text, std::string const& what)
{
    std::istringstream in(text);
    double seconds = 0;
    std::string change;
    if (char colon = 0;
        !(in >> seconds >> colon) || colon != ':' || !std::isfinite(seconds) || !std::getline(in, change))
        throw gi::InputError(what + " is no change on a path", "it begins with no time",
                             "write 3:light.all.scale=0");
    PathChange made{seconds, parse_change(change)};
    if (!is_scene_edit(made.change.key))
        throw gi::InputError(what + " is no change on a path", "it is no edit of the scene",
                             "give settings of the viewer by --set");
    return made;
}

} // namespace

std::vector<PathChange> path_changes(std::vector<std::string> const& texts, std::string const& file)
{
    std::vector<PathChange> changes;
    for (std::string const& text : texts) changes.push_back(path_change(text, "'" + text + "'"));
    std::istringstream in(file.empty() ? std::string() : gi::read_text(file));
    std::string line;
    for (int number = 1; std::getline(in, line); ++number) {
        std::size_t const first = line.find_first_not_of(" \t\r");
        if (first != std::string::npos && line[first] != '#')
            changes.push_back(path_change(line, fmt::format("{}:{}: '{}'", file, number, line)));
    }
    std::ranges::stable_sort(changes, {}, &PathChange::path_s);
    return changes;
}

ShownErrors score(ShownOptions const& o, std::span<PathChange const> changes, RecordedScenes const& scenes,
                  std::vector<SeenMoment> const& seen, gi::dvec3 origin, gi::StopRequest const& stop)
{
    if (seen.empty()) return {};
    gi::Report report;
    RenderSession exact(scenes.load, o.scene.settings.threads, report);
    if (scenes.drive) exact.drive_bodies(scenes.drive);
    for (Change const& c : parse_changes(o.settings)) exact.apply(c);
    for (Change const& c : std::vector<Change>{{"method", "reference"},
                                               {"denoise", o.truth_filter},
                                               {"reuse", 1},
                                               {"draw_surfaces", false},
                                               {"first_surfaces", false},
                                               {"scene", o.scene.scene}})
        exact.apply(c);
    std::size_t next = 0;
    gi::ProgressBar bar("converged pictures");
    ShownErrors sum;
    Unlit unlit;
    for (std::size_t k = 0; k < seen.size(); ++k) {
        for (; next < changes.size() && changes[next].path_s <= seen[k].path_s; ++next)
            exact.apply(changes[next].change);
        int const w = seen[k].at.views[0].width, h = seen[k].at.views[0].height;
        std::vector<gi::Picture> truth;
        std::vector<std::vector<unsigned char>> right;
        for (std::size_t e = 0; e < seen[k].shown.size(); ++e) {
            bar.update(double(k) / double(seen.size()));
            FrameCommand command;
            command.frame = k;
            command.scene_s = seen[k].scene_s;
            command.world_from_room = seen[k].at.world_from_room;
            command.tracked = seen[k].at.tracked;
            command.views = {seen[k].at.views[e]};
            command.views[0].partner = -1;
            command.paths = std::uint32_t(o.truth_paths);
            truth.push_back(exact.render(command, stop).views[0].picture);
            if (stop.requested()) return sum;
            right.push_back(gi::tone_map_bytes(*truth.back().find("color"), tone_settings(exact.settings())));
        }
        for (std::size_t e = 0; e < right.size(); ++e) {
            std::vector<float> const seen_light = decoded(seen[k].shown[e]), right_light = decoded(right[e]);
            std::vector<float> const error = gi::flip(seen_light, right_light, w, h);
            if (e < seen[k].light.size()) unlit.add(seen[k].light[e], seen_light, right_light, w, h);
            sum.flip += mean(error) / double(right.size());
            sum.most_flip = std::max(sum.most_flip, mean(error));
            std::vector<unsigned char> grey;
            for (float const v : error)
                grey.insert(grey.end(), 3, static_cast<unsigned char>(255 * std::clamp(v, 0.0f, 1.0f)));
            auto const save = [&](char const* what, std::vector<unsigned char> const& bytes) {
                gi::write_png(std::filesystem::path(o.out) / fmt::format("{}_{}_{}.png", what, k, e), w, h, bytes);
            };
            save("shown", seen[k].shown[e]);
            save("truth", right[e]);
            save("error", grey);
            if (e < seen[k].light.size() && !seen[k].light[e].sources.empty())
                gi::write_png(std::filesystem::path(o.out) / fmt::format("light_{}_{}.png", k, e),
                              seen[k].light[e].size_px.x, seen[k].light[e].size_px.y, greys(seen[k].light[e]));
        }
        if (right.size() == 2) sum.rivalry += rivalry(seen[k], truth, right, origin, w, h);
        ++sum.moments;
    }
    sum.flip /= std::max(1, sum.moments);
    sum.rivalry /= std::max(1, sum.moments);
    sum.unlit_share = unlit.unlit / unlit.surfaces;
    sum.unlit_error = unlit.difference / unlit.truth;
    return sum;
}

} // namespace viewer
