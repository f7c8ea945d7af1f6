// Trackers put together.

#include "gi/core/error.h"
#include "gi/core/pose.h"
#include "tests/viewer_tracking/pose_checks.h"
#include "viewer/devices/tracking/display_tracker.h"
#include "viewer/devices/tracking/dtrack.h"
#include "viewer/devices/tracking/known_walk.h"
#include "viewer/devices/tracking/tracker_hub.h"
#include "viewer/displays/display_file.h"

#include <gtest/gtest.h>
#include <map>
#include <thread>

namespace viewer::test {
namespace {

class GivenTracker : public Tracker {
public:
    std::vector<TrackerSample> next;
    void poll(double, std::vector<TrackerSample>& samples) override { samples.swap(next); }
    TrackerCounts counts() const override { return {}; }
    std::string description() const override { return "given"; }
};

struct Given {
    GivenTracker* source = nullptr;
    std::unique_ptr<TrackerHub> hub;

    explicit Given(TrackerSettings const& settings)
    {
        std::vector<std::unique_ptr<Tracker>> sources;
        sources.push_back(std::make_unique<GivenTracker>());
        source = static_cast<GivenTracker*>(sources[0].get());
        hub = std::make_unique<TrackerHub>(std::vector{settings}, std::move(sources), Polling::by_caller);
    }
    void send(TrackerSample const& s)
    {
        source->next = {s};
        hub->poll(s.received_s);
    }
};

TrackerSample sample(std::string const& body, gi::dvec3 at, double received_s,
                     std::optional<double> measured_s = {})
{
    TrackerSample s;
    s.body = body;
    s.pose.position = at;
    s.received_s = received_s;
    s.measured_s = measured_s;
    return s;
}

TEST(TrackerHub, BringsBodiesIntoTheRoomOnce)
{
    TrackerSettings settings;
    settings.to_room = {TrackerAxes::z_up, 0.001, {{0, 0, 5}, {1, 0, 0, 0}}};
    settings.left_hand = {"wand", {{0, 0, -0.1}, {1, 0, 0, 0}}};
    settings.right_hand.id = "";
    Given g(settings);
    g.send(sample("head", {1000, 2000, 1700}, 1));
    g.send(sample("wand", {0, 0, 1000}, 1.01));
    g.send(sample("right_hand", {0, 0, 1000}, 1.02));
    BodiesAt const b = g.hub->at(1.02);
    ASSERT_TRUE(b.tracked.head && b.tracked.left_hand);
    EXPECT_LT(glm::distance(b.tracked.head->position, {1, 1.7, 3}), 1e-9);
    EXPECT_LT(glm::distance(b.tracked.left_hand->position, {0, 1, 4.9}), 1e-9);
    EXPECT_FALSE(b.tracked.right_hand);
    EXPECT_EQ(b.states[2], TrackState::never);
    TrackerReport const r = g.hub->report(1.02)[0];
    EXPECT_EQ(r.other_samples, 1u);
    EXPECT_EQ(r.other_bodies, std::vector<std::string>{"right_hand"});
}

TEST(TrackerHub, ALeadingSlashOfABodyMeansNothing)
{
    for (auto const& [asked, sent] : {std::pair{"/head", "head"}, {"head", "/head"}, {"/head", "/head"}}) {
        TrackerSettings settings;
        settings.head.id = asked;
        Given g(settings);
        g.send(sample(sent, {0, 1.7, 0}, 1));
        EXPECT_TRUE(g.hub->at(1).tracked.head) << asked << " " << sent;
    }
    TrackerSettings twice;
    twice.right_hand.id = "/head";
    EXPECT_THROW(check(twice), gi::InputError);
}

TEST(TrackerHub, ControlsOfABodyAndOfADevice)
{
    TrackerSettings settings;
    settings.head.id = "0";
    settings.right_hand.id = "flystick0";
    settings.left_hand.id = "";
    Given g(settings);
    TrackerSample stick = sample("flystick0", {0, 1, 0}, 1);
    stick.buttons = 5;
    stick.axes = {0.5, -1};
    g.send(stick);
    std::size_t const right = std::size_t(Body::right_hand);
    EXPECT_EQ(g.hub->at(1).buttons[right], 5u);
    EXPECT_EQ(g.hub->at(1).axes[right], stick.axes);
    EXPECT_TRUE(g.hub->at(1).axes[0].empty()) << "the head's";
    TrackerSample device = sample(kDeviceControls, {}, 1.1);
    device.parts = SampleParts::buttons;
    device.buttons = 2;
    g.send(device);
    EXPECT_EQ(g.hub->at(1.1).buttons[0], 2u);
    EXPECT_EQ(g.hub->at(1.1).buttons[right], 2u);
    EXPECT_EQ(g.hub->at(1.1).axes[right], stick.axes) << "not sent, so not changed";
}

TEST(TrackerHub, MeasuredLatencyIsPredictedAway)
{
    for (double const latency : {0.0, 0.03}) {
        TrackerSettings settings;
        settings.prediction.latency_s = latency;
        Given g(settings);
        // 1 m/s; stamps say when the sensor had it, plus what it takes to leave the sensor.
        for (int i = 0; i < 200; ++i) {
            double const t = i / 60.0;
            g.send(sample("head", {t - latency, 0, 0}, 500 + t, t));
        }
        double const last = 199 / 60.0;
        EXPECT_NEAR(g.hub->at(500 + last + 0.02).tracked.head->position.x, last + 0.02, 1e-4) << latency;
    }
}

TEST(TrackerHub, LossIsHeldThenToldThenRecovered)
{
    Given g{TrackerSettings{}};
    double t = 0;
    for (; t < 1; t += 0.01) g.send(sample("head", {0, 1.7, 0}, t, t));
    EXPECT_EQ(g.hub->at(t).states[0], TrackState::tracked);
    EXPECT_EQ(g.hub->at(t + 0.5).states[0], TrackState::held);
    EXPECT_TRUE(g.hub->at(t + 0.5).tracked.head);
    EXPECT_EQ(g.hub->at(t + 1.1).states[0], TrackState::lost);
    EXPECT_FALSE(g.hub->at(t + 1.1).tracked.head);
    TrackerSample gone = sample("head", {}, t + 1.2, t + 1.2);
    gone.visible = false;
    gone.buttons = 4;
    g.send(gone);
    EXPECT_EQ(g.hub->at(t + 1.2).states[0], TrackState::lost) << "a sample that says so is no pose";
    EXPECT_EQ(g.hub->at(t + 1.2).buttons[0], 4u);
    g.send(sample("head", {1, 1.7, 0}, t + 1.3, t + 1.3));
    EXPECT_EQ(g.hub->at(t + 1.3).states[0], TrackState::tracked);
    EXPECT_LT(g.hub->at(t + 1.31).tracked.head->position.x, 0.05);
    g.send(sample("head", {1, 1.7, 0}, t + 1.4, t + 1.4));
    EXPECT_NEAR(g.hub->at(t + 1.41).tracked.head->position.x, 0.5, 0.2);
    for (int i = 2; i < 5; ++i) g.send(sample("head", {1, 1.7, 0}, t + 1.3 + 0.1 * i, t + 1.3 + 0.1 * i));
    EXPECT_NEAR(g.hub->at(t + 1.71).tracked.head->position.x, 1, 1e-3);
    TrackerReport const r = g.hub->report(t + 1.71)[0];
    EXPECT_EQ(r.bodies[0].counts.dropouts, 1u);
    EXPECT_EQ(r.bodies[0].not_visible, 1u);
}

TEST(TrackerHub, MidnightIsSurvived)
{
    Given g{TrackerSettings{}};
    gi::dvec3 before{0};
    for (int i = 0; i < 600; ++i) {
        double const t = i / 60.0, stamp = std::fmod(86395 + t, 86400.0);
        g.send(sample("head", {0.5 * t, 1.7, 0}, 10 + t, stamp));
        auto const pose = g.hub->at(10 + t).tracked.head;
        ASSERT_TRUE(pose) << t;
        if (i > 60) {
            EXPECT_LT(glm::distance(pose->position, before), 0.06) << t;
        }
        before = pose->position;
    }
    EXPECT_EQ(g.hub->report(20)[0].bodies[0].clock_restarts, 1u);
    EXPECT_NEAR(before.x, 0.5 * 599 / 60.0, 0.01);
}

TEST(TrackerHub, AWrongTimeStampDoesNotBlind)
{
    Given g{TrackerSettings{}};
    for (int i = 0; i < 300; ++i) {
        double const t = i / 60.0;
        g.send(sample("head", {0, 1.7, 0}, 10 + t, i % 50 == 49 ? t + 1.5 : t));
        EXPECT_EQ(g.hub->at(10 + t).states[0], TrackState::tracked);
    }
    EXPECT_EQ(g.hub->report(20)[0].bodies[0].doubtful_times, 6u);
    EXPECT_EQ(g.hub->report(20)[0].bodies[0].clock_restarts, 0u);
}

TEST(TrackerHub, PositionsAndRotationsMayComeApart)
{
    Given g{TrackerSettings{}};
    TrackerSample p = sample("head", {1, 2, 3}, 1), r = sample("head", {}, 1.0001);
    p.parts = SampleParts::position;
    r.parts = SampleParts::rotation;
    r.pose.rotation = gi::exp_rotation({0, 1, 0});
    g.send(p);
    g.send(r);
    auto const pose = g.hub->at(1.0001).tracked.head;
    ASSERT_TRUE(pose);
    EXPECT_LT(glm::distance(pose->position, {1, 2, 3}), 1e-9);
    EXPECT_LT(glm::degrees(angle_between(g.hub->at(1.3).tracked.head->rotation, r.pose.rotation)), 0.01);
}

TEST(TrackerHub, TheFirstTrackerThatHasABodyCounts)
{
    TrackerSettings first, second;
    second.name = "spare";
    std::vector<std::unique_ptr<Tracker>> sources;
    auto a = std::make_unique<GivenTracker>(), b = std::make_unique<GivenTracker>();
    a->next = {sample("head", {1, 0, 0}, 1)};
    b->next = {sample("head", {2, 0, 0}, 1.9), sample("left_hand", {3, 0, 0}, 1.9)};
    sources.push_back(std::move(a));
    sources.push_back(std::move(b));
    TrackerHub hub({first, second}, std::move(sources), Polling::by_caller);
    hub.poll(2);
    EXPECT_EQ(hub.at(1.9).tracked.head->position.x, 1);
    EXPECT_EQ(hub.at(1.9).tracked.left_hand->position.x, 3);
    EXPECT_EQ(hub.at(2.5).tracked.head->position.x, 2) << "the first is lost by then";
}

/// That nobody has now.
int free_port() { return UdpReceiver("127.0.0.1", 0).port(); }

TEST(TrackerHub, TrackersOfOnePortShareItsPackets)
{
    TrackerSettings glasses, wand;
    glasses.name = "glasses";
    wand.name = "wand";
    glasses.type = wand.type = TrackerType::dtrack;
    glasses.port = wand.port = free_port();
    glasses.head.id = "0";
    wand.head.id = "1";
    wand.to_room.room_from_tracker.position = {0, 0, 5};
    wand.prediction.latency_s = 0.01;
    TrackerHub hub({glasses, wand}, Polling::by_caller);
    std::string const text =
        format_dtrack({sample("0", {1, 1.7, 0}, 0), sample("1", {2, 1, 0}, 0), sample("2", {}, 0)}, 1);
    UdpSender const sender("127.0.0.1", glasses.port);
    ASSERT_TRUE(sender.send({reinterpret_cast<unsigned char const*>(text.data()), text.size()}));
    std::vector<TrackerSample> samples;
    for (double const end = steady_seconds() + 5; samples.empty() && steady_seconds() < end;)
        hub.poll(steady_seconds(), &samples);
    EXPECT_EQ(samples.size(), 3u) << "each is passed on once";
    double const now = steady_seconds();
    BodiesAt const head = hub.of_tracker(0, now), hand = hub.of_tracker(1, now);
    ASSERT_TRUE(head.tracked.head && hand.tracked.head);
    EXPECT_LT(glm::distance(head.tracked.head->position, {1, 1.7, 0}), 1e-6);
    EXPECT_LT(glm::distance(hand.tracked.head->position, {2, 1, 5}), 1e-6);
    for (TrackerReport const& r : hub.report(now)) {
        EXPECT_EQ(r.port, glasses.port);
        EXPECT_EQ(r.counts.packets, 1u);
        EXPECT_EQ(r.other_bodies, std::vector<std::string>{"2"}) << "those that no tracker of the port asks for";
    }
}

TEST(TrackerHub, APortHasOneProtocol)
{
    TrackerSettings glasses, wand;
    glasses.name = "glasses";
    wand.name = "wand";
    wand.type = TrackerType::dtrack;
    glasses.port = wand.port = free_port();
    try {
        TrackerHub const hub({glasses, wand}, Polling::by_caller);
        ADD_FAILURE() << "taken";
    } catch (gi::InputError const& e) {
        EXPECT_NE(std::string(e.what()).find("trackers 'glasses' and 'wand' share 127.0.0.1 port"),
                  std::string::npos)
            << e.what();
    }
    wand.type = TrackerType::osc;
    wand.frame_rate_hz = 60;
    EXPECT_THROW(TrackerHub({glasses, wand}, Polling::by_caller), gi::InputError);
    glasses.port = wand.port = 0; // any that is free: two
    TrackerHub const hub({glasses, wand}, Polling::by_caller);
    EXPECT_NE(hub.report(0)[0].port, hub.report(0)[1].port);
}

TEST(TrackerHub, OpensTheTrackersOfEveryShippedDisplay)
{
    int with_trackers = 0;
    for (auto const& entry : std::filesystem::directory_iterator(LIGHTWELL_SOURCE_DIR "/data/displays")) {
        if (entry.path().extension() != ".yaml") continue;
        gi::Report report;
        std::vector<TrackerSettings> settings;
        for (DisplayTracker const& t : load_display(entry.path(), report).trackers)
            if (t.type != DisplayTrackerType::openxr) settings.push_back(tracker_settings(t));
        std::map<int, int> free; // in place of the files' own, which others may have
        for (TrackerSettings& s : settings)
            if (s.port > 0) s.port = free.try_emplace(s.port, free_port()).first->second;
        with_trackers += !settings.empty();
        EXPECT_NO_THROW(TrackerHub(settings, Polling::by_caller)) << entry.path();
    }
    EXPECT_GE(with_trackers, 3);
}

TEST(TrackerHub, PlaysFilesAndFakesOnItsThread)
{
    auto const file = std::filesystem::temp_directory_path() / "lightwell_hub_test.csv";
    {
        std::FILE* const f = std::fopen(file.c_str(), "w");
        std::fputs(format_tracker_file(known_walk_samples(1, 60)).c_str(), f);
        std::fclose(f);
    }
    TrackerSettings played, fake;
    played.type = TrackerType::file;
    played.file = file;
    played.at_end = AtEnd::begin_again;
    fake.type = TrackerType::fake;
    fake.head.id = "";
    TrackerHub hub({played, fake}, Polling::by_thread);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    BodiesAt const b = hub.at(steady_seconds());
    std::filesystem::remove(file);
    ASSERT_TRUE(b.tracked.head && b.tracked.right_hand);
    EXPECT_NEAR(glm::length(glm::dvec2(b.tracked.head->position.x, b.tracked.head->position.z)), 1.5, 0.1);
    EXPECT_GT(hub.report(steady_seconds())[1].counts.samples, 3u);
}

TEST(TrackerHub, RefusesSettingsThatCannotBe)
{
    auto const refused = [](auto const& change) {
        TrackerSettings s;
        change(s);
        EXPECT_THROW(check(s), gi::InputError);
    };
    EXPECT_NO_THROW(check(TrackerSettings{}));
    refused([](TrackerSettings& s) { s.port = 70000; });
    refused([](TrackerSettings& s) { s.head.id = s.left_hand.id; });
    refused([](TrackerSettings& s) {
        s.head.id = s.left_hand.id = s.right_hand.id = s.left_foot.id = s.right_foot.id = "";
    });
    refused([](TrackerSettings& s) { s.left_foot.id = s.right_foot.id; });
    refused([](TrackerSettings& s) { s.to_room.metres_per_unit = 0; });
    refused([](TrackerSettings& s) { s.to_room.room_from_tracker.rotation = {2, 0, 0, 0}; });
    refused([](TrackerSettings& s) { s.filter.position.min_cutoff_hz = 0; });
    refused([](TrackerSettings& s) { s.prediction.horizon_s = 2; });
    refused([](TrackerSettings& s) { s.prediction.lost_after_s = 0.05; });
    refused([](TrackerSettings& s) { s.prediction.latency_s = NAN; });
}

} // namespace
} // namespace viewer::test
