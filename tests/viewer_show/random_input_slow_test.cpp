// Everything at random for a while: keys, mouse, sizes, scenes, settings, right and wrong requests. The program
// goes on, keeps answering, needs no more and more memory, and ends in order.
//
// Memory is judged where the viewer is as it was at its beginning, which it is brought back to
// every half a minute: the same scene, settings, size and time, and nothing is being rendered.
// What it holds then beyond what it held before is what it has kept. Between these moments it depends on what
// came together by chance, and is only printed.
//
// LIGHTWELL_RANDOM_INPUT_S: seconds, 60 if it is not set (acceptance: 1800); LIGHTWELL_RANDOM_INPUT_SEED: another
// walk; LIGHTWELL_RANDOM_INPUT_CSV: file for the resident memory, second by second.

#include "gi/core/quantile.h"
#include "tests/viewer_show/live_view.h"
#include "tests/viewer_show/memory_log.h"
#include "tests/viewer_show/x/x_window.h"

#include <deque>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <random>

namespace viewer::test {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kAnswer(30); // also where a frame of the reference is being rendered
constexpr std::chrono::seconds kFrame(300); // of the slowest method, which what needs a frame of its own waits for
// Limits of memory growth: median of the last third over that of the middle third of a walk. Threads and drivers
// allocate memory that they reuse in the first minutes, so the limit for short walks is loose.
constexpr double kGrowth = 1.05, kGrowthOfShortWalks = 1.5, kShortWalk_s = 600;
constexpr double kBetweenRests_s = 30; // or a twelfth of the walk
constexpr int kStill = 20;             // tenths of a second: the viewer gives memory back after ten
constexpr glm::ivec2 kSize{320, 240};

double seconds_from_environment(char const* name, double otherwise)
{
    char const* const text = std::getenv(name);
    return text != nullptr && *text != '\0' ? std::atof(text) : otherwise;
}

/// Of the samples of a part of the time.
double median_of_part(std::vector<double> const& samples, double from, double to)
{
    auto const at = [&](double part) { return samples.begin() + std::ptrdiff_t(part * double(samples.size())); };
    return gi::median(std::vector<double>(at(from), at(to)));
}

template <class T>
void print_tenths(char const* what, std::vector<T> const& values)
{
    fmt::print("{} at 10 % .. 100 %:", what);
    for (std::size_t i = 1; i <= 10 && !values.empty(); ++i)
        fmt::print(" {:.0f}", double(values[std::max<std::size_t>(1, i * values.size() / 10) - 1]));
    fmt::print("\n");
}

class RandomInput : public OnScreen {
protected:
    void SetUp() override
    {
        OnScreen::SetUp();
        if (IsSkipped()) return;
        view.emplace("cornell --size 320x240 --record walk.lwr --frame-log frames.csv --screenshots own_");
        Outcome const made = run("generate boxes --triangles 3000 --out boxes.glb", view->folder().path());
        ASSERT_EQ(made.code, 0) << made.err;
        window.emplace("Lightwell: cornell");
        for (std::string const& key : keys()) first[key] = view->ask({{"do", "get"}, {"key", key}}).at("value");
        connect();
    }

    /// All of them that `set` takes at any time.
    static std::vector<std::string> const& keys()
    {
        static std::vector<std::string> const all{
            "method",       "compare",        "schedule",  "directions", "resolution",   "axes",
            "updated_axes", "light_samples",  "bounces",   "seed",       "reuse",        "denoise",
            "share_eyes",   "radiance_cache", "exposure",  "tone",       "rate",         "paths",
            "scale",        "play",           "speed",     "stereo",     "eye_distance", "swap_eyes",
            "view",         "split",          "reproject", "refine",     "panel"};
        return all;
    }

    /// Keys that the remote control presses and may hold down.
    static std::vector<std::string> const& remote_keys()
    {
        static std::vector<std::string> const all{"w", "a", "s", "d", "q", "e", "up",  "F1",    "F11", "v", "c",
                                                  "m", "+", "-", "1", "5", "0", "tab", "space", "r",   "p"};
        return all;
    }

