// A screen lit by two projectors whose calibration was imported, photographed from the head's place: where spots are, and
// how bright white and black are where the projectors overlap and where they do not.

#include "tests/viewer_display/calibration_samples.h"
#include "tests/viewer_gl/surfaceless.h"
#include "viewer/app/layout.h"
#include "viewer/displays/display_file.h"
#include "viewer/displays/import.h"

#include <cmath>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

constexpr glm::ivec2 kProjector_px{320, 200}, kCamera_px{480, 224};
constexpr double kGamma = 2.2, kBlack = 0.01; ///< of a projector: what it shows as black, as a share of its white
constexpr double kWorld_m = 12;               ///< the spots are on a sphere of this radius

enum class Screen { flat, cylinder, dome };

/// Where a ray from within meets the screen of 3 m.
gi::dvec3 on_screen(Screen screen, gi::dvec3 from, gi::dvec3 along)
{
    constexpr double kAway_m = 3;
    if (screen == Screen::flat) return from + along * ((-kAway_m - from.z) / along.z);
    gi::dvec3 const keep = screen == Screen::dome ? gi::dvec3(1) : gi::dvec3(1, 0, 1); // a cylinder about y
    gi::dvec3 const p = from * keep, d = along * keep;
    double const a = glm::dot(d, d), b = glm::dot(p, d), c = glm::dot(p, p) - kAway_m * kAway_m;
    return from + along * ((-b + std::sqrt(b * b - a * c)) / a);
}

/// A pinhole that sends or takes pictures.
struct Pinhole {
    gi::dvec3 at{0};
    double yaw_deg = 0, roll_deg = 0; ///< to the left, counterclockwise
    glm::dvec2 tangents{1};           ///< half width and height
    glm::ivec2 px{1};

    gi::dquat turn() const
    {
        return glm::angleAxis(glm::radians(yaw_deg), gi::dvec3{0, 1, 0}) *
               glm::angleAxis(glm::radians(roll_deg), gi::dvec3{0, 0, 1});
    }
    /// @param p  0 to 1 from the upper left
    gi::dvec3 ray(glm::dvec2 p) const
    {
        return turn() * glm::normalize(gi::dvec3{(2 * p.x - 1) * tangents.x, (1 - 2 * p.y) * tangents.y, -1});
    }
    glm::dvec2 place_of(gi::dvec3 point) const
    {
        gi::dvec3 const d = glm::conjugate(turn()) * (point - at);
        return {0.5 + 0.5 * d.x / -d.z / tangents.x, 0.5 - 0.5 * d.y / -d.z / tangents.y};
    }
    /// From an edge of the picture, as a share of its size; negative outside.
    double inside(gi::dvec3 point) const
    {
        glm::dvec2 const p = place_of(point);
        return std::min({p.x, 1 - p.x, p.y, 1 - p.y});
    }
};

std::array<Pinhole, 2> projectors()
{
    return {Pinhole{{-0.8, 0.4, 0.5}, 8, 2, {0.55, 0.34}, kProjector_px},
            Pinhole{{0.9, 0.2, 0.4}, -7, -3, {0.55, 0.34}, kProjector_px}};
}

Pinhole camera_at(gi::dvec3 eye) { return {eye, 0, 0, {0.62, 0.29}, kCamera_px}; }

/// The projectors' share of the light of a point.
double weight_of(std::size_t projector, gi::dvec3 point)
{
    double const own = std::max(0.0, projectors()[projector].inside(point)),
                 other = std::max(0.0, projectors()[1 - projector].inside(point));
    return own > 0 ? own / (own + other) : 0;
}

