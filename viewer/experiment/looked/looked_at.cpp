#include "viewer/experiment/looked/looked_at.h"

#include "gi/core/error.h"
#include "study/gaze/spread_places.h"
#include "study/journal/scene_facts.h"
#include "viewer/engine/render_session.h"
#include "viewer/experiment/looked/dwell.h"
#include "viewer/experiment/looked/gaze_rays.h"
#include "viewer/experiment/stimuli/stimulus_place.h"
#include "viewer/experiment/stimuli/stimulus_settings.h"
#include "viewer/study/scene_content.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace viewer {
namespace {

/// One picture of a view: its stimulus and where it was.
struct SeenPicture {
    StimulusSettings settings;
    glm::dvec2 corner_px{}, size_px{}; ///< from the window's top left corner
    double round_s = 6;                ///< of a path
};

/// A view that can be followed.
struct FollowedView {
    study::AnalysedGaze const* gaze;
    study::ViewedGaze const* viewed;
    std::vector<SeenPicture> pictures;
    study::SessionStarted const* start;
};

/// A fixation, or a part of one while the camera moves.
struct Look {
    std::pair<double, double> place_px; ///< from the centre of the window
    double seconds = 0, time_s = 0;     ///< time: since the beginning of the view
};

constexpr double kLook_s = 0.02; ///< longest part of a fixation while the camera moves

/// @return why it cannot be followed; empty = it can
std::string picture_of(study::Dataset const& records, study::TrialRow const& row,
                       study::StimulusShown const& shown, SeenPicture& picture)
{
    if (!shown.left_px || !shown.top_px || !shown.width_px || !shown.height_px)
        return "where pictures were is not recorded: headsets, walls, and records of earlier versions";
    study::Stimulus const* const planned = study::stimulus_of(row.step->trial, shown.letter);
    if (planned == nullptr) return "the plan has no such stimulus";
    study::Stimulus stimulus = *planned;
    if (stimulus.is_varied && !stimulus.level) stimulus.level = row.done->level;
    picture.settings = stimulus_settings(records.script, *row.block, stimulus);
    if (picture.settings.ar) return "AR sessions have no scene";
    if (picture.settings.settings.stereo != "off") return "stereo";
    if (picture.settings.sha256 != shown.settings_sha256) return "its settings are not those recorded";
    picture.corner_px = {*shown.left_px, *shown.top_px};
    picture.size_px = {*shown.width_px, *shown.height_px};
    picture.round_s = row.block->timing.stimulus_ms ? 1e-3 * *row.block->timing.stimulus_ms : 6;
    return {};
}

std::vector<Look> looks_of(FollowedView const& v, study::SeenFixation const& f, bool moves)
{
    study::GazeView const& view = *v.viewed->view;
    double const from_s = std::max(f.fixation->start_s, view.start_s);
    double const to_s = std::min(f.fixation->end_s, view.end_s);
    if (!moves) return {{{f.fixation->x_px, f.fixation->y_px}, f.dwell_s, 0}};
    int const parts = std::max(1, int(std::ceil((to_s - from_s) / kLook_s)));
    std::vector<Look> looks;
    auto const& samples = v.gaze->recording.samples;
    auto it = std::lower_bound(samples.begin(), samples.end(), from_s,
                               [](study::GazeSample const& s, double t) { return s.time_s < t; });
    std::pair<double, double> place(f.fixation->x_px, f.fixation->y_px);
    for (int p = 0; p < parts; ++p) {
        double const end_s = from_s + (to_s - from_s) * (p + 1) / parts;
        double x = 0, y = 0;
        int n = 0;
        for (; it != samples.end() && it->time_s < end_s; ++it)
            if (it->is_valid) {
                x += it->x_px;
                y += it->y_px;
                ++n;
            }
        if (n > 0) place = {x / n, y / n}; // else where it was: samples are further apart, or lost and bridged
        looks.push_back({place, (to_s - from_s) / parts, end_s - 0.5 * (to_s - from_s) / parts - view.start_s});
    }
    return looks;
}

/// Names of the nodes and materials of a world; equal ones get their numbers.
class Names {
public:
    explicit Names(gi::World const& world) : world_(world), materials_(world.scene->material_names)
    {
        for (gi::Node const& n : world.scene->nodes) nodes_.push_back(n.name);
        materials_.resize(world.materials.size()); // the last one is that of surfaces without one
        number(nodes_, "object");
        number(materials_, "material");
    }
    DwellTarget object_of(std::uint32_t triangle) const
    {
        auto const next = std::upper_bound(world_.placed.begin(), world_.placed.end(), triangle,
                                           [](std::uint32_t t, auto const& p) { return t < p.first_triangle; });
        return {"object", nodes_[std::prev(next)->node]};
    }
    DwellTarget material_of(std::uint32_t triangle) const
    {
        return {"material", materials_[world_.triangle_material[triangle]]};
    }

private:
    static void number(std::vector<std::string>& names, std::string const& what)
    {
        std::map<std::string, int> count;
        for (std::string const& n : names) ++count[n];
        for (std::size_t i = 0; i < names.size(); ++i)
            if (names[i].empty() || count[names[i]] > 1)
                names[i] = fmt::format("{} {}", names[i].empty() ? what : names[i], i);
    }
    gi::World const& world_;
    std::vector<std::string> nodes_, materials_;
};

/// A scene with its edits, and all that is followed in it.
class FollowedScene {
public:
    FollowedScene(gi::World const& world, LookedAtSettings const& settings, SurfaceHeat& heat)
        : world_(world),
          rays_(world, settings.threads),
          names_(world),
          offsets_(study::gaussian_offsets(settings.accuracy_deg, settings.rays)),
          heat_(heat)
    {
    }