    /// Everything as at the beginning, a frame of it, and then none until something changes.
    void rest()
    {
        sleep_ms(500); // what was sent before is done first
        connect();     // whose answers nobody waits for
        for (std::string const& key : remote_keys())
            client->send(Json{{"do", "key"}, {"key", key}, {"action", "release"}}.dump() + "\n");
        RemoteClient to(view->socket());
        auto const ask = [&](Json const& request) {
            Json const answer = to.ask(request, kFrame);
            if (!answer.contains("result")) throw gi::InputError(request.dump(), answer.dump(), "see above");
        };
        for (auto const& [key, value] : first)
            ask({{"do", "set"}, {"key", key}, {"value", key == "refine" ? Json(false) : value}});
        ask({{"do", "pause"}});
        ask({{"do", "seek"}, {"time_s", 0}});
        ask({{"do", "load"}, {"scene", "cornell"}});
        window->resize(kSize);
        auto const begun = Clock::now();
        int still = 0;
        for (int frame = -1; still < kStill;) {
            if (Clock::now() - begun > kFrame) throw gi::InputError("refine", "goes on all the same", "see above");
            Json const stats = to.ask({{"do", "stats"}}, kAnswer).at("result");
            int const newest = stats.value("frame", -1);
            still = stats.value("at_rest", false) && newest == frame ? still + 1 : 0;
            frame = newest;
            sleep_ms(100);
        }
    }
    void go_on()
    {
        RemoteClient(view->socket())
            .ask({{"do", "set"}, {"key", "refine"}, {"value", first.at("refine")}}, kAnswer);
        connect();
    }

    double real(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random); }
    int whole(int low, int high) { return std::uniform_int_distribution<int>(low, high)(random); }
    template <class T>
    T one_of(std::vector<T> const& all)
    {
        return all[std::size_t(whole(0, int(all.size()) - 1))];
    }

    void connect()
    {
        client.emplace(view->socket());
        unanswered = 0;
    }

    /// Anything that JSON can hold.
    Json anything()
    {
        switch (whole(0, 9)) {
        case 0:
            return nullptr;
        case 1:
            return whole(0, 1) == 1;
        case 2:
            return whole(-2000000000, 2000000000);
        case 3:
            return real(-1e30, 1e30);
        case 4:
            return std::string(std::size_t(whole(0, 300)), 'x');
        case 5:
            return Json::array({1, "two", nullptr});
        case 6:
            return Json::object({{"x", 1}});
        case 7:
            return "reference";
        case 8:
            return Json::array({real(-5, 5), real(-5, 5), real(-5, 5)});
        default:
            return 1e-320;
        }
    }

    /// A value that the key may have, mostly; of the costly ones those that a slow machine can bear.
    Json value_of(std::string const& key)
    {
        using Words = std::vector<Json>;
        static std::map<std::string, Words> const words{
            {"method", {"slhb", "slhb", "slhb", "reference"}},
            {"compare", {"", "", "slhb", "reference"}},
            {"schedule", {"auto", "stored", "streamed", "temporal"}},
            {"directions", {"", "icosahedron:80", "icosahedron:320"}},
            {"denoise", {"none", "discontinuity", "wide", "atrous"}},
            {"tone", {"srgb", "filmic"}},
            {"stereo",
             {"off", "side-by-side", "top-bottom", "anaglyph-red-cyan", "anaglyph-dubois", "rows", "columns",
              "checkerboard", "quad-buffer", "two-windows"}},
            {"view", {"picture", "split", "flicker", "difference"}}};
        static std::map<std::string, std::pair<int, int>> const counts{
            {"resolution", {0, 256}},   {"axes", {0, 64}},   {"updated_axes", {0, 64}},
            {"light_samples", {0, 64}}, {"bounces", {0, 4}}, {"seed", {0, 1 << 30}},
            {"reuse", {1, 32}},         {"paths", {0, 3}}};
        static std::map<std::string, std::pair<double, double>> const numbers{
            {"exposure", {-4, 4}}, {"rate", {5, 60}},        {"scale", {0, 1}},
            {"speed", {-3, 3}},    {"eye_distance", {0, 1}}, {"split", {0, 1}}};
        if (auto const w = words.find(key); w != words.end()) return one_of(w->second);
        if (auto const c = counts.find(key); c != counts.end()) return whole(c->second.first, c->second.second);
        if (auto const n = numbers.find(key); n != numbers.end()) return real(n->second.first, n->second.second);
        return whole(0, 1) == 1; // the flags
    }

    Json set_request()
    {
        static std::vector<std::string> const vectors{"object.short block.position",
                                                      "object.tall block.position",
                                                      "object.3.position",
                                                      "light.0.intensity",
                                                      "light.0.position",
                                                      "material.white.base_color",
                                                      "material.0.emission",
                                                      "object.nobody.position",
                                                      "object.99999.position",
                                                      "light.77.intensity",
                                                      "object..position",
                                                      "material.white.",
                                                      "object.0.position"};
        static std::vector<std::string> const scalars{"object.short block.scale", "material.white.roughness",
                                                      "material.red.metallic",    "environment.scale",
                                                      "environment.rotation",     "object.lamp.scale"};
        int const kind = whole(0, 9);
        std::string const key = kind < 6 ? one_of(keys()) : kind < 8 ? one_of(vectors) : one_of(scalars);
        Json value = kind < 6   ? value_of(key)
                     : kind < 8 ? Json::array({real(-1, 1), real(0, 1), real(-1, 1)})
                                : Json(real(0, 1));
        if (whole(0, 5) == 0) value = anything();
        // Beyond what this machine can render in the time: right, but no part of this test.
        if (kind < 6 && value.is_number() && std::abs(value.get<double>()) > 64 && key != "seed") value = -1;
        return {{"do", "set"}, {"key", whole(0, 30) == 0 ? "nothing" : key}, {"value", value}};
    }

