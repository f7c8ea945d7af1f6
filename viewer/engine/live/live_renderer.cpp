#include "viewer/engine/live/live_renderer.h"

#include "gi/core/error.h"
#include "gi/methods/registry.h"
#include "viewer/engine/live/background_priority.h"
#include "viewer/engine/picking.h"
#include "viewer/engine/picture_margin.h"

#include <algorithm>
#include <malloc.h>
#include <utility>

namespace viewer {
namespace {

double pixels_of(std::vector<ViewCommand> const& views)
{
    double sum = 0;
    for (ViewCommand const& v : views) sum += double(v.width) * v.height;
    return sum;
}

bool same_sizes(std::vector<ViewCommand> const& a, std::vector<ViewCommand> const& b)
{
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](ViewCommand const& x, ViewCommand const& y) {
        return x.width == y.width && x.height == y.height;
    });
}

bool updates_axes(Settings const& s) { return gi::updates_axes(gi::find_method(s.method), s.render); }

/// Looks (0.1 s each) that find nothing to render before memory is given back
/// that the next frame would need again.
constexpr int kRestsBeforeTrim = 10;
/// Pictures of light alone after the last change, the last of them larger, before the first at full size, which takes
/// many times as long.
constexpr int kSettling = 2;
constexpr double kSettledScale = 0.5;

} // namespace

LiveRenderer::LiveRenderer(RenderSession& session, SessionClock const& clock, FrameLink* link, Hooks hooks)
    : session_(session), clock_(clock), link_(link), hooks_(std::move(hooks)), thread_([this] { run(); })
{
}

LiveRenderer::~LiveRenderer() { stop(); }

void LiveRenderer::stop()
{
    quit_ = true;
    {
        std::lock_guard const lock(mutex_);
        if (stop_) stop_->request();
    }
    wake_.notify_all();
    if (thread_.joinable()) thread_.join();
}

void LiveRenderer::ask(std::function<void(RenderSession&)> question)
{
    {
        std::lock_guard const lock(mutex_);
        jobs_.push_back([this, question = std::move(question)] { question(session_); });
    }
    wake_.notify_all();
}

void LiveRenderer::post(Change change, std::function<void(std::string const&)> done)
{
    {
        std::lock_guard const lock(mutex_);
        bool const is_edit = is_scene_edit(change.key);
        if (is_edit) edits_.push_back({++count_edits_, change});
        if (stop_ && (refines_ || is_edit)) stop_->request();
        jobs_.push_back([this, number = count_edits_, change = std::move(change), done = std::move(done)] {
            std::string error;
            try {
                session_.apply(change);
                changes_.push_back(change);
            } catch (gi::InputError const& e) {
                error = e.what();
            }
            made_edits_ = number;
            if (done) done(error);
        });
        asked_ = true;
    }
    wake_.notify_all();
}

void LiveRenderer::adopt(std::shared_ptr<PreparedScene> scene, SceneKnown known,
                         std::function<void(RenderSession const&, std::uint64_t)> done)
{
    ask([this, scene = std::move(scene), known, done = std::move(done)](RenderSession& s) {
        bool const is_first = !s.has_scene();
        s.adopt(std::move(*scene));
        if (known == SceneKnown::no || !is_first) changes_.push_back(to_change(s.shown_scene()));
        awaits_look_ = true;
        ++adopted_;
        done(s, adopted_);
    });
}

void LiveRenderer::resume(std::uint64_t scene)
{
    ask([this, scene](RenderSession&) {
        if (scene == adopted_) awaits_look_ = false;
    });
}

void LiveRenderer::go_to(double scene_s)
{
    ask([this, scene_s](RenderSession&) {
        scene_s_ = scene_s;
        ahead_s_ = 0;
    });
}

void LiveRenderer::look(Viewpoint viewpoint)
{
    bool moved = false;
    {
        std::lock_guard const lock(mutex_);
        moved = !same_cameras(viewpoint.views, viewpoint_.views) || !(viewpoint.tracked == viewpoint_.tracked) ||
                viewpoint.others != viewpoint_.others || !same_sizes(viewpoint.views, viewpoint_.views);
        anticipation_.see(viewpoint);
        viewpoint_ = std::move(viewpoint);
        if (moved) looked_ = asked_ = true;
        if (moved && stop_ && refines_) stop_->request();
    }
    if (moved) wake_.notify_all();
}

