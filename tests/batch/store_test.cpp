// Results, journals and claims, and what damage does to them.

#include "gi/core/file.h"
#include "gi/core/sha256.h"
#include "tests/viewer/run_program.h"
#include "viewer/batch/batch_file.h"
#include "viewer/batch/claim.h"
#include "viewer/batch/file_hash.h"
#include "viewer/batch/gather.h"
#include "viewer/batch/journal.h"
#include "viewer/batch/merge.h"
#include "viewer/batch/state.h"
#include "viewer/batch/work.h"

#include <sys/wait.h>

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

std::string key_number(int n) { return gi::sha256(std::to_string(n)); }

Batch small_batch(int tasks)
{
    Batch b;
    b.name = "b";
    b.program = "p";
    for (int i = 0; i < tasks; ++i) {
        Task t;
        t.key = key_number(i);
        t.group = "g";
        t.parameters = {{"n", std::to_string(i)}};
        t.command = {"render", "x"};
        t.outputs = {"out/"};
        b.tasks.push_back(t);
    }
    return b;
}

struct StoreTest : testing::Test {
    enum class End { published, killed_before };

    /// Publishes out/NAME with a text as the output of a task, or is killed before.
    Result publish(Task const& task, std::string const& name, std::string const& text, End how = End::published)
    {
        fs::create_directories(store.work(task.key) / "out");
        gi::write_text(store.work(task.key) / "out" / name, text);
        Result r;
        r.task = task.key;
        r.outputs = {{"out/", "", 0}};
        r.seconds = 2;
        store.prepare(r);
        if (how == End::published) store.publish(task.key);
        return r;
    }

    TemporaryFolder folder;
    Store store = Store::open_or_make(folder / "s");
    Batch batch = small_batch(3);
};

TEST_F(StoreTest, ResultIsThereWithItsObjectsOrNotAtAll)
{
    EXPECT_FALSE(store.result(batch.tasks[0].key));
    publish(batch.tasks[0], "a.txt", "hello");
    auto const r = store.result(batch.tasks[0].key);
    ASSERT_TRUE(r);
    ASSERT_EQ(r->outputs.size(), 1u);
    EXPECT_EQ(r->outputs[0].name, "out/a.txt");
    fs::path const object = store.object(r->outputs[0].sha256);
    EXPECT_EQ(test::file_text(object), "hello");
    EXPECT_EQ(file_sha256(object), r->outputs[0].sha256);
    EXPECT_EQ(file_sha256(object), "2cf24dba5fb0a30e26e83b2ac5b9e29e1b161e5c1fa7425e73043362938b9824");
    fs::remove(object);
    EXPECT_FALSE(store.result(batch.tasks[0].key)) << "its object is missing";
}

TEST_F(StoreTest, EveryTruncatedOrChangedResultCountsAsNone)
{
    publish(batch.tasks[0], "a.txt", "hello");
    fs::path const file = store.folder() / "results" / batch.tasks[0].key.substr(0, 2) / batch.tasks[0].key;
    std::string const whole = test::file_text(file);
    for (std::size_t n = 0; n < whole.size(); ++n) {
        gi::write_text(file, whole.substr(0, n));
        EXPECT_FALSE(store.result(batch.tasks[0].key)) << n;
        std::string changed = whole;
        changed[n] ^= 1;
        gi::write_text(file, changed);
        EXPECT_FALSE(store.result(batch.tasks[0].key)) << n;
    }
    gi::write_text(file, whole);
    EXPECT_TRUE(store.result(batch.tasks[0].key));
}

TEST_F(StoreTest, WhatWasPreparedIsPublishedLaterIfItIsWhole)
{
    std::string const whole = batch.tasks[0].key, damaged = batch.tasks[1].key, torn = batch.tasks[2].key;
    for (Task const& task : batch.tasks) publish(task, "a.txt", "text of " + task.key, End::killed_before);
    for (Task const& task : batch.tasks) ASSERT_FALSE(store.result(task.key));
    fs::path const object = store.object(gi::sha256("text of " + damaged));
    fs::permissions(object, fs::perms::owner_write, fs::perm_options::add);
    gi::write_text(object, "test of " + damaged); // as long as before
    fs::path const result = store.work(torn).string() + ".result";
    fs::resize_file(result, fs::file_size(result) - 1);
    settle_leftovers(store);
    auto const r = store.result(whole);
    ASSERT_TRUE(r);
    EXPECT_EQ(test::file_text(store.object(r->outputs.at(0).sha256)), "text of " + whole);
    EXPECT_FALSE(store.result(damaged));
    EXPECT_FALSE(store.result(torn));
    std::set<std::string> left;
    for (auto const& entry : fs::directory_iterator(store.folder() / "work")) left.insert(entry.path().filename());
    EXPECT_EQ(left, (std::set{damaged, torn})) << "folders of tasks that are not done";
    TaskJournalReader journal(store.journal());
    auto const events = journal.read();
    ASSERT_EQ(events.size(), 1u);
    EXPECT_EQ(events[0].task, whole);
    EXPECT_EQ(events[0].kind, EventKind::finished);

    publish(batch.tasks[1], "a.txt", "text of " + damaged); // as the next attempt does
    EXPECT_TRUE(store.result(damaged));
    EXPECT_EQ(test::file_text(object), "text of " + damaged);
}

