// Checksums of every layer of small pictures, to show that a change of the code changes no picture.
//   layer_checksums CASES [SCENE...] > before.txt     the same with the changed program, then: diff
// CASES is a text file with a line per case: LABEL METHOD [OPTION=VALUE...]. A line of output is
// "SCENE LABEL FORM LAYER CHECKSUM". Forms: a picture; frames of a moving scene, one with motion blur; a stereo pair
// whose second eye reuses light, without and with the radiance cache; a pair with and without dynamic geometry; and
// slhb's kernels on the host. Checksums are those of one machine: pictures depend on its vector instructions.

#include "gi/core/error.h"
#include "gi/core/text.h"
#include "gi/core/xxhash.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/registry.h"
#include "gi/scene/generate/builder.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/moving_world.h"
#include <glm/gtc/matrix_transform.hpp>

#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace {

using namespace gi;

constexpr int kWidth = 48, kHeight = 36;

struct Case {
    std::string label, method;
    std::vector<std::pair<std::string, std::string>> options;
};

std::vector<Case> read_cases(char const* file)
{
    std::vector<Case> cases;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);) {
        std::istringstream words(line);
        Case c;
        if (!(words >> c.label >> c.method) || c.label.starts_with('#')) continue;
        for (std::string word; words >> word;) {
            std::size_t const at = word.find('=');
            c.options.emplace_back(word.substr(0, at), at == std::string::npos ? "true" : word.substr(at + 1));
        }
        cases.push_back(std::move(c));
    }
    return cases;
}

/// A built-in scene with a small block that a tracker could move.
struct Stage {
    std::shared_ptr<Scene const> scene;
    std::size_t block; ///< node
    Camera left, right;
};

Stage stage_of(std::string const& name)
{
    Report report;
    Scene scene = load_scene(name, report);
    World const world = build_world(std::make_shared<Scene const>(scene), std::nullopt, report);
    vec3 const middle = world.bounds.center();
    float const radius = world.bounds.radius();
    SceneBuilder builder;
    int const red = builder.add_material("red", matt(vec3{0.7f, 0.2f, 0.1f}));
    builder.box(red, middle - 0.1f * radius, middle + 0.05f * radius);
    Stage stage;
    stage.block = scene.nodes.size();
    append(scene, builder.finish("block"), "block", glm::translate(dmat4(1), world.origin));
    for (std::size_t n = stage.block; n < scene.nodes.size(); ++n) scene.nodes[n].driven = true;
    if (world.light_select.empty()) {
        scene.environment.emplace();
        scene.environment->width = 2;
        scene.environment->height = 1;
        scene.environment->radiance.assign(2, vec3{1});
    }
    if (scene.cameras.empty() || world.cameras.empty()) {
        SceneBuilder eye;
        dvec3 const at = dvec3(middle) + world.origin;
        eye.add_camera("eye", at + double(radius) * dvec3{0.8, 0.4, 1.1}, at, 50);
        append(scene, eye.finish("eye"), "eye", dmat4(1));
    }
    stage.scene = std::make_shared<Scene const>(std::move(scene));
    stage.left = build_world(stage.scene, std::nullopt, report).cameras.at(0);
    stage.right = stage.left;
    stage.right.world_from_camera = glm::translate(stage.left.world_from_camera, dvec3{0.063, 0, 0});
    return stage;
}

class Sums {
public:
    Sums(std::string scene, std::string label) : scene_(std::move(scene)), label_(std::move(label)) {}
    void print(std::string const& form, RenderResult const& r) const
    {
        for (Layer const& l : r.picture.layers) line(form, l.name, xxh64(std::as_bytes(std::span(l.data))));
        if (!r.light_from.empty()) line(form, "light_from", xxh64(std::as_bytes(std::span(r.light_from))));
    }
    void print(std::string const& form, PairResult const& r) const
    {
        print(form + "_with", r.with);
        print(form + "_without", r.without);
        line(form, "coverage", xxh64(std::as_bytes(std::span(r.coverage))));
        line(form, "covered", xxh64(std::as_bytes(std::span(r.covered))));
    }
    /// What `make` throws for wrong input is a result, too.
    template <class F>
    void form(std::string const& name, F const& make) const
    {
        try {
            make(name);
        } catch (InputError const&) {
            line(name, "refused", 0);
        }
    }

private:
    void line(std::string const& form, std::string const& layer, std::uint64_t sum) const
    {
        fmt::print("{} {} {} {} {:016x}\n", scene_, label_, form, layer, sum);
    }
    std::string scene_, label_;
};

