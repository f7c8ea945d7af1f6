// Ctrl-C while a frame of --frames is denoised or written: the frames before it are kept, it is rendered again.

#include "tests/viewer/run_program.h"

#include <array>
#include <set>
#include <sys/inotify.h>

namespace viewer::test {
namespace {

constexpr char const* kStateOfFrames = "f_0-2.exr.state";

void expect_to_go_on(std::string const& call, TemporaryFolder const& folder)
{
    TemporaryFolder const undisturbed;
    run_well(call + " --resume", folder.path());
    run_well(call, undisturbed.path());
    EXPECT_EQ(folder.files(), undisturbed.files());
    for (std::string const& name : undisturbed.files())
        EXPECT_TRUE(file_text(folder / name) == file_text(undisturbed / name)) << name;
}

TEST(InterruptedFrames, WhileOneIsWritten)
{
    TemporaryFolder const folder;
    std::string const call =
        "render cornell --size 1600x1200 --paths 1 --bounces 0 --quiet --frames 0:3@8 --out f_%d.exr";
    Program program(words(call), folder.path());
    while (program.runs() && !std::filesystem::exists(folder / ".f_1.exr.tmp"))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.send(SIGINT);
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, 130) << o.err;
    EXPECT_NE(o.err.find("1 of 3 frames are complete"), std::string::npos) << o.err;
    EXPECT_EQ(folder.files(), (std::vector<std::string>{kStateOfFrames, "f_0.exr"}));
    expect_to_go_on(call, folder);
}

/// Processor time of a running program, s; 0 if it has ended.
double processor_s(pid_t pid)
{
    std::string const text = file_text("/proc/" + std::to_string(pid) + "/stat");
    std::vector<std::string> const fields = words(text.substr(text.rfind(')') + 1)); // from the third one
    if (fields.size() < 13) return 0;
    return (std::stod(fields[11]) + std::stod(fields[12])) / double(sysconf(_SC_CLK_TCK));
}

/// Sees the names of files as they are created in a folder.
class CreatedFiles {
public:
    explicit CreatedFiles(std::filesystem::path const& folder) : fd_(inotify_init1(IN_NONBLOCK))
    {
        inotify_add_watch(fd_, folder.c_str(), IN_CREATE);
    }
    ~CreatedFiles() { close(fd_); }
    CreatedFiles(CreatedFiles const&) = delete;
    CreatedFiles& operator=(CreatedFiles const&) = delete;

    /// Since the last call.
    std::set<std::string> names() const
    {
        std::set<std::string> all;
        alignas(inotify_event) std::array<char, 4096> events;
        for (ssize_t n; (n = read(fd_, events.data(), events.size())) > 0;)
            for (ssize_t at = 0; at < n;) {
                auto const* const event = reinterpret_cast<inotify_event const*>(&events[std::size_t(at)]);
                all.insert(event->name);
                at += ssize_t(sizeof(inotify_event) + event->len);
            }
        return all;
    }

private:
    int fd_;
};

/// Paths take the first 60 % of a frame's processor time, and the filter most of the rest.
/// The filter is abandoned, and nothing is started after it.
TEST(InterruptedFrames, WhileOneIsDenoised)
{
    std::string const call =
        "render cornell --size 800x600 --paths 2 --bounces 0 --threads 1 --quiet --aovs color "
        "--denoise atrous --frames 0:3@8 --out f_%d.exr";
    bool is_met = false;
    for (int tries = 0; tries < 5 && !is_met; ++tries) {
        TemporaryFolder const folder;
        CreatedFiles const created(folder.path());
        Program program(words(call), folder.path());
        auto const wait_until = [&](auto const& comes) {
            while (program.runs() && !comes()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
        };
        wait_until([&] { return std::filesystem::exists(folder / "f_0.exr"); });
        double const frame_s = processor_s(program.pid());
        wait_until([&] { return processor_s(program.pid()) > 1.7 * frame_s; });
        bool const was_late = created.names().contains(".f_1.exr.tmp");
        program.send(SIGINT);
        Outcome const o = program.wait();
        is_met = !was_late && created.names().empty();
        if (!is_met) continue; // it was so far already; always, if frames are denoised to the end
        EXPECT_EQ(o.code, 130) << o.err;
        EXPECT_EQ(folder.files(), (std::vector<std::string>{kStateOfFrames, "f_0.exr"}));
        expect_to_go_on(call, folder);
    }
    EXPECT_TRUE(is_met) << "every frame was denoised to the end";
}

} // namespace
} // namespace viewer::test