/// Writes what a calibration would have measured: points in mm, or positions in the frustum of an eye at the origin.
std::string calibrated(Screen screen, bool has_points, fs::path const& folder)
{
    constexpr double kAcross_deg = 50, kUpward_deg = 35;
    std::string regions, files;
    for (std::size_t i = 0; i < 2; ++i) {
        Pinhole const p = projectors()[i];
        auto const point = [&](glm::dvec2 at) { return on_screen(screen, p.at, p.ray(at)); };
        std::string const id = fmt::format("p{}", i);
        PixelMap const map = made_map(p.px.x, p.px.y, [&](glm::dvec2 at) {
            gi::dvec3 const x = point(at);
            if (has_points) return glm::vec3(1000.0 * x);
            glm::dvec2 const t{x.x / -x.z / std::tan(glm::radians(kAcross_deg)),
                               x.y / -x.z / std::tan(glm::radians(kUpward_deg))};
            return glm::vec3(0.5 + 0.5 * t.x, 0.5 - 0.5 * t.y, 0);
        });
        gi::write_text(folder / (id + ".pfm"), text_of(pfm_bytes(map)));
        write_grey(folder / (id + "_alpha.png"), p.px.x, p.px.y,
                   [&](glm::dvec2 at) { return std::pow(weight_of(i, point(at)), 1 / kGamma); });
        // Alone, a projector has to look as black as two: black + (1 - black) * beta = 2 black.
        write_grey(folder / (id + "_beta.png"), p.px.x, p.px.y, [&](glm::dvec2 at) {
            return projectors()[1 - i].inside(point(at)) > 0 ? 0 : std::pow(kBlack / (1 - kBlack), 1 / kGamma);
        });
        regions +=
            mpcdi_region(id, p.px.x, p.px.y, has_points ? "" : mpcdi_frustum(0, 0, 0, kAcross_deg, kUpward_deg));
        files += mpcdi_fileset(id, mpcdi_warp(id + ".pfm", has_points ? "mm" : "2d") +
                                       mpcdi_light("alphaMap", id + "_alpha.png", kGamma) +
                                       mpcdi_light("betaMap", id + "_beta.png", kGamma));
    }
    return mpcdi_xml(has_points ? "a3" : "3d", regions, files);
}

enum class Content { black, white, spots };

/// Linear light that the world sends to `eye`.
double world_light(Content content, gi::dvec3 eye, gi::dvec3 along)
{
    if (content != Content::spots) return content == Content::white;
    constexpr double kRadius_deg = 1.6, kStep_deg = 7;
    double const b = glm::dot(eye, along), t = -b + std::sqrt(b * b - glm::dot(eye, eye) + kWorld_m * kWorld_m);
    gi::dvec3 const p = (eye + t * along) / kWorld_m;
    double const azimuth = glm::degrees(std::atan2(p.x, -p.z)), elevation = glm::degrees(std::asin(p.y));
    double const x = azimuth - kStep_deg * std::round(azimuth / kStep_deg),
                 y = elevation - kStep_deg * std::round(elevation / kStep_deg);
    return std::clamp((kRadius_deg - std::hypot(x * std::cos(glm::radians(elevation)), y)) / 0.6 + 0.5, 0.0, 1.0);
}