TEST_F(StoreTest, WhatCannotBePublishedIsLeftAndKeepsNothingElseBack)
{
    for (Task const& task : batch.tasks) publish(task, "a.txt", "text of " + task.key, End::killed_before);
    std::string const key = batch.tasks[0].key;
    fs::path const in_the_way = store.folder() / "results" / key.substr(0, 2);
    gi::write_text(in_the_way, "");
    gi::write_text(store.folder() / "work" / std::string(64, 'z'), "no task");
    auto const failures = settle_leftovers(store);
    ASSERT_EQ(failures.size(), 1u);
    EXPECT_NE(failures[0].find("cannot keep"), std::string::npos) << failures[0];
    EXPECT_FALSE(store.result(key));
    EXPECT_TRUE(store.result(batch.tasks[1].key));
    EXPECT_TRUE(store.result(batch.tasks[2].key));

    EXPECT_THROW(work_on(store, batch, batch.tasks[0], {}, gi::StopRequest()), gi::InputError);
    std::vector<Event> failed = TaskJournalReader(store.journal()).read();
    std::erase_if(failed, [](Event const& e) { return e.kind != EventKind::failed; });
    ASSERT_EQ(failed.size(), 1u);
    EXPECT_EQ(failed[0].task, key);
    EXPECT_NE(failed[0].why.find("cannot keep"), std::string::npos) << failed[0].why;

    fs::remove(in_the_way);
    EXPECT_TRUE(settle_leftovers(store).empty());
    EXPECT_TRUE(store.result(key));
}

TEST_F(StoreTest, WithdrawnResultTakesItsNewObjectsAlong)
{
    publish(batch.tasks[0], "a.txt", "old");
    Task const& task = batch.tasks[1];
    fs::create_directories(store.work(task.key));
    gi::write_text(store.work(task.key) / "old.txt", "old");
    gi::write_text(store.work(task.key) / "new.txt", "new");
    Result r;
    r.task = task.key;
    r.outputs = {{"old.txt", "", 0}, {"new.txt", "", 0}};
    store.prepare(r);
    store.withdraw(r);
    EXPECT_TRUE(settle_leftovers(store).empty());
    EXPECT_FALSE(store.result(task.key));
    EXPECT_FALSE(fs::exists(store.object(gi::sha256("new"))));
    EXPECT_TRUE(store.result(batch.tasks[0].key)) << "it has the other one, too";
}

/// Nobody knows whether the disk has the content of a result that could not be published: others that have it too
/// count as not done, and make it again.
TEST_F(StoreTest, ContentOfAWithdrawnResultIsMadeAnewByOthersThatHaveIt)
{
    Task const &first = batch.tasks[0], &second = batch.tasks[1];
    for (bool const is_published_before : {true, false}) {
        Result const brought = publish(first, "a", "new", End::killed_before);
        publish(second, "b", "new", is_published_before ? End::published : End::killed_before);
        store.withdraw(brought);
        if (!is_published_before) store.publish(second.key);
        EXPECT_FALSE(store.result(second.key)) << "its content is gone";
        publish(second, "b", "new"); // the next attempt
        EXPECT_TRUE(store.result(second.key));
        store.forget(second.key, gi::sha256("new"));
    }
}

TEST_F(StoreTest, WhatAnotherProcessIsAboutToPublishIsLeftToIt)
{
    publish(batch.tasks[0], "a.txt", "hello", End::killed_before);
    std::string const key = batch.tasks[0].key;
    Claim claim(store.claims(), key);
    ASSERT_TRUE(claim.take());
    settle_leftovers(store);
    EXPECT_FALSE(store.result(key));
    store.publish(key);
    EXPECT_TRUE(store.result(key));
}

