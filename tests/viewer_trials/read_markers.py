"""Reads markers of a Lab Streaming Layer stream until a file named `stop` appears; a JSON line for each.

Usage: read_markers.py OUT STOP
"""

import json
import os
import sys

import pylsl

out, stop = sys.argv[1:3]
with open(out, "w") as lines:
    streams = pylsl.resolve_byprop("name", "Lightwell", timeout=60)
    inlet = pylsl.StreamInlet(streams[0])
    inlet.open_stream(timeout=20)
    info = inlet.info(timeout=20)
    about = {
        "type": info.type(),
        "participant": info.desc().child_value("participant"),
        "experiment": info.desc().child_value("experiment"),
        "correction_s": inlet.time_correction(timeout=20),
    }
    print(json.dumps(about), file=lines, flush=True)
    while os.path.exists(os.path.dirname(stop)) and not os.path.exists(stop):
        sample, time = inlet.pull_sample(timeout=0.2)
        if sample is not None:
            print(json.dumps({"time": time, "now": pylsl.local_clock(), "event": json.loads(sample[0])}), file=lines, flush=True)
