#include "viewer/displays/calibration.h"

#include "viewer/displays/import_common.h"

#include <algorithm>
#include <fmt/format.h>

namespace viewer {

Display display_of(std::vector<CalibratedProjector> projectors, std::string const& file, ImportLog const& log)
{
    Display d;
    std::vector<gi::dvec3> eyes;
    int x_px = 0;
    for (CalibratedProjector& p : projectors) {
        DisplayWindow window;
        window.name = free_name(d.windows, p.wall.name);
        window.width_px = p.size_px.x;
        window.height_px = p.size_px.y;
        window.x_px = x_px;
        window.borders = false;
        x_px += p.size_px.x;
        auto const eye = std::ranges::find(eyes, p.eye_m);
        p.wall.user = int(eye - eyes.begin());
        if (eye == eyes.end()) {
            User user;
            user.name = free_name(d.users, "eye");
            user.head.translation_m = p.eye_m;
            eyes.push_back(p.eye_m);
            d.users.push_back(user);
        }
        p.wall.window = int(d.windows.size());
        p.wall.name = free_name(d.walls, p.wall.name);
        d.windows.push_back(window);
        d.walls.push_back(std::move(p.wall));
    }
    if (!projectors.empty())
        log.lose("the calibration does not say where its windows are: taken as side by side, drawn by one process",
                 1, file);
    return finished(std::move(d), file, log);
}

} // namespace viewer