void LiveRenderer::again()
{
    {
        std::lock_guard const lock(mutex_);
        looked_ = true;
    }
    wake_.notify_all();
}

std::shared_ptr<LiveFrame const> LiveRenderer::newest() const
{
    std::lock_guard const lock(mutex_);
    return newest_;
}

std::vector<Change> LiveRenderer::edits_since(LiveFrame const& frame) const
{
    std::vector<Change> since;
    std::lock_guard const lock(mutex_);
    for (Edit const& e : edits_)
        if (e.number > frame.edits && (is_object_edit(e.change.key) || is_light_edit(e.change.key)))
            since.push_back(e.change);
    return since;
}

std::shared_ptr<LiveFrame const> LiveRenderer::frame(std::uint64_t number)
{
    std::lock_guard const lock(mutex_);
    while (!frames_.empty() && frames_.front()->command.frame < number) frames_.pop_front();
    return !frames_.empty() && frames_.front()->command.frame == number ? frames_.front() : nullptr;
}

bool LiveRenderer::rests() const
{
    std::lock_guard const lock(mutex_);
    return resting_ && !looked_ && jobs_.empty();
}

std::shared_ptr<LiveFrame const> LiveRenderer::next_frame(double timeout_s)
{
    double const asked = clock_.now_s();
    again();
    std::unique_lock lock(mutex_);
    published_.wait_for(lock, std::chrono::duration<double>(timeout_s),
                        [&] { return quit_ || stopped_ || (newest_ && newest_->begun_s >= asked); });
    return newest_ && newest_->begun_s >= asked ? newest_ : nullptr;
}

void LiveRenderer::do_jobs()
{
    while (true) {
        std::function<void()> job;
        {
            std::lock_guard const lock(mutex_);
            if (jobs_.empty()) return;
            resting_ = false;
            job = std::move(jobs_.front());
            jobs_.pop_front();
        }
        job();
    }
}

/// Also returns early if there are jobs, or to quit.
void LiveRenderer::wait_until(double time_s)
{
    std::unique_lock lock(mutex_);
    wake_.wait_for(lock, std::chrono::duration<double>(std::max(0.0, time_s - clock_.now_s())),
                   [&] { return quit_ || !jobs_.empty(); });
}

void LiveRenderer::run()
{
    BackgroundPriority const priority;
    try {
        if (link_ != nullptr)
            run_linked();
        else
            run_leading();
    } catch (std::exception const& e) {
        if (hooks_.failed) hooks_.failed(e.what());
    }
    stopped_ = true;
    published_.notify_all();
    if (hooks_.published) hooks_.published();
}

void LiveRenderer::run_linked()
{
    while (!quit_ && !session_.has_scene()) {
        wait_until(clock_.now_s() + 0.1);
        do_jobs();
    }
    if (quit_) return; // no scene: the other ranks find out for themselves
    link_->begin();
    if (link_->leads())
        run_leading();
    else
        run_following();
    link_->end();
}

bool LiveRenderer::scene_may_move(Viewpoint const& now) const
{
    Settings const& s = session_.settings();
    return !has_last_ || !changes_.empty() || (s.play && s.speed != 0 && session_.moves()) ||
           !(now.tracked == last_look_.tracked) || now.others != last_look_.others || scene_s_ != last_scene_s_;
}

bool LiveRenderer::anything_moves(Viewpoint const& now) const
{
    return scene_may_move(now) || !same_cameras(now.views, last_look_.views) ||
           !same_sizes(now.views, last_look_.views);
}

/// Posts the choice as a change, like the user's, so that a replay and the other ranks apply it too.
void LiveRenderer::choose_updated_axes(bool may_move)
{
    Settings const& s = session_.settings();
    int const updated = updates_axes(s) ? update_governor_.next(may_move) : 0;
    if (updated == s.updated_axes) return;
    Change const change{"updated_axes", updated};
    session_.apply(change);
    changes_.push_back(change);
}

/// Time from a frame's start to the middle of its display interval, s.
double LiveRenderer::seen_after_s() const { return std::min(1.5 * frame_s_, Anticipation::kFarthest_s); }

