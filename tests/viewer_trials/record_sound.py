"""Records a PulseAudio sink's monitor as `t_s,sound`, by the steady clock.

A sample's time is the least difference between its place in the stream and the time at which it was read, over the whole
recording: what it was late by (the sound server's blocks, this process's turn) is not in it, but for its least value.
Usage: record_sound.py FILE; ends with SIGINT.
"""

import os
import signal
import struct
import subprocess
import sys
import time

RATE_HZ = 48000

data, starts, stopping = bytearray(), [], []
signal.signal(signal.SIGINT, lambda *_: stopping.append(1))
recorder = subprocess.Popen(
    ["parec", "-d", "test.monitor", "--format=float32le", f"--rate={RATE_HZ}", "--channels=1", "--raw", "--latency-msec=5"],
    stdout=subprocess.PIPE,
    start_new_session=True,
)
assert recorder.stdout is not None
while not stopping:
    some = os.read(recorder.stdout.fileno(), 1 << 16)
    if not some:
        break
    data += some
    starts.append(time.monotonic() - len(data) / 4 / RATE_HZ)
recorder.kill()
start_s = min(starts[len(starts) // 10 :])
with open(sys.argv[1] + ".part", "w") as out:
    out.write("t_s,sound\n")
    for i, (value,) in enumerate(struct.iter_unpack("<f", data[: len(data) // 4 * 4])):
        out.write(f"{start_s + i / RATE_HZ:.6f},{value:.5f}\n")
os.rename(sys.argv[1] + ".part", sys.argv[1])