Pose pose_at(Stage const& stage, double time_s, PairSide side)
{
    Pose pose = evaluate_pose(*stage.scene, time_s);
    if (side == PairSide::without)
        for (std::size_t n = stage.block; n < stage.scene->nodes.size(); ++n) pose.world_from_node[n] *= dmat4(0);
    return pose;
}

void run(std::string const& name, Stage const& stage, Case const& c)
{
    Sums const sums(name, c.label);
    Method const& method = find_method(c.method);
    RenderSettings s;
    s.width = kWidth;
    s.height = kHeight;
    s.paths = 3;
    s.bounces = 3;
    s.seed = 7;
    for (auto const& [option, value] : c.options) render_option(option).set(s, value, option + " = " + value);
    StopRequest const never;
    Report report;
    FrameView const left{stage.left, kWidth, kHeight}, right{stage.right, kWidth, kHeight, 0};
    std::vector<FrameView> const eyes{left, right};
    sums.form("picture", [&](std::string const& form) {
        World const world = build_world(stage.scene, 0.3, report);
        sums.print(form, method.render(world, stage.left, s, never, {}, report));
    });
    sums.form("frames", [&](std::string const& form) {
        MovingWorld world(stage.scene, 0, report);
        auto const frames = method.frames(world, stage.left, s, report);
        for (double const time_s : {0.0, 0.1, 0.25}) {
            frames->changed(world.advance(time_s));
            sums.print(fmt::format("{}_{}", form, time_s), frames->frame(stage.left, never, {}));
        }
    });
    sums.form("blurred", [&](std::string const& form) {
        MovingWorld world(stage.scene, 0, report);
        auto const frames = method.frames(world, stage.left, s, report);
        auto const moments = [&](std::uint32_t pass) { return Moment{world.advance(0.02 * pass), stage.left}; };
        sums.print(form, frames->frame(stage.left, never, {}, moments));
    });
    sums.form("eyes", [&](std::string const& form) {
        for (VertexSharing const sharing : {VertexSharing::none, VertexSharing::exact, VertexSharing::cached}) {
            MovingWorld world(stage.scene, 0, report);
            auto const frames = method.frames(world, stage.left, s, report);
            for (int frame = 0; frame < 2; ++frame) {
                frames->changed(world.advance(0.1 * frame));
                std::vector<RenderResult> const both = frames->views(eyes, 2, sharing, never);
                for (std::size_t k = 0; k < both.size(); ++k)
                    sums.print(fmt::format("{}_{}_{}_{}", form, int(sharing), frame, k), both[k]);
            }
        }
    });
    sums.form("pair", [&](std::string const& form) {
        for (PairDifference const difference : {PairDifference::anything, PairDifference::vanishing}) {
            MovingWorld world(stage.scene, 0, report);
            auto const frames = method.frames(world, stage.left, s, report);
            for (double const time_s : {0.0, 0.1})
                sums.print(fmt::format("{}_{}_{}", form, int(difference), time_s),
                           ask<PairFrames>(*frames)->pair(
                               left, {2, difference},
                               [&](PairSide side) { return world.advance(pose_at(stage, time_s, side)); }, never));
        }
    });
    if (!c.label.starts_with("look_ups_maps")) return;
    sums.form("kernels", [&](std::string const& form) {
        World const world = build_world(stage.scene, 0.3, report);
        sums.print(form, render_by_kernels(Space::host, world, stage.left, s, never, {}, report));
    });
}

} // namespace

int main(int argc, char** argv)
try {
    if (argc < 2) throw InputError("layer_checksums needs a file of cases", "it was given none", "see main.cpp");
    std::vector<Case> const cases = read_cases(argv[1]);
    std::vector<std::string> scenes(argv + 2, argv + argc);
    if (scenes.empty()) scenes = built_in_scenes();
    for (std::string const& name : scenes) {
        Stage const stage = stage_of(name);
        for (Case const& c : cases) run(name, stage, c);
    }
    return 0;
} catch (std::exception const& e) {
    fmt::print(stderr, "{}\n", e.what());
    return 2;
}
