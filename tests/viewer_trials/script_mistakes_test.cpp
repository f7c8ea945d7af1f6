// Sixty mistakes of scripts (data/mistakes.yaml): each is reported alone, and all are reported at once.

#include "gi/core/file.h"
#include "tests/viewer/run_program.h"
#include "viewer/experiment/stimuli/script_check.h"
#include "viewer/experiment/stimuli/study_scenes.h"

#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <map>

namespace viewer::test {
namespace {

struct Mistake {
    std::string good, bad, told;
};

/// The text between marks «good|bad|told», and the mistakes.
struct Template {
    std::vector<std::string> text;
    std::vector<Mistake> mistakes;

    std::string with(std::function<bool(std::size_t)> const& is_made) const
    {
        std::string out = text[0];
        for (std::size_t i = 0; i < mistakes.size(); ++i)
            out += (is_made(i) ? mistakes[i].bad : mistakes[i].good) + text[i + 1];
        return out;
    }
};

Template read_template()
{
    std::ifstream in(LIGHTWELL_SOURCE_DIR "/tests/viewer_trials/data/mistakes.yaml", std::ios::binary);
    std::string const all{std::istreambuf_iterator<char>(in), {}};
    std::string const open = "«", close = "»";
    Template t;
    std::size_t at = all.find('\n', all.find("together")) + 1; // after the comment
    for (;;) {
        std::size_t const begin = all.find(open, at);
        t.text.push_back(all.substr(at, begin == std::string::npos ? begin : begin - at));
        if (begin == std::string::npos) return t;
        std::size_t const end = all.find(close, begin);
        std::string const inner = all.substr(begin + open.size(), end - begin - open.size());
        std::size_t const first = inner.find('|'), second = inner.find('|', first + 1);
        t.mistakes.push_back(
            {inner.substr(0, first), inner.substr(first + 1, second - first - 1), inner.substr(second + 1)});
        at = end + close.size();
    }
}

/// Loads each scene once.
SceneAccess cached_scenes()
{
    SceneAccess scenes = study_scenes();
    scenes.load = [load = scenes.load](std::string const& name, gi::Report& report) {
        static std::map<std::string, std::shared_ptr<gi::Scene const>> known;
        auto& scene = known[name];
        if (!scene) scene = load(name, report);
        return scene;
    };
    return scenes;
}

std::vector<std::string> told(std::string const& text, bool renders)
{
    static TemporaryFolder const folder;
    static SceneAccess const scenes = cached_scenes();
    std::string const file = (folder.path() / "t.yaml").string();
    gi::write_text(file, text);
    for (char const* const scene : {"room.yaml", "hall.yaml"})
        gi::write_text(
            (folder.path() / scene).string(),
            "models: [{generate: {kind: cornell}}]\n"
            "lights: [{type: spot, position: [0.2, 0.5, 0.5], target: [0.3, 0, 0.3], intensity: 2, cone: "
            "[15, 25]}]\n"
            "cameras: [{name: camera, from: [0.28, 0.27, 1.2], at: [0.28, 0.27, 0.2], fov: 40}]\n");
    std::string wav(
        "RIFF\x28\0\0\0WAVEfmt \x10\0\0\0\x01\0\x01\0\x40\x1f\0\0\x80\x3e\0\0\x02\0\x10\0data\x04\0\0\0", 44);
    gi::write_text((folder.path() / "word.wav").string(), wav + std::string(4, '\x10'));
    ScriptToCheck read = load_script_to_check(file);
    ScriptCheckOptions options;
    options.stimuli.renders = renders;
    check_script(read, scenes, options);
    std::vector<std::string> out;
    for (study::ScriptError const& e : read.mistakes.in_order()) out.emplace_back(e.what());
    return out;
}

std::string listed(std::vector<std::string> const& messages)
{
    std::string all;
    for (std::string const& m : messages) all += "  " + m + "\n";
    return all;
}

TEST(ScriptMistakes, NoneInTheSoundScript)
{
    EXPECT_EQ(listed(told(read_template().with([](std::size_t) { return false; }), true)), "");
}

TEST(ScriptMistakes, EachIsToldAlone)
{
    Template const t = read_template();
    ASSERT_GE(t.mistakes.size(), 60u);
    for (std::size_t k = 0; k < t.mistakes.size(); ++k) {
        auto const messages = told(t.with([&](std::size_t i) { return i == k; }), false);
        std::string const all = listed(messages);
        EXPECT_NE(all.find(t.mistakes[k].told), std::string::npos) << t.mistakes[k].bad << "\n" << all;
        EXPECT_EQ(messages.size(), 1u) << t.mistakes[k].bad << "\n" << all;
        for (std::string const& m : messages) EXPECT_NE(m.find("t.yaml:"), std::string::npos) << m;
    }
}

TEST(ScriptMistakes, AllAreToldAtOnce)
{
    Template const t = read_template();
    auto const messages = told(t.with([](std::size_t) { return true; }), false);
    std::string const all = listed(messages);
    for (Mistake const& m : t.mistakes) EXPECT_NE(all.find(m.told), std::string::npos) << m.bad << "\n";
    EXPECT_EQ(messages.size(), t.mistakes.size()) << all;
}

} // namespace
} // namespace viewer::test
