// Entries of the dialog "open scene", and its memory of recent ones.

#include "viewer/app/open_dialog.h"

#include "gi/core/file.h"
#include "gi/core/text.h"
#include "tests/viewer/run_program.h"
#include "viewer/app/controls.h"

#include <fstream>
#include <gtest/gtest.h>
#include <unistd.h>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

TEST(OpenDialog, ListsFoldersAndScenes)
{
    TemporaryFolder const folder;
    for (char const* name : {"b.GLB", "a.yaml", "c.txt", "d.obj", ".hidden.glb", "sequence.json"})
        std::ofstream(folder / name) << "x";
    fs::create_directory(folder / "z");
    fs::create_directory(folder / "y.glb");
    FolderContents const c = contents_of(folder.path());
    EXPECT_EQ(c.folders, (std::vector<std::string>{"y.glb", "z"}));
    EXPECT_EQ(c.files, (std::vector<std::string>{"a.yaml", "b.GLB", "d.obj", "sequence.json"}));
    EXPECT_TRUE(c.problem.empty());
    EXPECT_FALSE(contents_of(folder / "no-such-folder").problem.empty());
}

TEST(RecentScenes, TheNewestComesFirstOnce)
{
    TemporaryFolder const folder;
    RecentScenes const recent(folder / "state/recent");
    EXPECT_TRUE(recent.read().empty());
    for (char const* name : {"a.glb", "b.glb", "c.glb"}) {
        std::ofstream(folder / name) << "x";
        EXPECT_EQ(recent.add((folder / name).string()), "");
    }
    EXPECT_EQ(recent.add((folder / "a.glb").string()), "");
    EXPECT_EQ(recent.add("atrium"), "") << "a built-in scene is not kept";
    std::string const at = folder.path().string() + "/";
    EXPECT_EQ(recent.read(), (std::vector<std::string>{at + "a.glb", at + "c.glb", at + "b.glb"}));
    fs::remove(folder / "c.glb");
    EXPECT_EQ(recent.read(), (std::vector<std::string>{at + "a.glb", at + "b.glb"}));
}

TEST(RecentScenes, AreLimitedAndSurviveAnyFile)
{
    TemporaryFolder const folder;
    RecentScenes const recent(folder / "recent");
    std::ofstream(folder / "recent") << "no path\n\n/nowhere\n\xff\xfe\n";
    EXPECT_TRUE(recent.read().empty());
    for (std::size_t i = 0; i < RecentScenes::kMost + 3; ++i) {
        fs::path const file = folder / ("scene" + std::to_string(i) + ".glb");
        std::ofstream(file) << "x";
        EXPECT_EQ(recent.add(file.string()), "");
    }
    EXPECT_EQ(recent.read().size(), RecentScenes::kMost);
    std::ofstream(folder / "file") << "x";
    EXPECT_NE(RecentScenes(folder / "file/recent").add((folder / "scene1.glb").string()), "") << "it says why";
    EXPECT_EQ(RecentScenes(fs::path()).add((folder / "scene1.glb").string()), "") << "nothing is kept";
}

TEST(Controls, EveryKeyIsInTheDocumentation)
{
    std::string const docs = file_text(LIGHTWELL_SOURCE_DIR "/docs/viewer.md");
    for (KeyMeaning const& k : key_meanings()) EXPECT_NE(docs.find(k.meaning), std::string::npos) << k.keys;
}

} // namespace
} // namespace viewer::test