class CalibrationPhoto : public Surfaceless, public testing::WithParamInterface<std::pair<Screen, bool>> {
protected:
    /// The light of each projector's pixels, row by row from the top.
    std::array<std::vector<double>, 2> shown(Display const& display, Content content)
    {
        Layout const layout = display_layout(display, {}, gi::dmat4(1));
        auto frame = std::make_shared<LiveFrame>();
        frame->command.views = layout.views;
        for (ViewCommand const& view : layout.views) {
            gi::Picture picture;
            picture.width = view.width;
            picture.height = view.height;
            picture.add("depth", 1);
            gi::Layer& color = picture.add("color", 3);
            gi::ViewTangents const t = *view.camera.off_axis;
            glm::dmat3 const turn(view.camera.world_from_camera);
            gi::dvec3 const eye(view.camera.world_from_camera[3]);
            std::size_t i = 0;
            for (int y = 0; y < view.height; ++y)
                for (int x = 0; x < view.width; ++x) {
                    gi::dvec3 const d =
                        turn * glm::normalize(gi::dvec3{glm::mix(t.left, t.right, (x + 0.5) / view.width),
                                                        glm::mix(t.top, t.bottom, (y + 0.5) / view.height), -1});
                    auto const light = float(world_light(content, eye, d));
                    for (int c = 0; c < 3; ++c) color.data[i++] = light;
                }
            frame->result.views.push_back({picture, {}, {}});
        }
        Presenter presenter(wall_settings(display));
        std::array<std::vector<double>, 2> out;
        for (std::size_t w = 0; w < 2; ++w) {
            presenter.take(frame, layout.panes[w]);
            TextureTarget const window(TextureTarget::Format::bytes, kProjector_px);
            presenter.draw(window.target(), {0, 0}, layout.panes[w], {}, {});
            auto const bytes = read_bytes(window.target());
            for (std::size_t i = 0; i < bytes.size(); i += 3)
                out[w].push_back(kBlack + (1 - kBlack) * std::pow(bytes[i] / 255.0, kGamma));
        }
        return out;
    }

    /// Light that a projector with these pixels sends to a place of its picture.
    static double sent(std::vector<double> const& pixels, glm::dvec2 p)
    {
        double const x = std::clamp(p.x * kProjector_px.x - 0.5, 0.0, kProjector_px.x - 1.001),
                     y = std::clamp(p.y * kProjector_px.y - 0.5, 0.0, kProjector_px.y - 1.001);
        auto const at = [&](int i, int j) { return pixels[std::size_t(j * kProjector_px.x + i)]; };
        int const i = int(x), j = int(y);
        return glm::mix(glm::mix(at(i, j), at(i + 1, j), x - i), glm::mix(at(i, j + 1), at(i + 1, j + 1), x - i),
                        y - j);
    }
};

