#pragma once
// One file of the tables, or of the lines of JSON, that tasks made;
// each row begins with the parameters of its task.

#include "viewer/batch/task.h"

namespace viewer::batch {

class MergedTable {
public:
    /// @param file its ending decides what is joined: .csv and .tsv take files of the same ending, .jsonl those
    /// that end with .json (an object each, which becomes a line) or .jsonl
    explicit MergedTable(std::string const& file);

    bool takes(std::string const& output) const;
    /// @throws InputError a table has other columns than the first one, or a line is no JSON object
    void add(Task const& task, std::string const& output, std::string const& text);
    std::string const& text() const { return text_; }

private:
    void add_rows(Task const& task, std::string const& output, std::string_view text);
    void add_objects(Task const& task, std::string const& output, std::string_view text);

    std::string ending_, columns_, text_;
};

} // namespace viewer::batch
