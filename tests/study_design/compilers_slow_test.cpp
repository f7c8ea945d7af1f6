// Plans are the same, byte by byte, whoever compiled the program.

#include "tests/study_design/samples.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>

namespace study::test {
namespace {

std::string output_of(std::string const& command)
{
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> const pipe(popen(command.c_str(), "r"), &pclose);
    std::string out;
    std::array<char, 4096> chunk;
    for (std::size_t n = 0; (n = std::fread(chunk.data(), 1, chunk.size(), pipe.get())) > 0;)
        out.append(chunk.data(), n);
    return out;
}

TEST(PlanFiles, AreTheSameFromGccAndClang)
{
    if (output_of("command -v clang++").empty()) GTEST_SKIP() << "there is no clang++ to compare with";
    std::string folder = (std::filesystem::temp_directory_path() / "lightwell_plan_XXXXXX").string();
    ASSERT_NE(mkdtemp(folder.data()), nullptr);
    std::string const root = LIGHTWELL_SOURCE_DIR, other = folder + "/plan_writer";
    // Another level of optimisation and other vector units as well.
    std::string const build =
        "bash -c 'clang++ -std=c++20 -O1 -ffp-contract=off -isystem " EIGEN_HEADERS " -I " + root + " " + root +
        "/study/script/*.cpp " + root + "/study/plan/*.cpp " + root + "/study/{numeric,adaptive}/*.cpp " + root +
        "/gi/core/{error,edit_distance,mistakes,text,yaml}.cpp " + STUDY_EXAMPLES_SOURCE + " " + root +
        "/tests/study_design/plan_writer.cpp -lyaml-cpp -lfmt -o " + other + "' 2>&1";
    std::string const messages = output_of(build);
    ASSERT_TRUE(std::filesystem::exists(other)) << messages;
    int count = 0;
    for (auto const& entry : std::filesystem::directory_iterator(root + "/data/study"))
        for (int participant = 1; participant <= 24; ++participant) {
            std::string const arguments = " " + entry.path().string() + " " + std::to_string(participant);
            std::string const expected = output_of(PLAN_WRITER + arguments);
            EXPECT_GT(expected.size(), 1000u) << arguments;
            EXPECT_EQ(output_of(other + arguments), expected) << arguments;
            ++count;
        }
    EXPECT_GE(count, 4 * 24);
    std::filesystem::remove_all(folder);
}

} // namespace
} // namespace study::test