    /// Adds what the rays of a look that fall on this picture met. @param found  by ray: whether it fell on one
    void follow(FollowedView const& v, SeenPicture const& picture, StimulusPlace const& place, Look const& look,
                std::vector<bool>& found, Dwell& dwell)
    {
        StimulusView view;
        view.size_px = glm::ivec2(picture.size_px);
        view.duration_s = picture.round_s;
        auto const views = stimulus_views(place, picture.settings, view, look.time_s);
        gi::CameraRays const camera =
            gi::camera_rays(views.at(0).camera, views[0].width, views[0].height, world_.origin);
        glm::dvec2 const window_px(v.gaze->recording.window_px.first, v.gaze->recording.window_px.second);
        std::vector<gi::Ray> rays;
        std::vector<std::size_t> of;
        for (std::size_t i = 0; i < offsets_.size(); ++i) {
            if (found[i]) continue;
            auto const at = study::offset_place(v.gaze->recording.screen, look.place_px, offsets_[i]);
            if (!at) continue;
            glm::dvec2 const px = glm::dvec2(at->first, at->second) + 0.5 * window_px - picture.corner_px;
            if (px.x < 0 || px.y < 0 || px.x >= picture.size_px.x || px.y >= picture.size_px.y) continue;
            found[i] = true;
            rays.push_back(camera.through(gi::vec2(px)));
            of.push_back(i);
        }
        auto const met = rays_.meet(std::move(rays));
        for (std::size_t k = 0; k < met.size(); ++k) {
            GazeMeeting const& m = met[k];
            bool const is_by_mirror = m.mirrors > 0;
            if (m.is_cut) {
                dwell.add({"none", "behind more than 8 mirrors"}, of[k], look.seconds, is_by_mirror);
            } else if (m.triangle == gi::kNoTriangle) {
                dwell.add({"none", "background"}, of[k], look.seconds, is_by_mirror);
            } else {
                dwell.add(names_.object_of(m.triangle), of[k], look.seconds, is_by_mirror);
                dwell.add(names_.material_of(m.triangle), of[k], look.seconds, is_by_mirror);
                heat_.seconds[m.triangle] += look.seconds / double(offsets_.size());
            }
        }
    }

