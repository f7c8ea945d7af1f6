#pragma once
// The dialog "open scene", drawn in the panel's window: built-in and recent scenes, and files in folders.

#include "viewer/app/recent_scenes.h"

#include <optional>

namespace viewer {

/// Entries of a folder: its folders, then files of formats that load_scene reads, each sorted by name.
struct FolderContents {
    std::vector<std::string> folders, files;
    bool cut = false;    ///< it has more than are listed
    std::string problem; ///< why it cannot be read; empty = it can
};
FolderContents contents_of(std::filesystem::path const& folder);

class OpenDialog {
public:
    explicit OpenDialog(RecentScenes recent = RecentScenes()) : recent_(std::move(recent)) {}

    bool is_open() const { return open_; }
    /// Opens it at the folder of this scene, or closes it.
    void toggle(std::string const& scene);
    /// Draws it between Panel::begin and finish, if it is open.
    /// @return the scene that the user chose; choosing closes the dialog
    std::optional<std::string> draw();
    RecentScenes const& recent() const { return recent_; }

private:
    void go_to(std::filesystem::path const& folder);

    RecentScenes recent_;
    bool open_ = false;
    std::filesystem::path folder_;
    FolderContents contents_;
    std::vector<std::string> recently_, built_in_;
    std::string filter_;
};

} // namespace viewer
