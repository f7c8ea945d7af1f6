// The rendering thread: frames come, changes show in the next, nothing blocks who asks.

#include "viewer/engine/live/live_renderer.h"

#include "gi/core/error.h"
#include "gi/scene/generate/figure.h"
#include "gi/scene/generate/generate.h"

#include <atomic>
#include <future>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

std::shared_ptr<gi::Scene const> cornell(std::string const& name, gi::Report&)
{
    if (name != "cornell") throw gi::InputError("no scene '" + name + "'", "there is only one", "use cornell");
    return std::make_shared<gi::Scene const>(gi::generate_cornell());
}

struct Live {
    gi::Report report;
    SessionClock clock;
    RenderSession session{cornell, 0, report};
    std::vector<FrameCommand> commands; ///< finished, by the rendering thread
    std::vector<std::string> failures;
    gi::Camera eye;
    std::unique_ptr<LiveRenderer> renderer;

    Live()
    {
        session.apply({"scene", "cornell"});
        session.apply({"method", "slhb"});
        session.apply({"resolution", 64});
        session.apply({"directions", "icosahedron:80"});
        session.apply({"rate", 50});
        eye = session.world().cameras.at(0);
        LiveRenderer::Hooks hooks;
        hooks.finished = [this](LiveFrame const& f) { commands.push_back(f.command); };
        hooks.failed = [this](std::string const& why) { failures.push_back(why); };
        renderer = std::make_unique<LiveRenderer>(session, clock, nullptr, hooks);
    }
    void look(double aside = 0)
    {
        Viewpoint at;
        at.pose_s = clock.now_s();
        gi::Camera camera = eye;
        camera.world_from_camera = eye.world_from_camera * glm::translate(gi::dmat4(1), gi::dvec3{aside, 0, 0});
        at.views = {{"window", camera, 64, 64, -1}};
        renderer->look(at);
    }
};

/// The leader of a cluster in which another rank takes a given time.
class SlowestRank : public FrameLink {
public:
    explicit SlowestRank(double seconds, std::optional<gi::DynamicUpdate> dynamic_update = {})
        : seconds_(seconds), dynamic_update_(dynamic_update)
    {
    }
    void begin() override {}
    void end() override {}
    bool leads() const override { return true; }
    void send(FrameCommand const&) override {}
    std::optional<FrameCommand> receive() override { return {}; }
    void check() override {}
    FrameWork wait_for_all(FrameCommand const&, FrameWork const& own) override
    {
        return {seconds_, dynamic_update_.value_or(own.dynamic_update), own.moved, own.surfaces_s};
    }
    FrameLight exchange(FrameCommand const&, FrameLight own) override { return own; }
    std::uint64_t show(ShownMoment) override { return 1; }
    std::optional<ShownMoment> next_shown() override { return {}; }
    void wake_by(std::function<void()>) override {}
    void drawn(std::uint64_t, ShownState) override {}
    void swapped(std::uint64_t, double) override {}
    ShownState shown_state() const override { return {}; }

private:
    double seconds_;
    std::optional<gi::DynamicUpdate> dynamic_update_;
};

/// Time that passes only while frames are rendered: as long as a slow machine takes for their pixels and paths.
class FrameClock : public SessionClock {
public:
    double now_s() const override { return now_s_; }
    void render(FrameCommand const& command)
    {
        double const pixels =
            command.views[0].width * command.views[0].height * command.light_scale * command.light_scale;
        pass(0.002 + 1.5e-6 * pixels * (command.paths + 1)); // 60 ms of the whole view
    }
    void pass(double seconds) { now_s_ = now_s_ + seconds; }

private:
    std::atomic<double> now_s_{0};
};

