// `mpirun -n N lightwell render` makes what one process makes.

#include "gi/image_io/picture_file.h"
#include "tests/viewer_cluster/mpirun.h"

#include <cmath>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <opencv2/videoio.hpp>

namespace viewer::test {
namespace {

class RenderByRanks : public testing::Test {
protected:
    void SetUp() override
    {
        if (!has_mpirun()) GTEST_SKIP() << "no mpirun here: several machines are not tested";
    }
    /// @return mpirun's exit code
    int render(int ranks, std::string const& arguments, std::string const& options = "")
    {
        Mpirun mpirun(ranks, options, LIGHTWELL_PROGRAM " render " + arguments, shared_.path());
        int const code = mpirun.wait();
        said_ = mpirun.text();
        return code;
    }
    /// Metadata and all.
    void expect_equal_files(std::vector<std::string> const& names)
    {
        for (std::string const& name : names)
            EXPECT_TRUE(file_text(shared_ / name) == file_text(alone_ / name)) << name << " differs\n" << said_;
    }
    nlohmann::json stats(TemporaryFolder const& folder)
    {
        return nlohmann::json::parse(file_text(folder / "s.json"));
    }

    TemporaryFolder shared_, alone_;
    std::string said_;
};

/// The bytes of all its frames: two files of one video have different numbers in their heads.
std::vector<std::uint8_t> frames_of(std::filesystem::path const& video)
{
    cv::VideoCapture in(video.string(), cv::CAP_FFMPEG);
    std::vector<std::uint8_t> all;
    for (cv::Mat frame; in.read(frame);) all.insert(all.end(), frame.datastart, frame.dataend);
    return all;
}

constexpr char const* kFrames =
    "cornell --frames 3:8@24 --turntable --size 32x24 --paths 3 --threads 2 --quiet --out f_%02d.exr "
    "--png p_%02d.png --video v.mkv --stats s.json";

TEST_F(RenderByRanks, FramesAreEqualBitForBit)
{
    run_well(std::string("render ") + kFrames, alone_.path());
    ASSERT_EQ(render(2, kFrames), 0) << said_;
    auto files = alone_.files();
    std::erase_if(files, [](std::string const& f) { return f == "s.json" || f == "v.mkv"; });
    EXPECT_EQ(frames_of(alone_ / "v.mkv").size(), 5u * 32 * 24 * 3);
    EXPECT_EQ(frames_of(alone_ / "v.mkv"), frames_of(shared_ / "v.mkv"));
    expect_equal_files(files);
    EXPECT_EQ(shared_.files().size(), files.size() + 3) << "s.json, v.mkv, mpirun.out";
    nlohmann::json const a = stats(alone_), b = stats(shared_);
    EXPECT_EQ(a.at("settings"), b.at("settings"));
    ASSERT_EQ(b.at("frames").size(), 5u);
    for (std::size_t k = 0; k < 5; ++k)
        for (char const* key : {"frame", "time_s", "exr", "png", "reused", "paths_per_pixel", "rays",
                                "relmse_estimate", "end", "losses"})
            EXPECT_EQ(a.at("frames")[k].at(key), b.at("frames")[k].at(key)) << k << " " << key;
    std::size_t lines = 0; // of one rank
    for (std::size_t at = 0; (at = said_.find("5 frames of 32 x 24 pixels", at)) != std::string::npos; ++at)
        ++lines;
    EXPECT_EQ(lines, 1u) << said_;
}

TEST_F(RenderByRanks, MissingFramesAreRenderedByThoseWhoseTheyAre)
{
    run_well(std::string("render ") + kFrames, alone_.path());
    ASSERT_EQ(render(3, kFrames), 0) << said_;
    for (char const* name : {"f_04.exr", "f_05.exr", "v.mkv"}) std::filesystem::remove(shared_ / name);
    ASSERT_EQ(render(2, std::string(kFrames) + " --resume"), 0) << said_;
    expect_equal_files({"f_03.exr", "f_04.exr", "f_05.exr", "f_06.exr", "f_07.exr", "p_04.png"});
    EXPECT_EQ(frames_of(alone_ / "v.mkv"), frames_of(shared_ / "v.mkv"));
    EXPECT_NE(said_.find("3 existed already"), std::string::npos) << said_;
}

void expect_close(gi::Picture const& a, gi::Picture const& b)
{
    ASSERT_EQ(a.layers.size(), b.layers.size());
    // Means in single precision: each path rounds them by up to 2^-24 of what they are then.
    double largest = 0;
    for (gi::Layer const& layer : a.layers) {
        gi::Layer const* const other = b.find(layer.name);
        ASSERT_NE(other, nullptr) << layer.name;
        ASSERT_EQ(layer.data.size(), other->data.size());
        float const tolerance = layer.name == "variance" ? 1e-5f : 1e-6f; // variances are of differences
        // Normals and positions are means of values of either sign, up to 1.
        float const least = layer.name == "normal" || layer.name == "position" ? 1 : 1e-3f;
        for (std::size_t k = 0; k < layer.data.size(); ++k) {
            float const scale = std::max(least, std::abs(layer.data[k]));
            EXPECT_NEAR(layer.data[k], other->data[k], tolerance * scale) << layer.name << " " << k;
            largest = std::max(largest, double(std::abs(layer.data[k] - other->data[k]) / scale));
        }
    }
    std::printf("largest difference %.2g of the value\n", largest);
}

TEST_F(RenderByRanks, OnePictureIsEqualButForRounding)
{
    for (char const* method : {"reference", "slhb --schedule streamed", "slhb --schedule stored"})
        for (int const ranks : {2, 3}) {
            std::string const call =
                fmt::format("cornell --method {} --size 40x30 --paths 13 --threads 1 --quiet --out "
                            "a.exr --png a.png --stats s.json",
                            method);
            SCOPED_TRACE(fmt::format("{} ranks: {}", ranks, call));
            run_well("render " + call, alone_.path());
            ASSERT_EQ(render(ranks, call), 0) << said_;
            gi::Picture const one = gi::read_exr(alone_ / "a.exr"), many = gi::read_exr(shared_ / "a.exr");
            expect_close(one, many);
            EXPECT_EQ(one.metadata, many.metadata);
            auto const result = [&](TemporaryFolder const& folder, char const* key) {
                return stats(folder).at("result").at(key);
            };
            for (char const* key : {"end", "paths_per_pixel", "rays"})
                EXPECT_EQ(result(alone_, key), result(shared_, key)) << key;
            EXPECT_NEAR(result(alone_, "relmse_estimate").get<double>(),
                        result(shared_, "relmse_estimate").get<double>(), 1e-8);
            EXPECT_EQ(stats(alone_).at("report").at("losses"), stats(shared_).at("report").at("losses"));
        }
}

TEST_F(RenderByRanks, MoreRanksThanPaths)
{
    std::string const call = "cornell --size 16x16 --paths 2 --quiet --threads 1 --out a.exr";
    run_well("render " + call, alone_.path());
    ASSERT_EQ(render(3, call), 0) << said_;
    expect_close(gi::read_exr(alone_ / "a.exr"), gi::read_exr(shared_ / "a.exr"));
}

TEST_F(RenderByRanks, WhatCannotBeSharedIsRefused)
{
    for (char const* more :
         {"--budget 1s", "--until relmse=0.1", "--paths 4 --resume --out a.exr",
          "--paths 4 --time 0 --shutter 0.1", "--frames 0:2@24 --reuse 4", "--frames 0:2@24 --video v.mkv"}) {
        EXPECT_EQ(render(2, fmt::format("cornell --size 16x16 {}", more)), 2) << more << said_;
        EXPECT_NE(said_.find("with several processes"), std::string::npos) << more << said_;
    }
    EXPECT_EQ(shared_.files(), std::vector<std::string>{"mpirun.out"});
}

/// Of a rank of the mpirun that runs now.
int pid_of_rank(int rank, std::string const& folder)
{
    for (auto const& entry : std::filesystem::directory_iterator("/proc")) {
        std::string const name = entry.path().filename().string();
        if (std::isdigit(name[0]) == 0) continue;
        std::error_code ignored;
        std::string const environment = file_text(entry.path() / "environ");
        if (environment.find(fmt::format("OMPI_COMM_WORLD_RANK={}", rank) + '\0') != std::string::npos &&
            std::filesystem::read_symlink(entry.path() / "cwd", ignored) == folder &&
            std::filesystem::read_symlink(entry.path() / "exe", ignored) ==
                std::filesystem::canonical(LIGHTWELL_PROGRAM "-render"))
            return std::stoi(name);
    }
    return 0;
}

/// Once a file is there.
void kill_rank(int rank, std::filesystem::path const& folder, std::string const& file)
{
    auto const limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    int pid = 0;
    while ((pid == 0 || !std::filesystem::exists(folder / file)) && std::chrono::steady_clock::now() < limit) {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        pid = pid_of_rank(rank, folder.string());
    }
    ASSERT_GT(pid, 0);
    kill(pid, SIGKILL);
}

constexpr char const* kLong = LIGHTWELL_PROGRAM
    " render cornell --frames 0:12@24 --size 96x96 --paths 20 --threads 1 --quiet --out f_%02d.exr ";

TEST_F(RenderByRanks, AKilledRankIsNamedAndTheRestResumes)
{
    {
        Mpirun mpirun(2, recovery_option(), kLong, shared_.path());
        kill_rank(1, shared_.path(), "f_01.exr"); // its first
        mpirun.wait();
        said_ = mpirun.text();
    }
    EXPECT_NE(said_.find("has died"), std::string::npos) << said_;
    EXPECT_NE(said_.find("lightwell: rank 0 on "), std::string::npos) << said_;
    EXPECT_NE(said_.find("--resume"), std::string::npos) << said_;
    auto const files = shared_.files();
    EXPECT_LT(files.size(), 12u);
    for (std::string const& f : files)
        if (f.ends_with(".exr")) {
            EXPECT_NO_THROW(gi::read_exr(shared_ / f)) << f;
        }
    Mpirun again(2, recovery_option(), std::string(kLong) + "--resume", shared_.path());
    EXPECT_EQ(again.wait(), 0);
    for (int k = 0; k < 12; ++k)
        EXPECT_TRUE(std::filesystem::exists(shared_ / fmt::format("f_{:02}.exr", k))) << k;
    EXPECT_NE(again.text().find("12 frames of 96 x 96 pixels"), std::string::npos) << again.text();
}

TEST_F(RenderByRanks, OthersFinishTheirFrames)
{
    Mpirun mpirun(2, recovery_option(), std::string(kLong) + "--on-rank-loss continue", shared_.path());
    kill_rank(1, shared_.path(), "f_01.exr");
    mpirun.wait();
    EXPECT_NE(mpirun.text().find("the others go on"), std::string::npos) << mpirun.text();
    EXPECT_NE(mpirun.text().find("ranks were lost"), std::string::npos) << mpirun.text();
    for (int k = 0; k < 12; k += 2)
        EXPECT_TRUE(std::filesystem::exists(shared_ / fmt::format("f_{:02}.exr", k))) << k;
}

} // namespace
} // namespace viewer::test
