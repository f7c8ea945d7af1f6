// A session in a headset of a real runtime: stimuli one after the other, answers by controllers.

#include "study/journal/journal_file.h"
#include "tests/viewer_trials/running_session.h"
#include "tests/viewer_xr/monado.h"
#include "tests/viewer_xr/remote_driver.h"

namespace viewer::test {
namespace {

constexpr char const* kScriptText = R"(schema: study/1
id: worn
seed: 4
participants: {count: 2}
timing: {vsync: record, on_bad_trial: keep, calibrate: {frames: 50}}
factors: {bounces: [0, 2]}
defaults: {settings: {method: slhb, scene: cornell, paths: 1, view: openxr, scale: 0.5}, iti_ms: 100, isi_ms: 200, stimulus_ms: 500}
devices: {first: [xr:left/select], second: [xr:right/select]}
sequence: [better]
record: {markers: [udp]}
blocks:
  better: {task: pair, presentation: sequential, prompt: better, pairs: {factor: bounces}, repeats: 2}
)";

TEST_F(Monado, SessionInAHeadset)
{
    gi::test::Xvfb const server(700, 500);
    if (!server.problem().empty()) GTEST_SKIP() << "SKIPPED: " << server.problem();
    int const port = free_port();
    start_service({"--remote", std::to_string(port)});
    RemoteDriver remote(port);
    remote.set_head({{0, 0, 0, 1}, {0, 1.7f, 0}});
    auto const press = [&](std::size_t hand, bool pressed) {
        for (std::size_t h = 0; h < 2; ++h)
            remote.set_hand(h, {{0, 0, 0, 1}, {h == 0 ? -0.3f : 0.3f, 1.2f, -0.4f}}, {0, 0}, pressed && h == hand);
        remote.send_all();
    };
    press(0, false);
    std::ofstream(folder / "x.yaml") << kScriptText;
    MarkerListener const markers;
    std::vector<std::string> call{kScript, "client", "--dir", runtime_folder(), "--", LIGHTWELL_PROGRAM};
    for (std::string const& a :
         words(fmt::format("study run {} --participant 1 --dir {} --size 320x240 --font 12 --threads 1 --hmd "
                           "--marker-port {}",
                           (folder / "x.yaml").string(), (folder / "data").string(), markers.port())))
        call.push_back(a);
    Child session(call, folder.path(), "session");
    for (int trial = 0; trial < 2; ++trial) {
        for (int interval = 0; interval < 2; ++interval)
            ASSERT_TRUE(markers.wait_for("stimulus").is_object()) << session.out() << session.err();
        sleep_ms(300);
        press(std::size_t(trial), true);
        EXPECT_TRUE(markers.wait_for("answer").is_object());
        press(0, false);
    }
    EXPECT_EQ(session.wait(Seconds(90)), 0) << session.out() << session.err();
    auto const file = folder / "data/sub-P001/ses-01/beh/journal.jsonl";
    std::vector<study::TrialDone> trials;
    for (study::JournalEntry const& e : study::read_journal(file).record.entries)
        if (auto const* const t = std::get_if<study::TrialDone>(&e)) trials.push_back(*t);
    ASSERT_EQ(trials.size(), 2u);
    EXPECT_EQ(trials[0].response, "first");
    EXPECT_EQ(trials[0].device, "xr:left/select");
    EXPECT_EQ(trials[1].response, "second");
    for (study::TrialDone const& t : trials)
        for (study::StimulusShown const& s : t.shown) {
            EXPECT_EQ(s.onset_method, "openxr_predicted") << "a prediction is never called measured";
            EXPECT_GT(s.onset_uncertainty_ms, 0);
        }
}

} // namespace
} // namespace viewer::test