    Json request()
    {
        switch (whole(0, 19)) {
        case 0:
            return {{"do", "load"}, {"scene", one_of<std::string>({"cornell", "atrium", "boxes.glb", "cornell"})}};
        case 1:
            return {{"do", "load"},
                    {"scene", one_of<std::string>({"missing.glb", "", "/", "walk.lwr", "frames.csv"})}};
        case 2:
            return {{"do", "camera"},
                    {"position", {real(-1, 1), real(-1, 1), real(-2, 1)}},
                    {"look_at", {real(-1, 1), real(-1, 1), real(-1, 1)}}};
        case 3:
            return {{"do", "camera"}, {"fov_deg", real(-10, 200)}};
        case 4:
            return {{"do", "camera"}, {"rotation", {real(-1, 1), real(-1, 1), real(-1, 1), real(-1, 1)}}};
        case 5:
            return {
                {"do", "pick"}, {"x_px", real(-10, 900)}, {"y_px", real(-10, 700)}, {"select", whole(0, 1) == 1}};
        case 6:
            return {{"do", "key"},
                    {"key", whole(0, 10) == 0 ? one_of<std::string>({"nokey", ""}) : one_of(remote_keys())},
                    {"action", one_of<std::string>({"tap", "tap", "press", "release"})}};
        case 7:
            return {{"do", "seek"}, {"time_s", real(-10, 100)}};
        case 8:
            return {{"do", one_of<std::string>({"play", "pause"})}};
        case 9:
            return {{"do", "screenshot"},
                    {"file", one_of<std::string>({"shot.png", "shot.exr", "/nowhere/shot.png", "shot", ""})},
                    {"view", whole(-1, 3)},
                    {"converged", whole(0, 5) == 0}};
        case 10:
            return {{"do", "screenshot"}, {"file", "window.png"}};
        case 11:
            return {{"do", "stats"}};
        case 12:
            return {{"do", "get"}, {"key", one_of<std::string>({"method", "split", "none", ""})}};
        default:
            return set_request();
        }
    }

    std::string rubbish()
    {
        switch (whole(0, 5)) {
        case 0:
            return "\n";
        case 1:
            return "{\"do\": \"set\", \"key\": \"exposure\", \"value\": 1e999}\n";
        case 2:
            return "GET / HTTP/1.1\r\n\r\n";
        case 3:
            return std::string(40, '[') + "\n";
        case 4:
            return "{\"do\": 3}\n{\"id\": {}, \"do\": \"ping\"}\n{\"do\": \"set\"";
        default: {
            std::string bytes(std::size_t(whole(1, 400)), '\0');
            for (char& c : bytes) c = char(whole(0, 255));
            return bytes + "\n";
        }
        }
    }

    void input_at_the_window()
    {
        if (!window->key_problem().empty()) return;
        static std::vector<std::string> const keys{
            "w", "a", "s",   "d",     "q",  "e",  "r",   "p",    "v",     "c",  "m",    "1",       "2",        "6",
            "9", "0", "Tab", "space", "F1", "F2", "F11", "plus", "minus", "Up", "Left", "Shift_L", "Control_L"};
        glm::ivec2 const size = window->size_px();
        glm::ivec2 const at{whole(0, std::max(0, size.x - 1)), whole(0, std::max(0, size.y - 1))};
        switch (whole(0, 4)) {
        case 0:
        case 1: {
            window->focus();
            std::string const key = one_of(keys);
            window->press(key);
            sleep_ms(whole(0, 150));
            window->release(key);
            break;
        }
        case 2:
            window->point_at(at);
            break;
        case 3: { // a click, or a drag, perhaps of an object
            bool const moves = whole(0, 1) == 1;
            if (moves) window->press("Control_L");
            window->point_at(at);
            window->press_button(1);
            for (int i = whole(0, 5); i > 0; --i) window->point_at(at + 7 * i);
            window->release_button(1);
            if (moves) window->release("Control_L");
            break;
        }
        default:
            for (int i = whole(1, 4); i > 0; --i) {
                int const wheel = whole(4, 5);
                window->press_button(wheel);
                window->release_button(wheel);
            }
        }
    }

    void note(std::string what)
    {
        ++actions;
        latest.push_back(std::move(what));
        if (latest.size() > 40) latest.pop_front();
    }

