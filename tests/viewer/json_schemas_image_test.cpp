// What commands print with --json against docs/schemas, by Python's jsonschema (of Debian,
// by scripts/setup --tests).

#include "tests/viewer/run_program.h"

#include <cstdlib>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

TEST(JsonSchemas, DescribeWhatCommandsPrint)
{
    if (std::system("/usr/bin/python3 -c 'import jsonschema' 2> /dev/null") != 0)
        GTEST_SKIP() << "SKIPPED: python3-jsonschema is not installed (scripts/setup --tests installs it)";
    fs::path const source = LIGHTWELL_SOURCE_DIR;
    TemporaryFolder const folder, out;
    std::string const command = "/usr/bin/python3 '" + (source / "tests/viewer/json_schemas.py").string() + "' '" +
                                program_path() + "' '" + (source / "docs/schemas").string() + "' '" +
                                folder.path().string() + "' > '" + (out / "out.txt").string() + "' 2>&1";
    int const status = std::system(command.c_str());
    EXPECT_EQ(status, 0) << file_text(out / "out.txt");
    std::fputs(file_text(out / "out.txt").c_str(), stdout);
}

} // namespace
} // namespace viewer::test