/// Adds margins to the pictures in the direction in which viewers turn, if there is time for it.
/// @param last  expected viewpoint when the next picture is shown
void LiveRenderer::add_margins(FrameCommand& command, Viewpoint const& last) const
{
    bool const has_time = command.light_scale > Governor::kLeastScale;
    if (!(command.light_scale < 1) || command.only_light || !has_time || last.views.size() != command.views.size())
        return;
    for (std::size_t k = 0; k < command.views.size(); ++k) {
        glm::ivec2 const margin = margin_for(command.views[k], last.views[k].camera);
        command.views[k].margin_x = margin.x;
        command.views[k].margin_y = margin.y;
    }
}

FrameCommand LiveRenderer::make_command(Viewpoint const& now, bool still, FrameBudget& budget)
{
    Settings const& s = session_.settings();
    FrameCommand command;
    command.views = now.views;
    bool const own_surfaces = s.first_surfaces && has_own_surfaces(command) && !(s.scale > 0);
    bool const shows_drawn = own_surfaces && now.drawn_scale > 0 && s.draw_surfaces && s.compare.empty();
    bool const refines = still && !(shows_drawn && settled_ < kSettling);
    budget = governor_.next(pixels_of(now.views), refines, {s.paths, s.scale, s.scale}, own_surfaces);
    if (still && !refines && settled_ + 1 == kSettling) budget.scale = std::max(budget.scale, kSettledScale);
    command.frame = frame_++;
    command.pose_s = now.pose_s;
    command.display_s = now.display_s;
    last_scene_s_ = scene_s_;
    bool const plays = s.play && s.predict && !still && session_.moves();
    command.scene_s = scene_s_ + (plays ? s.speed * seen_after_s() : 0);
    command.world_from_room = now.world_from_room;
    command.tracked = now.tracked;
    command.others = now.others;
    command.changes = std::exchange(changes_, {});
    command.paths = budget.paths;
    if (own_surfaces) {
        command.light_scale = budget.scale;
        command.only_light = shows_drawn && budget.scale < 1;
        if (command.only_light) // mirrors and panes need not be sharper than what is drawn around them
            budget.surfaces = std::max(budget.scale, std::min(budget.surfaces, now.drawn_scale));
        command.surface_scale = budget.surfaces;
    } else {
        for (ViewCommand& v : command.views) v = scaled(v, budget.scale);
    }
    return command;
}

void LiveRenderer::run_leading()
{
    bool gave_up = false;
    while (!quit_) {
        Viewpoint now, ahead, last; // last: when the picture is replaced
        Anticipation anticipation;
        bool looked = false;
        {
            std::lock_guard const lock(mutex_);
            now = viewpoint_;
            ahead = last = now;
            if (session_.settings().predict && link_ == nullptr) {
                double const now_s = clock_.now_s();
                ahead = anticipation_.at(now_s, now_s + seen_after_s());
                last = anticipation_.at(now_s, now_s + 2 * frame_s_);
                anticipation = anticipation_;
            }
            looked = looked_.exchange(false);
            asked_ = false;
            if (looked || !jobs_.empty()) resting_ = false;
        }
        bool const awaited_look = awaits_look_;
        do_jobs(); // after reading the viewpoint, so that a frame includes every job posted before it
        if (awaited_look || awaits_look_) { // `now` is of the old scene
            if (looked) looked_ = true;
            if (awaits_look_) wait_until(clock_.now_s() + 0.01);
            continue;
        }
        double const begun = clock_.now_s();
        Settings const& s = session_.settings();
        bool const plays = s.play && session_.moves();
        if (!plays && ahead_s_ > 0) scene_s_ = last_.scene_s; // clips stop where they were seen last
        if (!plays) ahead_s_ = 0;
        if (has_last_ && plays) scene_s_ += s.speed * (begun - last_begun_s_);
        last_begun_s_ = begun;
        bool const still = !anything_moves(now);
        bool const rests = !session_.has_scene() || now.views.empty() ||
                           (still && !last_.only_light && (!s.refine || still_paths_ >= kConvergedPaths));
        if (rests && !looked) {
            if (link_ != nullptr) link_->check();
            if (++rests_for_ == kRestsBeforeTrim) malloc_trim(0);
            std::unique_lock lock(mutex_);
            resting_ = true;
            wake_.wait_for(lock, std::chrono::milliseconds(100),
                           [&] { return quit_ || !jobs_.empty() || looked_; });
            continue;
        }
        if (!session_.has_scene() || now.views.empty()) {
            wait_until(begun + 0.01);
            continue;
        }
        rests_for_ = 0;
        choose_updated_axes(scene_may_move(now));
        FrameBudget budget;
        FrameCommand command = make_command(still ? now : ahead, still, budget);
        if (!still) add_margins(command, last);
        if (command.only_light && !still && s.predict && link_ == nullptr &&
            !session_.depends_on_poses(ahead.views))
            command.views =
                anticipation.far_ahead(begun, 1.5 * frame_s_, // the middle of the time for which it is the newest
                                       [this](auto from, auto direction, double most_m) {
                                           return free_way_m(session_.world(), from, direction, most_m);
                                       });
        last_look_ = std::move(now);
        if (link_ != nullptr) link_->send(command);
        {
            std::lock_guard const lock(mutex_);
            resting_ = false;
            // Ranks must trace the same number of paths, and so must both methods of a comparison.
            bool const may_end_early =
                link_ == nullptr && gi::find_method(s.method).ends_frames_early && s.compare.empty();
            // After a frame that was given up, the next is rendered whatever comes.
            stop_ = may_end_early && !gave_up ? std::make_shared<gi::StopRequest>() : nullptr;
            refines_ = still;
            if (stop_ && (refines_ ? asked_ : !edits_.empty() && edits_.back().number > made_edits_))
                stop_->request();
        }
        ahead_s_ = command.scene_s != scene_s_ ? seen_after_s() : 0;
        Rendered const rendered = render(std::move(command), budget, ahead_s_);
        gave_up = rendered == Rendered::given_up;
        if (gave_up) {
            if (looked) looked_ = true; // the next frame is for it
            continue;
        }
        settled_ = still ? settled_ + 1 : 0;
        if (rendered == Rendered::failed) wait_until(clock_.now_s() + 0.2);
        if (!still) wait_until(begun + 1 / s.rate_hz);
    }
}

