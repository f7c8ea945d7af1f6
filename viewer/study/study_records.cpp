#include "viewer/study/study_records.h"

#include "gi/core/durable_file.h"
#include "study/tables/bids.h"
#include "viewer/base/version.h"

#include <fmt/format.h>

namespace viewer {

study::Dataset load_records(std::string const& dir, std::string const& script)
{
    study::Dataset records = study::read_dataset(dir, script);
    for (std::string const& remark : records.remarks) std::fputs((remark + "\n").c_str(), stderr);
    return records;
}

void write_files(std::filesystem::path const& folder, std::vector<study::TextFile> const& files)
{
    for (study::TextFile const& f : files) {
        std::filesystem::path const file = folder / f.path;
        gi::make_folder(file.parent_path());
        gi::write_durably(file, f.text);
    }
}

int rebuild_tables(std::filesystem::path const& dir, study::Dataset const& records)
{
    std::vector<study::TextFile> files = study::dataset_files(records.script, records.sessions, version_number());
    for (study::RecordedSession const& session : records.sessions) {
        for (study::TextFile& f : study::session_files(records.script, session)) files.push_back(std::move(f));
        for (study::TextFile& f : gaze_files(dir, records.script, session)) files.push_back(std::move(f));
    }
    auto const script = study::kept_script(dir, records.script).lexically_relative(dir);
    files.push_back({script.generic_string(), records.script_text});
    write_files(dir, files);
    return int(files.size());
}

} // namespace viewer
