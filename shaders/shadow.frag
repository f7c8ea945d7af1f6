// Depth alone (viewer/devices/gl/shadow_maps.h); what covers less than half of what is behind it casts no shadow.

void main()
{
#if MASKED
    if (coverage() < (more.y > 0.0 ? more.y : 0.5)) discard;
#endif
}