void LiveRenderer::run_following()
{
    while (!quit_) {
        std::optional<FrameCommand> command = link_->receive();
        if (!command) return;
        {
            gi::StepListener const listener([this](gi::Step const& step) {
                if (hooks_.at_step) hooks_.at_step(step);
            });
            for (Change const& c : command->changes) session_.apply(c);
        }
        render(std::move(*command), {});
    }
}

/// Passes the measurements of the last frame, of any rank, to the governors.
void LiveRenderer::measure(FrameWork const& work, FrameBudget const& budget)
{
    Settings const& s = session_.settings();
    FrameBudget done = budget;
    done.paths = last_.paths;
    governor_.measured(done, pixels_of(last_look_.views), work.seconds, s.rate_hz, work.surfaces_s);
    if (updates_axes(s)) update_governor_.measured({work.dynamic_update, work.moved, s.rate_hz});
}

LiveRenderer::Rendered LiveRenderer::render(FrameCommand command, FrameBudget const& budget, double ahead_s)
{
    auto frame = std::make_shared<LiveFrame>();
    frame->begun_s = clock_.now_s();
    frame->budget = budget;
    frame->ahead_s = ahead_s;
    gi::StopRequest never;
    bool given_up = false;
    frame->edits = made_edits_;
    std::shared_ptr<gi::StopRequest> const stop = stop_;
    if (hooks_.own_views) {
        frame->ordered = command.views;
        if (!command.views.empty()) session_.headlight_at(eye_of(command.views));
        command.views = hooks_.own_views(command);
    }
    gi::StepListener const listener([this](gi::Step const& step) {
        // A method that starts may take long to build its structures.
        bool const builds = step.of > 0 || step.what.starts_with("build");
        if (quit_ && link_ == nullptr && builds) throw gi::Interrupted();
        if (hooks_.at_step) hooks_.at_step(step);
    });
    try {
        frame->result = session_.render(command, stop ? *stop : never, stop ? OnStop::give_up : OnStop::shorten);
    } catch (gi::Interrupted const&) {
        given_up = stop && stop->requested() && !quit_;
        frame->result = {};
    } catch (gi::InputError const& e) {
        if (hooks_.failed) hooks_.failed(e.what());
        frame->result = {};
    }
    {
        std::lock_guard const lock(mutex_);
        stop_ = nullptr;
    }
    if (given_up) { // as if it had never begun
        changes_.insert(changes_.begin(), command.changes.begin(), command.changes.end());
        --frame_;
        return Rendered::given_up;
    }
    frame->done_s = clock_.now_s();
    bool const done = !frame->result.views.empty() || command.views.empty(); // a rank may have no walls to draw
    if (!frame->result.views.empty()) {
        command.paths = frame->result.paths;
        still_paths_ = frame->result.still_frames > 1 ? still_paths_ + std::uint32_t(command.paths)
                                                      : std::uint32_t(command.paths);
    }
    frame->still_paths = still_paths_;
    frame->settings = session_.settings();
    last_ = command;
    has_last_ = true;
    frame->command = std::move(command);
    auto const surfaces = frame->result.stages_s.find(kSurfacesStage);
    constexpr double kNewest = 0.2;
    double const took_s = frame->done_s - frame->begun_s;
    if (done) frame_s_ = frame_s_ > 0 ? frame_s_ + kNewest * (took_s - frame_s_) : took_s;
    FrameWork const own{took_s, frame->result.dynamic_update, frame->result.moved,
                        surfaces == frame->result.stages_s.end() ? 0 : surfaces->second};
    if (done && link_ == nullptr) measure(own, budget);
    if (!frame->result.views.empty()) stored_ = own.dynamic_update.stored;
    frame->schedule = frame->result.choice;
    if (Settings const& s = frame->settings; gi::find_method(s.method).updates_axes != nullptr)
        frame->schedule = schedule_sentence(get(s, "schedule").get<std::string>(), s.updated_axes, stored_,
                                            update_governor_.share_of_all());
    if (done && hooks_.finished) hooks_.finished(*frame);
    if (!done) { // what it was to change belongs to the next frame, else no recording would have it
        std::vector<Change> const& lost = frame->command.changes;
        if (link_ == nullptr) changes_.insert(changes_.begin(), lost.begin(), lost.end());
        if (link_ != nullptr) { // the others need not wait for it
            FrameCommand const without = frame->command;
            exchange_light(*frame);
            link_->wait_for_all(without, own);
        }
        return Rendered::failed;
    }
    if (link_ == nullptr) {
        publish(std::move(frame));
        return Rendered::whole;
    }
    FrameCommand const shown = frame->command;
    exchange_light(*frame);
    if (!link_->leads()) publish(frame); // before the leader shows it
    FrameWork const slowest = link_->wait_for_all(shown, own);
    if (shown.views.empty()) stored_ = slowest.dynamic_update.stored; // this rank has no hit buffers of its own
    if (!link_->leads()) return Rendered::whole;
    publish(std::move(frame));
    measure(slowest, budget);
    return Rendered::whole;
}

