// Any bytes as what is measured for experiments: display models, readings, photodiodes, gaze. Each is read, or
// refused with one line. A display model that is read gives the same text again.

#include "gi/core/error.h"
#include "study/display/luminance_fit.h"
#include "study/display/model_file.h"
#include "study/signals/gaze.h"
#include "study/signals/photodiode.h"

#include <cstdlib>

namespace {

template <class Read>
void read_or_refuse(Read const& read)
{
    try {
        read();
    } catch (gi::InputError const& e) {
        if (std::string(e.what()).find('\n') != std::string::npos) std::abort();
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    std::string const text(reinterpret_cast<char const*>(data), size);
    read_or_refuse([&] {
        study::DisplayModel const m = study::parse_display_model(text, "fuzz");
        std::string const again = study::display_model_text(m);
        if (study::display_model_text(study::parse_display_model(again, "again")) != again) std::abort();
        if (m.luminance)
            for (int c = 0; c < 3; ++c)
                if (double const v = study::value_of_share(*m.luminance, c, 0.3); !(v >= 0 && v <= 1))
                    std::abort();
    });
    read_or_refuse([&] { study::fit_luminance(study::read_readings(text, "fuzz"), {}); });
    read_or_refuse([&] { study::read_wav(text, "fuzz"); });
    read_or_refuse([&] { study::summarise(study::read_gaze_csv(text, "fuzz")); });
    read_or_refuse([&] {
        study::DiodeSignal const s = study::read_diode_csv(text, "fuzz");
        study::find_flashes(s.time_s, s.light, 5);
    });
    return 0;
}
