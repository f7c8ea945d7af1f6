#include "study/observers/simulate.h"

#include "gi/core/durable_file.h"
#include "gi/core/file.h"
#include "study/journal/journal_file.h"
#include "study/journal/moments.h"
#include "study/observers/model_presenter.h"
#include "study/script/script_error.h"

#include <chrono>

namespace study {

namespace fs = std::filesystem;

fs::path truth_file(fs::path const& dir) { return dir / "sourcedata" / "simulation" / "truth.json"; }

void keep_truth(fs::path const& dir, std::string const& truth)
{
    fs::path const file = truth_file(dir);
    std::error_code ignored;
    if (!fs::exists(file, ignored)) {
        gi::make_folder(file.parent_path());
        gi::write_durably(file, truth);
    } else if (gi::read_text(file) != truth) {
        throw ScriptError(file.string(), {}, "other observers answered in this folder",
                          "a folder has one set of true parameters for reports",
                          "use the same observers and seed, or another folder");
    }
}

SessionOutcome simulate_session(Script const& script, int participant, Observer const& observer,
                                SessionSettings settings, double gap_s)
{
    ModelPresenter presenter(observer);
    auto const now = std::chrono::system_clock::now().time_since_epoch();
    double start_s = std::chrono::duration<double>(now).count();
    fs::path const journal =
        session_folder(settings.dir, participant_id(script, participant), settings.session) / "journal.jsonl";
    std::error_code ignored;
    if (settings.start == SessionStart::go_on && fs::exists(journal, ignored))
        if (auto const last = last_unix_time(read_journal(journal).record)) start_s = *last + gap_s;
    settings.is_simulated = true;
    double calibrated_s = -1; // clock at the first call, where the gap ends
    settings.unix_s = [&] {
        if (calibrated_s < 0) calibrated_s = presenter.now();
        return start_s + presenter.now() - calibrated_s;
    };
    return run_session(script, participant, presenter, settings);
}

} // namespace study
