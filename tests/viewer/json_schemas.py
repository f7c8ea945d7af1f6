"""What commands print with --json, and files of --stats, against the schemas of docs/schemas.

json_schemas.py PROGRAM SCHEMAS WORK: SCHEMAS is the folder of the schemas, WORK is an empty folder. Prints a line for each call;
exit code 1 if an output and its schema differ, if a command with --json has no call here, or if a schema has a key without a
description. Calls that need a display or a headset are skipped, visibly, where there is none.
"""

import atexit
import functools
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

import jsonschema

PROGRAM, SCHEMAS, WORK = sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[3])
failures = []


@dataclass
class Call:
    arguments: str
    schema: str
    codes: tuple = (0,)  # exit codes that are right
    file: str = ""  # that holds the JSON, instead of stdout
    before: tuple = ()  # calls that make its inputs
    needs: str = ""  # "display", or "headset"


EXAMPLES = tuple(f"study example {name} --out {name}.yaml" for name in ("visibility2026", "pairs", "staircase", "rating"))
BENCH = "--size 16x16 --reference-paths 4 --json --out"
CALLS = [
    Call("render cornell --size 16x16 --paths 4 --out one.exr --quiet --json --stats one.json", "render"),
    Call("render cornell --size 16x16 --paths 1 --out eye.exr --eye left --screen-distance 2 --time 0 --quiet --stats eye.json", "render",
         file="eye.json"),
    Call("render cornell --size 16x16 --frames 0:3@10 --paths 2 --out f_%04d.exr --quiet --json", "render"),
    Call("render cornell --size 16x16 --frames 0:3@10 --paths 2 --out f_%04d.exr --quiet --json --resume", "render"),
    Call("render atrium --method paths --size 16x16 --frames 0:2@24 --reuse 16 --paths 1 --out r_%04d.exr --quiet --json", "render"),
    Call("compare one.exr one.exr --json", "compare"),
    Call("compare one.exr eye.exr --fail-above rmse=0 --json", "compare", codes=(1,)),
    Call("info cornell --json", "info"),
    Call("info atrium --json --time 0.5", "info"),
    Call("info lit.yaml --json", "info", before=("generate avatar --out avatar.glb", "generate sky --size 64x32 --out sky.exr")),
    Call("info --settings --json", "info_settings"),
    Call("info --directions icosahedron:80 --png directions.png --json", "info_directions"),
    Call(f"bench sweep --scene cornell --methods reference --budgets 20ms --repeats 2 {BENCH} sweep", "bench_table"),
    Call(f"bench pictures --scenes cornell --methods reference,paths --budgets 1path,20ms --repeats 1 {BENCH} pictures", "bench_pictures"),
    Call(f"bench dynamic --triangles 2000 --frames 3 {BENCH} dynamic", "bench_table"),
    Call("bench raster --meshes 20 --samples 2000 --triangles 2000 --repeats 1 --json --out raster", "bench_table"),
    Call("bench rays --scene cornell --directions icosahedron:80 --hit-buffer 64 --repeats 2 --json --out rays", "bench_table"),
    Call("bench accuracy --scene cornell --directions icosahedron:80 --hit-buffers 32 --seeds 2 --paths 8 --direction-paths 8 "
         f"{BENCH} accuracy", "bench_table"),
    Call("bench thesis --tables 6.1,6.5 --size 16 --paths 2 --most-triangles 2000 --reference-paths 8 --json --out thesis", "bench_table"),
    Call(f"bench views --scene cornell --frames 8 {BENCH} views", "bench_table"),
    Call("bench schedules --schedules stored/16 --set directions=icosahedron:80 --set resolution=32 --paths 1 --frames 8 --judged 1 "
         f"{BENCH} schedules", "bench_table"),
    Call("study plan visibility2026.yaml --json", "study_plan", before=EXAMPLES),
    Call("study plan staircase.yaml --json --display-model model.yaml", "study_plan",
         before=("study calibrate --luminance readings.csv --screen 1000x700 --width-cm 30 --height-cm 21 --distance-cm 57.3 --out model.yaml",)),
    Call("study check pairs.yaml --no-render --json", "study_check"),
    Call("study check wrong.yaml --json", "study_check", codes=(2,)),
    Call("study simulate pairs.yaml --participants 1..6 --out pairs --json", "study_simulate"),
    Call("study simulate staircase.yaml --participants 1..2 --out staircase --json", "study_simulate"),
    Call("study simulate rating.yaml --participants 1..3 --out rating --json", "study_simulate"),
    Call("study analyze pairs --replicates 100 --json", "study_analyze"),
    Call("study analyze staircase --replicates 100 --draws 0 --json", "study_analyze"),
    Call("study analyze rating --replicates 100 --json --out results", "study_analyze", file="results/analysis.json"),
    Call("study analyze --gaze gaze.csv --display-model screen.yaml --json --out looked", "study_analyze_gaze"),
    Call("study analyze --gaze gaze.csv --display-model screen.yaml --gaze-method idt --out looked", "study_analyze_gaze", file="looked/gaze.json"),
    Call("study power pairs.yaml --block better --test none-wide --participants 6 --effects 0,1 --simulations 4 --json", "study_power"),
    Call("study photodiode diode.csv --session rating/sub-P001/ses-01/beh --clock session --json", "study_photodiode"),
    Call("study run pairs.yaml --participant 1 --dir run --size 64x48 --json", "study_run", codes=(1,), needs="display"),
    Call("display check cave4.yaml --json", "display_check", before=("display example cave4.yaml --out cave4.yaml",)),
    Call("display check room.yaml --json", "display_check"),
    Call("display import cave.pvx --out imported.yaml --json", "display_import",
         before=("display example cave.pvx --out cave.pvx",)),
    Call("recording info walk.lwr --json", "recording_info", needs="display",
         before=("view cornell --size 64x48 --time-limit 2 --record walk.lwr",)),
    Call("track listen --type file --file walk.csv --seconds 0.2 --json", "track_listen", before=("track walk --seconds 1 --out walk.csv",)),
    Call("track listen --type vrpn --device Tracker0@127.0.0.1:1 --seconds 0.2 --json", "track_listen"),
    Call("xr info --json", "xr_info", needs="headset"),
    Call("ar cameras --json", "ar_cameras"),
    Call("ar record counter --out recorded --frames 5 --size 320x240 --rate 60 --json", "ar_record"),
    Call("ar replay recorded --fast --json", "ar_replay"),
    Call("ar light desk/session.yaml --poses desk/poses.csv --views 1 --out light.exr --json", "ar_light",
         before=("ar synthesize desk --frames 2 --size 64x48 --paths 1",)),
    Call("ar light desk/session.yaml --poses desk/poses.csv --views 2 --out light.exr --stats light.json", "ar_light", file="light.json"),
    Call("ar run desk/session.yaml --fast --poses desk/poses.csv --stats run.json", "ar_run_stats", file="run.json"),
    Call("batch plan example.yaml --json", "batch_plan", before=("batch example --out example.yaml",)),
    Call("batch --store walk.batch --json --quiet render atrium --frames 0:2@24 --paths 1 --size 16x12 --out w_%04d.exr", "batch"),
    Call("batch resume walk.batch --json --quiet", "batch"),
    Call("batch status walk.batch --messages --json", "batch_status"),
    Call("batch gather walk.batch --out walk --json", "batch_gather"),
    Call("ar bench --counter --size 320x240 --frames 4 --json", "ar_bench"),
    Call("ar bench desk/session.yaml --frames 2 --still-frames 2 --json", "ar_bench", codes=(0, 1)),  # 1: too few pixels to find the camera
]


