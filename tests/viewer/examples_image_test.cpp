// Every example that the program, the README and docs/*.md give is run, some with less work, all in one folder, as
// newcomers do.

#include "tests/viewer/run_program.h"

#include <set>

namespace viewer::test {
namespace {

std::vector<std::string> lines(std::string const& text)
{
    std::istringstream in(text);
    std::vector<std::string> out;
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

/// The folder of all examples.
TemporaryFolder const& folder()
{
    static TemporaryFolder const one;
    return one;
}

/// What makes a long call short and may be left out by those who read it.
std::string shortened(std::string call)
{
    auto const add = [&](char const* begin, std::string const& option) {
        if (call.starts_with(begin) && call.find(option.substr(0, option.find(' '))) == std::string::npos)
            call += " " + option;
    };
    add("study report ", "--draws 50");
    add("study analyze ", "--draws 50");
    add("ar synthesize one_marker ", "--size 320x240");
    add("bench schedules ", "--set directions=icosahedron:80");
    add("bench sweep --scene cornell --budgets", "--methods paths,slhb");
    return call;
}

/// Runs all lines that start with `prefix`, in order. What several texts give alike is run once.
/// @return how many there were
int run_examples(std::vector<std::string> const& text, std::string const& prefix)
{
    // That of `ar bench` is run by tests/viewer_ar/bench_command_image_test.cpp.
    static std::set<std::vector<std::string>> done{
        words("ar bench --size 640x480 --frames 2 --paths 1 --truth-paths 2 --folder desks --out table")};
    int count = 0;
    for (std::string const& line : text) {
        if (!line.starts_with(prefix)) continue;
        std::string const call = line.substr(prefix.size(), line.find('#') - prefix.size());
        if (done.insert(words(call)).second) run_well(shortened(call), folder().path());
        ++count;
    }
    return count;
}

class Examples : public testing::TestWithParam<char const*> {};

/// All commands with their subcommands, as the program's own help lists them, e.g. "study run".
void list_commands(std::string const& command, std::vector<std::string>& all)
{
    std::vector<std::string> const text = lines(run_well(command + " --help", folder().path()).out);
    auto at = std::ranges::find(text, "Subcommands:");
    if (at == text.end()) return;
    for (++at; at != text.end() && at->starts_with("  "); ++at) {
        std::string const name = at->substr(2, at->find(' ', 2) - 2);
        if (name.empty() || name == "help") continue; // a further line of the command above
        std::string const whole = command.empty() ? name : command + " " + name;
        if (whole == "batch render" || whole == "batch bench") continue; // --help is of what they run
        all.push_back(whole);
        list_commands(whole, all);
    }
}

/// Under "Examples:" stand calls of the command itself.
TEST(HelpExamples, AreOfTheirCommand)
{
    std::vector<std::string> all;
    list_commands("", all);
    EXPECT_GT(all.size(), 60u);
    for (std::string const& command : all) {
        bool in_examples = false;
        int count = 0;
        for (std::string const& line : lines(run_well(command + " --help", folder().path()).out)) {
            if (!line.starts_with(" ")) in_examples = line.starts_with("Example");
            std::size_t const call = line.find("lightwell ");
            if (!in_examples || call == line.npos) continue;
            std::string const words = line.substr(call + 10) + " ";
            EXPECT_TRUE(words.starts_with(command + " ")) << command << " --help: " << line;
            ++count;
        }
        if (command == "display check" || command == "display import" || command == "generate ring" ||
            command == "study plan" || command == "batch resume") {
            EXPECT_GT(count, 0) << command;
        }
    }
}

TEST_P(Examples, OfHelpRun)
{
    std::string const help = run_well(std::string(GetParam()) + " --help", folder().path()).out;
    EXPECT_GT(run_examples(lines(help), "  lightwell "), 0) << help;
}

std::string test_name(testing::TestParamInfo<char const*> const& of)
{
    std::string name = *of.param == '\0' ? "program" : of.param;
    std::ranges::replace_if(
        name, [](char c) { return c == ' ' || c == '.' || c == '/'; }, '_');
    return name;
}

INSTANTIATE_TEST_SUITE_P(Of, Examples,
                         testing::Values("", "render", "compare", "denoise", "info", "generate", "display",
                                         "study", "study simulate", "study rebuild", "study export",
                                         "study analyze", "study report", "study power", "bench", "bench sweep",
                                         "bench pictures", "bench report", "bench shown", "bench views",
                                         "bench schedules", "bench raster", "bench rays", "bench accuracy",
                                         "bench thesis", "track", "track listen", "track send", "track walk", "ar",
                                         "ar synthesize", "ar run", "ar track", "ar bench", "ar cameras",
                                         "ar record", "ar replay", "ar board", "ar calibrate", "ar map",
                                         "ar albedo", "ar light", "batch"),
                         test_name);

/// A newcomer's hour: what the README and the documents say, in this order, in one folder.
TEST(DocumentExamples, Run)
{
    run_well("generate boxes --triangles 2000 --out YOUR_SCENE.glb", folder().path());
    for (char const* const document : {"README.md", "docs/first-hour.md", "docs/commands.md", "docs/batch.md", "docs/displays.md",
                                       "docs/study/tutorial.md", "docs/study/analysis.md"}) {
        SCOPED_TRACE(document);
        std::vector<std::string> shell;
        bool inside = false;
        for (std::string const& line : lines(file_text(std::string(LIGHTWELL_SOURCE_DIR "/") + document))) {
            if (line.starts_with("```"))
                inside = line == "```sh";
            else if (inside)
                shell.push_back(line);
        }
        EXPECT_GT(run_examples(shell, "build/release/lightwell "), 0);
    }
}

} // namespace
} // namespace viewer::test