    std::size_t offsets() const { return offsets_.size(); }

private:
    gi::World const& world_;
    GazeRays rays_;
    Names names_;
    std::vector<study::GazeOffset> offsets_;
    SurfaceHeat& heat_;
};

SurfaceHeat surface_of(gi::World const& world, std::string const& scene, std::vector<std::string>& taken)
{
    SurfaceHeat heat;
    taken.push_back(study::label_of("surfaces" + std::filesystem::path(scene).stem().string(), taken));
    heat.file = taken.back();
    heat.scene = scene;
    heat.origin = world.origin;
    heat.corners.reserve(3 * world.triangles.size());
    for (gi::uvec3 const& t : world.triangles)
        for (int k = 0; k < 3; ++k) heat.corners.push_back(world.positions[t[k]]);
    heat.seconds.assign(world.triangles.size(), 0);
    return heat;
}

/// What has the same surfaces: scene, edits other than those of lights, and whether its clips play.
std::string surfaces_key(StimulusSettings const& s)
{
    nlohmann::json edits = nlohmann::json::array();
    for (Change const& c : s.edits)
        if (!c.key.starts_with("light.") && !c.key.starts_with("environment.")) edits.push_back({c.key, c.value});
    return s.scene + "\n" + edits.dump() + (s.settings.play ? "play" : "");
}

std::vector<study::Column> target_columns()
{
    return {study::name_column("kind", "object or material of the scene; none: no surface"),
            study::name_column("name", "Its name; what has no name or shares it has its number in the scene"),
            {"seconds", "Time of fixations on it", "s"},
            {"seconds_se", "Standard error from the accuracy of the eye tracker", "s"},
            {"share", "Share of the time of fixations"},
            {"share_se", "Standard error of the share"},
            {"by_mirror_s", "Of the time, by way of mirrors and panes", "s"}};
}
void add_target(std::vector<std::string> cells, DwellTarget const& target, DwellOn const& d, double whole_s,
                study::Table& table)
{
    for (std::string const& c :
         {study::cell(target.kind), study::cell(target.name), study::cell(d.seconds), study::cell(d.se),
          study::cell(d.seconds / whole_s), study::cell(d.se / whole_s), study::cell(d.by_mirror_s)})
        cells.push_back(c);
    table.rows.push_back(std::move(cells));
}

class Follower {
public:
    Follower(study::Dataset const& records, study::GazeAnalysis const& analysis, SceneAccess const& scenes,
             LookedAtSettings const& settings)
        : records_(records), analysis_(analysis), scenes_(scenes), settings_(settings)
    {
    }

    LookedAt all()
    {
        collect();
        follow();
        write_tables();
        return std::move(result_);
    }

private:
    void leave_out(std::string const& why) { ++left_out_[why]; }

    /// The views, with their pictures.
    void collect()
    {
        for (auto const& gaze : analysis_.recordings)
            for (study::RecordedSession const& session : records_.sessions) {
                study::SessionStarted const& start = study::start_of(records_.script, session);
                if (start.participant_id != gaze->recording.participant ||
                    start.session != gaze->recording.session)
                    continue;
                auto const rows = study::trial_rows(records_.script, session);
                for (study::ViewedGaze const& v : gaze->views)
                    if (v.view->is_counted && v.is_usable) collect(*gaze, v, rows, start);
            }
    }
    void collect(study::AnalysedGaze const& gaze, study::ViewedGaze const& v,
                 std::vector<study::TrialRow> const& rows, study::SessionStarted const& start)
    {
        FollowedView followed{&gaze, &v, {}, &start};
        for (study::TrialRow const& row : rows) {
            if (row.done->step != v.view->step || row.done->attempt != v.view->attempt) continue;
            for (char const letter : v.view->shown)
                for (study::StimulusShown const& shown : row.done->shown) {
                    if (shown.letter != letter || std::abs(shown.onset_s + row.offset_s - v.view->start_s) > 1e-6)
                        continue;
                    SeenPicture picture;
                    if (std::string const why = picture_of(records_, row, shown, picture); !why.empty())
                        return leave_out(why);
                    followed.pictures.push_back(std::move(picture));
                }
        }
        if (followed.pictures.empty()) return leave_out("its stimuli are not in the journal");
        views_.push_back(std::move(followed));
        dwell_.emplace_back(std::size_t(settings_.rays));
        found_.emplace_back();
    }

