#pragma once
// Renders that are interrupted once they have a state, and others that are killed (SIGKILL) at moments of chance and
// continued until they are complete.

#include "tests/viewer/run_program.h"

#include <random>

namespace viewer::test {

/// Until a render has a picture so far; before that an interruption leaves nothing.
inline void wait_for_state(Program const& program, std::filesystem::path const& state)
{
    while (program.runs() && !std::filesystem::exists(state))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_TRUE(program.runs());
}

struct KilledRender {
    int kills = 0, without_state = 0; ///< of them before the first state was written
    double longest_loss_s = 0;        ///< age of the newest state at a kill, without the first one of each run
    bool has_leftovers = false;       ///< some file beside picture and state was left by a kill
    std::string picture;              ///< at the end
};

/// Runs `call --out a.exr --checkpoint INTERVAL --quiet`, kills it, and goes on
/// with --resume until it is complete.
inline KilledRender render_with_kills(std::string const& call, std::string const& interval, int kills,
                                      double most_seconds, std::uint32_t seed)
{
    namespace fs = std::filesystem;
    TemporaryFolder const folder;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> moment(0, most_seconds);
    std::string const all = call + " --out a.exr --quiet --checkpoint " + interval;
    KilledRender r;
    while (r.kills < kills) {
        bool const has_state = fs::exists(folder / "a.exr.state");
        auto const before = has_state ? fs::last_write_time(folder / "a.exr.state") : fs::file_time_type::min();
        Program program(words(all + (has_state ? " --resume" : "")), folder.path());
        if (!program.wait_until_catches(SIGINT, true)) {
            ADD_FAILURE() << "it ended too early: " << program.wait().err;
            return r;
        }
        std::this_thread::sleep_for(std::chrono::duration<double>(moment(random)));
        program.send(SIGKILL);
        auto const killed = fs::file_time_type::clock::now();
        if (program.wait().signal != SIGKILL) {
            ADD_FAILURE() << "it was complete after " << r.kills << " kills: it needs more paths";
            return r;
        }
        ++r.kills;
        if (!fs::exists(folder / "a.exr.state")) {
            ++r.without_state;
        } else if (auto const written = fs::last_write_time(folder / "a.exr.state"); written > before) {
            r.longest_loss_s = std::max(r.longest_loss_s, std::chrono::duration<double>(killed - written).count());
        }
        auto const files = folder.files();
        r.has_leftovers |= files != std::vector<std::string>{"a.exr.state"} && !files.empty();
    }
    run_well(all + " --resume", folder.path());
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
    r.picture = file_text(folder / "a.exr");
    return r;
}

} // namespace viewer::test