TEST_F(StoreTest, PlanOfABatchComesBackWholeAndByTask)
{
    batch.tasks[1].resources = {4, 2, 1 << 30};
    batch.tasks[1].limit_s = 9;
    batch.files.push_back({"f", "/f", "abc", 3, 7});
    batch.tasks[1].inputs = {0};
    std::string const id = store.keep(batch);
    EXPECT_EQ(store.batches(), std::vector<std::string>{id});
    EXPECT_EQ(text_of_batch(store.batch(id)), text_of_batch(batch));
    Batch const one = store.batch_of_task(id, 1);
    ASSERT_EQ(one.tasks.size(), 1u);
    EXPECT_EQ(one.tasks[0].key, batch.tasks[1].key);
    EXPECT_EQ(one.tasks[0].resources, batch.tasks[1].resources);
    EXPECT_THROW(store.batch_of_task(id, 3), gi::InputError);
    EXPECT_EQ(store.find_batch("b"), id);
    EXPECT_THROW(store.find_batch("c"), gi::InputError);
    std::string const text = text_of_batch(batch);
    for (std::size_t n = 0; n < text.size(); n += 7)
        EXPECT_THROW(batch_of_text(text.substr(0, n), "f"), gi::InputError) << n;
}

TEST_F(StoreTest, OtherFoldersAreRefused)
{
    EXPECT_THROW(Store::open(folder / "none"), gi::InputError);
    gi::write_text(folder / "mine.txt", "x");
    EXPECT_THROW(Store::open_or_make(folder.path()), gi::InputError);
    gi::write_text(store.folder() / "format", "batch-store/9\n");
    EXPECT_THROW(Store::open_or_make(store.folder()), gi::InputError);
}

TEST_F(StoreTest, JournalOutlivesTornLines)
{
    Event e;
    e.task = batch.tasks[0].key;
    TaskJournal(store.journal()).append(e);
    fs::path const file = fs::directory_iterator(store.journal())->path();
    std::string const line = test::file_text(file);
    for (std::size_t n = 0; n + 1 < line.size(); n += 11) { // with all but its line end it is whole
        std::ofstream(file, std::ios::binary) << line << line.substr(0, n);
        TaskJournalReader reader(store.journal());
        EXPECT_EQ(reader.read().size(), 1u) << n;
        TaskJournal(store.journal()).append(e); // on a line of its own
        EXPECT_EQ(reader.read().size(), 1u) << n;
        EXPECT_EQ(reader.damaged(), n == 0 ? 0u : 1u) << n;
        EXPECT_TRUE(reader.read().empty());
    }
}

TEST_F(StoreTest, LinesOfManyProcessesStayWhole)
{
    std::vector<pid_t> children;
    for (int p = 0; p < 4; ++p)
        if (pid_t const child = fork(); child == 0) {
            TaskJournal journal(store.journal());
            Event e;
            e.kind = EventKind::failed;
            e.task = batch.tasks[0].key;
            e.messages = std::string(std::size_t(500 * p), 'x');
            for (int i = 0; i < 100; ++i) journal.append(e);
            _exit(0);
        } else {
            children.push_back(child);
        }
    for (pid_t const child : children) waitpid(child, nullptr, 0);
    TaskJournalReader reader(store.journal());
    EXPECT_EQ(reader.read().size(), 400u);
    EXPECT_EQ(reader.damaged(), 0u);
}

TEST_F(StoreTest, ClaimBelongsToOneProcessAndEndsWithIt)
{
    Claim mine(store.claims(), key_number(1));
    EXPECT_TRUE(mine.take());
    EXPECT_FALSE(mine.is_taken_elsewhere());
    {
        Claim other(store.claims(), key_number(1)), another(store.claims(), key_number(2));
        EXPECT_TRUE(other.is_taken_elsewhere());
        EXPECT_FALSE(other.take());
        EXPECT_TRUE(another.take());
    }
    EXPECT_TRUE(Claim(store.claims(), key_number(1)).is_taken_elsewhere()) << "closing another one keeps it";
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    pid_t const child = fork();
    if (child == 0) {
        Claim theirs(store.claims(), key_number(3));
        bool const has = theirs.take();
        (void)!write(ready[1], &has, 1);
        pause();
    }
    bool has = false;
    ASSERT_EQ(read(ready[0], &has, 1), 1);
    Claim later(store.claims(), key_number(3));
    EXPECT_TRUE(has && !later.take());
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_TRUE(later.take());
}

TEST_F(StoreTest, StateIsReadFromTheStoreAlone)
{
    TaskJournal journal(store.journal());
    auto const tell = [&](int task, EventKind kind) {
        Event e;
        e.kind = kind;
        e.task = batch.tasks[std::size_t(task)].key;
        e.why = kind == EventKind::failed ? "exit code 1" : "";
        journal.append(e);
    };
    batch = small_batch(5);
    tell(0, EventKind::started);
    publish(batch.tasks[0], "a", "1");
    tell(1, EventKind::started);
    tell(1, EventKind::failed);
    tell(2, EventKind::started);
    tell(3, EventKind::started);
    tell(3, EventKind::started);
    Claim running(store.claims(), batch.tasks[2].key);
    ASSERT_TRUE(running.take());
    BatchState const s = state_of(store, batch);
    EXPECT_EQ(s.tasks[0].state, TaskState::done);
    EXPECT_EQ(s.tasks[1].state, TaskState::failed);
    EXPECT_EQ(s.tasks[1].last.why, "exit code 1");
    EXPECT_EQ(s.tasks[2].state, TaskState::running);
    EXPECT_EQ(s.tasks[3].state, TaskState::waiting) << "nobody runs it any more";
    EXPECT_EQ(s.tasks[4].state, TaskState::waiting);
    EXPECT_EQ(s.repeated, 1);
    EXPECT_EQ(seconds_left(batch, s), 4 * 2.0);
}

