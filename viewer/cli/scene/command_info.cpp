#include "gi/core/error.h"
#include "gi/hit_buffers/directions/direction_picture.h"
#include "gi/hit_buffers/directions/direction_quality.h"
#include "gi/image_io/picture_file.h"
#include "gi/methods/registry.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/model/summary.h"
#include "viewer/base/arguments.h"
#include "viewer/base/choices.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/cli/command_table.h"
#include "viewer/cli/commands.h"
#include "viewer/offline/choose_camera.h"
#include "viewer/offline/load_world.h"
#include "viewer/offline/picture_memory.h"
#include "viewer/offline/render_record.h"
#include "viewer/study/study_settings.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <memory>

namespace viewer {
namespace {

struct InfoOptions {
    std::string scene, directions, png, size = "512x512";
    std::vector<std::string> methods;
    std::optional<double> time_s;
    bool settings = false, json = false;
};

struct MethodPlan {
    std::string_view method;
    std::vector<gi::PlanItem> items;
};

/// The methods of these names, or all that plan what they build. Throws InputError for one that does not.
std::vector<gi::Method const*> methods_with_plans(std::vector<std::string> const& names)
{
    std::vector<gi::Method const*> out;
    std::string known;
    for (gi::Method const& m : gi::methods()) {
        if (m.explain == nullptr) continue;
        if (names.empty()) out.push_back(&m);
        known += (known.empty() ? "" : ", ") + std::string(m.name);
    }
    for (std::string const& name : names) {
        out.push_back(&gi::find_method(name));
        if (out.back()->explain == nullptr)
            throw gi::InputError("info --method " + name, "what it builds does not depend on the scene",
                                 "choose one of: " + known);
    }
    return out;
}

/// Prints a direction set, how uniform it is, and the errors of its look-up maps.
int run_directions(InfoOptions const& o)
{
    constexpr std::size_t kSamples = std::size_t(1) << 18;
    check_ending(o.png, ".png", "a PNG", "end it with .png");
    check_outputs({o.png}, {});
    gi::DirectionSet const set = gi::make_directions(o.directions);
    gi::DirectionQuality const q = gi::measure(set, kSamples);
    nlohmann::ordered_json j;
    j["directions"] = set.name;
    j["count"] = set.size();
    j["axes"] = set.axes.size();
    j["largest_gap_deg"] = glm::degrees(q.largest_gap_rad);
    j["mean_gap_deg"] = glm::degrees(q.mean_gap_rad);
    j["solid_angle_smallest"] = q.smallest_solid_angle;
    j["solid_angle_largest"] = q.largest_solid_angle;
    j["solid_angle_deviation"] = q.solid_angle_deviation;
    for (auto const& [name, mapping] :
         {std::pair{"octahedral", gi::SphereMapping::octahedral}, {"lat_long", gi::SphereMapping::lat_long}})
        for (std::uint32_t const size : {64u, 256u, 1024u}) {
            gi::DirectionMap const map = gi::make_direction_map(set, mapping, size);
            gi::MapQuality const m = gi::measure(view(map), set, kSamples);
            j["maps"].push_back({{"mapping", name},
                                 {"width", map.width},
                                 {"height", map.height},
                                 {"wrong_share", m.wrong_share},
                                 {"mean_excess_deg", glm::degrees(m.mean_excess_rad)},
                                 {"largest_excess_deg", glm::degrees(m.largest_excess_rad)}});
        }
    if (!o.png.empty()) {
        gi::DirectionPicture const picture = gi::draw(set);
        gi::write_png(o.png, picture.width, picture.height, picture.rgb);
        j["png"] = o.png;
    }
    if (o.json) {
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    fmt::print("{}\n  {:<22} {} on {} axes\n", set.name, "directions", set.size(), set.axes.size());
    fmt::print("  {:<22} {:.3f} at most, {:.3f} on average, degrees\n", "gap to the nearest",
               glm::degrees(q.largest_gap_rad), glm::degrees(q.mean_gap_rad));
    fmt::print("  {:<22} {:.3f} to {:.3f} of the mean, standard deviation {:.3f}\n", "solid angle",
               q.smallest_solid_angle, q.largest_solid_angle, q.solid_angle_deviation);
    fmt::print("Map against brute force      not the nearest     farther by, on average / at most, degrees\n");
    for (auto const& m : j["maps"])
        fmt::print("  {:<12} {:>5} x {:<5} {:>13.3f} % {:>18.5f} / {:.4f}\n", m["mapping"].get<std::string>(),
                   m["width"].get<int>(), m["height"].get<int>(), 100 * m["wrong_share"].get<double>(),
                   m["mean_excess_deg"].get<double>(), m["largest_excess_deg"].get<double>());
    if (!o.png.empty()) fmt::print("{}\n", o.png);
    std::fflush(stdout);
    return 0;
}

/// Prints every setting of scripts, panels and remote control.
int run_settings(bool as_json)
{
    auto const all = study_settings();
    if (as_json) {
        nlohmann::ordered_json j;
        for (StudySetting const& s : all)
            j["settings"].push_back({{"key", s.key},
                                     {"kind", s.kind},
                                     {"range", s.range},
                                     {"default", s.usual},
                                     {"can_vary", s.can_vary},
                                     {"meaning", s.meaning}});
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    std::string text =
        "Settings of stimuli (`settings`, levels of factors) and, marked with *, those that `vary` takes\n";
    for (StudySetting const& s : all) {
        text += fmt::format("{} {}\n    {}: {}{}\n    {}\n", s.can_vary ? '*' : ' ', s.key, s.kind, s.range,
                            s.usual.empty() ? "" : "; default " + s.usual, s.meaning);
    }
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    return 0;
}

/// The summary with units in the names of the keys.
nlohmann::ordered_json content_json(gi::SceneSummary const& s)
{
    using Json = nlohmann::ordered_json;
    auto const triple = [](gi::dvec3 v) { return Json{v.x, v.y, v.z}; };
    Json j;
    j["nodes"] = s.nodes;
    j["meshes"] = s.meshes;
    j["placed_meshes"] = s.placed_meshes;
    j["triangles"] = s.triangles;
    j["vertices"] = s.vertices;
    j["bounds_m"] =
        s.bounds_m ? Json{{"low", triple(s.bounds_m->first)}, {"high", triple(s.bounds_m->second)}} : Json();
    gi::MaterialKinds const& k = s.materials;
    j["materials"] = {{"all", k.all},     {"matt", k.matt},     {"coated", k.coated}, {"phong", k.phong},
                      {"metal", k.metal}, {"mirror", k.mirror}, {"glass", k.glass},   {"emitting", k.emitting}};
    j["material_names"] = s.material_names;
    j["emitting_materials"] = s.emitting_materials;
    j["textures"] = s.textures;
    j["texture_bytes"] = s.texture_bytes;
    j["punctual_lights"] = s.punctual_lights;
    j["lights"] = Json::array();
    for (gi::LightSummary const& l : s.lights) {
        bool const is_far = l.type == gi::LightType::directional;
        j["lights"].push_back({{"type", is_far                          ? "directional"
                                        : l.type == gi::LightType::spot ? "spot"
                                                                        : "point"},
                               {"position_m", is_far ? Json() : triple(l.position_m)},
                               {"direction", l.type == gi::LightType::point ? Json() : triple(l.direction)}});
    }
    j["emissive_triangles"] = s.emissive_triangles;
    j["emissive_area_m2"] = s.emissive_area_m2;
    j["environment_map"] = nullptr;
    if (auto const& e = s.environment)
        j["environment_map"] = {{"width_px", e->width},
                                {"height_px", e->height},
                                {"irradiance_up_w_per_m2", triple(e->up)},
                                {"irradiance_down_w_per_m2", triple(e->down)},
                                {"irradiance_brightest_w_per_m2", triple(e->brightest)},
                                {"brightest_normal", triple(e->brightest_normal)},
                                {"smooth_share", e->smooth_share}};
    for (char const* const list : {"cameras", "skins", "mesh_sequences", "clips", "playing"})
        j[list] = Json::array();
    for (gi::CameraSummary const& c : s.cameras) {
        bool const has_lens = c.aperture_radius_m > 0;
        j["cameras"].push_back({{"name", c.name},
                                {"aperture_radius_m", c.aperture_radius_m},
                                {"focus_distance_m", has_lens ? Json(c.focus_distance_m) : Json()}});
    }
    for (std::size_t const joints : s.skin_joints) j["skins"].push_back({{"joints", joints}});
    j["morph_targets"] = s.morph_targets;
    for (auto const& m : s.mesh_sequences) j["mesh_sequences"].push_back({{"name", m.name}, {"frames", m.frames}});
    for (auto const& c : s.clips) j["clips"].push_back({{"name", c.name}, {"duration_s", c.duration_s}});
    for (auto const& p : s.playing) j["playing"].push_back({{"name", p.name}, {"weight", p.weight}});
    return j;
}

int run(InfoOptions const& o)
{
    if (o.settings) {
        if (!o.scene.empty() || !o.directions.empty() || !o.methods.empty() || !o.png.empty() || o.time_s)
            throw gi::InputError("--settings with another option", "settings are the same in all scenes",
                                 "give --settings alone, or with --json");
        return run_settings(o.json);
    }
    if (o.scene.empty() == o.directions.empty())
        throw gi::InputError("info needs a SCENE, --directions or --settings", "it was given several or none",
                             "give one of them");
    if (!o.directions.empty() && !o.methods.empty())
        throw gi::InputError("--method with --directions", "a set of directions is not rendered", "leave one out");
    if (!o.directions.empty()) return run_directions(o);
    if (!o.png.empty()) throw gi::InputError("--png without --directions", "info draws no scenes", "use render");
    std::vector<gi::Method const*> const asked = methods_with_plans(o.methods);
    gi::Report report;
    RenderOptions rendered; // as render loads the scene, which may get a sky
    rendered.scene = o.scene;
    rendered.time_s = o.time_s;
    gi::RenderSettings settings;
    std::tie(settings.width, settings.height) = parse_size(o.size);
    gi::check_picture_size(settings.width, settings.height);
    LitScene const lit = lit_scene(rendered, report);
    gi::World const world = gi::build_world(lit.scene, o.time_s, report);
    gi::SceneSummary const summary = gi::summarise(world);
    gi::ScenePlan const plan = gi::plan_scene(world);
    gi::Camera const camera = choose_camera(world, {}).camera;
    PictureMemory const memory = picture_memory(settings.width, settings.height);
    std::vector<MethodPlan> methods;
    for (gi::Method const* const m : asked) methods.push_back({m->name, m->explain(world, settings, camera)});
    if (o.json) {
        nlohmann::ordered_json j;
        j["scene"] = o.scene;
        j["content"] = content_json(summary);
        if (!lit.added.empty()) j["added_light"] = lit.added;
        j["picture"] = {{"width_px", settings.width},
                        {"height_px", settings.height},
                        {"memory_bytes", memory.sums_bytes},
                        {"state_file_bytes", memory.state_bytes}};
        for (MethodPlan const& m : methods) j["plan_" + std::string(m.method)] = to_json(m.items);
        j["plan"] = to_json(plan.items);
        j["report"] = to_json(report);
        std::fputs(to_text(j).c_str(), stdout);
        return 0;
    }
    // Written at once, so that an error is found at the end, as for all commands.
    std::string text = o.scene + "\n";
    for (gi::SummaryLine const& line : text_lines(summary))
        text += fmt::format("  {:<22} {}\n", line.what, line.value);
    if (!lit.added.empty()) text += fmt::format("  {:<22} {}\n", "added light", lit.added);
    auto const add_plan = [&](std::string const& title, std::vector<gi::PlanItem> const& items) {
        text += title + "\n";
        for (gi::PlanItem const& item : items)
            text += fmt::format("  {:<4} {:<38} {}\n", item.build ? "yes" : "no", item.what, item.reason);
    };
    text += fmt::format(
        "A picture of {} x {} pixels\n  {:<22} {} besides the scene and what methods build\n  {:<22} {}\n",
        settings.width, settings.height, "memory", text_of_bytes(memory.sums_bytes), "state file",
        text_of_bytes(memory.state_bytes));
    add_plan("What is built for the scene", plan.items);
    for (MethodPlan const& m : methods)
        add_plan(
            fmt::format("What method {} builds, at {} x {} pixels", m.method, settings.width, settings.height),
            m.items);
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
    print_losses(report);
    return 0;
}

} // namespace

void add_info(CLI::App& app, int& exit_code)
{
    auto const o = std::make_shared<InfoOptions>();
    CLI::App* const c = app.add_subcommand("info", about("info"));
    offer(c->add_option("SCENE", o->scene,
                        "scene file, folder of OBJ or PLY frames, or atrium, cornell, mirror, ring, avatar"),
          gi::built_in_scenes());
    c->add_option("--directions", o->directions,
                  "instead of a scene: a direction set FAMILY:COUNT; families are\n"
                  "icosahedron, octahedron, tetrahedron, uv_grid, halton, fibonacci");
    c->add_option("--png", o->png, "with --directions: PNG file for a drawing of them");
    offer(c->add_option(
              "--method", o->methods,
              "say what these methods build, NAME[,NAME...]; without it: all whose plan depends on the scene"),
          gi::method_names())
        ->delimiter(',')
        ->allow_extra_args(false);
    c->add_option("--size", o->size, "width x height of the picture that is planned, pixels")
        ->capture_default_str();
    c->add_option("--time", o->time_s, "animation time, s")->check(in_range(-1e9, 1e9));
    c->add_flag(
        "--settings", o->settings,
        "instead of a scene: all settings that scripts of experiments may have: key, kind, range, default,\n"
        "meaning, and which a procedure can vary");
    c->add_flag("--json", o->json, "print JSON");
    c->footer(R"(Examples:
  lightwell info atrium
  lightwell info cornell --json
  lightwell info atrium --size 7680x4320 --method slhb
  lightwell info mirror --method ispm,lpv
  lightwell info --settings
  lightwell info --directions icosahedron:320 --png icosahedron.png

A scene without light is described with the light that render gives it (--light of render), which "added light" names.
--json holds: scene, content, added_light (if any)
(numbers, with units in the names of keys), picture (width_px, height_px, memory_bytes, state_file_bytes), plan and
plan_METHOD (name, what, build, reason, and the numbers in them), report.

The lines below "environment map" give the irradiance (red, green, blue) of unshadowed surfaces that face up, down
and to the most light, and the share of the map, by squared radiance, that is smooth (small if it has a sun).)");
    c->callback([o, &exit_code] { exit_code = run(*o); });
}

} // namespace viewer
