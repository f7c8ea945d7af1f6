// What shells complete, what man pages hold, what a user's configuration adds: from the programs as they are.

#include "tests/viewer/run_program.h"
#include "viewer/cli/completion.h"

#include <fstream>

namespace viewer::test {
namespace {

/// Sets an environment variable of the children of a test.
class Variable {
public:
    Variable(char const* name, std::string const& value) : name_(name) { setenv(name, value.c_str(), 1); }
    ~Variable() { unsetenv(name_); }
    Variable(Variable const&) = delete;
    Variable& operator=(Variable const&) = delete;

private:
    char const* name_;
};

Outcome outcome_of(std::string const& arguments) { return run(arguments, std::filesystem::temp_directory_path()); }

std::vector<std::string> candidates(std::vector<std::string> const& call)
{
    Variable const completes(kCompleteVariable, "1");
    Outcome const o = Program(call, std::filesystem::temp_directory_path()).wait();
    EXPECT_EQ(o.code, 0) << o.err;
    return words(o.out);
}

bool has(std::vector<std::string> const& all, std::string const& word)
{
    return std::ranges::find(all, word) != all.end();
}

TEST(Completion, OffersCommandsOptionsAndValues)
{
    using Words = std::vector<std::string>;
    EXPECT_EQ(candidates({"ren"}), (Words{"render"}));
    EXPECT_EQ(candidates({"render"}), (Words{"render"})); // not yet a whole word
    EXPECT_EQ(candidates({"study", "sim"}), (Words{"simulate"}));
    EXPECT_EQ(candidates({"study", "cal"}), (Words{"calibrate"})); // of another program
    EXPECT_EQ(candidates({"study", "run", "--partic"}), (Words{"--participant"}));
    EXPECT_EQ(candidates({"render", "atrium", "--method", "slh"}), (Words{"slhb", "slhb_shadow_rays"}));
    EXPECT_EQ(candidates({"render", "atrium", "--method=slh"}), (Words{"--method=slhb", "--method=slhb_shadow_rays"}));
    EXPECT_EQ(candidates({"render", "atrium", "--tone", ""}), (Words{"srgb", "filmic"}));
    EXPECT_EQ(candidates({"render", "corn"}), (Words{"cornell", kFilesLine}));
    EXPECT_EQ(candidates({"render", "cornell", "--png", "a"}), (Words{kFilesLine}));
    EXPECT_EQ(candidates({"compare", "a.exr", "b.exr", "--metrics", "flip,relm"}), (Words{"flip,relmse"}));
    EXPECT_TRUE(has(candidates({"render", "cornell", "-"}), "--out"));
    EXPECT_FALSE(has(candidates({"render", "cornell", "-o", "a.exr", "-"}), "--out")); // given already
    EXPECT_TRUE(candidates({"nothing", "at", "all", "--x"}).empty());
}

TEST(Completion, ScriptsAreForThreeShells)
{
    for (char const* const shell : {"bash", "zsh", "fish"}) {
        Outcome const o = outcome_of(std::string("completion ") + shell);
        EXPECT_EQ(o.code, 0) << o.err;
        EXPECT_NE(o.out.find(kCompleteVariable), std::string::npos);
    }
    EXPECT_EQ(outcome_of("completion tcsh").code, 2);
}

/// Bash itself, where a key press is replaced by a call of the function that `complete` names.
TEST(Completion, BashCompletes)
{
    TemporaryFolder const folder;
    std::string const script = "source <(" + program_path() + " completion bash); COMP_WORDS=(" + program_path() +
                               " render atrium --meth); COMP_CWORD=3; _lightwell " + program_path() +
                               "; printf '%s\\n' \"${COMPREPLY[@]}\" > found";
    std::ofstream(folder / "ask.sh") << script;
    std::string const call = "cd '" + folder.path().string() + "' && bash ask.sh";
    ASSERT_EQ(std::system(call.c_str()), 0);
    EXPECT_EQ(file_text(folder / "found"), "--method\n");
}

TEST(Help, OfACommandAndOfAll)
{
    EXPECT_EQ(outcome_of("help render").out, outcome_of("render --help").out);
    EXPECT_EQ(outcome_of("help study run").out, outcome_of("study run --help").out);
    EXPECT_EQ(outcome_of("help").out, outcome_of("--help").out);
    EXPECT_EQ(outcome_of("-V").out, outcome_of("--version").out);
    EXPECT_EQ(outcome_of("help rendr").code, 2);
}

TEST(ManPages, HaveEveryOptionAndNoErrors)
{
    TemporaryFolder const folder;
    {
        Variable const man("LIGHTWELL_MAN", folder.path().string());
        for (char const* const call : {"", "render", "bench", "view", "study", "study run", "ar"})
            EXPECT_EQ(outcome_of(call).code, 0) << call;
    }
    for (char const* const page : {"lightwell.1", "lightwell-render.1", "lightwell-bench.1", "lightwell-view.1",
                                   "lightwell-study.1", "lightwell-study-run.1", "lightwell-ar.1"}) {
        std::string const text = file_text(folder / page);
        EXPECT_TRUE(text.starts_with(".TH \"lightwell")) << page;
        if (std::system("command -v groff >/dev/null") != 0) continue;
        std::string const call =
            "cd '" + folder.path().string() + "' && groff -man -ww -z -Tutf8 " + page + " 2>&1";
        std::string said;
        FILE* const pipe = popen(call.c_str(), "r");
        for (int c = fgetc(pipe); c != EOF; c = fgetc(pipe)) said += char(c);
        pclose(pipe);
        EXPECT_EQ(said, "") << page;
    }
    std::string const render = file_text(folder / "lightwell-render.1");
    for (std::string const& option : candidates({"render", "cornell", "--"})) {
        std::string escaped;
        for (char const c : option) escaped += c == '-' ? "\\-" : std::string(1, c);
        EXPECT_NE(render.find("\\fB" + escaped + "\\fR"), std::string::npos) << option;
    }
}

TEST(Configuration, GivesOptionsThatTheCallDoesNot)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "c.yaml") << "render: {size: 12x8, paths: 1, quiet: true, aovs: [L1, L2]}\n"
                                        "study run: {participant: 3}\n";
    Variable const config("LIGHTWELL_CONFIG", (folder / "c.yaml").string());
    Outcome const o = run("render cornell --paths 2 -o a.exr --stats a.json", folder.path());
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.err.find("with --size=12x8 --quiet --aovs=L1 --aovs=L2 of "), std::string::npos) << o.err;
    std::string const stats = file_text(folder / "a.json");
    EXPECT_NE(stats.find("\"paths_per_pixel\": 2"), std::string::npos) << stats;
    EXPECT_NE(stats.find("12"), std::string::npos);
    EXPECT_EQ(run("info cornell", folder.path()).err, ""); // has no section
}

