"""Which of the compiled modules this processor runs: wheels and packages have one for each level of x86-64 in a folder of its own."""

from __future__ import annotations

import os

_SECOND = {"sse4_2", "popcnt"}
_THIRD = _SECOND | {"avx2", "bmi1", "bmi2", "fma", "movbe", "f16c", "abm"}
_FOURTH = _THIRD | {"avx512f", "avx512bw", "avx512cd", "avx512dq", "avx512vl"}
LEVELS = {"x86-64-v4": _FOURTH, "x86-64-v3": _THIRD, "x86-64-v2": _SECOND}  # best first; gi/core/processor_level.cpp


def _features() -> set[str]:
    """What the processor has, as Linux says."""
    with open("/proc/cpuinfo") as lines:
        for line in lines:
            if line.startswith("flags"):
                return set(line.split(":", 1)[1].split())
    return set()


def folders(package: str) -> list[str]:
    """The folder of the best level that runs here, or of the one in the environment variable LIGHTWELL_LEVEL; none where
    the package has no such folder, as one built for this machine."""
    forced = os.environ.get("LIGHTWELL_LEVEL", "")
    if forced and forced not in LEVELS:
        raise ImportError(f"LIGHTWELL_LEVEL={forced} (there is no such level of processors) choose {', '.join(LEVELS)}")
    features = _features()
    if forced and not LEVELS[forced] <= features:
        raise ImportError(f"LIGHTWELL_LEVEL={forced} (this machine's processor is of a lower level) choose that, or unset it")
    for level in [forced] if forced else LEVELS:
        folder = os.path.join(package, level)
        if LEVELS[level] <= features and os.path.isdir(folder):
            return [folder]
    if not _SECOND <= features and any(os.path.isdir(os.path.join(package, level)) for level in LEVELS):
        raise ImportError("lightwell's modules are for processors of the level x86-64-v2 or higher (this machine's is of a lower one)")
    return []


def check(level: str) -> None:
    """Says so if the module is not of the level that LIGHTWELL_LEVEL asks for."""
    forced = os.environ.get("LIGHTWELL_LEVEL") or level
    if forced != level:
        raise ImportError(f"LIGHTWELL_LEVEL={forced} (this installation has no module for it) choose {level}, or unset it")
