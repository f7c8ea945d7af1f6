#include "viewer/bench/pictures_filtered.h"

#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "gi/metrics/compare.h"
#include "viewer/report/measure.h"

namespace viewer {

FilteredPicture filtered(gi::Picture picture, PictureFilter const& filter)
{
    FilteredPicture f{std::move(picture)};
    if (filter.settings.denoiser == gi::Denoiser::none) return f;
    f.seconds = seconds_of([&] { f.no_variance = gi::denoise(f.picture, filter.settings).no_variance; });
    return f;
}

PictureFiles save_pictures(gi::Picture const& picture, SweepReference const& reference,
                           std::filesystem::path const& folder, std::string const& stem)
{
    PictureFiles const files{stem + ".png", stem + "_flip.png"};
    int width = 0, height = 0;
    auto const difference = gi::difference_image(picture, reference.picture, "color", width, height);
    gi::write_png(folder / files.flip_map, width, height, difference);
    gi::write_png(folder / files.picture, picture.width, picture.height,
                  gi::tone_map_bytes(*picture.find("color"), {}));
    return files;
}

} // namespace viewer
