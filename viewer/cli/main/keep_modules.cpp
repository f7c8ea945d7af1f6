// Of programs with sanitizers: modules stay loaded. LeakSanitizer looks at the end, when memory that only an
// unloaded driver pointed to would be a leak without names. It also hides faults of our own dlclose.

extern "C" int dlclose(void*) { return 0; }
