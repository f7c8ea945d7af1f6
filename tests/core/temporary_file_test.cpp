#include "gi/core/temporary_file.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <fstream>
#include <gtest/gtest.h>
#include <set>
#include <sys/wait.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

class Temporaries : public testing::Test {
protected:
    Temporaries() : folder_(fs::path(testing::TempDir()) / ("lightwell_temporary_" + std::to_string(getpid())))
    {
        fs::create_directory(folder_);
    }
    ~Temporaries() override { fs::remove_all(folder_); }

    std::set<std::string> names() const
    {
        std::set<std::string> out;
        for (auto const& entry : fs::directory_iterator(folder_)) out.insert(entry.path().filename().string());
        return out;
    }

    fs::path const folder_;
    fs::path const file_ = folder_ / "a.exr";
};

TEST_F(Temporaries, WhatAKilledProgramLeftIsReplacedByTheNextWrite)
{
    pid_t const child = fork();
    if (child == 0) {
        TemporaryFile const temporary(file_);
        std::ofstream(temporary.path()) << std::string(1000, 'x') << std::flush;
        _exit(0); // without destructors, as if killed
    }
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    EXPECT_EQ(names(), std::set<std::string>{".a.exr.tmp"});
    write_text(file_, "new");
    EXPECT_EQ(names(), std::set<std::string>{"a.exr"});
    EXPECT_EQ(read_text(file_), "new");
}

TEST_F(Temporaries, OfTwoThatWriteAtOnceEachHasItsOwn)
{
    {
        TemporaryFile first(file_), second(file_);
        EXPECT_NE(first.path(), second.path());
        std::ofstream(first.path()) << "first";
        std::ofstream(second.path()) << "second";
        EXPECT_EQ(second.replace(file_), 0);
        EXPECT_EQ(read_text(file_), "second");
        EXPECT_EQ(first.replace(file_), 0);
    }
    EXPECT_EQ(read_text(file_), "first");
    EXPECT_EQ(names(), std::set<std::string>{"a.exr"});
}

TEST_F(Temporaries, AFailureLeavesNothing)
{
    EXPECT_THROW(write_by_rename(file_, [](fs::path const&) { throw InputError("no", "it is a test", "none"); }),
                 InputError);
    EXPECT_TRUE(names().empty());
}

TEST_F(Temporaries, OthersFilesOfThatNameAreNotTouched)
{
    fs::path const store = folder_ / "store";
    write_text(store, "kept");
    fs::create_hard_link(store, folder_ / ".a.exr.tmp");
    write_text(file_, "new");
    EXPECT_EQ(read_text(store), "kept");
    fs::remove(folder_ / ".a.exr.tmp");
    fs::create_symlink(store, folder_ / ".a.exr.tmp");
    write_text(file_, "newer");
    EXPECT_EQ(read_text(store), "kept");
    EXPECT_EQ(read_text(file_), "newer");
}

} // namespace
} // namespace gi::test
