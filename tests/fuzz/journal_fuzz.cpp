// Any text as a journal: entries or a ScriptError, never anything else.
// Lines get the checksum that fits them, or nothing would pass it. What was read is written as the same entries,
// and a session takes them up or says why it cannot.

#include "gi/core/crc32.h"
#include "study/journal/entry_line.h"
#include "study/journal/journal_file.h"
#include "study/journal/moments.h"
#include "study/journal/session_summary.h"
#include "study/run/progress.h"
#include "study/script/script_error.h"
#include "study/script/script_file.h"

#include <cstdio>
#include <cstdlib>

namespace {

study::Script const& script()
{
    static study::Script const s = study::parse_script(R"(
schema: study/1
id: t
seed: 5
participants: {count: 2}
factors: {quality: {many: {n: 9}}}
reference: {quality: many}
sequence: [{questionnaire: sus_presence}, n]
blocks:
  n:
    task: 2ifc
    prompt: p
    instructions: i
    stimulus_ms: 100
    compare: {vary: n, scale: log2, range: [1, 64], harder: up}
    interleave:
      - {name: s, method: staircase, up: 1, down: 2, start: 8, steps: 1, stop: {max_trials: 6}}
      - {name: q, method: questplus, threshold: [1, 8, 64], slope: 2, guess: 0.5, lapse: 0.02, stop: {trials: 4}}
    practice: {trials: 2}
)",
                                                       "fuzz");
    return s;
}

std::string summed(std::string_view text)
{
    std::string out;
    for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string_view::npos; at = end + 1) {
        std::string_view const line = text.substr(at, end - at);
        char sum[32];
        std::snprintf(sum, sizeof sum, ",\"crc32\":\"%08x\"}", gi::crc32(line));
        out += std::string(line) + sum + "\n";
    }
    return out + std::string(text.substr(text.rfind('\n') == std::string_view::npos ? 0 : text.rfind('\n') + 1));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const raw(reinterpret_cast<char const*>(data), size);
    for (std::string const& text : {raw, summed(raw)}) {
        try {
            study::JournalText const journal = study::parse_journal(text, "fuzz");
            if (journal.good_bytes + journal.torn_bytes + journal.room_bytes != text.size()) std::abort();
            std::string written;
            int n = 0;
            for (study::JournalEntry const& e : journal.record.entries) written += entry_line(e, ++n) + "\n";
            std::string again;
            n = 0;
            for (study::JournalEntry const& e : study::parse_journal(written, "fuzz").record.entries)
                again += entry_line(e, ++n) + "\n";
            if (written != again) std::abort();
            study::session_summary(journal.record);
            study::last_unix_time(journal.record);
            study::Plan const plan = make_plan(script(), 1);
            study::Progress progress(script(), plan);
            for (study::JournalEntry const& e : journal.record.entries) {
                progress.apply(e);
                progress.next();
            }
        } catch (gi::InputError const& e) {
            if (std::string(e.what()).find('\n') != std::string::npos) std::abort();
        } catch (std::invalid_argument const&) {
        }
    }
    return 0;
}