def write_inputs():
    (WORK / "lit.yaml").write_text("models: [{file: avatar.glb}]\nenvironment: {file: sky.exr}\n"
                                   "cameras: [{name: lens, from: [0, 1, 3], at: [0, 1, 0], fov: 40}]\n")
    (WORK / "screen.yaml").write_text("schema: display-model/1\ndate: 2026-12-01\n"
                                      "screen: {size_px: [1920, 1080], size_cm: [53.1, 29.87], distance_cm: 57, method: typed}\n")
    (WORK / "gaze.csv").write_text("t_s,x_px,y_px\n" + "".join(f"{i / 250},{600 + 300 * (i // 100)},540\n" for i in range(400)))
    (WORK / "room.yaml").write_text("""
world: {position_m: [1, 0, 2], yaw_deg: 30}
walls: [{name: wall, lower_left_m: [-1, 0, 0], lower_right_m: [1, 0, 0], upper_left_m: [-1, 1, 0], window: wall}]
windows: [{name: wall, size_px: [640, 320]}]
users: [{name: viewer, head_position_m: [0, 1, -2]}]
""")
    (WORK / "wrong.yaml").write_text("schema: study/1\nid: wrong\nblocks:\n  one: {task: guess}\n")
    readings = ["channel,value,cd_m2"]
    for channel, peak in (("red", 21), ("green", 71), ("blue", 8)):
        readings += [f"{channel},{i / 8},{0.3 + peak * (i / 8) ** 2.2}" for i in range(9)]
    (WORK / "readings.csv").write_text("\n".join(readings) + "\n")