/// While the head turns, pictures of smaller light show more than the view.
TEST(LiveRenderer, PicturesHaveMarginsWhileTheHeadTurns)
{
    Live live;
    live.renderer.reset();
    live.commands.clear();
    live.session.apply({"refine", false}); // a frame for each look
    FrameClock clock;
    LiveRenderer::Hooks hooks;
    hooks.own_views = [&](FrameCommand const& command) {
        clock.render(command);
        return command.views;
    };
    hooks.finished = [&](LiveFrame const& f) { live.commands.push_back(f.command); };
    live.renderer = std::make_unique<LiveRenderer>(live.session, clock, nullptr, hooks);
    auto const look = [&](double turned_rad) {
        Viewpoint at;
        at.pose_s = clock.now_s();
        gi::Camera camera = live.eye;
        camera.world_from_camera = glm::rotate(live.eye.world_from_camera, turned_rad, gi::dvec3{0, 1, 0});
        at.views = {{"window", camera, 160, 120, -1}};
        live.renderer->look(at);
    };
    auto const wait = [&] {
        while (!live.renderer->rests()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    };
    double turned_rad = 0;
    for (int i = 0; i < 40; ++i) {
        look(turned_rad = 0.8 * clock.now_s());
        wait();
    }
    clock.pass(0.1);
    look(turned_rad);
    live.renderer->again();
    wait();
    live.renderer->stop();
    ASSERT_EQ(live.commands.size(), 41u);
    std::size_t small = 0;
    for (std::size_t k = 0; k < 40; ++k) {
        FrameCommand const& c = live.commands[k];
        bool const may = c.light_scale < 1 && c.light_scale > Governor::kLeastScale;
        small += may;
        if (k > 4) { // before, frames take longer than motion is measured over
            EXPECT_EQ(c.views[0].margin_x > 0, may) << k;
        }
    }
    EXPECT_GT(small, 20u);
    EXPECT_EQ(live.commands.back().views[0].margin_x, 0) << "it stands";
}

/// Of all ranks the slowest decides what there is time for, whatever this one took for its share of the pixels.
TEST(LiveRenderer, PicturesOfLightAloneComeBeforeTheFirstThatRefines)
{
    Live live;
    live.renderer.reset();
    live.commands.clear();
    live.session.apply({"refine", false}); // it rests after the first at full size
    live.session.apply({"draw_surfaces", true});
    FrameClock clock;
    LiveRenderer::Hooks hooks;
    hooks.own_views = [&](FrameCommand const& command) {
        for (int k = 0; k < 4; ++k) clock.render(command); // slow enough for small pictures
        return command.views;
    };
    hooks.finished = [&](LiveFrame const& f) { live.commands.push_back(f.command); };
    live.renderer = std::make_unique<LiveRenderer>(live.session, clock, nullptr, hooks);
    for (int i = 0; i < 20; ++i) {
        Viewpoint at;
        at.pose_s = clock.now_s();
        at.drawn_scale = 0.5;
        gi::Camera camera = live.eye;
        camera.world_from_camera =
            live.eye.world_from_camera * glm::translate(gi::dmat4(1), gi::dvec3{0.001 * i, 0, 0});
        at.views = {{"window", camera, 160, 120, -1}};
        live.renderer->look(at);
        while (!live.renderer->rests()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    live.renderer->stop();
    std::vector<FrameCommand> const& all = live.commands;
    ASSERT_GE(all.size(), 4u);
    FrameCommand const *const moving = &all[all.size() - 4], *const last = &all.back();
    EXPECT_TRUE(moving[0].only_light);
    EXPECT_TRUE(moving[1].only_light);
    EXPECT_LT(moving[1].light_scale, 0.5);
    EXPECT_TRUE(moving[2].only_light);
    EXPECT_EQ(moving[2].light_scale, 0.5);
    EXPECT_FALSE(last->only_light);
    EXPECT_EQ(last->light_scale, 1);
}

TEST(LiveRenderer, GoesByTheSlowestRank)
{
    for (bool const slow : {true, false}) {
        Live live;
        live.renderer.reset();
        live.session.apply({"refine", false}); // a frame for each look
        SlowestRank link(slow ? 10 : 1e-4);
        LiveRenderer::Hooks hooks;
        hooks.own_views = [](FrameCommand const& command) { return std::vector{command.views.at(0)}; };
        live.renderer = std::make_unique<LiveRenderer>(live.session, live.clock, &link, hooks);
        std::shared_ptr<LiveFrame const> frame;
        for (int i = 0; i < 6; ++i) {
            Viewpoint at;
            gi::Camera camera = live.eye;
            camera.world_from_camera = glm::translate(live.eye.world_from_camera, gi::dvec3{0.01 * i, 0, 0});
            for (char const* const wall : {"left", "front", "right", "floor"})
                at.views.push_back({wall, camera, 64, 64, -1});
            live.renderer->look(at);
            frame = live.renderer->next_frame(60);
            ASSERT_NE(frame, nullptr);
            EXPECT_EQ(frame->result.views.size(), 1u);
        }
        live.renderer->stop();
        EXPECT_EQ(frame->budget.scale, slow ? 0.25 : 1);
        EXPECT_EQ(frame->budget.paths == 1, slow) << frame->budget.paths;
    }
}

/// The other ranks have the hit buffers, and so the facts about them.
TEST(LiveRenderer, ALeaderWithoutWallsSaysWhatOthersDo)
{
    Live live;
    live.renderer.reset();
    SlowestRank link(0.01, gi::DynamicUpdate{160, 160, 3, 0});
    LiveRenderer::Hooks hooks;
    hooks.own_views = [](FrameCommand const&) { return std::vector<ViewCommand>{}; };
    live.renderer = std::make_unique<LiveRenderer>(live.session, live.clock, &link, hooks);
    std::shared_ptr<LiveFrame const> frame;
    for (int i = 0; i < 3; ++i) {
        live.look(0.01 * i);
        frame = live.renderer->next_frame(60);
        ASSERT_NE(frame, nullptr);
    }
    live.renderer->stop();
    EXPECT_EQ(frame->schedule, "stored: all 160 directions; nothing has moved so far");
}

/// Large pictures of a method that can give them up, counted.
struct LargePictures : Live {
    std::atomic<int> begun{0}, finished{0};

    LargePictures()
    {
        renderer.reset();
        session.apply({"method", "paths"});
        LiveRenderer::Hooks hooks;
        hooks.own_views = [this](FrameCommand const& command) {
            ++begun;
            return command.views;
        };
        hooks.finished = [this](LiveFrame const& f) {
            commands.push_back(f.command);
            ++finished;
        };
        renderer = std::make_unique<LiveRenderer>(session, clock, nullptr, hooks);
    }
    ~LargePictures() { renderer.reset(); } // it counts
    void look_at(double aside)
    {
        Viewpoint at;
        gi::Camera camera = eye;
        camera.world_from_camera = eye.world_from_camera * glm::translate(gi::dmat4(1), gi::dvec3{aside, 0, 0});
        at.views = {{"window", camera, 1280, 1280, -1}};
        renderer->look(at);
    }
};

/// Who walks on does not wait for the large picture that was begun while they stood.
TEST(LiveRenderer, ALookGivesUpAPictureThatRefines)
{
    LargePictures live;
    int given_up = 0;
    for (int k = 0; k < 20 && given_up < 2; ++k) {
        live.look_at(0.01 * k);
        ASSERT_NE(live.renderer->next_frame(60), nullptr);
        int const before = live.begun;
        while (live.begun == before) std::this_thread::sleep_for(std::chrono::milliseconds(1)); // it refines
        int const already = live.finished;
        live.look_at(0.01 * k + 0.005);
        ASSERT_NE(live.renderer->next_frame(60), nullptr);
        given_up += live.finished == already + 1;
    }
    live.renderer->stop();
    EXPECT_EQ(given_up, 2);
    for (std::size_t i = 1; i < live.commands.size(); ++i)
        EXPECT_EQ(live.commands[i].frame, live.commands[i - 1].frame + 1);
}

/// A lamp that goes out while someone walks does not wait for the picture of the old light.
TEST(LiveRenderer, AnEditGivesUpThePictureThatIsRendered)
{
    LargePictures live;
    int given_up = 0;
    for (int k = 0; k < 40 && given_up < 2; ++k) {
        live.look_at(0.01 * k);
        ASSERT_NE(live.renderer->next_frame(60), nullptr);
        int const before = live.begun;
        live.look_at(0.01 * k + 0.005);
        while (live.begun == before)
            std::this_thread::sleep_for(std::chrono::milliseconds(1)); // of a head that moves
        int const already = live.finished;
        live.renderer->post({"material.0.base_color", {0.1, 0.1, 0.5 + 0.01 * k}});
        ASSERT_NE(live.renderer->next_frame(60), nullptr);
        given_up += live.finished == already + 1 && live.begun == before + 2;
    }
    live.renderer->stop();
    EXPECT_EQ(given_up, 2);
    for (std::size_t i = 1; i < live.commands.size(); ++i)
        EXPECT_EQ(live.commands[i].frame, live.commands[i - 1].frame + 1);
}

/// What is drawn between two pictures of light has the edits that came after the first one.
TEST(LiveRenderer, SaysWhichEditsAFrameDoesNotHave)
{
    Live live;
    live.look();
    auto const first = live.renderer->next_frame(60);
    ASSERT_NE(first, nullptr);
    std::promise<void> go;
    live.renderer->ask([&](RenderSession&) { go.get_future().wait(); });
    std::vector<Change> const moves{{"object.short block.position", {0.1, 0, 0}},
                                    {"object.short block.scale", 0.9}};
    live.renderer->post({"exposure", 1});
    live.renderer->post(moves[0]);
    live.renderer->post({"material.0.base_color", {0.1, 0.1, 0.9}}); // is seen with the next light
    live.renderer->post(moves[1]);
    EXPECT_EQ(live.renderer->edits_since(*first), moves);
    go.set_value();
    auto const next = live.renderer->next_frame(60);
    ASSERT_NE(next, nullptr);
    EXPECT_TRUE(live.renderer->edits_since(*next).empty());
}

TEST(LiveRenderer, RendersWhatIsLookedAtAndConverges)
{
    Live live;
    live.look();
    auto const first = live.renderer->next_frame(60);
    ASSERT_NE(first, nullptr);
    EXPECT_EQ(first->result.views.size(), 1u);
    std::uint32_t paths = 0;
    for (int i = 0; i < 20; ++i) {
        auto const frame = live.renderer->next_frame(60);
        ASSERT_NE(frame, nullptr);
        EXPECT_GT(frame->still_paths, paths);
        paths = frame->still_paths;
    }
    live.look(0.05);
    auto const moved = live.renderer->next_frame(60);
    ASSERT_NE(moved, nullptr);
    EXPECT_EQ(moved->result.still_frames, 1);
    live.renderer->stop();
    EXPECT_TRUE(live.failures.empty());
    for (std::size_t i = 1; i < live.commands.size(); ++i)
        EXPECT_EQ(live.commands[i].frame, live.commands[i - 1].frame + 1);
}

TEST(LiveRenderer, AtRestNoFrameComes)
{
    Live live;
    live.renderer->post({"refine", false});
    auto const rests_soon = [&] {
        for (int i = 0; i < 2000; ++i) {
            if (live.renderer->rests()) return true;
            std::this_thread::sleep_for(std::chrono::milliseconds(10));
        }
        return false;
    };
    for (double const aside : {0.0, 0.05}) {
        live.look(aside);
        EXPECT_FALSE(live.renderer->rests()) << "a frame is due";
        ASSERT_TRUE(rests_soon());
        auto const frame = live.renderer->newest();
        ASSERT_NE(frame, nullptr);
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
        EXPECT_EQ(live.renderer->newest(), frame);
        std::promise<void> go;
        live.renderer->ask([&](RenderSession&) { go.get_future().wait(); });
        EXPECT_FALSE(live.renderer->rests()) << "what was asked may change something";
        go.set_value();
        ASSERT_TRUE(rests_soon());
    }
}

TEST(LiveRenderer, AChangeShowsInTheNextFrameAndErrorsComeBack)
{
    Live live;
    live.look();
    ASSERT_NE(live.renderer->next_frame(60), nullptr);
    std::mutex mutex;
    std::vector<std::string> answers;
    auto const note = [&](std::string const& error) {
        std::lock_guard const lock(mutex);
        answers.push_back(error);
    };
    live.renderer->post({"material.0.base_color", {0.1, 0.1, 0.9}}, note);
    live.renderer->post({"bounces", -3}, note);
    live.renderer->post({"scene", "elsewhere"}, note);
    auto const frame = live.renderer->next_frame(60);
    ASSERT_NE(frame, nullptr);
    live.renderer->stop();
    ASSERT_EQ(answers.size(), 3u);
    EXPECT_EQ(answers[0], "");
    EXPECT_NE(answers[1].find("bounces"), std::string::npos);
    EXPECT_NE(answers[2].find("elsewhere"), std::string::npos);
    std::size_t recorded = 0;
    for (FrameCommand const& o : live.commands) recorded += o.changes.size();
    EXPECT_EQ(recorded, 1u);
}

/// Another rank without which the first frame does not end.
class LateRank : public SlowestRank {
public:
    LateRank() : SlowestRank(0.01) {}
    FrameWork wait_for_all(FrameCommand const& command, FrameWork const& own) override
    {
        if (!has_waited_) {
            has_waited_ = true;
            begun.set_value();
            all_done.get_future().wait();
        }
        return SlowestRank::wait_for_all(command, own);
    }
    std::promise<void> begun, all_done;

private:
    bool has_waited_ = false;
};

/// While a frame is rendered, nothing that others call waits for it: else this would never end.
TEST(LiveRenderer, NobodyWaitsForAFrame)
{
    Live live;
    live.renderer.reset();
    LateRank link;
    LiveRenderer::Hooks hooks;
    hooks.own_views = [](FrameCommand const& command) { return command.views; };
    live.renderer = std::make_unique<LiveRenderer>(live.session, live.clock, &link, hooks);
    live.look();
    link.begun.get_future().wait();
    for (int i = 0; i < 100; ++i) {
        live.look(1e-4 * i);
        live.renderer->post({"exposure", 0.01 * i});
        live.renderer->newest();
        live.renderer->rests();
    }
    link.all_done.set_value();
    EXPECT_NE(live.renderer->next_frame(60), nullptr);
    live.renderer->stop();
}

/// What the thread rendered, a session that is given the same orders renders again, bit by bit.
TEST(LiveRenderer, ItsOrdersCanBeRenderedAgain)
{
    struct Seen {
        FrameCommand command;
        std::vector<float> color;
    };
    std::vector<Seen> seen;
    Live live;
    live.renderer->stop();
    LiveRenderer::Hooks hooks;
    hooks.finished = [&](LiveFrame const& f) {
        seen.push_back({f.command, f.result.views[0].picture.find("color")->data});
    };
    live.renderer = std::make_unique<LiveRenderer>(live.session, live.clock, nullptr, hooks);
    for (int i = 0; i < 10; ++i) {
        live.look(i < 6 ? 0.02 * i : 0.1);
        if (i == 3) live.renderer->post({"light.0.intensity", {1, 1, 1}});
        if (i == 4) live.renderer->post({"material.1.base_color", {0.2, 0.9, 0.1}});
        ASSERT_NE(live.renderer->next_frame(60), nullptr);
    }
    live.renderer->stop();
    gi::Report report;
    RenderSession again(cornell, 0, report);
    for (Change const& c : std::vector<Change>{
             {"scene", "cornell"}, {"method", "slhb"}, {"resolution", 64}, {"directions", "icosahedron:80"}, {"rate", 50}})
        again.apply(c);
    ASSERT_GE(seen.size(), 10u);
    for (Seen const& s : seen) {
        for (Change const& c : s.command.changes) again.apply(c);
        ASSERT_EQ(again.render(s.command, {}).views[0].picture.find("color")->data, s.color) << s.command.frame;
    }
}

/// Frames fail while a setting cannot be used with the scene.
/// The first frame after them says all that was changed.
TEST(LiveRenderer, ChangesOfFramesThatFailAreInTheNextOne)
{
    LoadScene const walk = [](std::string const&, gi::Report&) {
        gi::Scene scene = gi::generate_cornell();
        gi::add_figure(scene, glm::scale(gi::dmat4(1), gi::dvec3(0.2)), 0.3);
        return std::make_shared<gi::Scene const>(std::move(scene));
    };
    Live live;
    live.renderer->stop();
    gi::Report report;
    RenderSession session(walk, 0, report);
    session.apply({"scene", "walk"});
    session.apply({"method", "slhb"});
    session.apply({"schedule", "stored"});
    std::vector<std::string> changed;
    LiveRenderer::Hooks hooks;
    hooks.finished = [&](LiveFrame const& f) {
        for (Change const& c : f.command.changes) changed.push_back(c.key);
    };
    std::atomic<bool> failed{false};
    hooks.failed = [&](std::string const&) { failed = true; };
    LiveRenderer renderer(session, live.clock, nullptr, hooks);
    Viewpoint at;
    at.views = {{"window", session.world().cameras.at(0), 32, 32, -1}};
    renderer.post({"packed", true}); // not with dynamic geometry
    renderer.look(at);
    for (int i = 0; i < 200 && !failed; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    ASSERT_TRUE(failed);
    renderer.post({"packed", false});
    ASSERT_NE(renderer.next_frame(60), nullptr);
    renderer.stop();
    EXPECT_EQ(changed, (std::vector<std::string>{"packed", "packed"}));
}

/// A figure walks, and the rate cannot be held with all directions following it (160 times 1,000 triangles and
/// more in a fifth of a millisecond): fewer do, the orders say so, and a session that is given them renders the
/// same bits. Where the user has named the schedule, nothing is changed.
TEST(LiveRenderer, FewerDirectionsFollowWhatTakesTooLong)
{
    LoadScene const walk = [](std::string const&, gi::Report&) {
        gi::Scene scene = gi::generate_cornell();
        gi::add_figure(scene, glm::scale(gi::dmat4(1), gi::dvec3(0.2)), 0.3);
        return std::make_shared<gi::Scene const>(std::move(scene));
    };
    for (std::string const schedule : {"auto", "stored"}) {
        std::vector<Change> const settings{
            {"scene", "walk"}, {"method", "slhb"}, {"resolution", 64}, {"rate", 1000}, {"schedule", schedule}};
        gi::Report report;
        SessionClock clock;
        RenderSession session(walk, 0, report), again(walk, 0, report);
        for (Change const& c : settings) session.apply(c), again.apply(c);
        struct Seen {
            FrameCommand command;
            std::vector<float> color;
            std::string schedule;
        };
        std::vector<Seen> seen;
        LiveRenderer::Hooks hooks;
        hooks.finished = [&](LiveFrame const& f) {
            seen.push_back({f.command, f.result.views[0].picture.find("color")->data, f.schedule});
        };
        gi::Camera const eye = session.world().cameras.at(0);
        LiveRenderer renderer(session, clock, nullptr, hooks);
        Viewpoint at;
        at.views = {{"window", eye, 48, 48, -1}};
        renderer.look(at);
        for (int i = 0; i < 6; ++i) ASSERT_NE(renderer.next_frame(60), nullptr);
        renderer.stop();
        int changed = 0;
        for (Seen const& s : seen) {
            for (Change const& c : s.command.changes) {
                changed += c.key == "updated_axes";
                again.apply(c);
            }
            ASSERT_EQ(again.render(s.command, {}).views[0].picture.find("color")->data, s.color)
                << s.command.frame;
        }
        EXPECT_EQ(changed > 0, schedule == "auto");
        EXPECT_EQ(session.settings().updated_axes > 0, schedule == "auto");
        EXPECT_NE(seen.back().schedule.find(schedule == "auto" ? "of 160 directions" : "as it was set"),
                  std::string::npos);
    }
}

} // namespace
} // namespace viewer::test
