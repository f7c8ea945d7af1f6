// Every example that the program, the README and docs/commands.md give is run as it stands.

#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

std::vector<std::string> lines(std::string const& text)
{
    std::istringstream in(text);
    std::vector<std::string> out;
    for (std::string line; std::getline(in, line);) out.push_back(line);
    return out;
}

/// Runs all lines that start with `prefix` in one new folder, in order.
/// @return how many there were
int run_examples(std::vector<std::string> const& text, std::string const& prefix)
{
    TemporaryFolder const folder;
    int count = 0;
    for (std::string const& line : text) {
        if (!line.starts_with(prefix)) continue;
        run_well(line.substr(prefix.size(), line.find('#') - prefix.size()), folder.path());
        ++count;
    }
    return count;
}

class HelpExamples : public testing::TestWithParam<char const*> {};

TEST_P(HelpExamples, Run)
{
    TemporaryFolder const folder;
    std::string const help = run_well(std::string(GetParam()) + " --help", folder.path()).out;
    EXPECT_GT(run_examples(lines(help), "  lightwell "), 0) << help;
}

INSTANTIATE_TEST_SUITE_P(Of, HelpExamples,
                         testing::Values("", "render", "compare", "info", "generate", "display", "study",
                                         "study simulate", "study rebuild", "study export", "study analyze",
                                         "study report", "study power", "bench", "bench sweep", "bench pictures",
                                         "bench report", "bench views", "bench schedules", "bench raster",
                                         "bench rays", "bench accuracy", "bench thesis", "track", "track listen",
                                         "track send", "track walk", "ar", "ar synthesize", "ar run", "ar track",
                                         "ar bench", "ar cameras", "ar record", "ar replay", "ar board",
                                         "ar calibrate", "ar map", "ar albedo", "ar light"),
                         [](auto const& example) {
                             std::string name = *example.param == '\0' ? "program" : example.param;
                             std::replace(name.begin(), name.end(), ' ', '_');
                             return name;
                         });

class DocumentExamples : public testing::TestWithParam<char const*> {};

TEST_P(DocumentExamples, Run)
{
    std::vector<std::string> shell;
    bool inside = false;
    for (std::string const& line : lines(file_text(std::string(LIGHTWELL_SOURCE_DIR "/") + GetParam()))) {
        if (line.starts_with("```"))
            inside = line == "```sh";
        else if (inside)
            shell.push_back(line);
    }
    EXPECT_GT(run_examples(shell, "build/release/lightwell "), 0);
}

INSTANTIATE_TEST_SUITE_P(Of, DocumentExamples, testing::Values("README.md", "docs/commands.md"),
                         [](auto const& example) {
                             return std::string(example.param).starts_with("README") ? "Readme" : "Commands";
                         });

} // namespace
} // namespace viewer::test
