// What the program promises on large or long work: against a render of another program,
// and on a million triangles.

#include "tests/support/data.h"
#include "tests/viewer/run_program.h"

#include <nlohmann/json.hpp>

namespace viewer::test {
namespace {

using Json = nlohmann::json;

TEST(Acceptance, CornellBoxAgreesWithTungsten)
{
    std::filesystem::path const scene = gi::test::shared_data() / "scenes" / "cornell_box";
    LIGHTWELL_NEED_DATA(scene);
    TemporaryFolder const folder;
    run_well("render " + (scene / "cornell_box.glb").string() +
                 " --camera reference_camera --size 256x256 --paths 4096 --out a.exr",
             folder.path(), std::chrono::minutes(10));
    Json const j = Json::parse(
        run_well("compare a.exr " + (scene / "reference_tungsten.exr").string() + " --metrics bias,flip --json",
                 folder.path())
            .out);
    for (char const* const channel : {"bias.r", "bias.g", "bias.b"})
        EXPECT_NEAR(j.at("values").at(channel).get<double>(), 1, 0.01) << channel;
    EXPECT_LE(j.at("values").at("flip").get<double>(), 0.03);
}

TEST(Acceptance, AMillionTrianglesLoadSoonAndSmall)
{
    TemporaryFolder const folder;
    run_well("generate boxes --triangles 1000000 --out boxes.glb", folder.path());
    run_well("render boxes.glb --size 8x8 --paths 1 --out a.exr --stats a.json", folder.path());
    Json const report = Json::parse(file_text(folder / "a.json")).at("report");
    EXPECT_GE(report.at("counts").at("triangles").get<double>(), 990'000);
    EXPECT_LT(report.at("stages_s").at("load").get<double>(), 3) << "s";
    EXPECT_LT(report.at("peak_memory_bytes").get<double>(), double(1 << 30)) << "and that includes Embree's tree";
}

} // namespace
} // namespace viewer::test
