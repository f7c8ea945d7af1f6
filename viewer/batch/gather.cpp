#include "viewer/batch/gather.h"

#include "gi/core/durable_file.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/batch/file_hash.h"
#include "viewer/batch/merge.h"

#include <algorithm>
#include <map>

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;

class Gatherer {
public:
    Gatherer(Store const& store, Batch const& batch, fs::path const& folder, Placing placing, Existing existing)
        : store_(store), batch_(batch), folder_(folder), placing_(placing), existing_(existing)
    {
    }

    Gathered run()
    {
        for (Task const& task : batch_.tasks) {
            auto const result = store_.result(task.key);
            if (!result) {
                ++out_.missing;
                continue;
            }
            bool all_placed = true;
            for (Output const& output : result->outputs) all_placed = place(task, output) && all_placed;
            if (!all_placed) {
                ++out_.missing;
                continue;
            }
            ++out_.tasks;
            for (Merge const& merge : batch_.merges)
                if (merge.group == task.group) add_to(merge, task, *result);
        }
        for (auto const& [file, table] : tables_) {
            gi::make_folder(file.parent_path());
            std::error_code none;
            if (existing_ == Existing::refuse && fs::exists(file, none) && gi::read_text(file) != table.text())
                refuse(file);
            gi::write_text(file, table.text());
            out_.merged.push_back(file.string());
        }
        return out_;
    }

private:
    [[noreturn]] static void refuse(fs::path const& file)
    {
        throw gi::InputError("'" + file.string() + "' has another content", "it would be replaced",
                             "choose another folder, or add --replace");
    }

    bool place(Task const& task, Output const& output)
    {
        fs::path const to = folder_ / task.group / output.name, from = store_.object(output.sha256);
        auto const [known, is_new] = placed_.emplace(to, output.sha256);
        if (!is_new && known->second != output.sha256)
            throw gi::InputError("two tasks made different files '" + output.name + "'",
                                 "one is of " + title_of(task), "name their outputs differently in the manifest");
        if (!is_new) return true;
        if (file_sha256(from) != output.sha256) {
            out_.damaged.push_back(title_of(task) + ": " + output.name);
            store_.forget(task.key, output.sha256);
            return false;
        }
        ++out_.files;
        std::error_code none;
        if (fs::exists(to, none)) {
            if (fs::is_regular_file(to, none) && file_sha256(to) == output.sha256) return true;
            if (existing_ == Existing::refuse) refuse(to);
        }
        gi::make_folder(to.parent_path());
        gi::write_by_rename(to, [&](fs::path const& temporary) {
            std::error_code cannot_link;
            if (placing_ == Placing::link) {
                fs::remove(temporary);
                fs::create_hard_link(from, temporary, cannot_link);
            }
            if (placing_ == Placing::copy || cannot_link) { // another disk
                fs::copy_file(from, temporary, fs::copy_options::overwrite_existing);
                fs::permissions(temporary, fs::perms::owner_write, fs::perm_options::add);
            }
        });
        return true;
    }

    void add_to(Merge const& merge, Task const& task, Result const& result)
    {
        auto const at = tables_.try_emplace(folder_ / merge.group / merge.file, merge.file).first;
        // In a folder with several tables, the table with the merged one's name.
        bool const is_named = std::ranges::any_of(
            result.outputs, [&](Output const& o) { return fs::path(o.name).filename() == merge.file; });
        for (Output const& output : result.outputs)
            if (is_named ? fs::path(output.name).filename() == merge.file : at->second.takes(output.name))
                at->second.add(task, output.name, gi::read_text(store_.object(output.sha256)));
    }

    Store const& store_;
    Batch const& batch_;
    fs::path folder_;
    Placing placing_;
    Existing existing_;
    Gathered out_;
    std::map<fs::path, std::string> placed_; ///< hashes
    std::map<fs::path, MergedTable> tables_;
};

} // namespace

Gathered gather(Store const& store, Batch const& batch, fs::path const& folder, Placing placing, Existing existing)
{
    return Gatherer(store, batch, folder, placing, existing).run();
}

} // namespace viewer::batch