TEST_F(StoreTest, GatherCopiesChecksAndRefuses)
{
    publish(batch.tasks[0], "a", "1");
    publish(batch.tasks[1], "b", "2");
    Gathered g = gather(store, batch, folder / "out", Placing::copy, Existing::refuse);
    EXPECT_EQ(g.files, 2u);
    EXPECT_EQ(g.missing, 1u);
    EXPECT_EQ(test::file_text(folder / "out/g/out/b"), "2");
    publish(batch.tasks[2], "b", "2"); // the same content: one file
    g = gather(store, batch, folder / "out", Placing::copy, Existing::refuse);
    EXPECT_EQ(g.missing, 0u);
    gi::write_text(folder / "out/g/out/a", "mine");
    EXPECT_THROW(gather(store, batch, folder / "out", Placing::copy, Existing::refuse), gi::InputError);
    EXPECT_EQ(test::file_text(folder / "out/g/out/a"), "mine");
    gather(store, batch, folder / "out", Placing::link, Existing::replace);
    EXPECT_EQ(test::file_text(folder / "out/g/out/a"), "1");
    EXPECT_EQ(fs::hard_link_count(folder / "out/g/out/a"), 2u);
}

TEST_F(StoreTest, GatherForgetsWhatIsDamaged)
{
    publish(batch.tasks[0], "a", "12345");
    fs::path const object = store.object(store.result(batch.tasks[0].key)->outputs[0].sha256);
    fs::permissions(object, fs::perms::owner_write, fs::perm_options::add);
    std::ofstream(object, std::ios::binary) << "12346";
    Gathered const g = gather(store, batch, folder / "out", Placing::copy, Existing::refuse);
    EXPECT_EQ(g.damaged, std::vector<std::string>{"g n=0: out/a"});
    EXPECT_EQ(g.missing, 3u);
    EXPECT_FALSE(fs::exists(folder / "out/g/out/a"));
    EXPECT_FALSE(store.result(batch.tasks[0].key));
    publish(batch.tasks[0], "a", "12345"); // as resuming does
    EXPECT_EQ(gather(store, batch, folder / "out", Placing::copy, Existing::refuse).files, 1u);
}

TEST_F(StoreTest, TwoDifferentFilesOfOneNameAreRefused)
{
    publish(batch.tasks[0], "a", "1");
    publish(batch.tasks[1], "a", "2");
    EXPECT_THROW(gather(store, batch, folder / "out", Placing::copy, Existing::refuse), gi::InputError);
}

TEST(MergedTable, RowsBeginWithTheParametersOfTheirTask)
{
    Task t;
    t.group = "g";
    t.parameters = {{"scene", "a, b"}, {"paths", "4"}};
    MergedTable table("all.csv");
    EXPECT_TRUE(table.takes("x/y.csv"));
    EXPECT_FALSE(table.takes("x/y.json"));
    table.add(t, "t.csv", "x,y\r\n1,\"two\nlines\"\r\n3,4");
    t.parameters = {{"scene", "c"}, {"paths", "1"}};
    table.add(t, "t.csv", "x,y\n5,6\n");
    EXPECT_EQ(table.text(), "scene,paths,x,y\n\"a, b\",4,1,\"two\nlines\"\n\"a, b\",4,3,4\nc,1,5,6\n");
    EXPECT_THROW(table.add(t, "t.csv", "x,z\n5,6\n"), gi::InputError);
}

TEST(MergedTable, JsonBecomesLines)
{
    Task t;
    t.parameters = {{"n", "1"}};
    MergedTable table("all.jsonl");
    EXPECT_TRUE(table.takes("y.json"));
    table.add(t, "a.json", "{\n \"x\": [1, 2],\n \"n\": 5}\n");
    table.add(t, "a.jsonl", "{\"x\":1}\n{\"x\":2}\n");
    EXPECT_EQ(table.text(),
              "{\"n\":\"1\",\"x\":[1,2],\"result_n\":5}\n{\"n\":\"1\",\"x\":1}\n{\"n\":\"1\",\"x\":2}\n");
    EXPECT_THROW(table.add(t, "a.json", "[1]"), gi::InputError);
}

} // namespace
} // namespace viewer::batch