def write_diode():
    """A flash for each onset of the first session of `rating`, 10 ms late."""
    shown = {}
    for line in (WORK / "rating/sub-P001/ses-01/beh/journal.jsonl").read_text().splitlines():
        for stimulus in json.loads(line).get("shown", []):
            shown[stimulus["onset_s"]] = stimulus["duration_s"]
    edges = [(at + 0.01, light) for start, length in sorted(shown.items()) for at, light in ((start, 1), (start + length, 0))]
    rows, light, k = ["t_s,light"], 0, 0
    for i in range(int(1000 * (edges[-1][0] - edges[0][0] + 2))):
        t = edges[0][0] - 1 + i / 1000
        while k < len(edges) and edges[k][0] <= t:
            light, k = edges[k][1], k + 1
        rows.append(f"{t:.4f},{light + 0.01 * (i % 3)}")
    (WORK / "diode.csv").write_text("\n".join(rows) + "\n")


def lightwell(arguments, prefix=()):
    return subprocess.run([*prefix, PROGRAM, *arguments.split()], capture_output=True, text=True, cwd=WORK, timeout=100)


@functools.cache
def display():
    """Starts an X server; its display, or empty if there is none."""
    if not shutil.which("Xvfb"):
        return ""
    read, write = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(write), "-screen", "0", "640x480x24", "-nolisten", "tcp", "-noreset"],
                              pass_fds=[write], stderr=subprocess.DEVNULL)
    atexit.register(server.terminate)
    os.close(write)
    number = os.read(read, 16).decode().strip()
    return ":" + number if number else ""


def commands_with_json(path=()):
    text = lightwell(" ".join([*path, "--help"])).stdout
    found = {" ".join(path)} if re.search(r"^  (-\w,)?--json\b", text, re.M) else set()
    for block in re.findall(r"^[A-Z][^\n]*:\n((?:  [a-z]\w*  .*\n(?: {6,}.*\n)*)+)", text, re.M):
        for name in re.findall(r"^  ([a-z]\w*)  ", block, re.M):
            if name != "help":  # prints the help of all others
                found |= commands_with_json((*path, name))
    return found


def documents(text):
    """The JSON documents of a text, one after another."""
    decoder, at, found = json.JSONDecoder(), 0, []
    while at < len(text.rstrip()):
        document, at = decoder.raw_decode(text, at)
        found.append(document)
        at += len(text[at:]) - len(text[at:].lstrip())
    return found


def undescribed(schema, at=""):
    """Keys without a description, and objects whose keys are named but not closed."""
    if isinstance(schema, list):
        for k, part in enumerate(schema):
            yield from undescribed(part, f"{at}/{k}")
    if not isinstance(schema, dict):
        return
    named = schema.get("properties", {}) if isinstance(schema.get("properties", {}), dict) else {}
    if "properties" in schema and schema.get("additionalProperties") is not False:
        yield f"{at}: additionalProperties is not false"
    unnamed = [schema["additionalProperties"]] if isinstance(schema.get("additionalProperties"), dict) else []
    for key, part in [*named.items(), *schema.get("patternProperties", {}).items(), *(("*", part) for part in unnamed)]:
        if not part.get("description", "").strip():
            yield f"{at}/{key}: no description"
    for key, part in schema.items():
        if key not in ("const", "enum", "required"):
            yield from undescribed(part, f"{at}/{key}")