    /// Scene by scene, so that each is loaded once.
    void follow()
    {
        std::map<std::string, std::vector<std::pair<std::size_t, std::size_t>>> by_surfaces; // view, picture
        for (std::size_t v = 0; v < views_.size(); ++v)
            for (std::size_t p = 0; p < views_[v].pictures.size(); ++p)
                by_surfaces[surfaces_key(views_[v].pictures[p].settings)].emplace_back(v, p);
        gi::Report report; // what is lost of a scene was said when it was shown
        for (auto const& [key, pictures] : by_surfaces) {
            StimulusSettings const& first = views_[pictures[0].first].pictures[pictures[0].second].settings;
            RenderSession session(scenes_.load, settings_.threads, report);
            session.apply({"scene", first.scene});
            for (Change const& c : first.edits) session.apply(c);
            if (session.moves() && first.settings.play) {
                for (auto const& [v, p] : pictures) drop(v, "scenes that move by themselves");
                continue;
            }
            note_other_content(first.scene, *session.world().scene, pictures);
            result_.surfaces.push_back(surface_of(session.world(), first.scene, surface_names_));
            FollowedScene scene(session.world(), settings_, result_.surfaces.back());
            for (auto const& [v, p] : pictures) follow(session.world(), scene, v, views_[v].pictures[p]);
        }
    }
    void follow(gi::World const& world, FollowedScene& scene, std::size_t v, SeenPicture const& picture)
    {
        FollowedView const& view = views_[v];
        StimulusPlace const place = place_of(world, scenes_.camera(world, picture.settings.camera));
        bool const moves = std::ranges::any_of(
            view.pictures, [](SeenPicture const& p) { return p.settings.path != StimulusPath::none; });
        std::size_t n = 0;
        for (study::SeenFixation const& f : view.viewed->fixations)
            for (Look const& look : looks_of(view, f, moves)) {
                if (found_[v].size() <= n) found_[v].push_back({look.seconds, std::vector<bool>(scene.offsets())});
                scene.follow(view, picture, place, look, found_[v][n++].rays, dwell_[v]);
            }
    }
    void drop(std::size_t v, std::string const& why)
    {
        if (dropped_.insert(v).second) leave_out(why);
    }
    void note_other_content(std::string const& name, gi::Scene const& scene,
                            std::vector<std::pair<std::size_t, std::size_t>> const& pictures)
    {
        std::string const content = scene_sha256(scene);
        std::set<study::AnalysedGaze const*> others;
        for (auto const& [v, p] : pictures)
            for (auto const& [fact, recorded] : views_[v].start->about)
                if (fact == study::scene_fact(name) && recorded != content) others.insert(views_[v].gaze);
        if (!others.empty())
            result_.cautions.push_back(
                fmt::format("scene {}: its files are not those that {} sessions showed", name, others.size()));
    }

