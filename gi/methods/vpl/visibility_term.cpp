#include "gi/methods/vpl/imperfect_term.h"
#include "gi/methods/vpl/layer_term.h"
#include "gi/methods/vpl/ray_terms.h"

namespace gi {

std::unique_ptr<VisibilityTerm> make_term(VisibilityKind kind, TermSource const& source)
{
    float const radius_m = source.settings.of<VirtualLightSettings>().ao_radius_m;
    switch (kind) {
    case VisibilityKind::exact:
        return std::make_unique<RayTerm>(source.visibility, kInf);
    case VisibilityKind::slhb:
        return std::make_unique<LayerTerm>(source);
    case VisibilityKind::imperfect:
        return std::make_unique<ImperfectTerm>(source);
    case VisibilityKind::ambient:
        return std::make_unique<AmbientTerm>(source.visibility, radius_m);
    case VisibilityKind::directional:
        return std::make_unique<RayTerm>(source.visibility, radius_m);
    case VisibilityKind::none:
        break;
    }
    return std::make_unique<VisibilityTerm>();
}

} // namespace gi