void LiveRenderer::publish(std::shared_ptr<LiveFrame const> frame)
{
    {
        std::lock_guard const lock(mutex_);
        while (newest_ && !edits_.empty() && edits_.front().number <= newest_->edits) edits_.pop_front();
        constexpr std::size_t kMost = 8; // the leader shows the last or the one before
        if (link_ != nullptr && !link_->leads()) frames_.push_back(frame);
        if (frames_.size() > kMost) frames_.pop_front();
        newest_ = std::move(frame);
    }
    published_.notify_all();
    if (hooks_.published) hooks_.published();
}

/// Surfaces of all ranks are lit by the light of all views, and by the same cells.
void LiveRenderer::exchange_light(LiveFrame& frame)
{
    std::vector<ViewCommand> const& all = frame.ordered.empty() ? frame.command.views : frame.ordered;
    FrameLight own{std::vector<std::shared_ptr<gi::LightPicture const>>(all.size()), frame.result.cells};
    for (std::size_t k = 0, n = 0; k < all.size() && n < frame.result.views.size(); ++k)
        if (frame.command.views[n].name == all[k].name) own.views[k] = frame.result.views[n++].light;
    FrameCommand command = frame.command;
    command.views = all;
    FrameLight const light = link_->exchange(command, std::move(own));
    frame.light = light.views;
    frame.result.cells = light.cells;
    if (!link_->leads()) return;
    for (std::size_t k = 0; k < all.size(); ++k)
        if (light.views[k] &&
            std::ranges::find(frame.command.views, all[k].name, &ViewCommand::name) == frame.command.views.end())
            session_.learn(*light.views[k]);
}

} // namespace viewer
