#include "gi/core/crc32.h"
#include "gi/core/durable_file.h"
#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "study/journal/moments.h"
#include "study/script/script_error.h"
#include "tests/study_record/samples.h"
#include "tests/viewer/run_program.h"

#include <fcntl.h>
#include <sys/resource.h>

namespace study::test {
namespace {

using viewer::test::TemporaryFolder;

TEST(Sha256, OfThePublishedExamples)
{
    EXPECT_EQ(gi::sha256(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    EXPECT_EQ(gi::sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    EXPECT_EQ(gi::sha256("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
              "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
    EXPECT_EQ(gi::sha256(std::string(1000000, 'a')),
              "cdc76e5c9914fb9281a1c7e284d73e67f1809a48a497200e046d39ccc7112cd0");
}

TEST(Crc32, OfThePublishedExample) { EXPECT_EQ(gi::crc32("123456789"), 0xcbf43926u); }

TEST(Moments, OfTheCalendar)
{
    EXPECT_EQ(utc_text(0), "1970-01-01T00:00:00.000Z");
    EXPECT_EQ(utc_text(1795334400.0625), "2026-11-22T08:00:00.063Z");
    EXPECT_EQ(utc_text(-0.001), "1969-12-31T23:59:59.999Z");
    for (double const t : {0.0, 951782399.999, 951868800.0, 1795334400.5, 4102444800.25})
        EXPECT_NEAR(*unix_time(utc_text(t)), t, 0.0005);
    for (char const* wrong : {"", "2026-11-22", "2026-13-22T08:00:00.000Z", "2026-02-30T08:00:00.000Z",
                              "2026-11-22T25:00:00.000Z", "2026-11-22T08:00:00.000Zx"})
        EXPECT_FALSE(unix_time(wrong)) << wrong;
}

TEST(Moments, TheLastOneIsThatOfTheLastPart)
{
    SessionRecord record{entries_of_every_kind()};
    EXPECT_NEAR(*last_unix_time(record), *unix_time("2026-11-22T08:00:00.000Z") + 100 - 12.5, 1e-6);
    SessionStarted again;
    again.utc = "2026-11-22T07:00:00.000Z"; // the wall clock was set back
    again.clock_s = 3;
    record.entries.emplace_back(again);
    EXPECT_EQ(*last_unix_time(record), *unix_time(again.utc));
    record.entries.emplace_back(StepDone{0, 4, 5, ""});
    EXPECT_EQ(*last_unix_time(record), *unix_time(again.utc) + 2);
    EXPECT_FALSE(last_unix_time({}));
}

TEST(DurableFiles, AppearWholeOrNotAtAll)
{
    TemporaryFolder const folder;
    gi::make_folder(folder / "a/b/c");
    gi::make_folder(folder / "a/b/c");
    gi::write_durably(folder / "a/b/c/x.txt", "one");
    gi::write_durably(folder / "a/b/c/x.txt", "two");
    EXPECT_EQ(gi::read_text(folder / "a/b/c/x.txt"), "two");

    rlimit old{};
    getrlimit(RLIMIT_FSIZE, &old);
    rlimit const small{1000, old.rlim_max};
    auto const handler = std::signal(SIGXFSZ, SIG_IGN);
    setrlimit(RLIMIT_FSIZE, &small);
    EXPECT_THROW(gi::write_durably(folder / "a/b/c/x.txt", std::string(5000, 'x')), gi::InputError);
    setrlimit(RLIMIT_FSIZE, &old);
    std::signal(SIGXFSZ, handler);
    EXPECT_EQ(gi::read_text(folder / "a/b/c/x.txt"), "two");
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder / "a/b/c"), {}), 1);
}

TEST(DurableFiles, SayWhatIsInTheWay)
{
    TemporaryFolder const folder;
    gi::write_durably(folder / "x", "");
    EXPECT_THROW(gi::make_folder(folder / "x/y"), gi::InputError);
    EXPECT_THROW(gi::make_folder(folder / "x"), gi::InputError);
    EXPECT_THROW(gi::read_text(folder / "none"), gi::InputError);
    EXPECT_THROW(gi::read_text(folder.path()), gi::InputError);
    EXPECT_THROW(gi::write_durably(folder / "none/x", "a"), gi::InputError);
}

} // namespace
} // namespace study::test