TEST(Configuration, SaysWhatIsWrongInIt)
{
    TemporaryFolder const folder;
    Variable const config("LIGHTWELL_CONFIG", (folder / "c.yaml").string());
    EXPECT_NE(run("render cornell", folder.path()).err.find("there is no such file"), std::string::npos);
    for (auto const& [text, told] : {std::pair{"rendr: {size: 12x8}", "did you mean 'render'?"},
                                     {"render: {sice: 12x8}", "c.yaml:1:10: 'sice' is no option of render"},
                                     {"render: {quiet: 5}", "c.yaml:1:17: "},
                                     {"render: [1]", "c.yaml:1:9: "},
                                     {"render: {size: 12}", "--size '12'"}}) {
        std::ofstream(folder / "c.yaml") << text;
        Outcome const o = run("render cornell", folder.path());
        EXPECT_EQ(o.code, 2) << text;
        EXPECT_NE(o.err.find(told), std::string::npos) << o.err;
    }
}

TEST(DidYouMean, MethodsScenesCamerasAndMetrics)
{
    TemporaryFolder const folder;
    for (auto const& [call, near] : {std::pair{"render cornell --method shlb", "slhb"},
                                     {"render atrum", "atrium"},
                                     {"render atrium --camera galery", "gallery"},
                                     {"compare a.png a.png --metrics flp", "flip"}}) {
        run("render cornell --size 4x4 --paths 1 -o a.exr --png a.png", folder.path());
        Outcome const o = run(call, folder.path());
        EXPECT_EQ(o.code, 2) << call;
        EXPECT_NE(o.err.find("did you mean '" + std::string(near) + "'?"), std::string::npos) << o.err;
    }
}

} // namespace
} // namespace viewer::test
