// Any text as the journal of a batch: events and damaged lines, together as many as there are lines that are not
// empty. Lines get the checksum that fits them, or nothing would pass it.

#include "gi/core/checked_line.h"
#include "viewer/batch/journal.h"

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <unistd.h>

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    namespace fs = std::filesystem;
    fs::path const folder = fs::temp_directory_path() / ("batch_journal_fuzz_" + std::to_string(getpid()));
    fs::create_directory(folder);
    std::string text;
    std::size_t lines = 0;
    std::istringstream in(std::string(data, data + size));
    for (std::string line; std::getline(in, line);) {
        bool const is_object = line.starts_with('{') && line.ends_with('}') && line.size() > 2;
        text += (is_object ? gi::checked_line(line) : line) + "\n";
        lines += !line.empty();
    }
    std::ofstream(folder / "machine.jsonl", std::ios::binary) << text;
    viewer::batch::TaskJournalReader reader(folder);
    std::size_t const events = reader.read().size();
    if (events + reader.damaged() != lines) std::abort();
    if (!reader.read().empty()) std::abort();
    fs::remove_all(folder);
    return 0;
}
