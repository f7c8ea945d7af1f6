#include "viewer/experiment/stimuli/prepared_files.h"

#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

void write_two(fs::path const& folder)
{
    write_prepared(folder, [](fs::path const& into) -> nlohmann::json {
        gi::Report report;
        gi::Picture picture;
        picture.width = picture.height = 8;
        picture.add("color", 3);
        for (char const* const name : {"00000_0.exr", "00001_0.exr"})
            gi::write_exr(into / name, picture, gi::PixelType::half, report);
        return {{"frames", 2}, {"views", 1}};
    });
}

TEST(PreparedFiles, AreThereWhole)
{
    TemporaryFolder const folder;
    EXPECT_FALSE(prepared_flaw(folder / "k").empty()) << "nothing is there";
    write_two(folder / "out/k");
    EXPECT_EQ(prepared_flaw(folder / "out/k"), "");
    EXPECT_EQ(read_prepared(folder / "out/k").at("frames"), 2);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder / "out"), {}), 1) << "no other folder stays";
}

TEST(PreparedFiles, DamagedOnesAreNoticedAndMadeAnew)
{
    TemporaryFolder const folder;
    fs::path const at = folder / "k";
    std::vector<std::pair<char const*, std::function<void()>>> const damages{
        {"a picture is missing", [&] { fs::remove(at / "00001_0.exr"); }},
        {"a picture is cut off", [&] { fs::resize_file(at / "00001_0.exr", 300); }},
        {"a picture is empty", [&] { fs::resize_file(at / "00001_0.exr", 0); }},
        {"a picture is zeros",
         [&] {
             auto const length = fs::file_size(at / "00001_0.exr");
             fs::resize_file(at / "00001_0.exr", 0);
             fs::resize_file(at / "00001_0.exr", length);
         }},
        {"no JSON", [&] { std::ofstream(at / "stimulus.json") << "{"; }},
        {"other JSON", [&] { std::ofstream(at / "stimulus.json") << "[1]"; }},
        {"JSON of nothing", [&] { std::ofstream(at / "stimulus.json") << "{\"files\": {}}"; }},
        {"JSON of texts", [&] { std::ofstream(at / "stimulus.json") << "{\"files\": {\"00000_0.exr\": \"x\"}}"; }},
        {"no stimulus.json", [&] { fs::remove(at / "stimulus.json"); }}};
    for (auto const& [what, damage] : damages) {
        write_two(at);
        ASSERT_EQ(prepared_flaw(at), "") << what;
        damage();
        EXPECT_NE(prepared_flaw(at), "") << what;
        EXPECT_THROW(read_prepared(at), gi::InputError) << what;
    }
    write_two(at);
    EXPECT_EQ(prepared_flaw(at), "");
}

TEST(PreparedFiles, NothingStaysOfWhatFails)
{
    TemporaryFolder const folder;
    auto const fail = [](fs::path const&) -> nlohmann::json { throw gi::InputError("it", "fails", ""); };
    EXPECT_THROW(write_prepared(folder / "k", fail), gi::InputError);
    EXPECT_TRUE(folder.files().empty());
}

} // namespace
} // namespace viewer::test