TEST_P(CalibrationPhoto, SeamsBrightnessAndBlack)
{
    auto const [screen, has_points] = GetParam();
    fs::path const folder = fs::path(testing::TempDir()) / "lightwell_photo";
    fs::create_directories(folder / "out_files");
    gi::write_text(folder / "mpcdi.xml", calibrated(screen, has_points, folder));
    gi::Report unused;
    ImportLog const log(unused, "out_files/");
    Display imported = import_display(folder / "mpcdi.xml", {}, log);
    for (KeptFile const& file : log.files()) gi::write_text(folder / file.name, text_of(file.bytes));
    gi::write_text(folder / "out.yaml", to_yaml(imported));
    Display display = load_display(folder / "out.yaml", unused);
    // Points hold for any head; a frustum for the eye of the calibration.
    if (has_points) display.users[0].head.translation_m = {0.25, 0.1, 0.3};
    Pinhole const camera = camera_at(display.users[0].head.translation_m);

    struct Seen { // a pixel of the photograph
        gi::dvec3 along, point;
        std::array<double, 2> inside;
    };
    std::vector<Seen> pixels;
    for (int y = 0; y < kCamera_px.y; ++y)
        for (int x = 0; x < kCamera_px.x; ++x) {
            gi::dvec3 const d = camera.ray({(x + 0.5) / kCamera_px.x, (y + 0.5) / kCamera_px.y});
            gi::dvec3 const p = on_screen(screen, camera.at, d);
            pixels.push_back({d, p, {projectors()[0].inside(p), projectors()[1].inside(p)}});
        }
    auto const photo = [&](Content content) {
        auto const light = shown(display, content);
        std::vector<double> out;
        for (Seen const& s : pixels) {
            double sum = 0;
            for (std::size_t k = 0; k < 2; ++k)
                if (s.inside[k] > 0) sum += sent(light[k], projectors()[k].place_of(s.point));
            out.push_back(sum);
        }
        return out;
    };
    // Pixels that straddle the edge of a projector's picture are not judged: within 1.5 of its pixels.
    double const edge = 1.5 / kProjector_px.y;
    auto const is_judged = [&](Seen const& s) {
        return std::abs(s.inside[0]) > edge && std::abs(s.inside[1]) > edge &&
               std::max(s.inside[0], s.inside[1]) > 0;
    };
    std::size_t overlapping = 0, alone = 0;
    double worst_white = 0, worst_black = 0;
    auto const white = photo(Content::white), black = photo(Content::black);
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        if (!is_judged(pixels[i])) continue;
        ++(std::min(pixels[i].inside[0], pixels[i].inside[1]) > 0 ? overlapping : alone);
        // White is 1 of one projector, 1 + black of two.
        worst_white = std::max(worst_white, std::abs(white[i] / (1 + 0.5 * kBlack) - 1));
        worst_black = std::max(worst_black, std::abs(black[i] / (2 * kBlack) - 1));
    }
    EXPECT_GT(overlapping, 10000u);
    EXPECT_GT(alone, 10000u);
    EXPECT_LT(worst_white, 0.02);
    EXPECT_LT(worst_black, 0.02);

    // Middles of spots, in the photograph and as the world has them.
    auto const spots = photo(Content::spots);
    double worst_px = 0;
    int count = 0;
    std::vector<char> is_taken(pixels.size());
    auto const wanted = [&](std::size_t i) { return world_light(Content::spots, camera.at, pixels[i].along); };
    for (std::size_t start = 0; start < pixels.size(); ++start) {
        if (is_taken[start] || wanted(start) < 0.5) continue;
        std::vector<std::size_t> spot{start}; // all pixels that it touches
        is_taken[start] = 1;
        bool is_whole = true;
        for (std::size_t k = 0; k < spot.size(); ++k) {
            int const x = int(spot[k]) % kCamera_px.x, y = int(spot[k]) / kCamera_px.x;
            is_whole &= is_judged(pixels[spot[k]]) ||
                        std::max(pixels[spot[k]].inside[0], pixels[spot[k]].inside[1]) > edge;
            for (glm::ivec2 const n : {glm::ivec2(x - 1, y), {x + 1, y}, {x, y - 1}, {x, y + 1}}) {
                if (n.x < 0 || n.y < 0 || n.x >= kCamera_px.x || n.y >= kCamera_px.y) {
                    is_whole = false;
                    continue;
                }
                auto const i = std::size_t(n.y * kCamera_px.x + n.x);
                if (is_taken[i] || !(wanted(i) > 0 || spots[i] > 3 * kBlack)) continue;
                is_taken[i] = 1;
                spot.push_back(i);
            }
        }
        if (!is_whole || spot.size() < 20) continue;
        glm::dvec2 here{0}, there{0};
        double here_sum = 0, there_sum = 0;
        for (std::size_t const i : spot) {
            glm::dvec2 const px(double(int(i) % kCamera_px.x), double(int(i) / kCamera_px.x));
            double const light = std::max(0.0, spots[i] - 2 * kBlack);
            here += light * px;
            here_sum += light;
            there += wanted(i) * px;
            there_sum += wanted(i);
        }
        worst_px = std::max(worst_px, glm::distance(here / here_sum, there / there_sum));
        ++count;
    }
    EXPECT_GE(count, 15);
    EXPECT_LT(worst_px, 1);
    std::printf("white %.2f %%, black %.2f %%, %d spots within %.2f px\n", 100 * worst_white, 100 * worst_black,
                count, worst_px);
    fs::remove_all(folder);
}

INSTANTIATE_TEST_SUITE_P(Screens, CalibrationPhoto,
                         testing::Values(std::pair{Screen::flat, true}, std::pair{Screen::cylinder, true},
                                         std::pair{Screen::dome, true}, std::pair{Screen::flat, false},
                                         std::pair{Screen::cylinder, false}, std::pair{Screen::dome, false}));

} // namespace
} // namespace viewer::test