    void write_tables()
    {
        study::ResultTable by_view{"dwell_views", "Gaze on objects and materials, by view", "", true, {}};
        by_view.table.columns = {study::name_column("recording", "Name of the recording"),
                                 {"step", "Step of the plan, from 1"},
                                 {"attempt", "Number of the attempt at the trial, from 1"},
                                 study::name_column("shown", "Letters of the stimuli shown side by side")};
        for (study::Column const& c : target_columns()) by_view.table.columns.push_back(c);
        struct Sums {
            double seconds = 0;
            std::map<study::AnalysedGaze const*, Dwell> of;
        };
        std::map<std::pair<std::string, std::string>, Sums> by_condition;
        for (std::size_t v = 0; v < views_.size(); ++v) {
            if (dropped_.contains(v)) continue;
            double whole_s = 0;
            for (Traced const& look : found_[v]) {
                whole_s += look.seconds;
                for (std::size_t i = 0; i < look.rays.size(); ++i)
                    if (!look.rays[i]) dwell_[v].add({"none", "beside the picture"}, i, look.seconds, false);
            }
            study::GazeView const& view = *views_[v].viewed->view;
            for (auto const& [target, d] : dwell_[v].all())
                add_target({study::cell(views_[v].gaze->recording.name), study::cell(view.step + 1),
                            study::cell(view.attempt), study::cell(view.shown)},
                           target, d, whole_s, by_view.table);
            Sums& s = by_condition[{view.block, view.condition}];
            s.seconds += whole_s;
            s.of.try_emplace(views_[v].gaze, std::size_t(settings_.rays)).first->second.add(dwell_[v]);
        }
        study::ResultTable dwell{
            "dwell",
            "Gaze on objects and materials",
            fmt::format("Errors are those of an accuracy of {:g} degrees, which all fixations of a "
                        "recording share.",
                        settings_.accuracy_deg),
            false,
            {}};
        dwell.table.columns = {study::name_column("block", "Block"),
                               study::name_column("condition", "Levels of the factors of each stimulus")};
        for (study::Column const& c : target_columns()) dwell.table.columns.push_back(c);
        for (auto const& [key, s] : by_condition) {
            std::map<DwellTarget, DwellOn> sum;
            for (auto const& [gaze, theirs] : s.of)
                for (auto const& [target, d] : theirs.all()) {
                    DwellOn& to = sum[target];
                    to.seconds += d.seconds;
                    to.se = std::hypot(to.se, d.se);
                    to.by_mirror_s += d.by_mirror_s;
                }
            for (auto const& [target, d] : sum)
                add_target({study::cell(key.first), study::cell(key.second)}, target, d, s.seconds, dwell.table);
        }
        study::ResultTable surfaces{"surfaces", "Gaze on the surfaces of scenes", "", false, {}};
        surfaces.table.columns = {study::name_column("file", "Name of the file, without .ply"),
                                  study::name_column("scene", "Scene; with other edits it has another file"),
                                  {"triangles", "Triangles"},
                                  {"seconds", "Time of fixations on them", "s"},
                                  {"most_s_per_m2", "Greatest density, which is white", "s/m2"}};
        for (SurfaceHeat const& h : result_.surfaces) {
            double seconds = 0;
            for (double const s : h.seconds) seconds += s;
            surfaces.table.rows.push_back({study::cell(h.file), study::cell(h.scene),
                                           study::cell(int(h.seconds.size())), study::cell(seconds),
                                           study::cell(h.most())});
        }
        study::ResultTable left_out{"dwell_left_out", "Views whose surfaces were not looked for", "", false, {}};
        left_out.table.columns = {study::name_column("reason", "Why"), {"views", "Views"}};
        for (auto const& [why, n] : left_out_) {
            left_out.table.rows.push_back({study::cell(why), study::cell(n)});
            result_.cautions.push_back(fmt::format("surfaces of {} views were not looked for: {}", n, why));
        }
        result_.tables = {std::move(dwell), std::move(by_view), std::move(surfaces), std::move(left_out)};
    }

    study::Dataset const& records_;
    study::GazeAnalysis const& analysis_;
    SceneAccess const& scenes_;
    LookedAtSettings settings_;
    LookedAt result_;
    /// Which rays of a look fell on a picture.
    struct Traced {
        double seconds;
        std::vector<bool> rays;
    };
    std::vector<FollowedView> views_;
    std::vector<Dwell> dwell_;               ///< by view
    std::vector<std::vector<Traced>> found_; ///< by view and look
    std::set<std::size_t> dropped_;
    std::map<std::string, int> left_out_;
    std::vector<std::string> surface_names_;
};

} // namespace

LookedAt looked_at(study::Dataset const& records, study::GazeAnalysis const& analysis, SceneAccess const& scenes,
                   LookedAtSettings const& settings)
{
    return Follower(records, analysis, scenes, settings).all();
}

} // namespace viewer
