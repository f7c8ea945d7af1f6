#include "gi/methods/whitted/whitted.h"

namespace gi {
namespace {

template <class T>
RenderOption ray_trees(char const* name, OptionValues values, char const* meaning, T WhittedSettings::*member)
{
    return {make_option<RenderSettings>(
                name, std::move(values), meaning, [member](auto& s) -> auto& { return s.template of<WhittedSettings>().*member; }),
            "Ray trees",
            {"whitted", "sh_grid", "ispm", "lpv", "isllpm", "multi_image"}};
}

} // namespace

RenderOptionTable const& whitted_options()
{
    using W = WhittedSettings;
    static RenderOptionTable const all{
        ray_trees("recursion", {0, 1000}, "mirrors and glass along a ray tree; rays beyond are cut and counted",
                  &W::recursion),
        ray_trees("cutoff", {0, 1}, "rays that would contribute less than this share are cut and counted",
                  &W::cutoff),
        ray_trees("shadow-rays", {1, 1024}, "light samples at a surface seen directly; in mirrors and glass one",
                  &W::light_samples)};
    return all;
}

} // namespace gi