def load_schemas():
    schemas = {file.name.removesuffix(".schema.json"): json.loads(file.read_text()) for file in sorted(SCHEMAS.glob("*.schema.json"))}
    store = {f"{SCHEMAS.as_uri()}/{name}.schema.json": schema for name, schema in schemas.items()}
    validators = {}
    for name, schema in schemas.items():
        try:
            jsonschema.Draft202012Validator.check_schema(schema)
        except jsonschema.SchemaError as e:
            failures.append(f"{name}.schema.json is no schema: {e.message}")
        if name != "common" and not (schema.get("title") and schema.get("description")):
            failures.append(f"{name}.schema.json: no title or no description")
        failures.extend(f"{name}.schema.json{problem}" for problem in undescribed(schema))
        resolver = jsonschema.RefResolver(f"{SCHEMAS.as_uri()}/{name}.schema.json", schema, store=store)
        validators[name] = jsonschema.Draft202012Validator(schema, resolver=resolver)
    return validators


def check(what, document, validator):
    for error in validator.iter_errors(document):
        for e in error.context or [error]:
            failures.append(f"{what}: {'/'.join(map(str, e.absolute_path))}: {e.message[:300]}")
    if validator.is_valid({**document, "not described": 1}):
        failures.append(f"{what}: its schema lets undescribed keys pass")
    if validator.is_valid({k: v for k, v in list(document.items())[1:]}):
        failures.append(f"{what}: its schema does not require {next(iter(document))}")
    for name, rows in document.get("tables", {}).items():
        if any(row.keys() != document["columns"][name].keys() for row in rows):
            failures.append(f"{what}: columns of {name} are not explained")


def run(call, validator):
    prefix = ()
    if call.needs == "display":
        if not display():
            return "SKIPPED: no Xvfb"
        prefix = ("env", f"DISPLAY={display()}")
    for arguments in call.before:
        made = lightwell(arguments, prefix)
        if made.returncode != 0:
            failures.append(f"{arguments}: {made.stderr}")
    if call.schema == "study_photodiode":
        write_diode()
    if call.schema == "study_run":  # nobody answers
        prefix += ("sh", "-c", '"$@" & while kill -0 $! && ! [ -e run/sub-P001/ses-01/beh/journal.jsonl ]; do sleep 0.1; done; '
                   "kill -TERM $!; wait $!", "sh")
    done = lightwell(call.arguments, prefix)
    if call.needs == "headset" and done.returncode == 2:
        return "SKIPPED: no headset"
    if done.returncode not in call.codes:
        failures.append(f"{call.arguments}: exit code {done.returncode}\n{done.stderr}")
        return "failed"
    try:
        all = documents((WORK / call.file).read_text() if call.file else done.stdout)
    except (OSError, ValueError) as e:
        failures.append(f"{call.arguments}: no JSON: {e}")
        return "failed"
    if not all:
        failures.append(f"{call.arguments}: printed nothing")
    before = len(failures)
    for document in all:
        check(call.arguments, document, validator)
    return f"{len(all)} validated" if len(failures) == before else "failed"


def main():
    validators = load_schemas()
    write_inputs()
    for command in sorted(commands_with_json()):
        if not any(c.arguments.startswith(command + " ") and not c.file and c.schema in validators for c in CALLS):
            failures.append(f"lightwell {command} --json has no schema or no call in {Path(__file__).name}")
    for schema in sorted(validators.keys() - {"common"} - {c.schema for c in CALLS}):
        failures.append(f"{schema}.schema.json describes the output of no call")
    for call in CALLS:
        if call.schema in validators:
            print(f"lightwell {call.arguments}: {run(call, validators[call.schema])}", flush=True)
    print("\n".join(f"FAILED: {f}" for f in failures))
    return 1 if failures else 0


sys.exit(main())
