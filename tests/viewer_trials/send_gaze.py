"""Sends a gaze stream as an eye tracker does: normalised places on the display, 250 Hz, until it is ended."""

import time

import pylsl

info = pylsl.StreamInfo("Tobii-like", "Gaze", 4, 250, "float32", "eyes")
channels = info.desc().append_child("channels")
for label in ["left_gaze_point_on_display_area_0", "left_gaze_point_on_display_area_1", "left_pupil_diameter", "validity"]:
    channel = channels.append_child("channel")
    channel.append_child_value("label", label)
outlet = pylsl.StreamOutlet(info)
start, n = pylsl.local_clock(), 0
while True:
    n += 1
    while pylsl.local_clock() < start + n / 250:
        time.sleep(0.001)
    outlet.push_sample([0.5, 0.5, 3.2, 0.0 if n % 50 == 0 else 1.0], start + n / 250)