    void act()
    {
        int const kind = whole(0, 99);
        if (kind < 62) {
            std::string const line = request().dump();
            note(line);
            client->send(line + "\n");
            if (++unanswered >= 40) connect(); // and leaves with answers open
        } else if (kind < 82) {
            note("input");
            input_at_the_window();
        } else if (kind < 90) {
            glm::ivec2 const size = whole(0, 9) == 0 ? glm::ivec2(1) : glm::ivec2(whole(1, 800), whole(1, 600));
            note(fmt::format("resize {}x{}", size.x, size.y));
            window->resize(size);
        } else if (kind < 92) {
            note("move");
            window->move({whole(-100, 500), whole(-100, 400)});
        } else if (kind < 96) {
            note("rubbish");
            RemoteClient(view->socket()).send(rubbish());
        } else {
            connect();
        }
        sleep_ms(whole(0, 60));
    }

    /// That it still answers.
    void check_alive()
    {
        auto const asked = Clock::now();
        Json const stats = RemoteClient(view->socket()).ask({{"do", "stats"}}, kAnswer);
        longest_answer_s = std::max(longest_answer_s, std::chrono::duration<double>(Clock::now() - asked).count());
        frames.push_back(stats.at("result").value("frame", -1));
        for (auto const& entry : std::filesystem::directory_iterator(view->folder().path()))
            if (entry.path().filename().string().starts_with("own_")) std::filesystem::remove(entry.path());
    }

    std::mt19937 random;
    std::optional<LiveView> view;
    std::optional<XWindow> window;
    std::optional<RemoteClient> client;
    int unanswered = 0;
    std::uint64_t actions = 0;
    std::deque<std::string> latest;
    double longest_answer_s = 0;
    std::map<std::string, Json> first; ///< settings
    std::vector<int> frames;           ///< number of the one that is shown, at every check
};

TEST_F(RandomInput, NeitherCrashesNorGrows)
{
    double const limit_s = seconds_from_environment("LIGHTWELL_RANDOM_INPUT_S", 60);
    auto const seed = unsigned(seconds_from_environment("LIGHTWELL_RANDOM_INPUT_SEED", 5));
    random.seed(seed);
    MemoryLog memory(view->program().pid());
    auto const begun = Clock::now();
    auto next_check = begun, next_rest = begun;
    std::chrono::milliseconds const between(int(1e3 * std::min(kBetweenRests_s, limit_s / 12)));
    std::vector<double> at_rest; // MiB
    std::string wrong;
    try {
        while (std::chrono::duration<double>(Clock::now() - begun).count() < limit_s && view->program().runs()) {
            if (Clock::now() >= next_rest) {
                rest();
                at_rest.push_back(memory.now_mib());
                go_on();
                next_rest = Clock::now() + between;
            }
            act();
            if (Clock::now() < next_check) continue;
            check_alive();
            next_check = Clock::now() + std::chrono::seconds(2);
        }
        check_alive();
    } catch (gi::InputError const& e) {
        wrong = e.what();
    }
    bool const lives = view->program().runs();
    memory.stop();
    double const lasted_s = std::chrono::duration<double>(Clock::now() - begun).count();
    fmt::print("seed {}, {} actions in {:.0f} s, longest answer {:.0f} ms\n", seed, actions, lasted_s,
               1e3 * longest_answer_s);
    std::vector<double> const& mib = memory.samples();
    if (!mib.empty()) {
        print_tenths("resident MiB", mib);
        fmt::print("at rest, MiB: {:.0f}\n", fmt::join(at_rest, " "));
        print_tenths("frame", frames);
        if (char const* const csv = std::getenv("LIGHTWELL_RANDOM_INPUT_CSV")) {
            std::ofstream out(csv);
            out << "# second,resident MiB of the viewer under random input, seed " << seed << "\n";
            for (std::size_t i = 0; i < mib.size(); ++i) out << i << "," << mib[i] << "\n";
        }
    }
    if (!lives || !wrong.empty()) {
        if (lives) view->program().send(SIGABRT);
        Outcome const o = view->program().wait();
        FAIL() << wrong << "\n"
               << (lives ? "it does not answer" : "it ended") << ", exit code " << o.code << ", signal "
               << o.signal << "\n"
               << o.out << o.err << "the latest actions:\n"
               << fmt::format("{}", fmt::join(latest, "\n"));
    }
    client.reset();
    view->quit();
    ASSERT_GE(at_rest.size(), 3u) << "too short a walk";
    double const growth = limit_s < kShortWalk_s ? kGrowthOfShortWalks : kGrowth;
    double const middle = median_of_part(at_rest, 1.0 / 3, 2.0 / 3), last = median_of_part(at_rest, 2.0 / 3, 1);
    fmt::print("at rest: {:.0f} MiB in the middle third, {:.0f} MiB in the last\n", middle, last);
    EXPECT_LE(last, growth * middle);
}

} // namespace
} // namespace viewer::test
