#pragma once
// A folder with the real lightwell-batch and, as `lightwell`, a shell script: its tasks take as long as a test
// wants, and write down each start.

#include "tests/viewer/run_program.h"

#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

namespace viewer::test {

/// `lightwell render N S` sleeps S seconds and writes out-N.txt, whose text depends on N alone. Further words:
/// see the script.
constexpr char const* kScript = R"(#!/bin/sh
echo "$2 $$" >> "$STARTS"
case "$4" in
  fail_once) if [ $(grep -c "^$2 " "$STARTS") -lt 2 ]; then echo "not yet" >&2; exit 1; fi ;;
  fail) echo "it cannot" >&2; exit 1 ;;
  wrong) echo "wrong input" >&2; exit 2 ;;
  segv) kill -SEGV $$ ;;
  hang) sleep 100 ;;
  eat) exec python3 -c 'x = bytearray(400 << 20); import time; time.sleep(100)' ;;
  nothing) exit 0 ;;
  links) cat data/in.txt > out-$2.txt; exit $? ;;
  ranks) echo "${OMPI_COMM_WORLD_SIZE:-none}" > out-$2.txt; exit 0 ;;
  cores) nproc > out-$2.txt; exit 0 ;;
  talk) seq 1 100000 >&2 ;;
  lost) echo "lost: triangles: 3" >&2 ;;
esac
sleep "$3"
seq "$2" $(($2 + 200)) > out-$2.txt
printf 'frame,value\n%s,1\n%s,2\n' "$2" "$2" > table-$2.csv
echo "{\"n\": $2}"
)";

class FakePrograms {
public:
    FakePrograms()
    {
        std::filesystem::create_directory(folder_ / "bin");
        std::filesystem::copy_file(LIGHTWELL_BATCH, folder_ / "bin/lightwell-batch");
        write("bin/lightwell", kScript);
        std::filesystem::permissions(folder_ / "bin/lightwell", std::filesystem::perms::owner_all);
        setenv("STARTS", (folder_ / "starts").c_str(), 1);
        setenv("LIGHTWELL_TEST_PROGRAM", (folder_ / "bin/lightwell-batch").c_str(), 1);
        write("starts", "");
    }
    ~FakePrograms() { unsetenv("LIGHTWELL_TEST_PROGRAM"); }

    std::filesystem::path const& folder() const { return folder_.path(); }
    std::filesystem::path operator/(std::string const& name) const { return folder_ / name; }
    void write(std::string const& name, std::string const& text) const
    {
        std::filesystem::create_directories((folder_ / name).parent_path());
        std::ofstream(folder_ / name, std::ios::binary) << text;
    }
    Outcome run(std::string const& arguments, std::chrono::seconds limit = kProgramLimit) const
    {
        return test::run(arguments, folder_.path(), limit);
    }
    /// How often each task was started.
    std::map<int, int> starts() const
    {
        std::map<int, int> n;
        std::istringstream in(file_text(folder_ / "starts"));
        for (std::string line; std::getline(in, line);)
            if (!line.empty()) ++n[std::stoi(line)];
        return n;
    }
    /// A sweep of tasks 1..count that take some seconds each. @param how further keys of the sweep
    void sweep(int count, double seconds, std::string const& word = "", std::string const& how = "") const
    {
        write("m.yaml",
              fmt::format("batch: m\nsweeps:\n  s:\n    command: render {{n}} {} {}\n    over: {{n: 1..{}}}\n"
                          "    outputs: [\"out-{{n}}.txt\"]\n{}",
                          seconds, word, count, how));
    }

private:
    TemporaryFolder folder_;
};

template <class Condition>
bool wait_until(Condition const& condition)
{
    auto const end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!condition() && std::chrono::steady_clock::now() < end)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    return condition();
}

inline nlohmann::json json_of(Outcome const& o)
{
    auto const j = nlohmann::json::parse(o.out, nullptr, false);
    EXPECT_FALSE(j.is_discarded()) << o.out << o.err;
    return j;
}

} // namespace viewer::test
